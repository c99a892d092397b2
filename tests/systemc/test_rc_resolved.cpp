// SPDX-License-Identifier: Apache-2.0
// Portals for resolved logic and for events.
#include "rc_fixture.hpp"

using namespace rc_test;
using sc_dt::sc_logic;
using sc_dt::sc_lv;

namespace {

/// Two processes drive one bus; what they drive is set from outside.
struct Drivers : sc_core::sc_module {
  sc_core::sc_in_rv<4> in{"in"};
  sc_core::sc_out_rv<4> out{"out"};
  sc_core::sc_inout_rv<4> bus{"bus"};
  sc_lv<4> first = "ZZZZ", second = "ZZZZ";
  sc_core::sc_event go;
  int in_events = 0;
  SC_HAS_PROCESS(Drivers);
  explicit Drivers(const sc_core::sc_module_name&) {
    SC_METHOD(drive_first);
    sensitive << go;
    SC_METHOD(drive_second);
    sensitive << go;
    SC_METHOD(watch);
    sensitive << in;
    dont_initialize();
  }
  void drive_first() {
    bus.write(first);
    out.write(first);
  }
  void drive_second() { bus.write(second); }
  void watch() { ++in_events; }
  void drive(const char* a, const char* b) {
    first = a;
    second = b;
    go.notify();
  }
};
auto group_of(Drivers& m) { return rc::ports(m.in, m.out, m.bus); }

struct VectorSystem {
  sc_core::sc_signal_rv<4> in{"in"}, out{"out"}, bus{"bus"};
  rc::reconfigurable<Drivers> m{"m"}, other{"other"};
  rc::portal_group<decltype(group_of(std::declval<Drivers&>()))> portals{"portals", {"in", "out", "bus"}};
  rc::control control{"control"};
  VectorSystem() {
    portals.bind_static(in, out, bus);
    portals.bind_dynamic(group_of(m));
    portals.bind_dynamic(group_of(other));
    control.add(m + other);
  }
};

std::string text(const sc_core::sc_signal_rv<4>& s) { return s.read().to_string(); }

/// The same with single bits.
struct Bits : sc_core::sc_module {
  sc_core::sc_in_resolved in{"in"};
  sc_core::sc_out_resolved out{"out"};
  sc_core::sc_inout_resolved line{"line"};
  explicit Bits(const sc_core::sc_module_name&) {}
};
auto group_of(Bits& m) { return rc::ports(m.in, m.out, m.line); }

}  // namespace

TEST_CASE("what several processes of a module write is resolved", "[rc][resolved]") {
  VectorSystem s;
  s.control.activate(s.m);
  simulate([&] {
    s.m.drive("01ZZ", "01Z1");
    deltas(2);
    CHECK(text(s.bus) == "01Z1");
    s.m.drive("0011", "0101");
    deltas(2);
    CHECK(text(s.bus) == "0XX1");
    CHECK(text(s.out) == "0011");
    CHECK(s.m.bus.read().to_string() == "0XX1");
    CHECK(s.other.bus.read().to_string() == "ZZZZ");
  });
}

TEST_CASE("the static side sees the portal as one driver among others", "[rc][resolved]") {
  VectorSystem s;
  s.control.activate(s.m);
  simulate([&] {
    s.bus.write("0Z1Z");  // another driver
    s.m.drive("ZZ0Z", "Z1ZZ");
    deltas(2);
    CHECK(text(s.bus) == "01XZ");
    CHECK(s.m.bus.read().to_string() == "01XZ");
  });
}

TEST_CASE("a closed resolved portal drives Z, also before a module was loaded", "[rc][resolved]") {
  VectorSystem s;
  simulate([&] {
    s.bus.write("0101");
    s.m.drive("1111", "ZZZZ");
    deltas(2);
    CHECK(text(s.bus) == "0101");  // X would spoil a bus that the static side uses
    s.control.activate(s.m);
    deltas(2);
    CHECK(text(s.bus) == "X1X1");
    s.control.deactivate(s.m);
    deltas(2);
    CHECK(text(s.bus) == "0101");
    CHECK(text(s.out) == "ZZZZ");
    s.portals.at<2>().set_undefined_output([] { return sc_lv<4>("XXXX"); });
    s.control.activate(s.m);
    s.control.unload(s.m);
    deltas(2);
    CHECK(text(s.bus) == "XXXX");  // on demand
  });
}

TEST_CASE("resolved inputs see the static signal while active", "[rc][resolved]") {
  VectorSystem s;
  simulate([&] {
    s.in.write("0101");
    deltas(2);
    CHECK(s.m.in.read().to_string() == "ZZZZ");
    CHECK(s.m.in_events == 0);
    s.control.activate(s.m);
    deltas(2);
    CHECK(s.m.in.read().to_string() == "0101");
    CHECK(s.m.in_events == 1);
    CHECK(s.other.in_events == 0);
  });
}

TEST_CASE("writes through resolved portals reach the static signal without an added delta", "[rc][resolved]") {
  VectorSystem s;
  s.control.activate(s.m);
  simulate([&] {
    wait(ns(1));
    s.m.drive("0011", "ZZZZ");
    deltas(1);
    CHECK(text(s.bus) == "0011");
  });
}

TEST_CASE("single resolved bits have edges", "[rc][resolved]") {
  sc_core::sc_signal_resolved in("in"), out("out"), line("line");
  rc::reconfigurable<Bits> m("m");
  rc::portal_group<decltype(group_of(m))> portals("portals");
  portals.bind_static(in, out, line);
  portals.bind_dynamic(group_of(m));
  rc::control control("control");
  control.add(m);
  control.activate(m);
  int rises = 0;
  Thread watch("watch", [&] {
    for (;;) {
      wait(m.in->posedge_event());
      ++rises;
    }
  });
  Thread first("first", [&] {
    m.out.write(sc_logic('1'));
    m.line.write(sc_logic('0'));
  });
  Thread second("second", [&] {
    wait(ns(1));
    m.line.write(sc_logic('1'));
  });
  simulate([&] {
    wait(ns(0.5));
    CHECK(out.read() == sc_logic('1'));
    CHECK(line.read() == sc_logic('0'));
    for (const char c : {'0', '1', 'Z', '1'}) {
      in.write(sc_logic(c));
      deltas(3);
    }
    CHECK(rises == 2);
    wait(ns(1));
    CHECK(line.read() == sc_logic('X'));
    control.deactivate(m);
    deltas(2);
    CHECK(out.read() == sc_logic('Z'));
    CHECK(line.read() == sc_logic('Z'));
    CHECK(m.in.read() == sc_logic('Z'));
  });
}

// ---- events

namespace {

struct Listener : sc_core::sc_module {
  sc_core::sc_event_queue_port in{"in"}, out{"out"};
  std::vector<sc_time> heard;
  SC_HAS_PROCESS(Listener);
  explicit Listener(const sc_core::sc_module_name&) {
    SC_METHOD(hear);
    sensitive << in;
    dont_initialize();
  }
  void hear() { heard.push_back(sc_time_stamp()); }
};
auto group_of(Listener& m) { return rc::ports(m.in, m.out); }

struct EventSystem {
  sc_core::sc_event_queue in{"in"}, out{"out"};
  rc::reconfigurable<Listener> m{"m"}, other{"other"};
  rc::portal_group<decltype(group_of(std::declval<Listener&>()))> portals{"portals", {"in", "out"}};
  rc::control control{"control"};
  EventSystem() {
    portals.bind_static(in, out);
    portals.bind_dynamic(group_of(m));
    portals.bind_dynamic(group_of(other));
    control.add(m + other);
  }
};

}  // namespace

TEST_CASE("events of the static side reach the active module only", "[rc][event]") {
  EventSystem s;
  simulate([&] {
    s.in.notify(ns(5));
    wait(ns(10));
    s.control.activate(s.m);
    s.in.notify(ns(5));
    s.in.notify(ns(25));
    wait(ns(10));
    s.control.unload(s.m);
    s.control.activate(s.other);
    wait(ns(20));
    CHECK(s.m.heard == std::vector<sc_time>{ns(15)});
    CHECK(s.other.heard == std::vector<sc_time>{ns(35)});
  });
}

TEST_CASE("events reach a module in the delta in which they occur", "[rc][event]") {
  EventSystem s;
  s.control.activate(s.m);
  sc_dt::uint64 direct = 0, through = 0;
  Thread at_queue("at_queue", [&] {
    for (;;) {
      wait(s.in.default_event());
      direct = sc_delta_count();
    }
  });
  Thread at_port("at_port", [&] {
    for (;;) {
      wait(s.m.in->default_event());
      through = sc_delta_count();
    }
  });
  simulate([&] {
    wait(ns(1));
    for (int i = 0; i < 3; ++i) {
      s.in.notify(ns(1));
      wait(ns(2));
      CHECK(direct != 0);
      CHECK(through == direct);
    }
  });
}

TEST_CASE("a module notifies the static side while it is active, and what it then has sent arrives", "[rc][event]") {
  EventSystem s;
  std::vector<sc_time> heard;
  Thread listener("listener", [&] {
    for (;;) {
      wait(s.out.default_event());
      heard.push_back(sc_time_stamp());
    }
  });
  simulate([&] {
    s.m.out->notify(ns(1));
    wait(ns(10));
    s.control.activate(s.m);
    s.m.out->notify(3, SC_NS);
    s.m.out->notify(ns(7));
    wait(ns(5));
    s.control.deactivate(s.m);
    s.m.out->cancel_all();
    s.m.out->notify(ns(1));
    wait(ns(10));
    CHECK(heard == std::vector<sc_time>{ns(13), ns(17)});
    s.control.activate(s.m);
    s.m.out->notify(ns(5));
    s.m.out->cancel_all();
    wait(ns(10));
    CHECK(heard.size() == 2);
  });
}
