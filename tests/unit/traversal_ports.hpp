// SPDX-License-Identifier: Apache-2.0
/// \file
/// Values on the ports of the traversal's modules.
#ifndef CCHIP_TESTS_UNIT_TRAVERSAL_PORTS_HPP
#define CCHIP_TESTS_UNIT_TRAVERSAL_PORTS_HPP

#include <cchip/blocks/traversal_events.hpp>
#include <cchip/sim/bits.hpp>
#include <type_traits>

namespace cchip::test {

constexpr int log2(int n) { return n <= 1 ? 0 : 1 + log2((n + 1) / 2); }

/// Writes the fields of a port one behind the other, the lowest bits first; reads those of a constant port.
template <class Port>
class Fields {
 public:
  explicit Fields(Port& port, int lsb = 0) : port_(port), lsb_(lsb) {}
  template <class Value>
  Fields& field(int width, Value& value) {
    if constexpr (std::is_const_v<Port>) {
      value = static_cast<Value>(sim::get_bits(port_, lsb_, width));
    } else {
      sim::set_bits(port_, lsb_, width, static_cast<std::uint64_t>(value));
    }
    lsb_ += width;
    return *this;
  }

 private:
  Port& port_;
  int lsb_;
};

/// {tests, best, strong, leaves, waiting}
template <class Port, class Verdict>
void verdict_fields(Fields<Port> fields, Verdict& x) {
  fields.field(16, x.waiting).field(16, x.leaves).field(16, x.strong).field(4, x.best).field(5, x.tests);
}
template <class Port>
void put_verdict(Port& port, const model::BoxVerdict& x, int lsb = 0) {
  verdict_fields(Fields(port, lsb), x);
}
template <class Port>
model::BoxVerdict get_verdict(const Port& port) {
  model::BoxVerdict x;
  verdict_fields(Fields(port), x);
  return x;
}

/// {header, epoch, children of B, line of B, children of A, line of A}
template <class Port, class Pair>
void pair_fields(Fields<Port> fields, Pair& x) {
  fields.field(24, x.line_a).field(4, x.children_a).field(24, x.line_b).field(4, x.children_b);
  fields.field(2, x.epoch).field(1, x.header);
}
template <class Port>
void put_pair(Port& port, const model::NodePair& x) {
  pair_fields(Fields(port), x);
}
template <class Port>
model::NodePair get_pair(const Port& port) {
  model::NodePair x;
  pair_fields(Fields(port), x);
  return x;
}

/// {code, kinds of B, first of B, kinds of A, first of A}
template <class Port>
void put_node_lines(Port& port, const model::NodeLines& x) {
  Fields(port).field(24, x.first_a).field(8, x.kinds_a).field(24, x.first_b).field(8, x.kinds_b).field(3, x.code);
}

}  // namespace cchip::test

#endif
