// SPDX-License-Identifier: Apache-2.0
// The dispatcher between queues and slots played by the test: every pair is answered once, by a slot that serves its
// kind, with what that slot said, or as an open one.
#include <deque>
#include <map>
#include <models/cchip_dispatcher.hpp>
#include <optional>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

struct WaitingPair {
  std::uint16_t tag;
  int kind;
};

template <class Config>
class DispatcherBench {
 public:
  static constexpr int slots = Config::SLOTS;
  static constexpr unsigned kinds = Config::KINDS;

  DispatcherBench(sim::Simulation<typename Config::Model>& s, Random& r) : simulation(s), top(s.top()), random(r) {
    top.some = top.no_provider = top.stop = top.decouple = 0;
    top.s_result_valid = 0;
    top.m_result_ready = 1;
    put_modules();
    reset();
  }
  /// Also in mid traffic: all that is inside is forgotten. One clock of reset is enough, also on that of a grant.
  void reset() {
    top.some = 0;
    top.s_result_valid = 0;
    simulation.reset(1 + static_cast<int>(random() % 2));
    simulation.settle();
    REQUIRE(top.m_result_valid == 0);
    REQUIRE((top.answered == 0 && top.refused_kind == 0 && top.refused_provider == 0));
    open_.clear();
    for (const auto& queue : queues) {
      for (const WaitingPair& pair : queue) open_.emplace(pair.tag, pair.kind);
    }
    said_.clear();
    for (Slot& slot : slots_) slot.pairs.clear();
    popped_clocks_ = 3;
    left_.reset();
    looked_ = false;
    // pairs may also wait from the first clock on, before the slots are open for them
    if (chance(random, 50)) simulation.steps(Config::CREDIT + 10);
  }
  void push(int kind) {
    std::uint16_t tag = 0;
    do tag = static_cast<std::uint16_t>(random());
    while (open_.count(tag) != 0);
    queues[static_cast<std::size_t>(kind)].push_back({tag, kind});
    open_[tag] = kind;
  }
  /// Nothing comes and goes but answers: the counts are exact then.
  void check_outstanding() {
    for (int clock = 0; clock < 40; ++clock) this->clock(0, 100, false);
    for (int s = 0; s < slots; ++s) {
      const auto count = sim::get_bits(top.outstanding, defs::pair_count_w * s, defs::pair_count_w);
      REQUIRE(count == slots_[static_cast<std::size_t>(s)].pairs.size());
      most_outstanding = std::max(most_outstanding, count);
    }
  }
  /// \param results percent of the clocks on which each slot answers
  void clock(int results, int ready, bool pairs = true) {
    unsigned some = 0;
    for (unsigned k = 0; k <= kinds; ++k) some |= queues[k].empty() || !pairs ? 0 : 1U << k;
    top.some = static_cast<CData>(some);
    top.m_result_ready = chance(random, ready) ? 1 : 0;
    sim::set_random(top.descriptor, defs::descriptor_w, random);
    if (popped_clocks_ == 1 || popped_clocks_ == 2)
      sim::set_bits(top.descriptor, defs::descriptor_tag.lsb, defs::descriptor_tag.width, popped_.tag);
    if (popped_clocks_ < 3) ++popped_clocks_;
    for (int s = 0; s < slots; ++s) {
      auto& inside = slots_[static_cast<std::size_t>(s)];
      std::uint64_t word = random();
      bool valid = false;
      if (!inside.pairs.empty() && inside.connected && chance(random, results)) {
        auto it = inside.pairs.begin();
        std::advance(it, static_cast<std::ptrdiff_t>(random() % inside.pairs.size()));
        word = (word & ~std::uint64_t{255}) | static_cast<std::uint64_t>(it->first);
        said_[it->second] = {word >> defs::slot_result_hit.lsb & content_mask, inside.module_id};
        inside.pairs.erase(it);
        valid = true;
      }
      sim::set_bits(top.s_result_data, defs::slot_result_w * s, defs::slot_result_w,
                    word & ((std::uint64_t{1} << defs::slot_result_w) - 1));
      sim::set_bits(top.s_result_valid, s, 1, valid ? 1 : 0);
    }
    simulation.settle();
    REQUIRE((top.answered != 0) == left_.has_value());
    if (left_) REQUIRE(int{top.answered_module} == *left_);
    left_.reset();
    for (int s = 0; s < slots; ++s) {
      int& stopped = slots_[static_cast<std::size_t>(s)].stopped;
      stopped = (top.stop >> s & 1U) != 0 ? stopped + 1 : 0;
      if ((top.m_vertex_valid >> s & 1U) == 0) continue;
      REQUIRE(unsigned{top.m_vertex_valid} == 1U << s);
      auto& inside = slots_[static_cast<std::size_t>(s)];
      if (top.m_vertex_first != 0) {
        vertices_ = 0;
        read_kind_ = popped_.kind;
        read_tag_ = popped_.tag;
        REQUIRE(read_kind_ > 0);
        REQUIRE(stopped < 12);  // what was chosen before may still come
        if (inside.connected)
          REQUIRE(defs::rm_serves(inside.module_id, read_kind_) != 0);  // it can answer for this kind
        inside.next = static_cast<int>(sim::get_bits(top.m_vertex_id, defs::pair_id_w * s, defs::pair_id_w));
      }
      ++vertices_;
      if (top.m_vertex_last == 0) continue;
      REQUIRE(vertices_ == (read_kind_ == 2 || read_kind_ == 3 ? 4 : 3));
      if (inside.connected) REQUIRE(inside.pairs.emplace(inside.next, read_tag_).second);
    }
    // The first vertex of a pair comes two clocks after it left its queue; the next pair may leave before the last one.
    if (top.pop != 0) {
      REQUIRE((looked_ && top.look == 0));  // its place was fetched on the clock before
      unsigned kind = 0;
      while ((top.kind >> kind & 1U) == 0) ++kind;
      REQUIRE(unsigned{top.kind} == 1U << kind);
      REQUIRE(!queues[kind].empty());
      popped_ = queues[kind].front();
      queues[kind].pop_front();
      popped_clocks_ = 0;
    }
    looked_ = top.look != 0;
    if (top.m_result_valid != 0 && top.m_result_ready != 0) {
      const auto get = [&](defs::Field f) { return sim::get_bits(top.m_result_data, f.lsb, f.width); };
      const auto it = open_.find(static_cast<std::uint16_t>(get(defs::result_tag)));
      REQUIRE(it != open_.end());
      REQUIRE(it->second == int{top.m_result_kind});
      ++answers;
      last_open = get(defs::result_hit) == 1 && get(defs::result_grid) == 1 && get(defs::result_definite) == 0 &&
                  get(defs::result_axis) == static_cast<std::uint64_t>(AxisClass::illegal) << 6 &&
                  get(defs::result_beats) == 0;
      opens += last_open ? 1 : 0;
      if (it->second == 0) REQUIRE(last_open);
      const auto said = said_.find(it->first);
      const std::uint64_t content = sim::get_bits(top.m_result_data, defs::result_hit.lsb, defs::slot_result_w - 8);
      if (said != said_.end() && said->second.content == content) {
        left_ = said->second.module_id;
        ++tested;
      } else {
        REQUIRE(last_open);
        left_ = 0;
      }
      if (said != said_.end()) said_.erase(said);
      open_.erase(it);
    }
    counted += top.answered;
    by_nobody += top.answered != 0 && top.answered_module == 0 ? 1 : 0;
    illegal += top.refused_kind;
    unprovided += top.refused_provider;
    simulation.rise();
  }
  void put_modules() {
    for (int s = 0; s < slots; ++s) {
      sim::set_bits(top.slot_module, defs::kind_w * s, defs::kind_w,
                    static_cast<std::uint64_t>(slots_[static_cast<std::size_t>(s)].module_id));
    }
  }
  /// A module in a slot, or none; pairs inside it are gone.
  void load(int slot, int module_id) {
    auto& s = slots_[static_cast<std::size_t>(slot)];
    s.module_id = module_id;
    s.connected = module_id != 0;
    if (module_id == 0) s.pairs.clear();
    put_modules();
  }
  int module_in(int slot) const { return slots_[static_cast<std::size_t>(slot)].module_id; }
  std::size_t open() const { return open_.size(); }

  sim::Simulation<typename Config::Model>& simulation;
  typename Config::Model& top;
  Random& random;
  std::array<std::deque<WaitingPair>, kinds + 1> queues;
  std::uint64_t answers = 0, tested = 0, most_outstanding = 0, opens = 0, counted = 0, by_nobody = 0, illegal = 0,
                unprovided = 0;
  bool last_open = false;

 private:
  struct Slot {
    int module_id = 0;
    bool connected = false;
    std::map<int, std::uint16_t> pairs;  // tag by number
    int next = 0;
    int stopped = 0;  // clocks
  };
  /// What a slot said of a pair: all but its number.
  struct Said {
    std::uint64_t content;
    int module_id;
  };
  static constexpr std::uint64_t content_mask = (std::uint64_t{1} << (defs::slot_result_w - 8)) - 1;
  std::array<Slot, 4> slots_{};
  std::map<std::uint16_t, int> open_;   // kind by tag
  std::map<std::uint16_t, Said> said_;  // by tag
  std::optional<int> left_;             // module of the answer that left a clock ago
  bool looked_ = false;
  WaitingPair popped_{};
  int popped_clocks_ = 3;
  int read_kind_ = 0;  // of the pair whose vertices come
  std::uint16_t read_tag_ = 0;
  int vertices_ = 0;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_dispatcher: every pair is answered once, with any exchanges, by force or not",
                        "[unit][cchip_dispatcher]", cchip_dispatcher_configs) {
  constexpr int slots = TestType::SLOTS;
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    DispatcherBench<TestType> bench(simulation, random);
    auto& top = bench.top;
    std::uint64_t pushed = 0, given_up = 0;
    for (int s = 0; s < slots; ++s) bench.load(s, 1 + s % TestType::KINDS);
    for (int round = 0; round < 90; ++round) {
      for (int clock = static_cast<int>(random() % 300); clock > 0; --clock) {
        if (chance(random, 30)) {
          bench.push(static_cast<int>(random() % (TestType::KINDS + 1)));
          ++pushed;
        }
        bench.clock(15, 80);
      }
      if (chance(random, 10)) bench.check_outstanding();
      // a slot is exchanged, by force or when it is quiet
      const int slot = static_cast<int>(random() % slots);
      top.stop = static_cast<CData>(1U << slot);
      const bool force = chance(random, 50);
      int clocks = 0;
      do {
        bench.clock(15, 80);
        REQUIRE(++clocks < 5000);
      } while (!force && (top.quiet >> slot & 1U) == 0);
      top.decouple = top.stop;
      bench.clock(0, 80);
      bench.load(slot, 0);
      while ((top.decoupled >> slot & 1U) == 0) {
        bench.clock(15, 80);
        REQUIRE(++clocks < 6000);
      }
      const auto lost = sim::get_bits(top.lost, defs::pair_count_w * slot, defs::pair_count_w);
      if (!force) REQUIRE(lost == 0);
      given_up += lost;
      top.decouple = 0;
      bench.clock(15, 80);
      bench.load(slot, 1 + static_cast<int>(random() % TestType::KINDS));
      top.stop = 0;
    }
    for (int clock = 0; bench.open() > 0; ++clock) {
      REQUIRE(clock < 200000);
      if (clock % 4000 == 0) {  // quads and what else there is in turn, with nothing on its way to a slot
        top.stop = static_cast<CData>((1U << slots) - 1);
        for (int i = 0; i < 40; ++i) bench.clock(30, 100);
        for (int s = 0; s < slots; ++s) bench.load(s, clock % 8000 == 0 ? 3 : TestType::KINDS);
        top.stop = 0;
      }
      bench.clock(30, 100);
    }
    for (int clock = 0; clock < 50; ++clock) bench.clock(30, 100);
    REQUIRE(bench.answers == pushed);
    REQUIRE(bench.counted == pushed);
    REQUIRE(bench.by_nobody == bench.illegal + given_up);
    REQUIRE(bench.illegal > 100);
    REQUIRE(given_up > 20);
    REQUIRE(bench.unprovided == 0);
    REQUIRE(bench.tested > 500);
    REQUIRE(bench.most_outstanding > 0);
    bench.check_outstanding();
  });
}

TEMPLATE_LIST_TEST_CASE(
    "cchip_dispatcher: each slot alone, with each module, tests what the module serves, the rest is refused when "
    "nobody provides it",
    "[unit][cchip_dispatcher]", cchip_dispatcher_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    DispatcherBench<TestType> bench(simulation, random);
    for (int slot = 0; slot < TestType::SLOTS; ++slot) {
      for (int module_id = 1; module_id <= TestType::KINDS; ++module_id) {
        CAPTURE(slot, module_id);
        for (int s = 0; s < TestType::SLOTS; ++s) bench.load(s, s == slot ? module_id : 0);
        std::size_t unserved = 0;
        std::uint64_t refused = 0;
        for (int kind = 1; kind <= TestType::KINDS; ++kind) {
          for (int i = 0; i < 3; ++i) bench.push(kind);
          const bool served = defs::rm_serves(module_id, kind) != 0;
          unserved += served ? 0 : 3;
          refused |= served ? 0 : 1U << (kind - 1);
        }
        for (int clock = 0; clock < 400; ++clock) bench.clock(30, 80);
        REQUIRE(bench.open() == unserved);
        for (std::uint64_t left = refused; left != 0; left &= left - 1) {
          const std::uint64_t kind = left & ~(left - 1);
          bench.top.no_provider = static_cast<CData>(kind);
          for (int clock = 0; clock < 100; ++clock) bench.clock(30, 80);
          REQUIRE(bench.open() == (unserved -= 3));
        }
        bench.top.no_provider = 0;
        for (int clock = 0; clock < 10; ++clock) bench.clock(30, 80);
      }
    }
    REQUIRE(bench.answers == bench.tested + bench.unprovided);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_dispatcher: a refused pair waits for the one before to leave, however slow the receiver",
                        "[unit][cchip_dispatcher]", cchip_dispatcher_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    DispatcherBench<TestType> bench(simulation, random);
    for (const int ready : {1, 5, 30}) {
      for (int i = 0; i < 40; ++i) bench.push(0);
      for (int clock = 0; bench.open() > 0; ++clock) {
        REQUIRE(clock < 20000);
        bench.clock(0, ready);
      }
    }
    REQUIRE(bench.illegal == 120);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_dispatcher: a reset in mid traffic forgets what is inside, and nothing else",
                        "[unit][cchip_dispatcher]", cchip_dispatcher_configs) {
  constexpr int slots = TestType::SLOTS;
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    DispatcherBench<TestType> bench(simulation, random);
    for (int s = 0; s < slots; ++s) bench.load(s, TestType::KINDS < 3 ? 1 : 3);
    const int most = std::min(TestType::KINDS, 3);
    for (int round = 0; round < 100; ++round) {
      for (int i = 0; i < 20; ++i) bench.push(static_cast<int>(random() % static_cast<unsigned>(most + 1)));
      // results slow, receiver slow: pairs, a refused one, an answer are inside
      for (int clock = static_cast<int>(random() % 60); clock > 0; --clock) bench.clock(20, 30);
      bench.reset();
      for (int clock = 0; bench.open() > 0; ++clock) {
        REQUIRE(clock < 4000);
        bench.clock(30, 100);
      }
      bench.check_outstanding();
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_dispatcher: a kind without a module is left open, the others are tested",
                        "[unit][cchip_dispatcher]", cchip_dispatcher_configs) {
  constexpr int slots = TestType::SLOTS;
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    DispatcherBench<TestType> bench(simulation, random);
    for (int s = 0; s < slots; ++s) bench.load(s, 1);
    bench.top.no_provider = 4;  // kind 3; kind 2 waits for a bitstream
    for (int i = 0; i < 90; ++i) bench.push(1 + i % 3);
    for (int clock = 0; clock < 4000; ++clock) bench.clock(30, 100);
    REQUIRE(bench.open() == 30);
    REQUIRE(bench.unprovided == 30);
    REQUIRE(bench.by_nobody == 30);
    REQUIRE(bench.queues[2].size() == 30);
    bench.load(0, 2);
    for (int clock = 0; clock < 4000; ++clock) bench.clock(30, 100);
    REQUIRE(bench.open() == 0);
    REQUIRE(bench.by_nobody == 30);
  });
}
