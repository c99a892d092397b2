// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <models/cchip_traversal_events.hpp>

#include "bench.hpp"
#include "traversal_ports.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using model::TraversalEvent;
using model::TraversalEvents;

unsigned below(Random& random, std::size_t n) { return static_cast<unsigned>(random() % n); }

/// A pipeline of seven clocks that decides at random, a box test and a leaf queue that answer at random, within the
/// rules.
class Surroundings {
 public:
  Surroundings(std::size_t queries, Random& random) : active_(queries), random_(random) {}
  int busy = 50;                                       ///< chance of any event that may happen on a clock, per cent
  std::uint64_t running = 6;                           ///< clock from which on the contexts may be used
  std::deque<TraversalEvents::QueryWords> before_any;  ///< queries that come first

  TraversalEvents::Inputs next() {
    TraversalEvents::Inputs in;
    in.running = clock_ >= running;
    in.start_ready = chance(random_, 90);
    if (!query_ && chance(random_, busy)) {
      if (before_any.empty()) {
        query_ = words();
      } else {
        query_ = before_any.front();
        before_any.pop_front();
      }
    }
    in.query = query_;
    if (!under_way_.empty() && chance(random_, busy)) {
      std::swap(under_way_[below(random_, under_way_.size())], under_way_.back());
      in.verdict.emplace();
      in.verdict->place = under_way_.back();
      in.verdict->waiting = static_cast<std::uint16_t>(random_());
      in.verdict->leaves = static_cast<std::uint16_t>(random_());
      in.verdict->strong = static_cast<std::uint16_t>(random_());
      in.verdict->best = below(random_, 16);
      in.verdict->tests = below(random_, 17);
      under_way_.pop_back();
    }
    in.lookup = looked_;
    if (!result_ && chance(random_, busy / 2)) {
      result_ = model::TraversalResult{below(random_, active_.size()), below(random_, 4), below(random_, 5),
                                       below(random_, 5), static_cast<QueryCode>(random_() % 8)};
    }
    in.result = result_;
    if (!drop_ && chance(random_, busy / 4))
      drop_ = TraversalEvents::Of{below(random_, active_.size()), below(random_, 4)};
    in.drop = drop_;
    in.leaf_room = leaves_ > 0 && chance(random_, busy);
    in.answer_room = answers_ > 0 && chance(random_, busy);
    if (pipeline_[4]) in.leaving = pipeline_[4]->context;
    if (pipeline_[6]) in.left = leave(*pipeline_[6]);
    return in;
  }

  void clock(const TraversalEvents& model, const TraversalEvents::Inputs& in) {
    if (model.query_ready()) query_.reset();
    if (model.result_ready()) result_.reset();
    if (model.drop_ready()) drop_.reset();
    if (const auto place = model.lookup_place(); place && model.lookup())
      looked_ = {context_of_.at(*place), below(random_, 4)};
    leaves_ -= in.leaf_room ? 1 : 0;
    answers_ -= in.answer_room ? 1 : 0;
    for (std::size_t i = 6; i > 0; --i) pipeline_[i] = pipeline_[i - 1];
    pipeline_[0] = model.event();
    ++clock_;
  }
  std::map<TraversalEvent, int> left;  ///< how many of each

 private:
  TraversalEvents::QueryWords words() {
    TraversalEvents::QueryWords x{};
    for (auto& word : x) word = static_cast<std::uint32_t>(random_());
    if (chance(random_, 80)) x[14] &= 0x3fffffff;
    if (chance(random_, 90)) {
      for (std::size_t i = 2; i < 11; ++i) x[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(x[i]) / 2);
    }
    if (chance(random_, 90)) {
      for (std::size_t i = 0; i < 2; ++i) x[i] /= 2;
    }
    if (chance(random_, 20)) {
      const std::array<std::uint32_t, 3> bases = {0xfeffffff, 0xff000000, 0xffffffff};
      x[below(random_, 2)] = bases[below(random_, 3)];
    }
    if (chance(random_, 20)) {
      const std::array<std::uint32_t, 4> extremes = {0x40000000, 0xc0000000, 0x40000001, 0xbfffffff};
      x[2 + below(random_, 9)] = extremes[below(random_, 4)];
    }
    return x;
  }

  TraversalEvents::Left leave(const TraversalEvents::Event& event) {
    TraversalEvents::Left x;
    x.context = event.context;
    ++left[event.event];
    bool goes = true;
    switch (event.event) {
      case TraversalEvent::start:
        x.start = true;
        x.cancel = chance(random_, 10);
        goes = !x.cancel && chance(random_, 90);
        active_[x.context] = goes;
        if (!goes && !x.cancel) ++answers_;
        x.room = goes ? 0 : 1;
        break;
      case TraversalEvent::pop:
        break;
      case TraversalEvent::verdict: {
        goes = active_[x.context] && chance(random_, 60);
        x.room = (event.extra ? 2U : 1U) - (goes ? 1U : 0U);
        const bool leaf = active_[x.context] && x.room > 0 && chance(random_, 50);
        x.room -= leaf ? 1 : 0;
        leaves_ += leaf ? 1 : 0;
        break;
      }
      case TraversalEvent::result:
        goes = false;
        break;
    }
    if (event.event != TraversalEvent::start && !goes && active_[x.context] && chance(random_, 20)) {
      active_[x.context] = false;
      ++answers_;
    }
    x.active = active_[x.context];
    x.wants = x.active && chance(random_, 70);
    if (event.event == TraversalEvent::result) return x;
    if (goes) {
      under_way_.push_back(event.place);
      context_of_[event.place] = x.context;
    } else {
      x.place = event.place;
    }
    return x;
  }

  std::vector<bool> active_;
  Random& random_;
  std::uint64_t clock_ = 0;
  std::optional<TraversalEvents::QueryWords> query_;
  std::optional<model::TraversalResult> result_;
  std::optional<TraversalEvents::Of> drop_;
  std::vector<std::size_t> under_way_;
  std::map<std::size_t, std::size_t> context_of_;
  TraversalEvents::Of looked_;
  std::array<std::optional<TraversalEvents::Event>, 7> pipeline_;
  int leaves_ = 0, answers_ = 0;
};

template <class Top>
void drive(Top& top, const TraversalEvents::Inputs& in, int context_w, int place_w) {
  top.running = in.running ? 1 : 0;
  top.start_ready = in.start_ready ? 1 : 0;
  top.s_query_valid = in.query ? 1 : 0;
  for (int i = 0; in.query && i < 16; ++i)
    sim::set_bits(top.s_query, 32 * i, 32, (*in.query)[static_cast<std::size_t>(i)]);
  top.s_verdict_valid = in.verdict ? 1 : 0;
  if (in.verdict) {
    put_verdict(top.s_verdict, *in.verdict);
    sim::set_bits(top.s_verdict, 57, place_w, in.verdict->place);
  }
  top.lookup_context = static_cast<CData>(in.lookup.context);
  top.lookup_epoch = static_cast<CData>(in.lookup.epoch);
  top.s_result_valid = in.result ? 1 : 0;
  if (in.result) {
    Fields(top.s_result)
        .field(3, in.result->hits)
        .field(3, in.result->open)
        .field(3, in.result->code)
        .field(2, in.result->epoch)
        .field(context_w, in.result->context);
  }
  top.s_drop_valid = in.drop ? 1 : 0;
  if (in.drop) {
    top.s_drop_context = static_cast<CData>(in.drop->context);
    top.s_drop_epoch = static_cast<CData>(in.drop->epoch);
  }
  top.s_leaving_valid = in.leaving ? 1 : 0;
  top.s_leaving_context = static_cast<CData>(in.leaving.value_or(0));
  const auto& left = in.left;
  top.s_left_valid = left ? 1 : 0;
  top.s_left_context = static_cast<CData>(left ? left->context : 0);
  top.s_left_active = left && left->active ? 1 : 0;
  top.s_left_wants = left && left->wants ? 1 : 0;
  top.s_left_start = left && left->start ? 1 : 0;
  top.s_left_cancel = left && left->cancel ? 1 : 0;
  top.s_left_back = left && left->place ? 1 : 0;
  if (left && left->place) top.s_left_place = static_cast<CData>(*left->place);
  top.s_left_room = static_cast<CData>(left ? left->room : 0);
  top.s_leaf_room = in.leaf_room ? 1 : 0;
  top.s_answer_room = in.answer_room ? 1 : 0;
}

template <class Top>
void check(const Top& top, const TraversalEvents& model) {
  REQUIRE((top.s_query_ready != 0) == model.query_ready());
  REQUIRE((top.s_result_ready != 0) == model.result_ready());
  REQUIRE((top.s_drop_ready != 0) == model.drop_ready());
  REQUIRE((top.lookup != 0) == model.lookup());
  REQUIRE((top.m_few != 0) == model.few());
  if (model.lookup_place()) REQUIRE(std::size_t{top.lookup_place} == *model.lookup_place());
  if (model.query()) {
    for (int i = 0; i < 16; ++i)
      REQUIRE(sim::get_bits(top.query, 32 * i, 32) == (*model.query())[static_cast<std::size_t>(i)]);
  }
  const auto& event = model.event();
  REQUIRE((top.m_valid != 0) == event.has_value());
  if (!event) return;
  REQUIRE((top.m_verdict_event != 0) == (event->event == TraversalEvent::verdict));
  REQUIRE((top.m_result_event != 0) == (event->event == TraversalEvent::result));
  REQUIRE((top.m_judge != 0) == event->judge);
  REQUIRE((top.m_start_event != 0) == (event->event == TraversalEvent::start));
  REQUIRE((top.m_pop_event != 0) == (event->event == TraversalEvent::pop));
  REQUIRE(std::size_t{top.m_context} == event->context);
  REQUIRE((top.m_extra != 0) == event->extra);
  if (event->event == TraversalEvent::start) REQUIRE((top.query_bad != 0) == model.query_bad());
  if (event->event != TraversalEvent::result) REQUIRE(std::size_t{top.m_place} == event->place);
  if (event->event == TraversalEvent::verdict || event->event == TraversalEvent::result) {
    REQUIRE(unsigned{top.m_epoch} == event->epoch);
  }
  if (event->event == TraversalEvent::verdict) {
    const model::BoxVerdict verdict = get_verdict(top.m_verdict);
    REQUIRE(verdict.waiting == event->verdict.waiting);
    REQUIRE(verdict.leaves == event->verdict.leaves);
    REQUIRE(verdict.strong == event->verdict.strong);
    REQUIRE(verdict.best == event->verdict.best);
    REQUIRE(verdict.tests == event->verdict.tests);
  }
  if (event->event == TraversalEvent::result) {
    const auto& r = event->result;
    REQUIRE(unsigned{top.m_result} == (static_cast<unsigned>(r.code) << 6 | r.open << 3 | r.hits));
  }
}

}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "cchip_traversal_events: the model's event on every clock, none of a query twice, none for ever",
    "[unit][cchip_traversal_events]", cchip_traversal_events_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    constexpr std::size_t queries = TestType::QUERIES;
    TraversalEvents model({queries, TestType::PAIRS, TestType::LEAF_DEPTH, TestType::ANSWERS});
    std::map<TraversalEvent, int> left;
    for (int run = 0; run < 40; ++run) {
      Surroundings around(queries, random);
      around.busy = run % 3 == 0 ? 90 : run % 3 == 1 ? 40 : 8;
      around.running = 6 + below(random, 4);
      drive(top, {}, log2(TestType::QUERIES), TestType::PLACE_W);
      simulation.reset();
      model.reset();
      for (int clock = 0; clock < 1000; ++clock) {
        const TraversalEvents::Inputs in = around.next();
        drive(top, in, log2(TestType::QUERIES), TestType::PLACE_W);
        simulation.settle();
        check(top, model);
        around.clock(model, in);
        model.clock(in);
        simulation.rise();
      }
      for (const auto& [event, n] : around.left) left[event] += n;
    }
    REQUIRE(left.size() == 4);
    for (const auto& [event, n] : left) {
      CAPTURE(static_cast<int>(event), n);
      REQUIRE(n > 200);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_traversal_events: each bit alone that makes a query illegal, and the legal ones beside",
                        "[unit][cchip_traversal_events]", cchip_traversal_events_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    std::deque<TraversalEvents::QueryWords> queries;
    const auto query = [&](std::size_t word, std::uint32_t value) {
      TraversalEvents::QueryWords words{};
      words[word] = value;
      queries.push_back(words);
    };
    for (std::size_t entry = 2; entry < 11; ++entry) {
      for (const std::uint32_t value : {0x40000000U, 0xc0000000U, 0x80000000U, 0xbfffffffU, 0x3fffffffU})
        query(entry, value);
      for (int bit = 0; bit < 30; ++bit) query(entry, 0x40000000U | 1U << bit);  // more than 1 by this bit
    }
    for (std::size_t base = 0; base < 2; ++base) {
      query(base, 0xff000000U);
      for (int bit = 24; bit < 32; ++bit) query(base, ~(1U << bit));
    }
    for (int bit = 0; bit < 32; ++bit) query(14, 1U << bit);
    std::shuffle(queries.begin(), queries.end(), random);
    TraversalEvents model({TestType::QUERIES, TestType::PAIRS, TestType::LEAF_DEPTH, TestType::ANSWERS});
    Surroundings around(TestType::QUERIES, random);
    around.busy = 90;
    around.before_any = queries;
    drive(top, {}, log2(TestType::QUERIES), TestType::PLACE_W);
    simulation.reset();
    model.reset();
    for (int clock = 0; clock < 200 * static_cast<int>(queries.size()) && !around.before_any.empty(); ++clock) {
      const TraversalEvents::Inputs in = around.next();
      drive(top, in, log2(TestType::QUERIES), TestType::PLACE_W);
      simulation.settle();
      check(top, model);
      around.clock(model, in);
      model.clock(in);
      simulation.rise();
    }
    REQUIRE(around.before_any.empty());
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_traversal_events: results and verdicts of a query enter in turn while both wait",
                        "[unit][cchip_traversal_events]", cchip_traversal_events_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& /*random*/) {
    auto& top = simulation.top();
    TraversalEvents model({TestType::QUERIES, TestType::PAIRS, TestType::LEAF_DEPTH, TestType::ANSWERS});
    constexpr std::size_t pairs = TestType::PAIRS < 7 ? TestType::PAIRS : 7;
    std::array<std::optional<TraversalEvents::Event>, 7> pipeline;
    std::deque<std::size_t> back;  // places of node pairs that are back from the box test at once
    std::size_t context = 0;
    std::size_t under_way = 0;
    bool asked = false;
    drive(top, {}, log2(TestType::QUERIES), TestType::PLACE_W);
    simulation.reset();
    model.reset();
    std::map<TraversalEvent, int> last, most;  // clock of the last one, most clocks without
    for (int clock = 0; clock < 4000; ++clock) {
      TraversalEvents::Inputs in;
      in.running = in.start_ready = true;
      if (!asked) in.query.emplace();
      if (pipeline[4]) in.leaving = pipeline[4]->context;
      if (pipeline[6]) {
        const TraversalEvents::Event& event = *pipeline[6];
        TraversalEvents::Left left;
        context = left.context = event.context;
        left.active = true;
        left.start = event.event == TraversalEvent::start;
        left.room = event.extra ? 1 : 0;
        if (event.event != TraversalEvent::result) back.push_back(event.place);
        under_way += left.start || event.event == TraversalEvent::pop ? 1 : 0;
        left.wants = under_way < pairs;
        in.left = left;
      }
      // the first one waits until the stack has sent others: after that one waits while another one is inside
      if (!back.empty() && (under_way >= 2 || clock > 300)) {
        in.verdict.emplace();
        in.verdict->place = back.front();
        back.pop_front();
      }
      in.lookup = {context, 0};
      const bool waits = clock > 500;  // a result, always
      if (waits) in.result = model::TraversalResult{context, 0, 0, 0, QueryCode::ok};
      drive(top, in, log2(TestType::QUERIES), TestType::PLACE_W);
      simulation.settle();
      CAPTURE(clock);
      check(top, model);
      if (top.m_valid != 0) {
        const TraversalEvent event = model.event()->event;
        if (clock > 600) most[event] = std::max(most[event], clock - last[event]);
        last[event] = clock;
      }
      asked = asked || model.query_ready();
      for (std::size_t i = 6; i > 0; --i) pipeline[i] = pipeline[i - 1];
      pipeline[0] = model.event();
      model.clock(in);
      simulation.rise();
    }
    REQUIRE(under_way >= 2);  // one of them waits while the other is inside
    for (const TraversalEvent event : {TraversalEvent::result, TraversalEvent::verdict}) {
      CAPTURE(static_cast<int>(event));
      REQUIRE(last[event] > 4000 - 17);
      REQUIRE(most[event] == 16);
    }
  });
}
