// SPDX-License-Identifier: Apache-2.0
// The control: sets, locks, moves, errors.
#include <memory>

#include "rc_fixture.hpp"

using namespace rc_test;
using Catch::Contains;
using Catch::Equals;
using rc::action;
using rc::state;

namespace {

/// Modules with a separate portal group each.
struct Row {
  std::vector<std::unique_ptr<sc_core::sc_signal<int>>> signals;
  std::vector<std::unique_ptr<Probe>> modules;
  std::vector<std::unique_ptr<CombGroup>> groups;
  rc::control control{"control"};
  explicit Row(int size) {
    for (int i = 0; i < size; ++i) {
      const std::string n = std::to_string(i);
      for (const char* s : {"d", "q"}) {
        signals.push_back(std::make_unique<sc_core::sc_signal<int>>((s + n).c_str()));
      }
      modules.push_back(std::make_unique<Probe>(("m" + n).c_str(), 100 * i));
      groups.push_back(std::make_unique<CombGroup>(("portals" + n).c_str()));
      groups.back()->bind_static(*signals[signals.size() - 2], *signals.back());
      groups.back()->bind_dynamic(group_of(*modules.back()));
      control.add(*modules.back());
    }
  }
  Probe& operator[](std::size_t i) { return *modules[i]; }
  rc::module_set all() {
    rc::module_set set(*modules[0]);
    for (auto& m : modules) set += *m;
    return set;
  }
};

}  // namespace

TEST_CASE("actions on sets of 1 to 8 modules run side by side and await them all", "[rc][control]") {
  const int size = GENERATE(1, 2, 3, 4, 5, 6, 7, 8);
  const int slowest = GENERATE_COPY(range(0, size));
  const OwnContext context;
  Row row(size);
  for (int i = 0; i < size; ++i) {
    const double time = i == slowest ? 50 : 1 + i;
    for (const action a : {action::load, action::activate, action::deactivate, action::unload}) {
      row[static_cast<std::size_t>(i)].set_delay(a, ns(time));
    }
  }
  const auto all_are = [&row](state s) {
    for (const auto& m : row.modules) CHECK(m->now() == s);
  };
  simulate([&] {
    row.control.load(row.all());
    CHECK(sc_time_stamp() == ns(50));
    all_are(state::inactive);
    row.control.activate(row.all());
    CHECK(sc_time_stamp() == ns(100));
    all_are(state::active);
    for (const auto& m : row.modules) CHECK(m->log.size() == 2);
    row.control.deactivate(row.all());
    CHECK(sc_time_stamp() == ns(150));
    all_are(state::inactive);
    row.control.unload(row.all());
    CHECK(sc_time_stamp() == ns(200));
    all_are(state::unloaded);
    for (const auto& m : row.modules) CHECK(m->log.size() == 4);
  });
}

TEST_CASE("a module named twice in a set is one module", "[rc][control]") {
  Row row(2);
  const rc::module_set set = row[0] + row[1] + row[0];
  CHECK(set.modules() == std::vector<rc::context*>{&row[0], &row[1]});
}

TEST_CASE("actions leave alone the modules of a set that are not in the state they begin with", "[rc][control]") {
  Row row(3);
  row.control.load(row[1]);
  row.control.activate(row[2]);
  simulate([&] {
    row.control.load(row.all());
    CHECK(row[0].now() == state::inactive);
    CHECK(row[1].now() == state::inactive);
    CHECK(row[2].now() == state::active);
    CHECK(row[1].log.empty());
    row.control.unload(row[0]);
    row.control.deactivate(row.all());
    CHECK(row[0].now() == state::unloaded);
    CHECK(row[1].log.empty());
    CHECK(row[2].now() == state::inactive);
    row.control.activate(row[1] + row[2]);
    row.control.activate(row[1] + row[2]);  // again: nothing to do
    CHECK(row[1].log == std::vector<std::string>{"on_activate 0 s"});
  });
}

TEST_CASE("of a set with a module that cannot be deactivated the others are, and all errors are reported",
          "[rc][control]") {
  Row row(3);
  Latch a, b;
  a.why = "latch a";
  b.why = "latch b";
  row[0].add(a);
  row[2].add(b);
  row.control.activate(row.all());
  row.control.set_deactivation_timeout(ns(20));
  simulate([&] {
    const std::string text = error_of([&] { row.control.unload(row.all()); });
    CHECK_THAT(text, Contains("m0: ") && Contains("latch a") && Contains("m2: ") && Contains("latch b"));
    CHECK(row[0].now() == state::active);
    CHECK(row[1].now() == state::unloaded);
    CHECK(row[2].now() == state::active);
  });
}

TEST_CASE("a module belongs to one control", "[rc][control]") {
  Row row(1);
  rc::control second("second");
  CHECK_THAT(error_of([&] { second.add(row[0]); }),
             Equals("second: m0 belongs to control control; remove it there first"));
  row.control.add(row[0]);  // again: no change
  row.control.remove(row[0]);
  CHECK_THAT(error_of([&] { row.control.load(row[0]); }),
             Equals("control: load m0, which is not in this control; add() it"));
  second.add(row[0]);
  second.activate(row[0]);
  CHECK_THAT(error_of([&] { second.remove(row[0]); }), Contains("m0 is active; only its own unloaded"));
  CHECK_THAT(error_of([&] { row.control.remove(row[0]); }), Contains("m0 is not in this control"));
}

TEST_CASE("controls and modules may end in either order", "[rc][control]") {
  sc_core::sc_signal<int> s("s"), t("t");
  auto control = std::make_unique<rc::control>("control");
  {
    Probe m("m");
    m.d(s);
    m.q(t);
    control->add(m);
  }
  Probe n("n");
  n.d(s);
  n.q(t);
  control->add(n);
  control.reset();
  rc::control next("next");
  CHECK_NOTHROW(next.add(n));
}

TEST_CASE("actions are called from threads", "[rc][control]") {
  Row row(1);
  struct Method : sc_core::sc_module {
    std::function<void()> body;
    SC_HAS_PROCESS(Method);
    Method(const sc_core::sc_module_name&, std::function<void()> f) : body(std::move(f)) { SC_METHOD(run); }
    void run() { body(); }
  };
  std::string text;
  Method method("method", [&] { text = error_of([&] { row.control.load(row[0]); }); });
  sc_core::sc_start(ns(1));
  CHECK_THAT(text, Equals("control: load is not called from a thread; actions take time, call them from an SC_THREAD"));
  CHECK_THAT(error_of([&] { row.control.load(row[0]); }), Contains("not called from a thread"));  // between two starts
  CHECK(row[0].now() == state::unloaded);
}

TEST_CASE("a process that would end with the action cannot ask for it", "[rc][control]") {
  sc_core::sc_signal<int> d("d"), q("q");
  struct Suicidal : Probe {
    rc::control* control = nullptr;
    std::string text;
    explicit Suicidal(const sc_core::sc_module_name& n) : Probe(n) { RC_THREAD(run); }
    void run() {
      text = error_of([this] { control->unload(*this); });
    }
  } m("m");
  CombGroup portals("portals");
  portals.bind_static(d, q);
  portals.bind_dynamic(group_of(m));
  rc::control control("control");
  control.add(m);
  m.control = &control;
  control.activate(m);
  simulate([&] {
    wait(ns(1));
    CHECK_THAT(m.text, Contains("unload m is called by m.run") && Contains("from a process outside"));
    CHECK(m.is_active());
  });
}

TEST_CASE("a lock belongs to a process, as often as it has locked", "[rc][control]") {
  Row row(1);
  Thread other("other", [&] {
    wait(ns(5));
    CHECK(row.control.is_locked());
    CHECK_FALSE(row.control.trylock());
    CHECK_THAT(error_of([&] { row.control.unlock(); }), Contains("has not locked it"));
    row.control.lock();
    CHECK(sc_time_stamp() == ns(20));
    row.control.unlock();
  });
  simulate([&] {
    CHECK(row.control.trylock());
    CHECK(row.control.lock());
    wait(ns(10));
    row.control.unlock();
    wait(ns(10));
    CHECK(row.control.is_locked());
    row.control.unlock();
    wait(ns(10));
    CHECK_FALSE(row.control.is_locked());
    CHECK(other.done());
    CHECK_THAT(error_of([&] { row.control.unlock(); }), Contains("has not locked it"));
  });
}

TEST_CASE("actions between lock and unlock are one for other processes", "[rc][control]") {
  Row row(2);
  for (const action a : {action::load, action::unload}) row[0].set_delay(a, ns(10));
  Thread other("other", [&] {
    wait(ns(1));
    row.control.activate(row[1]);
    CHECK(sc_time_stamp() == ns(25));
  });
  simulate([&] {
    row.control.lock();
    row.control.load(row[0]);
    wait(ns(5));
    row.control.unload(row[0]);
    CHECK(row[1].now() == state::unloaded);
    row.control.unlock();
    wait(ns(1));
    CHECK(other.done());
  });
}

TEST_CASE("lock with a limit waits that long", "[rc][control]") {
  Row row(1);
  Thread owner("owner", [&] {
    row.control.lock();
    wait(ns(50));
    row.control.unlock();
  });
  simulate([&] {
    wait(ns(1));
    CHECK_FALSE(row.control.lock(ns(20)));
    CHECK(sc_time_stamp() == ns(21));
    CHECK(row.control.lock(ns(40)));
    CHECK(sc_time_stamp() == ns(50));
    row.control.unlock();
  });
}

TEST_CASE("a process that has ended keeps no lock", "[rc][control]") {
  Row row(1);
  Thread owner("owner", [&] {
    row.control.lock();
    wait(ns(10));
  });
  simulate([&] {
    wait(ns(1));
    CHECK(row.control.is_locked());
    row.control.activate(row[0]);
    CHECK(sc_time_stamp() == ns(10));
    CHECK(row[0].is_active());
  });
}

TEST_CASE("hooks of a set may use the control that called them", "[rc][control]") {
  Row row(3);
  struct Loader : Probe {
    rc::control* control = nullptr;
    rc::context* next = nullptr;
    using Probe::Probe;
    void on_load() override { control->load(*next); }
  };
  sc_core::sc_signal<int> d("d"), q("q");
  Loader m("m");
  CombGroup portals("portals");
  portals.bind_static(d, q);
  portals.bind_dynamic(group_of(m));
  row.control.add(m);
  m.control = &row.control;
  m.next = &row[2];
  simulate([&] {
    row.control.load(row[0] + m);
    CHECK(row[2].now() == state::inactive);
    CHECK_FALSE(row.control.is_locked());
  });
}

TEST_CASE("move unloads a module and attaches it to another group of the same type", "[rc][control]") {
  Row row(2);
  row.control.activate(row[0]);
  simulate([&] {
    row.signals[0]->write(1);
    deltas(2);
    CHECK(row.signals[1]->read() == 1);
    row.control.unload(row[1]);
    row.control.move(row[0], *row.groups[1]);
    CHECK(row[0].now() == state::unloaded);
    row.control.activate(row[0]);
    CHECK(row.groups[1]->at<0>().active_module() == &row[0]);
    CHECK(row.groups[0]->at<0>().loaded_module() == nullptr);
    row.signals[2]->write(7);
    row.signals[0]->write(9);
    deltas(2);
    CHECK(row.signals[3]->read() == 7);
    CHECK_THAT(error_of([&] { row.control.load(row[1]); }), Contains("is in use by m0"));
  });
}

TEST_CASE("a moved module sees events at portals that no other module listens to", "[rc][control]") {
  Row row(1);
  sc_core::sc_signal<int> d("d"), q("q");
  CombGroup empty("empty");
  empty.bind_static(d, q);
  row.control.activate(row[0]);
  simulate([&] {
    row.control.move(row[0], empty);
    row.control.activate(row[0]);
    for (int i = 1; i <= 3; ++i) {
      d.write(i);
      deltas(2);
      CHECK(q.read() == i);
    }
  });
}

TEST_CASE("move to a group of another type is an error", "[rc][control]") {
  Row row(1);
  sc_core::sc_fifo<int> a("a"), b("b");
  AdderGroup adders("adders");
  adders.bind_static(a, b);
  simulate([&] { CHECK_THAT(error_of([&] { row.control.move(row[0], adders); }), Contains("move m0 to adders")); });
}
