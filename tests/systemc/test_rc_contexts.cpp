// SPDX-License-Identifier: Apache-2.0
// No global state: many systems in one process, one after the other.
#include "rc_fixture.hpp"
// after the fixture, which asks for dynamic processes
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>

using namespace rc_test;
using Catch::Contains;

namespace {

struct Caller : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Caller> initiator{"initiator"};
  tlm_utils::simple_target_socket<Caller> target{"target"};
  sc_core::sc_event_queue_port event{"event"};
  sc_core::sc_inout_rv<4> bus{"bus"};
  sc_core::sc_in<bool> clk{"clk"};
  int calls = 0;
  SC_HAS_PROCESS(Caller);
  explicit Caller(const sc_core::sc_module_name&) {
    target.register_b_transport(this, &Caller::transport);
    SC_CTHREAD(count, clk.pos());
    SC_METHOD(drive);
    sensitive << event;
  }
  void transport(tlm::tlm_generic_payload& p, sc_time&) {
    ++calls;
    p.set_response_status(tlm::TLM_OK_RESPONSE);
  }
  void count() {
    for (;;) wait();
  }
  void drive() { bus.write("0101"); }
};
auto group_of(Caller& m) { return rc::ports(m.initiator, m.target, m.event, m.bus, m.clk); }

/// Processes and members of every kind.
struct CallerRc : rc::reconfigurable<Caller> {
  rc::var<int> variable{"variable", 1};
  rc::signal<int> signal{"signal"};
  rc::fifo<int> fifo{"fifo"};
  rc::transaction_counter counter{"counter"};
  explicit CallerRc(const sc_core::sc_module_name& n) : reconfigurable(n) {
    add(counter);
    RC_THREAD(run);
    RC_METHOD(step);
    sensitive << signal;
    RC_CTHREAD(clocked, clk.pos());
  }
  void run() {
    spawn("helper", process_kind::thread, [this] { wait(ns(1000)); });
    tlm::tlm_generic_payload payload;
    sc_time delay;
    {
      const rc::transaction open(*this, "run");
      initiator->b_transport(payload, delay);
    }
    CHECK(payload.is_response_ok());
    fifo.write(variable);
    ++variable;
    signal.write(variable);
    event->notify(ns(1));
    wait(ns(1000));
  }
  void step() { counter.add(0); }
  void clocked() {
    for (;;) wait();
  }
};

void one_system(int i) {
  const OwnContext context;
  sc_core::sc_clock clk("clk", 2, SC_NS);
  sc_core::sc_signal<int> d("d"), q("q");
  sc_core::sc_fifo<int> a("a"), b("b");
  sc_core::sc_event_queue event("event");
  sc_core::sc_signal_rv<4> bus("bus");
  Caller outside("outside");
  outside.event(event);
  outside.bus(bus);
  outside.clk(clk);
  rc::reconfigurable<Comb> comb("comb", i);
  rc::reconfigurable<Adder> adder("adder", i), other("other", -i);
  CallerRc caller("caller");
  CombGroup combs("combs");
  AdderGroup adders("adders");
  rc::portal_group<decltype(group_of(caller))> callers("callers");
  rc::control control("control");
  combs.bind_static(d, q);
  combs.bind_dynamic(group_of(comb));
  adders.bind_static(a, b);
  adders.bind_dynamic(group_of(adder));
  adders.bind_dynamic(group_of(other));
  callers.bind_static(outside.target, outside.initiator, event, bus, clk);
  callers.bind_dynamic(group_of(caller));
  control.add(comb + adder + other + caller);
  if (i % 2 == 0) control.activate(adder);
  control.set_deactivation_timeout(ns(20));
  simulate([&] {
    for (int round = 0; round < 3; ++round) {
      control.activate(comb + adder + caller);
      d.write(round);
      a.write(round);
      CHECK(b.read() == round + i);
      wait(ns(10));
      CHECK(q.read() == round + i);
      CHECK(caller.variable == 2);
      CHECK(outside.calls == round + 1);
      a.write(1);
      CHECK_THAT(error_of([&] { control.unload(comb + adder + caller); }), Contains("not fetched"));
      CHECK(b.read() == 1 + i);
      control.unload(adder);
      control.activate(other);
      a.write(1);
      CHECK(b.read() == 1 - i);
      control.unload(other);
    }
    if (i % 3 == 0) control.activate(adder);  // some end halfway
  });
}

}  // namespace

TEST_CASE("500 systems in one process, one after the other", "[rc][contexts]") {
  for (int i = 0; i < 500; ++i) one_system(i);
}
