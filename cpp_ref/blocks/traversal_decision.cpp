// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/traversal_decision.hpp>

namespace cchip::model {

namespace {

unsigned count(unsigned set) {
  unsigned n = 0;
  for (; set != 0; set &= set - 1) ++n;
  return n;
}
unsigned lowest(unsigned set) {
  unsigned n = 0;
  while ((set >> n & 1U) == 0) ++n;
  return n;
}
/// Children that are nodes.
unsigned inner(std::uint8_t kinds) {
  unsigned set = 0;
  for (unsigned i = 0; i < 4; ++i) set |= (kinds >> 2 * i & 3U) == 0 ? 1U << i : 0U;
  return set;
}
/// Child `child` of a node, or the node itself with the one child that is a leaf.
void descend(const StackEntry::Side& side, unsigned child, unsigned& children, std::uint32_t& line) {
  const bool node = (side.inner >> child & 1U) != 0;
  children = node ? 15 : 1U << child;
  line = (node ? side.first + child : side.line) & 0xffffff;
}
NodePair child_pair(const StackEntry& of, unsigned number, unsigned epoch) {
  NodePair pair;
  pair.epoch = epoch;
  descend(of.a, number >> 2, pair.children_a, pair.line_a);
  descend(of.b, number & 3U, pair.children_b, pair.line_b);
  return pair;
}

}  // namespace

Decision decide(const TraversalLimits& limits, const Occurrence& o) {
  Decision d;
  d.state = o.state;
  d.constants = o.constants;
  d.work = o.work;
  std::optional<QueryCode> code;  // the query ends with it
  bool live = o.live;
  switch (o.event) {
    case TraversalEvent::start: {
      d.constants = o.query;
      d.state = {o.state.epoch, false, o.mode, 0, 1, 0, 0, 0, false};
      d.cancelled = o.work != 0;
      live = !d.cancelled;
      if (live && o.bad) code = QueryCode::bad_descriptor;
      if (live && !o.bad) {
        d.state.active = true;
        d.work = 1;
        d.goes = NodePair{true, o.state.epoch, 0, 0, 0, 0};
      } else {
        d.place_free = true;
        d.room = 1;
      }
      break;
    }
    case TraversalEvent::pop: {
      StackEntry entry = o.top;
      const unsigned chosen = lowest(entry.strong != 0 ? entry.strong : entry.waiting);
      d.goes = child_pair(entry, chosen, o.epoch);
      const auto others = static_cast<std::uint16_t>(~(1U << chosen));
      entry.waiting &= others;
      entry.strong &= others;
      d.at = o.state.entries - 1;
      if (entry.waiting != 0) {
        d.push = entry;
      } else {
        --d.state.entries;
      }
      ++d.state.under_way;
      ++d.work;
      break;
    }
    case TraversalEvent::verdict: {
      d.room = o.extra ? 2 : 1;
      if (live && o.lines.code != QueryCode::ok) {
        code = o.lines.code;
      } else if (live && o.pair.header) {
        d.goes = NodePair{false, o.epoch, 15, 15, o.lines.first_a, o.lines.first_b};
      } else if (live && o.over) {
        code = QueryCode::steps;
      } else if (live) {
        d.step = o.verdict.tests;
        ++d.state.steps;
        StackEntry entry{{inner(o.lines.kinds_a), o.lines.first_a, o.pair.line_a},
                         {inner(o.lines.kinds_b), o.lines.first_b, o.pair.line_b},
                         o.verdict.waiting,
                         o.verdict.strong};
        const bool room = o.verdict.leaves == 0 || o.extra;  // for the leaves of the next node pair
        const auto best = static_cast<std::uint16_t>(1U << o.verdict.best);
        std::optional<NodePair> next;
        if (o.verdict.waiting != 0 && room) {
          next = child_pair(entry, o.verdict.best, o.epoch);
          entry.waiting &= static_cast<std::uint16_t>(~best);
          entry.strong &= static_cast<std::uint16_t>(~best);
        } else {
          entry.strong |= best;
        }
        if (entry.waiting != 0 && o.state.entries == limits.stack) {
          code = QueryCode::stack;
          ++d.state.entries;  // of no meaning: the query has ended
        } else {
          d.goes = next;
          d.at = o.state.entries;
          if (entry.waiting != 0) {
            d.push = entry;
            ++d.state.entries;
          }
          if (o.verdict.leaves != 0) {
            d.leaf = LeafEntry{o.constants.base_a + o.lines.first_a, o.constants.base_b + o.lines.first_b,
                               o.lines.kinds_a, o.lines.kinds_b, o.verdict.leaves};
            d.work += count(o.verdict.leaves);
          }
        }
      }
      d.room -= (d.goes ? 1 : 0) + (d.leaf ? 1 : 0);
      d.place_free = !d.goes;
      if (!d.goes) {
        --d.work;
        if (live) d.state.under_way = (d.state.under_way + 7) % 8;
      }
      break;
    }
    case TraversalEvent::result: {
      --d.work;
      if (!live) break;
      d.state.pairs += o.result.hits + o.result.open;
      const unsigned open = d.state.open + o.result.open;
      d.state.open = std::min(open, 255U);
      d.state.hit = d.state.hit || o.result.hits != 0;
      if (o.result.code != QueryCode::ok) {
        code = o.result.code;
      } else if (d.state.mode == QueryMode::first && o.result.hits != 0) {
        code = QueryCode::ok;
      } else if (d.state.mode == QueryMode::first && open >= std::max(limits.open, 1U)) {
        code = QueryCode::host;
      }
      break;
    }
  }
  if (live && d.work == 0 && d.state.entries == 0 && !code) code = QueryCode::ok;
  if (code) {
    d.state.active = false;
    d.state.epoch = (d.state.epoch + 1) % 4;
    d.done = DoneRecord{d.constants.tag, *code,
                        d.state.hit        ? QueryAnswer::yes
                        : d.state.open > 0 ? QueryAnswer::open
                                           : QueryAnswer::no,
                        d.state.steps, d.state.pairs};
  }
  // a leaf pair that is out may end a query for the first hit
  const bool result_pending = live && d.state.mode == QueryMode::first && d.work != d.state.under_way;
  const unsigned pairs_each = std::max(limits.pairs_each, 1U);
  d.wants =
      d.state.active && d.state.entries != 0 && d.state.under_way < (result_pending ? pairs_each / 2 : pairs_each);
  return d;
}

}  // namespace cchip::model
