// SPDX-License-Identifier: Apache-2.0
// Defects of the library's predecessor, ReChannel 2: each name says what would happen.
#include <memory>

#include "rc_fixture.hpp"

using namespace rc_test;
using Catch::Contains;
using rc::action;
using rc::state;

namespace {

struct Pair {
  sc_core::sc_signal<int> d{"d"}, q{"q"};
  rc::reconfigurable<Comb> m{"m", 1};
  CombGroup portals{"portals"};
  Pair() {
    portals.bind_static(d, q);
    portals.bind_dynamic(group_of(m));
  }
};

struct Bare : sc_core::sc_module {
  explicit Bare(const sc_core::sc_module_name&) {}
};

}  // namespace

TEST_CASE("defect: of three modules reconfigured together the third would not be awaited", "[rc][defect]") {
  rc::reconfigurable<Bare> a("a"), b("b"), c("c");
  rc::control control("control");
  control.add(a + b + c);
  a.set_delay(action::load, ns(1));
  b.set_delay(action::load, ns(2));
  c.set_delay(action::load, ns(30));
  simulate([&] {
    control.load(a + b + c);
    CHECK(c.now() == state::inactive);
    CHECK(sc_time_stamp() == ns(30));
    control.unload(a + b + c);
    control.load(c + a);  // two: behind the end of a list
    CHECK(c.now() == state::inactive);
    CHECK(sc_time_stamp() == ns(60));
  });
}

TEST_CASE("defect: processes that end while others are collected would corrupt the registry", "[rc][defect]") {
  struct M : rc::reconfigurable<Bare> {
    int ended = 0;
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) { RC_THREAD(run); }
    void run() {
      for (int i = 0; i < 20; ++i) {  // every other one ends before the deactivation
        spawn("helper", process_kind::thread, [this, i] {
          wait(ns(i % 2 == 0 ? 1 : 1000));
          ++ended;
        });
      }
    }
  } m("m");
  rc::control control("control");
  control.add(m);
  simulate([&] {
    for (int i = 1; i <= 50; ++i) {
      control.activate(m);
      wait(ns(2));
      control.deactivate(m);
      CHECK(m.ended == 10 * i);
    }
  });
}

TEST_CASE("defect: lock with a limit would give up a lock that is free, or wait for ever", "[rc][defect]") {
  rc::control control("control");
  Thread owner("owner", [&] {
    wait(ns(10));
    control.lock();
    wait(ns(100));
    control.unlock();
  });
  simulate([&] {
    CHECK(control.lock(ns(5)));
    CHECK(sc_time_stamp() == SC_ZERO_TIME);
    control.unlock();
    wait(ns(20));
    CHECK_FALSE(control.lock(ns(5)));
    CHECK(sc_time_stamp() == ns(25));
  });
}

TEST_CASE("defect: a module with a port group would not be found at its portals, one without would", "[rc][defect]") {
  Pair p;
  CombGroup second("second");
  sc_core::sc_signal<int> d("d2"), q("q2"), e("e"), f("f");
  second.bind_static(d, q);
  rc::reconfigurable<Comb> single("single");
  rc::in_portal<int> in("in");
  rc::out_portal<int> out("out");
  in.static_port(e);
  out.static_port(f);
  in.bind_dynamic(single.d);
  out.bind_dynamic(single.q);
  rc::control control("control");
  control.add(p.m + single);
  simulate([&] {
    CHECK_NOTHROW(control.move(p.m, second));
    CHECK_THAT(error_of([&] { control.move(single, second); }), Contains("not bound to one group of the same type"));
  });
}

TEST_CASE("defect: a portal that closes without a module would write through a null pointer", "[rc][defect]") {
  Pair p;
  rc::control control("control");
  control.add(p.m);
  control.activate(p.m);
  simulate([&] {
    p.d.write(4);
    deltas(2);
    CHECK(p.q.read() == 5);
    control.deactivate(p.m);
    p.portals.at<1>().set_undefined_output([] { return 99; });
    control.unload(p.m);
    deltas(2);
    CHECK(p.q.read() == 0);
    control.activate(p.m);
    control.unload(p.m);
    deltas(2);
    CHECK(p.q.read() == 99);
  });
}

TEST_CASE("defect: the second system in one process would not see its start of simulation", "[rc][defect]") {
  for (int i = 0; i < 3; ++i) {
    const OwnContext context;
    Pair p;
    rc::control control("control");
    control.add(p.m);
    control.activate(p.m);
    simulate([&] {
      p.d.write(i);
      deltas(2);
      CHECK(p.q.read() == i + 1);
    });
  }
}

TEST_CASE("defect: without a control no module would see the start of simulation", "[rc][defect]") {
  struct Flag : rc::resettable {
    bool stored = false;
    void store_reset_value() override { stored = true; }
    void reset() override {}
  } flag;
  rc::reconfigurable<Bare> m("m");
  m.add(flag);
  simulate([&] {
    CHECK(flag.stored);
    CHECK(m.now() == state::unloaded);
  });
}
