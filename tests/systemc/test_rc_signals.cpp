// SPDX-License-Identifier: Apache-2.0
// Signal portals.
#include <algorithm>
#include <memory>

#include "rc_fixture.hpp"

using namespace rc_test;
using Catch::Contains;
using sc_dt::sc_logic;
using sc_dt::sc_lv;

namespace {

/// Any two ports, and a record of the events at the input.
template <class T>
struct Pins : sc_core::sc_module {
  sc_core::sc_in<T> d{"d"};
  sc_core::sc_inout<T> q{"q"};
  std::vector<std::pair<sc_time, T>> seen;
  SC_HAS_PROCESS(Pins);
  explicit Pins(const sc_core::sc_module_name&) {
    SC_METHOD(watch);
    sensitive << d;
    dont_initialize();
  }
  void watch() {
    CHECK(d.event());
    seen.emplace_back(sc_time_stamp(), d.read());
  }
};
template <class T>
auto group_of(Pins<T>& m) {
  return rc::ports(m.d, m.q);
}

template <class T>
struct System {
  sc_core::sc_signal<T> d{"d"}, q{"q"};
  rc::reconfigurable<Pins<T>> a{"a"}, b{"b"};
  rc::portal_group<decltype(group_of(std::declval<Pins<T>&>()))> portals{"portals", {"d", "q"}};
  rc::control control{"control"};
  System() {
    portals.bind_static(d, q);
    portals.bind_dynamic(group_of(a));
    portals.bind_dynamic(group_of(b));
    control.add(a + b);
  }
};

struct Colour {
  int value = 0;
  bool operator==(const Colour& other) const { return value == other.value; }
};
std::ostream& operator<<(std::ostream& out, const Colour& c) { return out << c.value; }
void sc_trace(sc_core::sc_trace_file*, const Colour&, const std::string&) {}

}  // namespace

template <>
struct cchip::rc::undefined_value<Colour> {
  static Colour get() { return {-1}; }
};

TEST_CASE("a closed portal shows the module an undefined value and no event", "[rc][signal]") {
  System<int> s;
  s.d.write(5);
  simulate([&] {
    deltas(2);
    CHECK(s.a.d.read() == 0);
    CHECK_FALSE(s.a.d.event());
    s.d.write(6);
    deltas(3);
    CHECK(s.a.seen.empty());
    s.control.activate(s.a);
    CHECK(s.a.d.read() == 6);
    CHECK(s.b.d.read() == 0);
    s.portals.at<0>().set_undefined_input(77);
    CHECK(s.b.d.read() == 77);
    CHECK(s.a.d.read() == 6);
    s.control.deactivate(s.a);
    CHECK(s.a.d.read() == 77);
  });
}

TEST_CASE("an opened portal gives the module one event of its input", "[rc][signal]") {
  System<int> s;
  s.d.write(5);
  simulate([&] {
    wait(ns(3));
    s.control.activate(s.a);
    deltas(3);
    CHECK(s.a.seen == std::vector<std::pair<sc_time, int>>{{ns(3), 5}});
    s.control.deactivate(s.a);
    s.control.activate(s.a);  // the value is the same
    deltas(3);
    CHECK(s.a.seen.size() == 2);
    s.d.write(9);
    deltas(3);
    CHECK(s.a.seen.size() == 3);
    CHECK(s.b.seen.empty());
  });
}

TEST_CASE("a module that is active from the start sees one event of its input", "[rc][signal]") {
  System<int> s;
  s.d.write(5);
  s.control.activate(s.a);
  simulate([&] {
    deltas(3);
    CHECK(s.a.seen == std::vector<std::pair<sc_time, int>>{{SC_ZERO_TIME, 5}});
  });
}

TEST_CASE("a value that changes while the portal opens gives one event", "[rc][signal]") {
  System<int> s;
  Thread writer("writer", [&] {
    s.d.write(6);
    wait(s.a.activated_event());
    s.d.write(7);  // in the delta that has the event of the opening
  });
  simulate([&] {
    wait(ns(1));
    s.control.activate(s.a);
    deltas(4);
    CHECK(s.a.seen == std::vector<std::pair<sc_time, int>>{{ns(1), 6}, {ns(1), 7}});
  });
}

TEST_CASE("processes that wait for different kinds of events of one input run once for each", "[rc][signal]") {
  struct Kinds : sc_core::sc_module {
    sc_core::sc_in<bool> clk{"clk"};
    int any = 0, rises = 0, falls = 0;
    SC_HAS_PROCESS(Kinds);
    explicit Kinds(const sc_core::sc_module_name&) {
      SC_METHOD(on_rise);
      sensitive << clk.pos();
      dont_initialize();
      SC_METHOD(on_any);
      sensitive << clk;
      dont_initialize();
      SC_METHOD(on_fall);
      sensitive << clk.neg();
      dont_initialize();
    }
    void on_any() { ++any; }
    void on_rise() { ++rises; }
    void on_fall() { ++falls; }
  };
  sc_core::sc_signal<bool> clk("clk");
  rc::reconfigurable<Kinds> m("m");
  rc::in_portal<bool> portal("portal");
  portal.static_port(clk);
  portal.bind_dynamic(m.clk);
  rc::control control("control");
  control.add(m);
  control.activate(m);
  simulate([&] {
    wait(ns(1));
    m.any = m.rises = m.falls = 0;
    for (int i = 1; i <= 10; ++i) {
      clk.write(!clk.read());
      wait(ns(1));
      CHECK(m.any == i);
      CHECK(m.rises == (i + 1) / 2);
      CHECK(m.falls == i / 2);
    }
  });
}

TEST_CASE("an opened portal gives an edge according to the present value", "[rc][signal]") {
  const bool level = GENERATE(false, true);
  const OwnContext context;
  System<bool> s;
  s.d.write(level);
  int rises = 0, falls = 0;
  Thread up("up", [&] {
    for (;;) {
      wait(s.a.d.posedge_event());
      CHECK(s.a.d.posedge());
      CHECK_FALSE(s.a.d.negedge());
      ++rises;
    }
  });
  Thread down("down", [&] {
    for (;;) {
      wait(s.a.d.negedge_event());
      CHECK(s.a.d.negedge());
      ++falls;
    }
  });
  simulate([&] {
    wait(ns(1));
    s.control.activate(s.a);
    deltas(3);
    CHECK(rises == (level ? 1 : 0));
    CHECK(falls == (level ? 0 : 1));
    s.d.write(!level);
    deltas(3);
    CHECK(rises == 1);
    CHECK(falls == 1);
  });
}

TEST_CASE("an output appears at the static signal while its module is active", "[rc][signal]") {
  System<int> s;
  Thread writer("writer", [&] {
    for (int i = 1;; ++i) {
      s.b.q.write(i);
      wait(ns(10));
    }
  });
  simulate([&] {
    wait(ns(11));
    CHECK(s.q.read() == 0);
    s.control.activate(s.b);
    deltas(2);
    CHECK(s.q.read() == 2);  // what the pins show when the portal opens
    wait(ns(10));
    CHECK(s.q.read() == 3);
    s.control.deactivate(s.b);
    deltas(2);
    CHECK(s.q.read() == 0);
    wait(ns(20));
    CHECK(s.q.read() == 0);
    s.control.activate(s.b);
    deltas(2);
    CHECK(s.q.read() == 5);
  });
}

TEST_CASE("a module that has written nothing changes nothing when its portal opens", "[rc][signal]") {
  System<int> s;
  s.q.write(42);
  simulate([&] {
    s.control.activate(s.a);
    deltas(3);
    CHECK(s.q.read() == 42);
  });
}

TEST_CASE("the static signal keeps its own value until the first closing, and the undefined one after unloading",
          "[rc][signal]") {
  System<int> s;
  s.q.write(42);
  s.control.activate(s.a);
  simulate([&] {
    deltas(2);
    CHECK(s.q.read() == 42);
    s.control.deactivate(s.a);
    deltas(2);
    CHECK(s.q.read() == 0);
    s.control.unload(s.a);
    deltas(2);
    CHECK(s.q.read() == 0);
  });
}

TEST_CASE("a closing portal writes an undefined value: Z for logic", "[rc][signal]") {
  System<sc_logic> s;
  sc_core::sc_signal<sc_lv<4>> w("w"), x("x");
  rc::reconfigurable<Pins<sc_lv<4>>> v("v");
  rc::portal_group<decltype(group_of(v))> more("more");
  more.bind_static(w, x);
  more.bind_dynamic(group_of(v));
  s.control.add(v);
  s.control.activate(s.a + v);
  Thread writer("writer", [&] {
    s.a.q.write(sc_logic('1'));
    v.q.write(sc_lv<4>("0101"));
  });
  simulate([&] {
    deltas(2);
    CHECK(s.q.read() == sc_logic('1'));
    CHECK(x.read() == sc_lv<4>("0101"));
    s.control.deactivate(s.a + v);
    deltas(2);
    CHECK(s.q.read() == sc_logic('Z'));
    CHECK(x.read() == sc_lv<4>("ZZZZ"));
    CHECK(s.a.d.read() == sc_logic('Z'));
  });
}

TEST_CASE("a closing portal writes an undefined value: what undefined_value says of other types", "[rc][signal]") {
  System<Colour> s;
  s.control.activate(s.a);
  Thread writer("writer", [&] { s.a.q.write(Colour{3}); });
  simulate([&] {
    deltas(2);
    CHECK(s.q.read() == Colour{3});
    s.control.deactivate(s.a);
    deltas(2);
    CHECK(s.q.read() == Colour{-1});
    CHECK(s.a.d.read() == Colour{-1});
  });
}

TEST_CASE("a closing portal writes an undefined value: the caller's, or keeps the last one", "[rc][signal]") {
  System<int> s;
  s.portals.at<1>().set_undefined_output([] { return 1234; });
  s.control.activate(s.a);
  Thread writer("writer", [&] { s.a.q.write(3); });
  simulate([&] {
    deltas(2);
    s.control.deactivate(s.a);
    deltas(2);
    CHECK(s.q.read() == 1234);
    s.portals.at<1>().hold_output();
    s.control.activate(s.a);
    deltas(2);
    CHECK(s.q.read() == 3);
    s.control.unload(s.a);
    deltas(3);
    CHECK(s.q.read() == 3);
  });
}

TEST_CASE("modules alternate at a signal with one writer", "[rc][signal]") {
  System<int> s;  // sc_signal checks its writer
  Thread write_a("write_a", [&] {
    for (int i = 0;; ++i) {
      s.a.q.write(i);
      wait(ns(1));
    }
  });
  Thread write_b("write_b", [&] {
    for (int i = 0;; ++i) {
      s.b.q.write(-i);
      wait(ns(1));
    }
  });
  simulate([&] {
    for (int i = 0; i < 5; ++i) {
      s.control.activate(s.a);
      wait(ns(5.5));
      CHECK(s.q.read() > 0);
      s.control.unload(s.a);
      s.control.activate(s.b);
      wait(ns(5.5));
      CHECK(s.q.read() < 0);
      s.control.unload(s.b);
    }
  });
}

TEST_CASE("two writing processes in one module are an error if the static signal takes one", "[rc][signal]") {
  System<int> s;
  s.control.activate(s.a);
  std::string text;
  Thread first("first", [&] {
    s.a.q.write(1);
    wait(ns(5));
  });
  Thread second("second", [&] {
    wait(ns(1));
    try {
      s.a.q.write(2);
    } catch (const sc_core::sc_report& report) {
      text = report.what();
    }
  });
  simulate([&] { wait(ns(2)); });
  CHECK_THAT(text, Contains("E115") && Contains("a.q is written by first.run and by second.run"));
}

TEST_CASE("two writing processes in one module are fine if the static signal takes several", "[rc][signal]") {
  sc_core::sc_signal<int> d("d");
  sc_core::sc_signal<int, sc_core::SC_MANY_WRITERS> q("q");
  rc::reconfigurable<Pins<int>> m("m");
  rc::portal_group<decltype(group_of(m))> portals("portals");
  portals.bind_static(d, q);
  portals.bind_dynamic(group_of(m));
  rc::control control("control");
  control.add(m);
  control.activate(m);
  Thread first("first", [&] {
    m.q.write(1);
    wait(ns(5));
  });
  Thread second("second", [&] {
    wait(ns(1));
    m.q.write(2);
  });
  simulate([&] {
    wait(ns(2));
    CHECK(q.read() == 2);
  });
}

TEST_CASE("a process that has ended may be followed by another writer", "[rc][signal]") {
  System<int> s;
  s.control.activate(s.a);
  simulate([&] {
    for (int i = 1; i <= 3; ++i) {
      sc_core::sc_spawn([&s, i] { s.a.q.write(i); });
      deltas(3);
      CHECK(s.q.read() == i);
    }
  });
}

TEST_CASE("an inout port sees the static signal and its events", "[rc][signal]") {
  System<int> s;
  s.control.activate(s.a);
  std::vector<int> seen;
  Thread reader("reader", [&] {
    for (;;) {
      wait(s.a.q.value_changed_event());
      CHECK(s.a.q.event());
      seen.push_back(s.a.q.read());
    }
  });
  Thread writer("writer", [&] {
    for (const int i : {7, 7, 8}) {
      wait(ns(2));
      s.a.q.write(i);
    }
  });
  simulate([&] {
    wait(ns(1));
    seen.clear();  // of the opening
    wait(ns(10));
    CHECK(seen == std::vector<int>{7, 8});
    s.control.deactivate(s.a);
    wait(ns(1));
    CHECK(seen == std::vector<int>{7, 8});
    CHECK(s.a.q.read() == 0);
  });
}

TEST_CASE("an initial value of an output appears when the portal opens", "[rc][signal]") {
  System<int> s;
  s.a.q.initialize(31);
  s.b.q.initialize(32);
  s.control.activate(s.a);
  simulate([&] {
    deltas(1);
    CHECK(s.q.read() == 31);
    s.control.unload(s.a);
    s.control.activate(s.b);
    deltas(1);
    CHECK(s.q.read() == 32);
  });
}

namespace {

/// A chain of combinational modules; counts the deltas that a change takes to pass, and the runs of each module.
struct Chain {
  static constexpr int length = 3;
  sc_core::sc_signal<int> s0{"s0"}, s1{"s1"}, s2{"s2"}, s3{"s3"};
};

/// Deltas and evaluations from a change of the input to rest; the answer is checked.
std::pair<sc_dt::uint64, int> change(Chain& c, Comb& first, Comb& second, Comb& third) {
  wait(ns(1));
  const int runs = first.runs + second.runs + third.runs;
  const auto before = sc_delta_count();
  c.s0.write(c.s0.read() + 1);
  wait(ns(1));  // all deltas of this instant
  const auto all = sc_delta_count() - before;
  CHECK(c.s3.read() == c.s0.read() + 111);
  return {all, first.runs + second.runs + third.runs - runs};
}

std::pair<sc_dt::uint64, int> direct() {
  const OwnContext context;
  std::pair<sc_dt::uint64, int> result;
  Chain c;
  Comb m1("m1", 100), m2("m2", 10), m3("m3", 1);
  m1.d(c.s0), m1.q(c.s1), m2.d(c.s1), m2.q(c.s2), m3.d(c.s2), m3.q(c.s3);
  simulate([&] { result = change(c, m1, m2, m3); });
  return result;
}

}  // namespace

TEST_CASE("signal portals add no delta and no evaluation to a chain of modules", "[rc][signal]") {
  const auto expected = direct();
  CHECK(expected.second == Chain::length);
  Chain c;
  rc::reconfigurable<Comb> m1("m1", 100), m2("m2", 10), m3("m3", 1);
  CombGroup g1("g1"), g2("g2"), g3("g3");
  g1.bind_static(c.s0, c.s1), g2.bind_static(c.s1, c.s2), g3.bind_static(c.s2, c.s3);
  g1.bind_dynamic(group_of(m1)), g2.bind_dynamic(group_of(m2)), g3.bind_dynamic(group_of(m3));
  rc::control control("control");
  control.add(m1 + m2 + m3);
  control.activate(m1 + m2 + m3);
  simulate([&] { CHECK(change(c, m1, m2, m3) == expected); });
}

TEST_CASE("a process of a module sees inputs that change in one delta once, in that delta", "[rc][signal]") {
  struct Sum : sc_core::sc_module {
    sc_core::sc_in<int> a{"a"}, b{"b"}, c{"c"};
    int runs = 0, last = 0;
    sc_dt::uint64 at = 0;
    SC_HAS_PROCESS(Sum);
    explicit Sum(const sc_core::sc_module_name&) {
      SC_METHOD(step);
      sensitive << a << b << c;
      dont_initialize();
    }
    void step() {
      ++runs;
      last = a.read() + b.read() + c.read();
      at = sc_delta_count();
    }
  };
  sc_core::sc_signal<int> a("a"), b("b"), c("c");
  rc::reconfigurable<Sum> m("m");
  auto group = rc::ports(m.a, m.b, m.c);
  rc::portal_group<decltype(group)> portals("portals");
  portals.bind_static(a, b, c);
  portals.bind_dynamic(group);
  rc::control control("control");
  control.add(m);
  control.activate(m);
  simulate([&] {
    wait(ns(1));
    m.runs = 0;
    for (int i = 1; i <= 100; ++i) {
      const auto before = sc_delta_count();
      a.write(i), b.write(10 * i), c.write(100 * i);
      deltas(3);
      CHECK(m.at == before + 1);
      CHECK(m.last == 111 * i);
      CHECK(m.runs == i);
    }
  });
}

TEST_CASE("a process that starts to wait for an event gets no event for that", "[rc][signal]") {
  System<bool> s;
  s.control.activate(s.a);
  std::vector<std::string> log;
  const auto note = [&](const char* what) { log.push_back(what + sc_time_stamp().to_string()); };
  Thread waiter("waiter", [&] {
    wait(ns(1));
    for (int i = 0; i < 2; ++i) {
      wait(s.a.d.posedge_event());
      note("rise ");
      wait(s.a.d.negedge_event());
      note("fall ");
    }
    wait(s.a.d.value_changed_event());
    note("any ");
  });
  simulate([&] {
    for (int i = 0; i < 6; ++i) {
      wait(ns(10));
      s.d.write(!s.d.read());
    }
    deltas(3);
    CHECK(log == std::vector<std::string>{"rise 10 ns", "fall 20 ns", "rise 30 ns", "fall 40 ns", "any 50 ns"});
  });
}

namespace {

/// Works at rising edges, looks at its data only then.
struct Edges : sc_core::sc_module {
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_in<int> d{"d"};
  int sum = 0;
  SC_HAS_PROCESS(Edges);
  explicit Edges(const sc_core::sc_module_name&) {
    SC_METHOD(step);
    sensitive << clk.pos();
    dont_initialize();
  }
  void step() { sum += d.read(); }
};
auto group_of(Edges& m) { return rc::ports(m.clk, m.d); }

/// All deltas of some clocks, and the sum.
std::pair<sc_dt::uint64, int> clocks(bool through_portals) {
  const OwnContext context;
  sc_core::sc_clock clk("clk", 4, SC_NS);
  sc_core::sc_signal<int> d("d");
  rc::reconfigurable<Edges> m("m");
  using Group = rc::portal_group<decltype(group_of(m))>;
  std::unique_ptr<Group> portals;
  rc::control control("control");
  control.add(m);
  if (through_portals) {
    portals = std::make_unique<Group>("portals");
    portals->bind_static(clk, d);
    portals->bind_dynamic(group_of(m));
    control.activate(m);
  } else {
    m.clk(clk), m.d(d);
  }
  std::pair<sc_dt::uint64, int> result;
  simulate([&] {
    wait(ns(1));
    const auto start = sc_delta_count();
    for (int i = 0; i < 100; ++i) {
      d.write(i);
      wait(ns(3));  // mostly apart from the edges
    }
    result = {sc_delta_count() - start, m.sum};
  });
  return result;
}

}  // namespace

TEST_CASE("portals of clocks and data add no delta where nothing waits for their events", "[rc][signal]") {
  const auto direct = clocks(false);
  CHECK(direct.second > 0);
  CHECK(clocks(true) == direct);
}

namespace {

/// Counts clocks from reset, as a closed module does.
template <bool Async>
struct Counter : sc_core::sc_module {
  sc_core::sc_in<bool> clk{"clk"}, rst{"rst"};
  sc_core::sc_out<int> n{"n"};
  SC_HAS_PROCESS(Counter);
  explicit Counter(const sc_core::sc_module_name&) {
    SC_CTHREAD(run, clk.pos());
    if (Async) {
      async_reset_signal_is(rst, true);
    } else {
      reset_signal_is(rst, true);
    }
  }
  void run() {
    n.write(0);
    for (int i = 1;; ++i) {
      wait();
      n.write(i);
    }
  }
};
template <bool Async>
auto group_of(Counter<Async>& m) {
  return rc::ports(m.clk, m.rst, m.n);
}

/// The same stimulus, value of n after every nanosecond.
template <bool Async>
std::vector<int> counts(bool through_portals) {
  OwnContext context;
  context.keep();
  std::vector<int> trace;
  sc_core::sc_clock clk("clk", 4, SC_NS);
  sc_core::sc_signal<bool> rst("rst");
  sc_core::sc_signal<int> n("n");
  rc::reconfigurable<Counter<Async>> m("m");
  using Group = rc::portal_group<decltype(group_of(m))>;
  std::unique_ptr<Group> portals;
  rc::control control("control");
  control.add(m);
  if (through_portals) {
    portals = std::make_unique<Group>("portals");
    portals->bind_static(clk, rst, n);
    portals->bind_dynamic(group_of(m));
    control.activate(m);
  } else {
    m.clk(clk), m.rst(rst), m.n(n);
  }
  Thread reset("reset", [&] {
    for (const double time : {2.0, 7.0, 5.5, 4.0, 3.5, 12.0, 0.5, 6.0}) {  // also on clock edges
      rst.write(!rst.read());
      wait(ns(time));
    }
  });
  simulate([&] {
    for (int i = 0; i < 60; ++i) {
      wait(ns(1));
      deltas(3);
      trace.push_back(n.read());
    }
  });
  return trace;
}

}  // namespace

TEST_CASE("reset_signal_is of a closed module works through a portal", "[rc][signal]") {
  const auto direct = counts<false>(false);
  CHECK(*std::max_element(direct.begin(), direct.end()) > 2);
  CHECK(std::count(direct.begin(), direct.end(), 0) > 8);
  CHECK(counts<false>(true) == direct);
}

TEST_CASE("async_reset_signal_is of a closed module works through a portal", "[rc][signal]") {
  const auto direct = counts<true>(false);
  CHECK(direct != counts<false>(false));
  CHECK(counts<true>(true) == direct);
}

TEST_CASE("reset on configuration: a signal that one portal drives resets the module through another", "[rc][signal]") {
  struct WithRoc : rc::reconfigurable<Counter<false>> {
    sc_core::sc_out<bool> roc{"roc"};
    explicit WithRoc(const sc_core::sc_module_name& name) : reconfigurable(name) {
      RC_THREAD(reset);
      sensitive << clk.pos();
    }
    void reset() {
      roc.write(true);
      wait(2);
      roc.write(false);
    }
  };
  sc_core::sc_clock clk("clk", 4, SC_NS);
  sc_core::sc_signal<bool> rst("rst");
  sc_core::sc_signal<int> n("n");
  WithRoc m("m");
  auto group = rc::ports(m.clk, m.rst, m.n, m.roc);
  rc::portal_group<decltype(group)> portals("portals");
  portals.bind_static(clk, rst, n, rst);
  portals.bind_dynamic(group);
  rc::control control("control");
  control.add(m);
  simulate([&] {
    for (int i = 0; i < 3; ++i) {
      control.activate(m);
      wait(ns(8));
      CHECK(n.read() == 0);
      CHECK(rst.read() == (i == 0));
      wait(ns(80));
      CHECK(n.read() > 10);
      control.unload(m);
      wait(ns(1));
    }
  });
}
