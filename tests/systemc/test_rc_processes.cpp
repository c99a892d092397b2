// SPDX-License-Identifier: Apache-2.0
// Processes and members of a module that are reset with its configuration, and those of a closed module, which are not.
#include <memory>

#include "rc_fixture.hpp"

using namespace rc_test;
using rc::state;

namespace {

/// A module without ports.
struct Bare : sc_core::sc_module {
  SC_HAS_PROCESS(Bare);
  explicit Bare(const sc_core::sc_module_name&) {}
};

/// Control of one module M.
template <class M>
struct System {
  M m{"m"};
  rc::control control{"control"};
  System() { control.add(m); }
  void on() { control.activate(m); }
  void off() { control.deactivate(m); }
};

/// Records when its destructor runs.
struct Witness {
  std::vector<std::string>& log;
  ~Witness() { log.push_back("unwound"); }
};

}  // namespace

TEST_CASE("the processes of a closed module go on while it is unloaded", "[rc][process]") {
  struct Ticker : Bare {
    int ticks = 0, edges = 0;
    sc_core::sc_event edge;
    SC_HAS_PROCESS(Ticker);
    explicit Ticker(const sc_core::sc_module_name& n) : Bare(n) {
      SC_THREAD(tick);
      SC_METHOD(step);
      sensitive << edge;
      dont_initialize();
    }
    void tick() {
      for (;; ++ticks) {
        wait(ns(1));
        edge.notify();
      }
    }
    void step() { ++edges; }
  };
  System<rc::reconfigurable<Ticker>> s;
  simulate([&] {
    wait(ns(10.5));
    CHECK(s.m.ticks == 10);
    s.on();
    wait(ns(10));
    s.off();
    wait(ns(10));
    CHECK(s.m.ticks == 30);
    CHECK(s.m.edges == 30);
  });
}

TEST_CASE("RC_THREAD starts from its top at each activation and is cancelled at a wait by deactivation",
          "[rc][process]") {
  struct M : rc::reconfigurable<Bare> {
    std::vector<std::string> log;
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) { RC_THREAD(run); }
    void run() {
      log.push_back("top " + sc_time_stamp().to_string());
      const Witness witness{log};
      for (;;) {
        wait(ns(4));
        log.push_back("step");
      }
    }
  };
  System<M> s;
  simulate([&] {
    wait(ns(10));
    CHECK(s.m.log.empty());
    s.on();
    wait(ns(10));
    CHECK(s.m.log == std::vector<std::string>{"top 10 ns", "step", "step"});
    s.off();
    deltas(2);
    CHECK(s.m.log.back() == "unwound");
    wait(ns(100));
    CHECK(s.m.log.size() == 4);
    s.on();
    deltas(2);
    CHECK(s.m.log.back() == "top 120 ns");
  });
}

TEST_CASE("RC_THREAD that has returned starts again at the next activation", "[rc][process]") {
  struct M : rc::reconfigurable<Bare> {
    int runs = 0;
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) { RC_THREAD(run); }
    void run() { ++runs; }
  };
  System<M> s;
  s.on();
  simulate([&] {
    for (int i = 1; i <= 5; ++i) {
      deltas(3);
      CHECK(s.m.runs == i);
      s.off();
      wait(ns(1));
      CHECK(s.m.runs == i);
      s.on();
    }
  });
}

TEST_CASE("RC_METHOD runs at each activation and on its events while the module is active", "[rc][process]") {
  struct M : rc::reconfigurable<Bare> {
    sc_core::sc_event event;
    int runs = 0;
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) {
      RC_METHOD(run);
      sensitive << event;
    }
    void run() { ++runs; }
  };
  System<M> s;
  simulate([&] {
    s.m.event.notify();
    deltas(2);
    CHECK(s.m.runs == 0);
    for (int i = 1; i <= 3; ++i) {
      s.on();
      deltas(2);
      CHECK(s.m.runs == 2 * i - 1);
      s.m.event.notify();
      deltas(1);
      CHECK(s.m.runs == 2 * i);
      s.off();
      s.m.event.notify();
      deltas(2);
      CHECK(s.m.runs == 2 * i);
    }
  });
}

TEST_CASE("RC_METHOD with dont_initialize runs on its events only, and only while the module is active",
          "[rc][process]") {
  struct M : rc::reconfigurable<Bare> {
    sc_core::sc_event event;
    int runs = 0;
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) {
      RC_METHOD(run);
      sensitive << event;
      dont_initialize();
    }
    void run() { ++runs; }
  };
  System<M> s;
  simulate([&] {
    for (int i = 0; i < 3; ++i) {
      s.m.event.notify();
      deltas(2);
      s.on();
      deltas(2);
      CHECK(s.m.runs == i);
      s.m.event.notify();
      deltas(1);
      CHECK(s.m.runs == i + 1);
      s.off();
    }
  });
}

TEST_CASE("RC_METHOD drops its next_trigger when the module is deactivated", "[rc][process]") {
  struct M : rc::reconfigurable<Bare> {
    std::vector<sc_time> runs;
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) { RC_METHOD(run); }
    void run() {
      runs.push_back(sc_time_stamp());
      next_trigger(ns(10));
    }
  };
  System<M> s;
  s.on();
  simulate([&] {
    wait(ns(15));
    s.off();
    wait(ns(2));
    s.on();
    wait(ns(12));
    CHECK(s.m.runs == std::vector<sc_time>{ns(0), ns(10), ns(17), ns(27)});
  });
}

namespace {

struct Clocked : sc_core::sc_module {
  sc_core::sc_in<bool> clk{"clk"}, rst{"rst"};
  explicit Clocked(const sc_core::sc_module_name&) {}
};

/// Counts its clocks.
struct ClockedRc : rc::reconfigurable<Clocked> {
  int n = -1;
  explicit ClockedRc(const sc_core::sc_module_name& name) : reconfigurable(name) {
    RC_CTHREAD(run, clk.pos());
    reset_signal_is(rst, true);
  }
  void run() {
    n = 0;
    for (;;) {
      wait();
      ++n;
    }
  }
};

}  // namespace

TEST_CASE("RC_CTHREAD starts at the first edge after activation and obeys its reset signal", "[rc][process]") {
  sc_core::sc_clock clk("clk", 10, SC_NS, 0.5, 5, SC_NS);  // edges at 5, 15, ...
  sc_core::sc_signal<bool> rst("rst");
  System<ClockedRc> s;
  auto group = rc::ports(s.m.clk, s.m.rst);
  rc::portal_group<decltype(group)> portals("portals");
  portals.bind_static(clk, rst);
  portals.bind_dynamic(group);
  simulate([&] {
    wait(ns(20));
    CHECK(s.m.n == -1);
    for (int round = 0; round < 3; ++round) {
      s.m.n = -1;
      s.on();
      wait(ns(4));
      CHECK(s.m.n == -1);
      wait(ns(2));
      CHECK(s.m.n == 0);
      wait(ns(30));
      CHECK(s.m.n == 3);
      rst.write(true);
      wait(ns(10));
      CHECK(s.m.n == 0);
      wait(ns(20));
      CHECK(s.m.n == 0);
      rst.write(false);
      wait(ns(20));
      CHECK(s.m.n == 2);
      s.off();
      wait(ns(24));
      CHECK(s.m.n == 2);
    }
  });
}

TEST_CASE("a process spawned during the simulation ends with the deactivation", "[rc][process]") {
  struct M : rc::reconfigurable<Bare> {
    std::vector<std::string> log;
    int started = 0, steps = 0;
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) { RC_THREAD(run); }
    void run() {
      spawn("helper", process_kind::thread, [this] {
        ++started;
        const Witness witness{log};
        for (;; ++steps) wait(ns(1));
      });
    }
  };
  System<M> s;
  simulate([&] {
    for (int i = 1; i <= 3; ++i) {
      s.on();
      wait(ns(5.5));
      CHECK(s.m.started == i);
      CHECK(s.m.steps == 5 * i);
      s.off();
      wait(ns(5));
      CHECK(s.m.steps == 5 * i);
      CHECK(s.m.log.size() == static_cast<std::size_t>(i));
    }
  });
}

TEST_CASE("a process spawned during the simulation for a module that is not active waits for the activation",
          "[rc][process]") {
  System<rc::reconfigurable<Bare>> s;
  std::vector<sc_time> runs;
  simulate([&] {
    s.m.spawn("helper", rc::context::process_kind::thread, [&] { runs.push_back(sc_time_stamp()); });
    wait(ns(5));
    s.on();
    wait(ns(5));
    s.off();
    s.on();
    wait(ns(5));
    CHECK(runs == std::vector<sc_time>{ns(5)});
  });
}

TEST_CASE("processes can be spawned for a closed module before the simulation", "[rc][process]") {
  System<rc::reconfigurable<Bare>> s;
  int runs = 0;
  s.m.spawn("helper", rc::context::process_kind::thread, [&] {
    for (;; ++runs) wait(ns(1));
  });
  simulate([&] {
    wait(ns(5));
    CHECK(runs == 0);
    s.on();
    wait(ns(5.5));
    CHECK(runs == 5);
  });
}

TEST_CASE("possible_deactivation waits for the next activation if the module shall and can leave", "[rc][process]") {
  struct M : rc::reconfigurable<Bare> {
    rc::transaction_counter open{"open"};
    int passed = 0;
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) {
      add(open);
      SC_HAS_PROCESS(M);
      SC_THREAD(run);  // not one that would be cancelled
    }
    void run() {
      for (;;) {
        open.add(1);
        wait(ns(10));
        open.add(-1);
        possible_deactivation();
        ++passed;
      }
    }
  };
  System<M> s;
  s.on();
  simulate([&] {
    wait(ns(15));
    CHECK(s.m.passed == 1);
    s.off();
    CHECK(sc_time_stamp() == ns(20));
    wait(ns(100));
    CHECK(s.m.passed == 1);
    s.on();
    wait(ns(11));
    CHECK(s.m.passed == 3);
  });
}

// ---- members

namespace {

struct Members : rc::reconfigurable<Bare> {
  rc::var<int> variable{"variable", 5};
  rc::var<std::string> text{"text", "initial"};
  int survivor = 5;
  rc::signal<int> signal{"signal"};
  rc::signal<bool> flag{"flag", true};
  rc::fifo<int> fifo{"fifo", 4};
  explicit Members(const sc_core::sc_module_name& n) : reconfigurable(n) { RC_THREAD(run); }
  void run() {
    for (;;) {
      wait(ns(1));
      ++variable;
      variable += 1;
      text = text.get() + "!";
      ++survivor;
      signal.write(variable);
      flag.write(false);
      if (fifo.num_free() > 0) fifo.write(variable);
    }
  }
};

}  // namespace

TEST_CASE("resettable variables have their initial value at each activation, plain ones survive", "[rc][members]") {
  System<Members> s;
  simulate([&] {
    for (int i = 1; i <= 3; ++i) {
      s.on();
      CHECK(s.m.variable == 5);
      wait(ns(3.5));
      CHECK(s.m.variable == 11);
      CHECK(s.m.text.get() == "initial!!!");
      CHECK(s.m.survivor == 5 + 3 * i);
      s.off();
      CHECK(s.m.variable == 5);
      CHECK(s.m.text.get() == "initial");
    }
  });
}

TEST_CASE("the initial value of a resettable is that at the start of simulation", "[rc][members]") {
  System<Members> s;
  s.m.variable = 7;
  s.m.signal.write(70);
  s.m.fifo.write(700);
  simulate([&] {
    for (int i = 0; i < 3; ++i) {
      s.on();
      deltas(2);
      CHECK(s.m.variable == 7);
      CHECK(s.m.signal.read() == 70);
      CHECK(s.m.fifo.num_available() == 1);
      CHECK(s.m.fifo.read() == 700);
      wait(ns(2));
      CHECK(s.m.variable != 7);
      CHECK(s.m.signal.read() != 70);
      s.off();
    }
  });
}

TEST_CASE("resettable signals are reset without being written by a second process", "[rc][members]") {
  System<Members> s;  // signals with one writer
  simulate([&] {
    for (int i = 0; i < 3; ++i) {
      s.on();
      CHECK(s.m.signal.read() == 0);
      CHECK(s.m.flag.read());
      wait(ns(2));
      CHECK(s.m.signal.read() == 7);
      CHECK_FALSE(s.m.flag.read());
      s.off();
      deltas(1);
      CHECK(s.m.signal.read() == 0);
      CHECK(s.m.flag.read());
    }
  });
}

TEST_CASE("a resettable FIFO has neither data nor room while its module is not active, then its initial content",
          "[rc][members]") {
  System<Members> s;
  s.m.fifo.write(1);
  s.m.fifo.write(2);
  simulate([&] {
    deltas(2);
    for (int i = 0; i < 3; ++i) {
      CHECK(s.m.fifo.num_available() == 0);
      CHECK(s.m.fifo.num_free() == 0);
      int value = 0;
      CHECK_FALSE(s.m.fifo.nb_read(value));
      CHECK_FALSE(s.m.fifo.nb_write(3));
      s.on();
      CHECK(s.m.fifo.num_available() == 2);
      CHECK(s.m.fifo.num_free() == 2);
      wait(ns(5));
      CHECK(s.m.fifo.num_available() == 4);
      CHECK(s.m.fifo.read() == 1);
      s.off();
    }
  });
}

TEST_CASE("a process that waits at a resettable FIFO continues after the activation", "[rc][members]") {
  struct M : rc::reconfigurable<Bare> {
    rc::fifo<int> full{"full", 1}, data{"data", 1};
    explicit M(const sc_core::sc_module_name& n) : reconfigurable(n) { data.write(9); }
  };
  System<M> s;
  Thread reader("reader", [&] {
    CHECK(s.m.data.read() == 9);
    CHECK(sc_time_stamp() == ns(7));
  });
  Thread writer("writer", [&] {
    s.m.full.write(1);
    CHECK(sc_time_stamp() == ns(7));
  });
  simulate([&] {
    wait(ns(7));
    CHECK_FALSE(reader.done());
    s.on();
    deltas(2);
    CHECK(reader.done());
    CHECK(writer.done());
  });
}

TEST_CASE("resettables outside of a reconfigurable module are plain", "[rc][members]") {
  rc::var<int> variable("variable", 3);
  rc::signal<int> signal("signal");
  rc::fifo<int> fifo("fifo", 2);
  simulate([&] {
    variable = 4;
    CHECK(variable + 1 == 5);
    signal.write(4);
    fifo.write(4);
    deltas(2);
    CHECK(signal.read() == 4);
    CHECK(fifo.read() == 4);
  });
}

TEST_CASE("resettables deep below a module are reset, those of a reconfigurable module inside with that one",
          "[rc][members]") {
  struct Leaf : sc_core::sc_module {
    rc::var<int> v{"v", 1};
    explicit Leaf(const sc_core::sc_module_name&) {}
  };
  struct Middle : sc_core::sc_module {
    Leaf leaf{"leaf"};
    explicit Middle(const sc_core::sc_module_name&) {}
  };
  struct Top : sc_core::sc_module {
    Middle middle{"middle"};
    rc::reconfigurable<Leaf> inner{"inner"};
    explicit Top(const sc_core::sc_module_name&) {}
  };
  System<rc::reconfigurable<Top>> s;
  s.control.add(s.m.inner);
  simulate([&] {
    s.on();
    s.m.middle.leaf.v = 2;
    s.m.inner.v = 2;
    s.off();
    CHECK(s.m.middle.leaf.v == 1);
    CHECK(s.m.inner.v == 2);
    s.control.activate(s.m.inner);
    CHECK(s.m.inner.v == 1);
  });
}
