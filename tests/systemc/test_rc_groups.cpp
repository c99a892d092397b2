// SPDX-License-Identifier: Apache-2.0
// Port groups and portal groups, and what they reject.
#include <type_traits>

#include "rc_fixture.hpp"

using namespace rc_test;
using Catch::Contains;
using Catch::Equals;

namespace {

/// Ports of each kind.
struct Many : sc_core::sc_module {
  sc_core::sc_in<int> in{"in"};
  sc_core::sc_out<int> out{"out"};
  sc_core::sc_inout<bool> inout{"inout"};
  sc_core::sc_fifo_in<char> fifo_in{"fifo_in"};
  sc_core::sc_fifo_out<char> fifo_out{"fifo_out"};
  SC_HAS_PROCESS(Many);
  explicit Many(const sc_core::sc_module_name&) {
    SC_METHOD(step);
    sensitive << in;
    SC_THREAD(copy);
  }
  void step() {
    out.write(in.read() + 1);
    inout.write(in.read() % 2 != 0);
  }
  void copy() {
    for (;;) fifo_out.write(static_cast<char>(fifo_in.read() + 1));
  }
};
auto group_of(Many& m) { return rc::ports(m.in, m.out, m.inout, m.fifo_in, m.fifo_out); }
using ManyGroup = rc::portal_group<decltype(group_of(std::declval<Many&>()))>;

}  // namespace

TEST_CASE("one statement binds all static sides of a group, one all ports of a module", "[rc][group]") {
  sc_core::sc_signal<int> in("in"), out("out");
  sc_core::sc_signal<bool> inout("inout");
  sc_core::sc_fifo<char> a("a"), b("b");
  rc::reconfigurable<Many> m("m"), n("n"), o("o");
  ManyGroup portals("portals", {"in", "out", "inout", "fifo_in", "fifo_out"});
  portals.bind_static(in, out, inout, a, b);
  portals.bind_dynamic(group_of(m));
  portals.bind_dynamic(group_of(n));
  portals.bind_dynamic(group_of(o));
  rc::control control("control");
  control.add(m + n + o);
  CHECK(portals.at<0>().name() == std::string("portals.in"));
  CHECK(portals.portals().size() == 5);
  simulate([&] {
    int i = 0;
    for (rc::context* module : (m + n + o).modules()) {
      control.activate(*module);
      in.write(++i);
      a.write('a');
      CHECK(b.read() == 'b');
      deltas(2);
      CHECK(out.read() == i + 1);
      CHECK(inout.read() == (i % 2 != 0));
      control.unload(*module);
    }
  });
}

TEST_CASE("a portal group takes modules with the same types of ports only", "[rc][group]") {
  using Bind = decltype(&ManyGroup::bind_dynamic);
  static_assert(std::is_invocable_v<Bind, ManyGroup&, decltype(group_of(std::declval<Many&>()))>);
  static_assert(!std::is_invocable_v<Bind, ManyGroup&, decltype(group_of(std::declval<Comb&>()))>);
  static_assert(!std::is_same_v<CombGroup, ManyGroup>);
  SUCCEED();
}

TEST_CASE("the ports of a group are of one module", "[rc][group]") {
  rc::reconfigurable<Comb> m("m"), n("n");
  CombGroup portals("portals");
  CHECK_THAT(error_of([&] { portals.bind_dynamic(rc::ports(m.d, n.q)); }),
             Equals("portals: ports m.d and n.q are of two modules; bind the ports of one at a time"));
}

TEST_CASE("a port has one portal", "[rc][group]") {
  rc::reconfigurable<Comb> m("m");
  CombGroup portals("portals", {"d", "q"}), others("others");
  portals.bind_dynamic(group_of(m));
  CHECK_THAT(error_of([&] { others.bind_dynamic(group_of(m)); }),
             Equals("others.p0: port m.d is bound to portal portals.d already; a port has one portal"));
}

TEST_CASE("ports of modules that are not reconfigurable have no portal", "[rc][group]") {
  Comb m("m");
  CombGroup portals("portals");
  CHECK_THAT(error_of([&] { portals.bind_dynamic(group_of(m)); }),
             Contains("port m.d belongs to no reconfigurable module; derive its module"));
}

TEST_CASE("names of a group are one for each portal, or none", "[rc][group]") {
  CHECK_THAT(error_of([] { CombGroup portals("portals", {"d"}); }),
             Equals("portal_group: 1 names for 2 portals; give one for each, or none"));
  CombGroup portals("other");
  CHECK(portals.at<1>().name() == std::string("other.p1"));
}

TEST_CASE("ports are bound before the simulation", "[rc][group]") {
  sc_core::sc_signal<int> d("d"), q("q");
  rc::reconfigurable<Comb> m("m"), late("late");
  CombGroup portals("portals");
  portals.bind_static(d, q);
  portals.bind_dynamic(group_of(m));
  late.d(d);
  sc_core::sc_signal<int> r("r");
  late.q(r);
  simulate([&] {
    CHECK_THAT(error_of([&] { portals.bind_dynamic(group_of(late)); }), Contains("is bound during simulation"));
  });
}

TEST_CASE("ports of submodules of a reconfigurable module are bound like its own", "[rc][group]") {
  struct Outer : sc_core::sc_module {
    Comb inner{"inner", 3};
    explicit Outer(const sc_core::sc_module_name&) {}
  };
  sc_core::sc_signal<int> d("d"), q("q");
  rc::reconfigurable<Outer> m("m");
  CombGroup portals("portals");
  portals.bind_static(d, q);
  portals.bind_dynamic(group_of(m.inner));
  rc::control control("control");
  control.add(m);
  simulate([&] {
    d.write(1);
    deltas(3);
    CHECK(q.read() == 0);
    control.activate(m);
    deltas(2);
    CHECK(q.read() == 4);
  });
}

TEST_CASE("static sides may be bound to ports of a parent module", "[rc][group]") {
  struct Shell : sc_core::sc_module {
    sc_core::sc_in<int> d{"d"};
    sc_core::sc_out<int> q{"q"};
    rc::reconfigurable<Comb> m{"m", 5};
    CombGroup portals{"portals"};
    rc::control control{"control"};
    explicit Shell(const sc_core::sc_module_name&) {
      portals.bind_static(d, q);
      portals.bind_dynamic(group_of(m));
      control.add(m);
      control.activate(m);
    }
  } shell("shell");
  sc_core::sc_signal<int> d("d"), q("q");
  shell.d(d);
  shell.q(q);
  simulate([&] {
    d.write(1);
    deltas(3);
    CHECK(q.read() == 6);
  });
}
