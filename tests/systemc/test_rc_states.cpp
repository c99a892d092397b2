// SPDX-License-Identifier: Apache-2.0
// States of a reconfigurable module and the actions that lead from one to the next.
#include "rc_fixture.hpp"

using namespace rc_test;
using Catch::Contains;
using Catch::Equals;
using rc::action;
using rc::state;

namespace {

/// Two modules at one pair of portals, with one control.
struct System {
  sc_core::sc_signal<int> d{"d"}, q{"q"};
  Probe m{"m", 100}, other{"other", 200};
  CombGroup portals{"portals", {"d", "q"}};
  rc::control control{"control"};
  System() {
    portals.bind_static(d, q);
    portals.bind_dynamic(group_of(m));
    portals.bind_dynamic(group_of(other));
    control.add(m + other);
  }
};

struct Resettable : rc::resettable {
  int stored = 0, resets = 0, activations = 0;
  sc_core::sc_time last;
  void store_reset_value() override { ++stored; }
  void reset() override {
    ++resets;
    last = sc_time_stamp();
  }
  void activated() override { ++activations; }
};

}  // namespace

TEST_CASE("load takes its delay, leaves the portals closed, then calls on_load", "[rc][states]") {
  System s;
  s.m.set_delay(action::load, ns(30));
  simulate([&] {
    s.control.load(s.m);
    CHECK(sc_time_stamp() == ns(30));
    CHECK(s.m.now() == state::inactive);
    CHECK(s.portals.at<0>().loaded_module() == &s.m);
    CHECK(s.portals.at<0>().active_module() == nullptr);
    CHECK(s.m.log == std::vector<std::string>{"on_load 30 ns"});
  });
}

TEST_CASE("load is refused while another loaded module has a portal, and changes nothing", "[rc][states]") {
  System s;
  sc_core::sc_signal<int> r("r");
  rc::reconfigurable<Comb> third("third");
  rc::in_portal<int> free_portal("free_portal");
  rc::out_portal<int>& taken = s.portals.at<1>();
  free_portal.static_port(r);
  free_portal.bind_dynamic(third.d);
  taken.bind_dynamic(third.q);
  s.control.add(third);
  simulate([&] {
    s.control.load(s.m);
    CHECK_THAT(error_of([&] { s.control.load(third); }),
               Equals("third: cannot be loaded, portal portals.q is in use by "
                      "m; unload that first"));
    CHECK(third.now() == state::unloaded);
    CHECK(free_portal.loaded_module() == nullptr);
    CHECK(taken.loaded_module() == &s.m);
    s.control.unload(s.m);
    s.control.load(third);
    CHECK(free_portal.loaded_module() == &third);
  });
}

TEST_CASE("activate opens the portals in an update phase, a delta later at least", "[rc][states]") {
  System s;
  simulate([&] {
    s.control.load(s.m);
    const auto before = sc_delta_count();
    sc_core::sc_spawn([&] {
      while (s.m.now() != state::active) {
        CHECK(s.portals.at<0>().active_module() == nullptr);
        wait(SC_ZERO_TIME);
      }
      CHECK(s.portals.at<0>().active_module() == &s.m);
      CHECK(sc_delta_count() >= before + 1);
    });
    s.control.activate(s.m);
    CHECK(sc_time_stamp() == SC_ZERO_TIME);
    CHECK(sc_delta_count() >= before + 1);
    CHECK(s.m.is_active());
    deltas(2);
  });
}

TEST_CASE("activate of an unloaded module loads it first", "[rc][states]") {
  System s;
  s.m.set_delay(action::load, ns(30));
  s.m.set_delay(action::activate, ns(4));
  simulate([&] {
    s.control.activate(s.m);
    CHECK(s.m.log == std::vector<std::string>{"on_load 30 ns", "on_activate 34 ns"});
  });
}

TEST_CASE("resettables are reset before each activation and after each deactivation", "[rc][states]") {
  System s;
  Resettable r;
  s.m.add(r);
  s.m.set_delay(action::activate, ns(4));
  s.m.set_delay(action::deactivate, ns(3));
  simulate([&] {
    CHECK(r.stored == 1);
    s.control.load(s.m);
    CHECK(r.resets == 0);
    s.control.activate(s.m);
    CHECK(r.resets == 1);
    CHECK(r.last == SC_ZERO_TIME);  // before the delay
    CHECK(r.activations == 1);
    s.control.deactivate(s.m);
    CHECK(r.resets == 2);
    CHECK(r.last == ns(7));  // after the delay
    CHECK(r.activations == 1);
  });
}

TEST_CASE("deactivate is delayed until nothing holds the module", "[rc][states]") {
  System s;
  Latch latch;
  s.m.add(latch);
  s.control.activate(s.m);
  simulate([&] {
    sc_core::sc_spawn([&] {
      wait(ns(40));
      CHECK(s.m.deactivation_pending());
      CHECK(s.portals.at<1>().active_module() == &s.m);
      latch.open();
    });
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(40));
    CHECK(s.m.now() == state::inactive);
    CHECK_FALSE(s.m.deactivation_pending());
    CHECK(s.portals.at<1>().active_module() == nullptr);
    CHECK(s.portals.at<1>().loaded_module() == &s.m);
  });
}

TEST_CASE("deactivate gives up after its limit and names all that holds the module, which stays active",
          "[rc][states]") {
  System s;
  Latch first, second;
  first.why = "first latch";
  second.why = "second latch";
  s.m.add(first);
  s.m.add(second);
  s.control.activate(s.m);
  s.control.set_deactivation_timeout(ns(70));
  simulate([&] {
    wait(ns(5));
    CHECK_THAT(error_of([&] { s.control.unload(s.m); }),
               Equals("m: cannot be deactivated within 70 ns, it is held by first latch; second latch; it stays "
                      "active"));
    CHECK(sc_time_stamp() == ns(75));
    CHECK(s.m.now() == state::active);
    CHECK_FALSE(s.m.deactivation_pending());
    s.d.write(5);
    deltas(3);
    CHECK(s.q.read() == 105);
    first.open();
    second.open();
    s.control.unload(s.m);  // free of what happened
    CHECK(s.m.now() == state::unloaded);
  });
}

TEST_CASE("deactivate limits its wait to 1 s at first, not at all with sc_max_time()", "[rc][states]") {
  System s;
  Latch latch;
  s.m.add(latch);
  s.control.activate(s.m);
  simulate(
      [&] {
        CHECK_THAT(error_of([&] { s.control.deactivate(s.m); }), Contains("within 1 s"));
        CHECK(sc_time_stamp() == sc_time(1, sc_core::SC_SEC));
        s.control.set_deactivation_timeout(sc_core::sc_max_time());
        sc_core::sc_spawn([&] {
          wait(sc_time(100, sc_core::SC_SEC));
          latch.open();
        });
        s.control.deactivate(s.m);
        CHECK(sc_time_stamp() == sc_time(101, sc_core::SC_SEC));
      },
      sc_time(1000, sc_core::SC_SEC));
}

TEST_CASE("an action whose caller is cancelled leaves a module that can be used", "[rc][states]") {
  System s;
  Latch latch;
  s.m.add(latch);
  s.m.set_delay(action::load, ns(30));
  simulate([&] {
    sc_core::sc_process_handle caller = sc_core::sc_spawn([&] { s.control.load(s.m); });
    wait(ns(10));
    caller.kill();
    s.control.activate(s.other);  // portals and lock are free
    s.control.unload(s.other);
    s.control.activate(s.m);
    caller = sc_core::sc_spawn([&] { s.control.deactivate(s.m); });
    wait(ns(10));
    CHECK(s.m.deactivation_pending());
    caller.kill();
    CHECK_FALSE(s.m.deactivation_pending());
    latch.open();
    wait(ns(10));
    CHECK(s.m.is_active());
    s.control.unload(s.m);
    CHECK(s.m.now() == state::unloaded);
  });
}

TEST_CASE("deactivate takes its delay with closed portals, then calls on_deactivate", "[rc][states]") {
  System s;
  s.m.set_delay(action::deactivate, ns(8));
  s.control.activate(s.m);
  simulate([&] {
    sc_core::sc_spawn([&] {
      wait(ns(1));
      CHECK(s.m.now() == state::inactive);
      CHECK(s.portals.at<0>().active_module() == nullptr);
      CHECK(s.m.log.empty());
    });
    s.control.deactivate(s.m);
    CHECK(s.m.log == std::vector<std::string>{"on_deactivate 8 ns"});
  });
}

TEST_CASE("unload deactivates first, frees the portals after its delay, then calls on_unload", "[rc][states]") {
  System s;
  s.m.set_delay(action::deactivate, ns(8));
  s.m.set_delay(action::unload, ns(3));
  s.control.activate(s.m);
  simulate([&] {
    sc_core::sc_spawn([&] {
      wait(ns(10));
      CHECK(s.portals.at<0>().loaded_module() == &s.m);
    });
    s.control.unload(s.m);
    CHECK(s.m.now() == state::unloaded);
    CHECK(s.portals.at<0>().loaded_module() == nullptr);
    CHECK(s.m.log == std::vector<std::string>{"on_deactivate 8 ns", "on_unload 11 ns"});
  });
}

TEST_CASE("actions before the simulation take no time, call no hook and set the initial configuration",
          "[rc][states]") {
  System s;
  s.m.set_delay(action::load, ns(30));
  s.m.set_delay(action::activate, ns(30));
  s.d.write(1);
  s.control.activate(s.other);
  s.control.unload(s.other);
  s.control.activate(s.m);
  CHECK(s.m.now() == state::active);
  CHECK(s.other.now() == state::unloaded);
  simulate([&] {
    CHECK(sc_time_stamp() == SC_ZERO_TIME);
    CHECK(s.portals.at<0>().active_module() == &s.m);
    deltas(2);
    CHECK(s.q.read() == 101);
    CHECK(s.m.log.empty());
  });
}

TEST_CASE("an initial configuration with two modules at one portal is an error of sc_start", "[rc][states]") {
  System s;
  s.control.load(s.m);
  s.control.activate(s.other);
  CHECK_THAT(error_of([] { sc_core::sc_start(ns(1)); }), Contains("is in use by"));
}

TEST_CASE("hooks may wait", "[rc][states]") {
  System s;
  s.m.hook_time = ns(100);
  simulate([&] {
    s.control.activate(s.m);
    s.control.unload(s.m);
    CHECK(s.m.log ==
          std::vector<std::string>{"on_load 0 s", "on_activate 100 ns", "on_deactivate 200 ns", "on_unload 300 ns"});
    CHECK(sc_time_stamp() == ns(400));
  });
}

TEST_CASE("delays are 0 at first, and those of one module and one action", "[rc][states]") {
  System s;
  s.m.set_delay(action::unload, ns(9));
  CHECK(s.m.delay(action::unload) == ns(9));
  CHECK(s.m.delay(action::load) == SC_ZERO_TIME);
  CHECK(s.other.delay(action::unload) == SC_ZERO_TIME);
  simulate([&] {
    s.control.activate(s.m);
    CHECK(sc_time_stamp() == SC_ZERO_TIME);
    s.control.unload(s.m);
    CHECK(sc_time_stamp() == ns(9));
  });
}

TEST_CASE("a control that knows better is asked at each action", "[rc][states]") {
  struct Slow : rc::control {
    using rc::control::control;
    double factor = 1;
    sc_time takes_time(const rc::context& module, action a) const override {
      CHECK(module.full_name() == "m");
      return ns(factor * (a == action::load ? 10 : a == action::activate ? 1 : 0));
    }
  };
  sc_core::sc_signal<int> d("d"), q("q");
  Probe m("m");
  CombGroup portals("portals");
  portals.bind_static(d, q);
  portals.bind_dynamic(group_of(m));
  Slow control("control");
  control.add(m);
  simulate([&] {
    control.activate(m);
    CHECK(sc_time_stamp() == ns(11));
    control.unload(m);
    CHECK(sc_time_stamp() == ns(11));
    control.factor = 2;
    control.activate(m);
    CHECK(sc_time_stamp() == ns(33));
  });
}

TEST_CASE("activation and deactivation have events", "[rc][states]") {
  System s;
  std::vector<std::string> seen;
  Thread watch("watch", [&] {
    wait(s.m.activated_event());
    seen.push_back("on " + sc_time_stamp().to_string());
    wait(s.m.deactivated_event());
    seen.push_back("off " + sc_time_stamp().to_string());
  });
  simulate([&] {
    wait(ns(3));
    s.control.activate(s.m);
    wait(ns(4));
    s.control.deactivate(s.m);
    deltas(2);
    CHECK(seen == std::vector<std::string>{"on 3 ns", "off 7 ns"});
  });
}
