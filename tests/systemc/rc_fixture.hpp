// SPDX-License-Identifier: Apache-2.0
// Closed modules that know nothing of reconfiguration, and a script that drives a simulation.
#ifndef CCHIP_TESTS_RC_FIXTURE_HPP
#define CCHIP_TESTS_RC_FIXTURE_HPP

#ifndef SC_INCLUDE_DYNAMIC_PROCESSES
#define SC_INCLUDE_DYNAMIC_PROCESSES  // sc_spawn
#endif
#include <catch2/catch.hpp>
#include <cchip/rc/rc.hpp>
#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

namespace rc_test {

namespace rc = cchip::rc;
using sc_core::sc_delta_count;
using sc_core::SC_MS;
using sc_core::SC_NS;
using sc_core::sc_time;
using sc_core::sc_time_stamp;
using sc_core::SC_ZERO_TIME;
using sc_core::wait;

inline sc_time ns(double n) { return {n, SC_NS}; }
inline void deltas(int n) {
  for (int i = 0; i < n; ++i) wait(SC_ZERO_TIME);
}

/// Elaboration and simulation in a separate context, any number of times in one process; all objects must be destroyed
/// before it. SystemC 2.3.4 frees twice what belongs to reset_signal_is() of a port when a context ends, so keep()
/// those.
class OwnContext {
 public:
  OwnContext() : mine_(std::make_unique<sc_core::sc_simcontext>()) { use(mine_.get()); }
  ~OwnContext() { use(old_); }
  OwnContext(const OwnContext&) = delete;
  OwnContext& operator=(const OwnContext&) = delete;
  /// Keeps it until the end of the process.
  void keep() {
    static auto& kept = *new std::vector<std::unique_ptr<sc_core::sc_simcontext>>;  // not destroyed
    kept.push_back(std::move(mine_));
  }

 private:
  static void use(sc_core::sc_simcontext* context) {
    sc_core::sc_curr_simcontext = sc_core::sc_default_global_context = context;
  }
  sc_core::sc_simcontext* old_ = sc_core::sc_curr_simcontext;
  std::unique_ptr<sc_core::sc_simcontext> mine_;
};

/// A thread of the static side.
class Thread : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Thread);
  Thread(const sc_core::sc_module_name&, std::function<void()> body) : body_(std::move(body)) { SC_THREAD(run); }
  bool done() const { return done_; }

 private:
  void run() {
    body_();
    done_ = true;
  }
  std::function<void()> body_;
  bool done_ = false;
};

/// Elaborates with one more thread, which ends the simulation; fails if this thread does not finish by `limit`.
inline void simulate(std::function<void()> body, const sc_time& limit = sc_time(1, SC_MS)) {
  Thread script("script", [&body] {
    body();
    sc_core::sc_stop();
  });
  sc_core::sc_start(limit);
  CHECK(script.done());
}

/// out = in + k, forever.
struct Adder : sc_core::sc_module {
  sc_core::sc_fifo_in<int> in{"in"};
  sc_core::sc_fifo_out<int> out{"out"};
  const int k;
  SC_HAS_PROCESS(Adder);
  Adder(const sc_core::sc_module_name&, int addend) : k(addend) { SC_THREAD(run); }
  void run() {
    for (;;) out.write(in.read() + k);
  }
};

/// q = d + k, combinational; counts its evaluations.
struct Comb : sc_core::sc_module {
  sc_core::sc_in<int> d{"d"};
  sc_core::sc_out<int> q{"q"};
  const int k;
  int runs = 0;
  SC_HAS_PROCESS(Comb);
  explicit Comb(const sc_core::sc_module_name&, int addend = 0) : k(addend) {
    SC_METHOD(step);
    sensitive << d;
  }
  void step() {
    ++runs;
    q.write(d.read() + k);
  }
};

inline auto group_of(Adder& m) { return rc::ports(m.in, m.out); }
inline auto group_of(Comb& m) { return rc::ports(m.d, m.q); }
using AdderGroup = rc::portal_group<decltype(group_of(std::declval<Adder&>()))>;
using CombGroup = rc::portal_group<decltype(group_of(std::declval<Comb&>()))>;

/// Holds a module until it is told to release it.
struct Latch : rc::holder {
  std::string why = "latch";
  sc_core::sc_event free;
  std::string holding() const override { return why; }
  const sc_core::sc_event* let_go() const override { return &free; }
  void open() {
    why.clear();
    free.notify();
  }
};

/// Records what happens to it, with the time.
struct Probe : rc::reconfigurable<Comb> {
  std::vector<std::string> log;
  sc_time hook_time = SC_ZERO_TIME;
  explicit Probe(const sc_core::sc_module_name& n, int addend = 0) : reconfigurable(n, addend) {}
  void note(const std::string& what) { log.push_back(what + " " + sc_time_stamp().to_string()); }
  void on_load() override { hook("on_load"); }
  void on_activate() override { hook("on_activate"); }
  void on_deactivate() override { hook("on_deactivate"); }
  void on_unload() override { hook("on_unload"); }
  void hook(const char* name) {
    note(name);
    if (hook_time != SC_ZERO_TIME) wait(hook_time);
  }
};

/// Message of the rc::error that a call throws, "" if it throws none.
template <class F>
std::string error_of(F&& call) {
  try {
    call();
  } catch (const rc::error& e) {
    return e.what();
  }
  return {};
}

}  // namespace rc_test

#endif
