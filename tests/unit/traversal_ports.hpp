// SPDX-License-Identifier: Apache-2.0
/// \file
/// Values on the ports of the traversal's modules.
#ifndef CCHIP_TESTS_UNIT_TRAVERSAL_PORTS_HPP
#define CCHIP_TESTS_UNIT_TRAVERSAL_PORTS_HPP

#include <cchip/models/traversal_events.hpp>
#include <cchip/sim/bits.hpp>

namespace cchip::test {

constexpr int log2(int n) { return n <= 1 ? 0 : 1 + log2((n + 1) / 2); }

/// Writes or reads fields one behind the other, the lowest bits first.
template <class Port>
class Fields {
 public:
  explicit Fields(Port& port, int lsb = 0) : port_(port), lsb_(lsb) {}
  Fields& put(int width, std::uint64_t value) {
    sim::set_bits(port_, lsb_, width, value);
    lsb_ += width;
    return *this;
  }
  template <class Value>
  Fields& get(int width, Value& value) {
    value = static_cast<Value>(sim::get_bits(port_, lsb_, width));
    lsb_ += width;
    return *this;
  }

 private:
  Port& port_;
  int lsb_;
};

/// {tests, best, strong, leaves, waiting}
template <class Port>
void put_verdict(Port& port, const model::BoxVerdict& x, int lsb = 0) {
  Fields<Port>(port, lsb).put(16, x.waiting).put(16, x.leaves).put(16, x.strong).put(4, x.best).put(5, x.tests);
}
template <class Port>
model::BoxVerdict get_verdict(const Port& port) {
  model::BoxVerdict x;
  Fields<const Port>(port).get(16, x.waiting).get(16, x.leaves).get(16, x.strong).get(4, x.best).get(5, x.tests);
  return x;
}

/// {header, epoch, children of B, line of B, children of A, line of A}
template <class Port>
void put_pair(Port& port, const model::NodePair& x) {
  Fields<Port>(port)
      .put(24, x.line_a)
      .put(4, x.children_a)
      .put(24, x.line_b)
      .put(4, x.children_b)
      .put(2, x.epoch)
      .put(1, x.header ? 1 : 0);
}
template <class Port>
model::NodePair get_pair(const Port& port) {
  model::NodePair x;
  Fields<const Port>(port)
      .get(24, x.line_a)
      .get(4, x.children_a)
      .get(24, x.line_b)
      .get(4, x.children_b)
      .get(2, x.epoch)
      .get(1, x.header);
  return x;
}

/// {code, kinds of B, first of B, kinds of A, first of A}
template <class Port>
void put_node_lines(Port& port, const model::NodeLines& x) {
  Fields<Port>(port)
      .put(24, x.first_a)
      .put(8, x.kinds_a)
      .put(24, x.first_b)
      .put(8, x.kinds_b)
      .put(3, static_cast<unsigned>(x.code));
}

}  // namespace cchip::test

#endif
