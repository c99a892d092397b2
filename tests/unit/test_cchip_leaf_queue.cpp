// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/leaf_queue.hpp>
#include <deque>
#include <models/cchip_leaf_queue.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using model::LeafQueue;

/// Chances in per cent on a clock.
struct Behaviour {
  const char* name = "usual";
  int entry = 20;   ///< the sender has an entry
  int many = 50;    ///< of an entry: any set of pairs, else one pair
  int dead = 20;    ///< of an entry: its query has ended already
  int epoch = 5;    ///< an epoch changes
  int ready = 60;   ///< of pairs to fetch
  int drop = 60;    ///< ready of those to drop
  int credit = 40;  ///< a pair leaves the receiver
  int reset = 5;    ///< per mille
};
using B = Behaviour;
const std::vector<B> behaviours = {
    changed<B>("fast", {{&B::entry, 100},
                        {&B::dead, 0},
                        {&B::epoch, 0},
                        {&B::ready, 100},
                        {&B::drop, 100},
                        {&B::credit, 100},
                        {&B::reset, 0}}),
    B{},
    changed<B>("seldom", {{&B::entry, 5},
                          {&B::many, 20},
                          {&B::epoch, 2},
                          {&B::ready, 50},
                          {&B::drop, 50},
                          {&B::credit, 50},
                          {&B::reset, 20}}),
    changed<B>("no credit", {{&B::entry, 30},
                             {&B::dead, 10},
                             {&B::epoch, 2},
                             {&B::ready, 100},
                             {&B::drop, 100},
                             {&B::credit, 5},
                             {&B::reset, 3}}),
    changed<B>("none taken",
               {{&B::entry, 30}, {&B::dead, 30}, {&B::ready, 5}, {&B::drop, 5}, {&B::credit, 50}, {&B::reset, 3}}),
    changed<B>("epochs change", {{&B::entry, 30},
                                 {&B::dead, 30},
                                 {&B::epoch, 60},
                                 {&B::ready, 40},
                                 {&B::drop, 40},
                                 {&B::credit, 60},
                                 {&B::reset, 10}}),
    changed<B>("all ended", {{&B::entry, 50},
                             {&B::dead, 100},
                             {&B::epoch, 0},
                             {&B::ready, 50},
                             {&B::drop, 100},
                             {&B::credit, 0},
                             {&B::reset, 0}}),
    changed<B>("all ended, not taken",
               {{&B::entry, 50}, {&B::dead, 100}, {&B::epoch, 10}, {&B::ready, 100}, {&B::drop, 10}, {&B::credit, 20}}),
};

template <class Config>
class LeafQueueBench {
 public:
  static constexpr std::size_t contexts = Config::QUERIES;
  static constexpr int context_w = contexts == 2 ? 1 : contexts == 4 ? 2 : contexts == 8 ? 3 : 4;

  LeafQueueBench(sim::Simulation<typename Config::Model>& simulation, Random& random)
      : simulation_(simulation),
        top_(simulation.top()),
        random_(random),
        model_(contexts, Config::DEPTH, Config::CREDIT),
        epochs_(contexts) {
    idle();
    for (std::size_t c = 0; c < contexts; ++c) {  // also while rst is 1
      in_.epoch = LeafQueue::Epoch{c, static_cast<unsigned>(random_() % 4)};
      step(true);
    }
    idle();
  }

  void run(const Behaviour& how, int clocks) {
    for (int clock = 0; clock < clocks; ++clock) {
      in_.entry.reset();
      in_.epoch.reset();
      if (chance(random_, how.epoch)) in_.epoch = LeafQueue::Epoch{random_() % contexts, any_epoch()};
      if (may_send() && chance(random_, how.entry)) in_.entry = any_entry(how);
      in_.ready = chance(random_, how.ready);
      in_.drop_ready = chance(random_, how.drop);
      in_.credit = outside_ != 0 && chance(random_, how.credit);
      step(static_cast<int>(random_() % 1000) < how.reset);
    }
  }
  /// Everything that is inside comes out.
  void drain() {
    idle();
    in_.ready = in_.drop_ready = true;
    for (int clock = 0; clock < 100 + 64 * (Config::DEPTH + 1) && !expected_.empty(); ++clock) {
      in_.credit = outside_ != 0;
      step(false);
    }
    REQUIRE(expected_.empty());
    in_.credit = false;
    for (int clock = 0; clock < 4; ++clock) step(false);
    REQUIRE(inside_ == 0);
  }

  void idle() { in_ = LeafQueue::Inputs{}; }
  LeafQueue::Inputs& in() { return in_; }
  bool may_send() const { return inside_ < Config::DEPTH && !first_; }
  LeafQueue::Entry any_entry(const Behaviour& how) {
    LeafQueue::Entry entry;
    entry.context = random_() % contexts;
    entry.epoch = (epochs_[entry.context] + (chance(random_, how.dead) ? 1 + random_() % 3 : 0)) % 4;
    for (LeafQueue::Children* children : {&entry.a, &entry.b}) {
      for (unsigned& kind : children->kinds) kind = static_cast<unsigned>(random_() % 4);
      children->first = static_cast<std::uint32_t>(random_() % 4 == 0 ? ~(random_() % 8) : random_());
    }
    const std::uint64_t set = chance(random_, how.many) ? random_() & (random_() | random_()) : 0;
    entry.leaves = static_cast<std::uint16_t>(set % 65536 | std::uint64_t{1} << random_() % 16);
    if (chance(random_, how.many / 10)) entry.leaves = 0xffff;
    return entry;
  }

  /// One clock with the inputs in().
  void step(bool reset) {
    top_.rst = reset ? 1 : 0;
    drive();
    simulation_.settle();
    if (defined_) compare();
    if (defined_ && random_() % 8 == 0) require_registers();
    if (reset) {
      model_.reset(in_.epoch);
      expected_.clear();
      inside_ = outside_ = 0;
    } else {
      if (in_.entry) take(*in_.entry);
      if (in_.credit) --outside_;
      give();
      inside_ -= top_.m_room;
      model_.clock(in_);
    }
    first_ = reset;
    defined_ = defined_ || reset;
    if (in_.epoch) epochs_[in_.epoch->context] = in_.epoch->epoch;
    simulation_.rise();
  }

  int fetched = 0;
  int dropped = 0;
  int waits = 0;  ///< clocks with all credit used
  int full = 0;   ///< clocks without room

 private:
  unsigned any_epoch() { return static_cast<unsigned>(random_() % 4); }

  void drive() {
    sim::set_random(top_.s_a, 40, random_);
    sim::set_random(top_.s_b, 40, random_);
    sim::set_random(top_.s_leaves, 16, random_);
    sim::set_random(top_.s_context, context_w, random_);
    sim::set_random(top_.s_epoch, 2, random_);
    sim::set_random(top_.epoch_context, context_w, random_);
    sim::set_random(top_.epoch, 2, random_);
    top_.s_valid = in_.entry ? 1 : 0;
    if (in_.entry) {
      sim::set_bits(top_.s_context, 0, context_w, in_.entry->context);
      sim::set_bits(top_.s_epoch, 0, 2, in_.entry->epoch);
      set_children(top_.s_a, in_.entry->a);
      set_children(top_.s_b, in_.entry->b);
      top_.s_leaves = in_.entry->leaves;
    }
    top_.epoch_write = in_.epoch ? 1 : 0;
    if (in_.epoch) {
      sim::set_bits(top_.epoch_context, 0, context_w, in_.epoch->context);
      sim::set_bits(top_.epoch, 0, 2, in_.epoch->epoch);
    }
    top_.s_credit = in_.credit ? 1 : 0;
    top_.m_ready = in_.ready ? 1 : 0;
    top_.m_drop_ready = in_.drop_ready ? 1 : 0;
  }
  template <class Port>
  static void set_children(Port& port, const LeafQueue::Children& children) {
    sim::set_bits(port, 0, 32, children.first);
    for (int i = 0; i < 4; ++i) sim::set_bits(port, 32 + 2 * i, 2, children.kinds[static_cast<std::size_t>(i)]);
  }

  void compare() {
    REQUIRE((top_.m_room != 0) == model_.room());
    REQUIRE((top_.m_valid != 0) == model_.valid());
    REQUIRE((top_.m_drop_valid != 0) == model_.drop_valid());
    if (model_.valid() || model_.drop_valid()) require_pair(model_.pair());
    waits += outside_ + (model_.valid() ? 1 : 0) == Config::CREDIT ? 1 : 0;
    full += inside_ == Config::DEPTH ? 1 : 0;
  }
  void require_pair(const LeafQueue::Pair& pair) {
    REQUIRE(top_.m_context == pair.context);
    REQUIRE(top_.m_epoch == pair.epoch);
    REQUIRE(sim::get_bits(top_.m_kinds, 0, 2) == pair.kind_a);
    REQUIRE(sim::get_bits(top_.m_kinds, 2, 2) == pair.kind_b);
    REQUIRE(sim::get_bits(top_.m_lines, 0, 32) == pair.line_a);
    REQUIRE(sim::get_bits(top_.m_lines, 32, 32) == pair.line_b);
  }

  /// Independent of the model: every pair leaves once, in order, and never more than the receiver has room for.
  void take(const LeafQueue::Entry& entry) {
    ++inside_;
    for (unsigned bit = 0; bit < 16; ++bit) {
      if ((entry.leaves >> bit & 1) == 0) continue;
      expected_.push_back(LeafQueue::Pair{entry.context, entry.epoch, entry.a.kinds[bit / 4], entry.b.kinds[bit % 4],
                                          entry.a.first + bit / 4, entry.b.first + bit % 4});
    }
  }
  void give() {
    const bool fetch = top_.m_valid != 0 && in_.ready;
    const bool drop = top_.m_drop_valid != 0 && in_.drop_ready;
    REQUIRE((top_.m_valid & top_.m_drop_valid) == 0);
    if (!fetch && !drop) return;
    REQUIRE(!expected_.empty());
    require_pair(expected_.front());
    expected_.pop_front();
    fetched += fetch ? 1 : 0;
    dropped += drop ? 1 : 0;
    outside_ += fetch ? 1 : 0;
    REQUIRE(outside_ <= Config::CREDIT);
  }

  /// No output follows an input before the rising edge.
  void require_registers() {
    const auto outputs = [&] {
      return std::array<std::uint64_t, 7>{top_.m_room,  top_.m_valid, top_.m_drop_valid, top_.m_context,
                                          top_.m_epoch, top_.m_kinds, top_.m_lines};
    };
    const auto before = outputs();
    const auto rst = top_.rst;
    top_.rst ^= 1;
    top_.s_valid = random_() % 2;
    top_.s_leaves = 0xffff;
    top_.s_credit ^= 1;
    top_.m_ready ^= 1;
    top_.m_drop_ready ^= 1;
    top_.epoch_write ^= 1;
    top_.eval();
    REQUIRE(outputs() == before);
    top_.rst = rst;
    drive();
    top_.eval();
    REQUIRE(outputs() == before);
  }

  sim::Simulation<typename Config::Model>& simulation_;
  typename Config::Model& top_;
  Random& random_;
  LeafQueue model_;
  LeafQueue::Inputs in_;
  std::vector<unsigned> epochs_;
  std::deque<LeafQueue::Pair> expected_;
  int inside_ = 0;   // entries that the sender has counted in and m_room not out
  int outside_ = 0;  // pairs that the receiver holds
  bool first_ = true;
  bool defined_ = false;
};

LeafQueue::Entry entry_of(std::uint16_t leaves, std::size_t context, unsigned epoch) {
  LeafQueue::Entry entry;
  entry.context = context;
  entry.epoch = epoch;
  entry.leaves = leaves;
  entry.a = {{0, 1, 2, 3}, 0x1000};
  entry.b = {{3, 2, 1, 0}, 0xfffffffe};  // line numbers wrap
  return entry;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "cchip_leaf_queue: outputs are the model's on every clock, every pair leaves once, in order, with its lines",
    "[unit][cchip_leaf_queue]", cchip_leaf_queue_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    for (const Behaviour& how : behaviours) {
      CAPTURE(how.name);
      LeafQueueBench<TestType> bench(simulation, random);
      bench.run(how, 8000);
      bench.drain();
      if (how.dead < 100) REQUIRE(bench.fetched > 100);
      if (how.dead == 100 && how.epoch == 0) REQUIRE(bench.fetched == 0);
      if (how.dead > 0) REQUIRE(bench.dropped > 100);
      if (how.dead == 0) REQUIRE(bench.dropped == 0);
      if (how.credit == 5) REQUIRE(bench.waits > 1000);
      if (how.entry >= 30 && how.reset <= 5) REQUIRE(bench.full > 1000);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_leaf_queue: latency, rate, credit and the clock on which a pair is judged",
                        "[unit][cchip_leaf_queue]", cchip_leaf_queue_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    LeafQueueBench<TestType> bench(simulation, random);
    const auto restart = [&] {
      bench.idle();
      for (std::size_t c = 0; c < TestType::QUERIES; ++c) {
        bench.in().epoch = LeafQueue::Epoch{c, 1};
        bench.step(true);
      }
      bench.idle();
      bench.step(false);
    };

    // as fast as it goes: five clocks to the first pair, three from pair to pair, four to those of the next entry
    restart();
    bench.in().ready = true;
    int sent = 0;
    std::vector<int> left;
    for (int clock = 0; clock < 200; ++clock) {
      bench.in().entry.reset();
      if (bench.may_send() && sent < 3) {
        bench.in().entry = entry_of(0x8421, 1, 1);
        ++sent;
      }
      bench.in().credit = !left.empty() && left.back() == clock - 1;
      if (top.m_valid != 0) left.push_back(clock);
      bench.step(false);
    }
    REQUIRE(left.size() == 12);
    REQUIRE(left.front() == 5);
    if (TestType::CREDIT > 1 && TestType::DEPTH > 2) REQUIRE(left.back() == 5 + 3 * 11 + 2);

    // CREDIT pairs and no more; a pair of a query that has ended needs none; each credit that comes back lets one pass
    restart();
    bench.in().ready = bench.in().drop_ready = true;
    for (int clock = 0; clock < 60 * TestType::CREDIT; ++clock) {
      bench.in().entry.reset();
      if (bench.may_send()) bench.in().entry = entry_of(0xffff, 0, 1);
      bench.step(false);
    }
    REQUIRE(bench.fetched == 12 + TestType::CREDIT);
    bench.in().entry.reset();
    bench.in().credit = true;
    bench.step(false);
    bench.in().credit = false;
    for (int clock = 0; clock < 60; ++clock) bench.step(false);
    REQUIRE(bench.fetched == 12 + TestType::CREDIT + 1);
    REQUIRE(bench.dropped == 0);
    bench.in().epoch = LeafQueue::Epoch{0, 2};
    bench.step(false);
    bench.in().epoch.reset();
    for (int clock = 0; clock < 60; ++clock) bench.step(false);
    REQUIRE(bench.dropped > 10);
    bench.drain();

    // an epoch that changes on clock `change` after the entry: forgotten if it came before the pair was judged, which
    // is once; what is offered stays as it is. The other way round: an epoch that comes back
    for (const bool ends : {true, false}) {
      for (int change = -1; change < 10; ++change) {
        restart();
        const int fetched = bench.fetched;
        const int dropped = bench.dropped;
        for (int clock = -1; clock < 20; ++clock) {
          bench.in().entry.reset();
          bench.in().epoch.reset();
          if (clock == 0) bench.in().entry = entry_of(0x0040, 1, ends ? 1 : 3);
          if (clock == change) bench.in().epoch = LeafQueue::Epoch{1, 3};
          bench.in().ready = bench.in().drop_ready = clock >= 12;
          bench.step(false);
        }
        CAPTURE(ends, change);
        const bool before = change < 4;
        REQUIRE(bench.fetched - fetched == (ends != before ? 1 : 0));
        REQUIRE(bench.dropped - dropped == (ends != before ? 0 : 1));
      }
    }
  });
}
