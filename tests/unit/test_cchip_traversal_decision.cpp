// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <map>
#include <models/cchip_traversal_decision.hpp>
#include <utility>

#include "bench.hpp"
#include "traversal_ports.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using model::Decision;
using model::Occurrence;
using model::TraversalEvent;

template <class Port, class State>
void state_fields(Fields<Port> fields, State& x, int stack_w) {
  fields.field(1, x.hit).field(8, x.open).field(32, x.pairs).field(32, x.steps).field(3, x.under_way);
  fields.field(stack_w + 1, x.entries).field(1, x.mode).field(1, x.active).field(2, x.epoch);
}
template <class Port>
void put_state(Port& port, const model::QueryState& x, int stack_w) {
  state_fields(Fields(port), x, stack_w);
}
template <class Port>
model::QueryState get_state(const Port& port, int stack_w) {
  model::QueryState x;
  state_fields(Fields(port), x, stack_w);
  return x;
}
template <class Port>
void put_constants(Port& port, const model::QueryConstants& x) {
  Fields(port).field(32, x.base_a).field(32, x.base_b).field(32, x.tag);
}
/// The child pair that a pop takes first.
unsigned first_of(const model::StackEntry& x) {
  const unsigned of = x.strong != 0 ? x.strong : x.waiting;
  unsigned n = 0;
  while (n < 15 && (of >> n & 1) == 0) ++n;
  return n;
}
bool has_others(const model::StackEntry& x) { return (x.waiting & (x.waiting - 1)) != 0; }
/// {others besides the first, first, strong, waiting, B, A}: fields of `x`, and of what the module works out of it.
template <class Port, class Entry, class First, class Others>
void entry_fields(Fields<Port> fields, Entry& x, First& first, Others& others) {
  fields.field(24, x.a.line).field(24, x.a.first).field(4, x.a.inner);
  fields.field(24, x.b.line).field(24, x.b.first).field(4, x.b.inner);
  fields.field(16, x.waiting).field(16, x.strong).field(4, first).field(1, others);
}
template <class Port>
void put_entry(Port& port, const model::StackEntry& x) {
  const unsigned first = first_of(x);
  const bool others = has_others(x);
  entry_fields(Fields(port), x, first, others);
}
template <class Port>
model::StackEntry get_entry(const Port& port) {
  model::StackEntry x;
  unsigned first = 0;
  bool others = false;
  entry_fields(Fields(port), x, first, others);
  REQUIRE(first == first_of(x));
  REQUIRE(others == has_others(x));
  return x;
}

unsigned below(Random& random, unsigned n) { return static_cast<unsigned>(random() % n); }
unsigned ones(unsigned x) { return x == 0 ? 0 : 1 + ones(x & (x - 1)); }
std::uint32_t line(Random& random) { return static_cast<std::uint32_t>(random()) & 0xffffff; }
/// Often 0, often one bit.
std::uint16_t some_of(Random& random, std::uint16_t of) {
  switch (random() % 4) {
    case 0:
      return 0;
    case 1:
      return static_cast<std::uint16_t>((1U << below(random, 16)) & of);
    default:
      return static_cast<std::uint16_t>(random() & of);
  }
}

/// As cchip_traversal can bring it about.
Occurrence occurrence(Random& random, const model::TraversalLimits& limits, unsigned work_w) {
  Occurrence o;
  o.event = static_cast<TraversalEvent>(below(random, 4));
  const bool start = o.event == TraversalEvent::start;
  const bool pop = o.event == TraversalEvent::pop;
  o.epoch = below(random, 4);
  o.extra = chance(random, 50);
  o.state.epoch = below(random, 4);
  o.state.active = !start && (pop || chance(random, 80));
  if (start || pop) o.epoch = o.state.epoch;
  o.live = o.state.active && o.epoch == o.state.epoch;
  o.state.mode = chance(random, 50) ? QueryMode::first : QueryMode::all;
  o.state.entries = chance(random, 30) ? 0 : chance(random, 30) ? limits.stack : random() % (limits.stack + 1);
  if (pop && o.state.entries == 0) o.state.entries = 1;
  o.state.under_way = below(random, 8);
  if (pop && o.state.under_way == 7) o.state.under_way = 6;
  if (o.event == TraversalEvent::verdict && o.live && o.state.under_way == 0) o.state.under_way = 1;
  o.state.steps = static_cast<std::uint32_t>(random());
  o.over = chance(random, 20);
  o.state.pairs = static_cast<std::uint32_t>(random());
  o.state.open = below(random, 256);
  o.state.hit = chance(random, 20);
  const auto constants = [&random] {
    return model::QueryConstants{static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()),
                                 static_cast<std::uint32_t>(random())};
  };
  o.constants = constants();
  o.query = constants();
  o.work = chance(random, 50) ? o.state.under_way : below(random, (1U << work_w) - 68);
  if (start && chance(random, 70)) o.work = 0;
  if ((o.event == TraversalEvent::verdict || o.event == TraversalEvent::result) && o.work == 0) o.work = 1;
  if (o.event == TraversalEvent::result && chance(random, 30)) o.state.under_way = o.work == 1 ? 0 : 1;
  o.verdict.waiting = some_of(random, 0xffff);
  o.verdict.leaves = some_of(random, static_cast<std::uint16_t>(~o.verdict.waiting));
  o.verdict.strong = some_of(random, o.verdict.waiting);
  do {
    o.verdict.best = below(random, 16);
  } while (o.verdict.waiting != 0 && (o.verdict.waiting >> o.verdict.best & 1) == 0);
  o.verdict.tests = 1 + below(random, 16);
  o.pair = {chance(random, 20), o.epoch, 15, 15, line(random), line(random)};
  if (chance(random, 20)) o.lines.code = static_cast<QueryCode>(4 + random() % 4);
  o.lines.kinds_a = static_cast<std::uint8_t>(random());
  o.lines.kinds_b = static_cast<std::uint8_t>(random());
  o.lines.first_a = line(random);
  o.lines.first_b = line(random);
  if (chance(random, 40)) o.result.hits = below(random, 5);
  if (chance(random, 40)) o.result.open = below(random, 5);
  if (chance(random, 10)) o.result.code = static_cast<QueryCode>(1 + random() % 7);
  o.top.a = {below(random, 16), line(random), line(random)};
  o.top.b = {below(random, 16), line(random), line(random)};
  o.top.waiting = static_cast<std::uint16_t>(some_of(random, 0xffff) | 1U << below(random, 16));
  o.top.strong = some_of(random, o.top.waiting);
  o.bad = chance(random, 20);
  o.mode = chance(random, 50) ? QueryMode::first : QueryMode::all;
  return o;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_traversal_decision: what the model decides, three clocks after every event",
                        "[unit][cchip_traversal_decision]", cchip_traversal_decision_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int stack_w = log2(TestType::STACK);
    auto& top = simulation.top();
    top.s_valid = 0;
    simulation.reset();
    std::optional<Decision> expected;
    std::array<std::optional<Occurrence>, 3> inside;  // oldest last
    unsigned open_limit_before = 0;
    std::map<QueryCode, int> codes;
    int wants = 0, pushes = 0, leaves = 0;
    model::TraversalLimits limits;
    limits.stack = TestType::STACK;
    for (int clock = 0; clock < 60000; ++clock) {
      // the limits change on any clock, often to their extremes
      if (chance(random, 30)) limits.pairs_each = below(random, 8);
      if (chance(random, 30)) limits.open = std::array{0U, 1U, 255U, below(random, 256)}[below(random, 4)];
      const bool valid = chance(random, 80);
      const bool reset = chance(random, 1);
      const Occurrence o = occurrence(random, limits, TestType::WORK_W);
      top.rst = reset ? 1 : 0;
      top.pairs_each = static_cast<CData>(limits.pairs_each);
      top.open_limit = static_cast<CData>(limits.open);
      top.s_valid = valid ? 1 : 0;
      top.s_is_verdict = o.event == TraversalEvent::verdict ? 1 : 0;
      top.s_is_result = o.event == TraversalEvent::result ? 1 : 0;
      top.s_is_start = o.event == TraversalEvent::start ? 1 : 0;
      top.s_is_pop = o.event == TraversalEvent::pop ? 1 : 0;
      top.s_epoch = static_cast<CData>(o.epoch);
      top.s_live = o.live ? 1 : 0;
      put_state(top.s_state, o.state, stack_w);
      put_constants(top.s_constants, o.constants);
      top.s_work = static_cast<SData>(o.work);
      top.s_over = o.over ? 1 : 0;
      top.s_full = o.state.entries == limits.stack ? 1 : 0;
      put_verdict(top.s_verdict, o.verdict);
      top.s_some_wait = o.verdict.waiting != 0 ? 1 : 0;
      top.s_rest = (o.verdict.waiting & ~(1U << o.verdict.best)) != 0 ? 1 : 0;
      top.s_some_leaves = o.verdict.leaves != 0 ? 1 : 0;
      top.s_leaves = static_cast<CData>(ones(o.verdict.leaves));
      top.s_extra = o.extra ? 1 : 0;
      top.s_room = o.verdict.leaves == 0 || o.extra ? 1 : 0;
      put_pair(top.s_record, o.pair);
      put_node_lines(top.s_nodes, o.lines);
      top.s_failed = o.lines.code != QueryCode::ok ? 1 : 0;
      top.s_result = static_cast<SData>(static_cast<unsigned>(o.result.code) << 6 | o.result.open << 3 | o.result.hits);
      put_entry(top.s_entry, o.top);
      top.query_bad = o.bad ? 1 : 0;
      top.query_mode = static_cast<CData>(o.mode);
      put_constants(top.query_constants, o.query);
      simulation.settle();

      const auto& d = expected;
      const bool start = d && inside[2]->event == TraversalEvent::start;
      REQUIRE((top.m_goes != 0) == (d && d->goes));
      REQUIRE((top.m_back != 0) == (d && d->place_free));
      REQUIRE((top.m_push != 0) == (d && d->push));
      REQUIRE((top.m_leaf != 0) == (d && d->leaf));
      REQUIRE((top.m_ends != 0) == (d && d->done));
      REQUIRE((top.m_step != 0) == (d && d->step));
      REQUIRE(unsigned{top.m_tests} == (d && d->step ? *d->step : 0));
      REQUIRE(unsigned{top.m_room} == (d ? d->room : 0));
      REQUIRE((top.m_active != 0) == (d && d->state.active));
      REQUIRE((top.m_wants != 0) == (d && d->wants));
      REQUIRE((top.m_start != 0) == (d && start));
      REQUIRE((top.m_cancel != 0) == (d && d->cancelled));
      const bool starts = inside[0] && inside[0]->event == TraversalEvent::start;  // after one clock
      REQUIRE((top.m_started != 0) == (starts && model::decide(limits, *inside[0]).goes.has_value()));
      if (d) {
        REQUIRE(unsigned{top.m_work} == d->work);
        REQUIRE(get_state(top.m_state, stack_w) == d->state);
        model::QueryConstants constants;
        Fields(std::as_const(top.m_constants))
            .field(32, constants.base_a)
            .field(32, constants.base_b)
            .field(32, constants.tag);
        REQUIRE(constants == d->constants);
        if (d->goes) REQUIRE(get_pair(top.m_record) == *d->goes);
        if (d->push) {
          REQUIRE(std::size_t{top.m_at} == d->at);
          REQUIRE(get_entry(top.m_entry) == *d->push);
          ++pushes;
        }
        if (d->leaf) {
          model::LeafEntry leaf;
          Fields(std::as_const(top.m_leaf_nodes))
              .field(32, leaf.first_a)
              .field(8, leaf.kinds_a)
              .field(32, leaf.first_b)
              .field(8, leaf.kinds_b);
          leaf.leaves = static_cast<std::uint16_t>(top.m_leaf_set);
          REQUIRE(leaf == *d->leaf);
          ++leaves;
        }
        if (d->done) {
          DoneRecord done;
          Fields(std::as_const(top.m_answer))
              .field(32, done.pairs)
              .field(32, done.steps)
              .field(2, done.answer)
              .field(3, done.code);
          REQUIRE(done.pairs == d->done->pairs);
          REQUIRE(done.steps == d->done->steps);
          REQUIRE(done.answer == d->done->answer);
          REQUIRE(done.code == d->done->code);
          ++codes[done.code];
        }
        wants += d->wants ? 1 : 0;
      }
      inside[2] = reset ? std::nullopt : inside[1];
      inside[1] = reset ? std::nullopt : inside[0];
      inside[0] = valid && !reset ? std::optional(o) : std::nullopt;
      expected.reset();
      if (inside[2]) {  // open_limit counts on an event's second clock, pairs_each on its third
        model::TraversalLimits then = limits;
        then.open = open_limit_before;
        expected = model::decide(then, *inside[2]);
      }
      open_limit_before = limits.open;
      simulation.rise();
    }
    REQUIRE(codes.size() == 8);
    REQUIRE(wants > 1000);
    REQUIRE(pushes > 1000);
    REQUIRE(leaves > 500);
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_traversal_decision: limits of 0 count as 1", "[unit][cchip_traversal_decision]",
                        cchip_traversal_decision_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    constexpr int stack_w = log2(TestType::STACK);
    auto& top = simulation.top();
    top.s_valid = 0;
    simulation.reset();
    for (int round = 0; round < 200; ++round) {
      const unsigned open_limit = below(random, 2);
      const unsigned open = below(random, 2);  // of the result
      model::QueryState state;
      state.active = true;
      state.mode = QueryMode::first;
      state.entries = 3;
      top.pairs_each = static_cast<CData>(below(random, 2));
      top.open_limit = static_cast<CData>(open_limit);
      top.s_is_result = 1;
      top.s_is_verdict = top.s_is_start = top.s_is_pop = 0;
      top.s_live = 1;
      top.s_epoch = 0;
      put_state(top.s_state, state, stack_w);
      top.s_work = 1;  // the last leaf pair: the query waits for its stack
      top.s_result = static_cast<SData>(open << 3);
      top.s_valid = 1;
      simulation.step();
      top.s_valid = 0;
      simulation.step();
      simulation.step();
      CAPTURE(open_limit, open, unsigned{top.pairs_each});
      REQUIRE((top.m_ends != 0) == (open == 1));
      REQUIRE((top.m_wants != 0) == (open == 0));
    }
  });
}
