// SPDX-License-Identifier: Apache-2.0
// Portals for TLM-2.0 sockets.
#include "rc_fixture.hpp"
// after the fixture, which asks for dynamic processes
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>

#include <array>

using namespace rc_test;
using Catch::Contains;
using rc::tlm_rule;
using tlm::tlm_generic_payload;

namespace {

/// Memory that takes its time and offers direct pointers.
struct Memory : sc_core::sc_module {
  tlm_utils::simple_target_socket<Memory> target{"target"};
  std::array<unsigned char, 16> bytes{};
  sc_time latency = ns(10);
  int calls = 0, ended = 0;
  explicit Memory(const sc_core::sc_module_name&) {
    target.register_b_transport(this, &Memory::transport);
    target.register_transport_dbg(this, &Memory::debug);
    target.register_get_direct_mem_ptr(this, &Memory::direct);
  }
  void transport(tlm_generic_payload& p, sc_time& delay) {
    ++calls;
    wait(latency);
    delay += ns(1);
    debug(p);
    p.set_dmi_allowed(true);
    p.set_response_status(tlm::TLM_OK_RESPONSE);
    ++ended;
  }
  unsigned debug(tlm_generic_payload& p) {
    unsigned char& byte = bytes.at(p.get_address());
    (p.is_write() ? byte : *p.get_data_ptr()) = p.is_write() ? *p.get_data_ptr() : byte;
    return 1;
  }
  bool direct(tlm_generic_payload&, tlm::tlm_dmi& dmi) {
    dmi.set_dmi_ptr(bytes.data());
    return true;
  }
};
auto group_of(Memory& m) { return rc::ports(m.target); }

struct Master : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Master> initiator{"initiator"};
  explicit Master(const sc_core::sc_module_name&) {}
};
auto group_of(Master& m) { return rc::ports(m.initiator); }

/// One byte.
struct Access {
  unsigned char data;
  tlm_generic_payload payload;
  sc_time delay;
  explicit Access(tlm::tlm_command command, unsigned char value = 0) : data(value) {
    payload.set_command(command);
    payload.set_address(3);
    payload.set_data_ptr(&data);
    payload.set_data_length(1);
    payload.set_streaming_width(1);
  }
};

/// Modules with an initiator socket in front of one static memory.
struct MasterSystem {
  Memory memory{"memory"};
  rc::reconfigurable<Master> m{"m"}, other{"other"};
  rc::portal_group<decltype(group_of(std::declval<Master&>()))> portals{"portals", {"bus"}};
  rc::control control{"control"};
  MasterSystem() {
    portals.bind_static(memory.target);
    portals.bind_dynamic(group_of(m));
    portals.bind_dynamic(group_of(other));
    control.add(m + other);
  }
};

/// Modules with a target socket behind one static master.
struct MemorySystem {
  Master master{"master"};
  rc::reconfigurable<Memory> m{"m"}, other{"other"};
  rc::portal_group<decltype(group_of(std::declval<Memory&>()))> portals{"portals", {"bus"}};
  rc::control control{"control"};
  MemorySystem() {
    portals.bind_static(master.initiator);
    portals.bind_dynamic(group_of(m));
    portals.bind_dynamic(group_of(other));
    control.add(m + other);
  }
};

}  // namespace

TEST_CASE("a module's call passes the portal with its answer and delay", "[rc][tlm]") {
  MasterSystem s;
  s.control.activate(s.m);
  simulate([&] {
    Access write(tlm::TLM_WRITE_COMMAND, 42);
    s.m.initiator->b_transport(write.payload, write.delay);
    CHECK(write.payload.is_response_ok());
    CHECK(write.delay == ns(1));
    CHECK(sc_time_stamp() == ns(10));
    CHECK(s.memory.bytes[3] == 42);
    CHECK_FALSE(write.payload.is_dmi_allowed());  // the memory says yes
  });
}

TEST_CASE("a module's call into a closed portal waits for the activation", "[rc][tlm]") {
  MasterSystem s;
  Thread caller("caller", [&] {
    Access write(tlm::TLM_WRITE_COMMAND, 42);
    s.m.initiator->b_transport(write.payload, write.delay);
    CHECK(sc_time_stamp() == ns(35));
  });
  simulate([&] {
    wait(ns(5));
    s.control.activate(s.other);
    wait(ns(10));
    CHECK(s.memory.calls == 0);
    s.control.unload(s.other);
    wait(ns(10));
    s.control.activate(s.m);
    wait(ns(20));
    CHECK(caller.done());
  });
}

TEST_CASE("a module is held from call to return, and cannot be cancelled meanwhile", "[rc][tlm]") {
  struct Caller : rc::reconfigurable<Master> {
    explicit Caller(const sc_core::sc_module_name& n) : reconfigurable(n) { RC_THREAD(run); }
    void run() {
      for (;;) {
        Access write(tlm::TLM_WRITE_COMMAND, 42);
        initiator->b_transport(write.payload, write.delay);
        wait(ns(10));
      }
    }
  };
  Memory memory("memory");
  Caller m("m");
  rc::portal_group<decltype(group_of(m))> portals("portals", {"bus"});
  portals.bind_static(memory.target);
  portals.bind_dynamic(group_of(m));
  rc::control control("control");
  control.add(m);
  control.activate(m);
  control.set_deactivation_timeout(ns(4));
  simulate([&] {
    wait(ns(3));
    CHECK_THAT(error_of([&] { control.deactivate(m); }),
               Contains("held by portals.bus: 1 call(s) of b_transport not returned"));
    wait(ns(1));
    control.deactivate(m);
    CHECK(sc_time_stamp() == ns(10));
    CHECK(memory.ended == memory.calls);
    wait(ns(50));
    CHECK(memory.calls == 1);
  });
}

TEST_CASE("static calls reach the active module", "[rc][tlm]") {
  MemorySystem s;
  s.m.bytes[3] = 1;
  s.other.bytes[3] = 2;
  simulate([&] {
    unsigned char expected = 0;
    for (rc::context* module : (s.m + s.other).modules()) {
      s.control.activate(*module);
      Access read(tlm::TLM_READ_COMMAND);
      s.master.initiator->b_transport(read.payload, read.delay);
      CHECK(read.payload.is_response_ok());
      CHECK(read.data == ++expected);
      CHECK_FALSE(read.payload.is_dmi_allowed());
      s.control.unload(*module);
    }
  });
}

TEST_CASE("a static call into a closed portal is answered with an error, or waits if it shall", "[rc][tlm]") {
  MemorySystem s;
  simulate([&] {
    Access read(tlm::TLM_READ_COMMAND);
    s.master.initiator->b_transport(read.payload, read.delay);
    CHECK(read.payload.get_response_status() == tlm::TLM_GENERIC_ERROR_RESPONSE);
    CHECK(sc_time_stamp() == SC_ZERO_TIME);
    s.portals.at<0>().set_rule(tlm_rule::wait);
    sc_core::sc_spawn([&] {
      wait(ns(20));
      s.control.activate(s.m);
    });
    s.master.initiator->b_transport(read.payload, read.delay);
    CHECK(read.payload.is_response_ok());
    CHECK(sc_time_stamp() == ns(30));
  });
}

TEST_CASE("a static call that is in progress holds the module, the next one finds it gone", "[rc][tlm]") {
  MemorySystem s;
  s.control.activate(s.m);
  Thread caller("caller", [&] {
    for (int i = 0; i < 2; ++i) {
      Access write(tlm::TLM_WRITE_COMMAND, 7);
      s.master.initiator->b_transport(write.payload, write.delay);
      CHECK(write.payload.is_response_ok() == (i == 0));
    }
  });
  simulate([&] {
    wait(ns(3));
    s.control.unload(s.m);
    CHECK(sc_time_stamp() == ns(10));
    CHECK(s.m.ended == 1);
    wait(ns(1));
    CHECK(caller.done());
  });
}

TEST_CASE("calls without pause do not keep a module", "[rc][tlm]") {
  MemorySystem s;
  s.portals.at<0>().set_rule(tlm_rule::wait);
  s.control.activate(s.m);
  Access write(tlm::TLM_WRITE_COMMAND, 7);  // outside: the thread does not end
  const auto call = [&] {
    for (;;) {
      s.master.initiator->b_transport(write.payload, write.delay);
      CHECK(write.payload.is_response_ok());
    }
  };
  Thread caller("caller", call);
  simulate([&] {
    for (int i = 0; i < 4; ++i) {
      rc::context& next = i % 2 == 0 ? static_cast<rc::context&>(s.other) : s.m;
      rc::context& last = i % 2 == 0 ? static_cast<rc::context&>(s.m) : s.other;
      wait(ns(13));
      s.control.unload(last);
      s.control.activate(next);
    }
    CHECK(sc_time_stamp() <= ns(4 * 30));
    CHECK(s.m.calls + s.other.calls >= 7);
    CHECK(s.m.ended == s.m.calls);
  });
}

TEST_CASE("a module that waits for a static call to let it go gets it", "[rc][tlm]") {
  MemorySystem s;
  Latch latch;
  s.m.add(latch);
  s.control.activate(s.m);
  Thread caller("caller", [&] {
    wait(ns(20));  // deactivation is pending then
    Access read(tlm::TLM_READ_COMMAND);
    s.master.initiator->b_transport(read.payload, read.delay);
    CHECK(read.payload.is_response_ok());
    latch.open();
  });
  simulate([&] {
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(30));
  });
}

TEST_CASE("a module that calls without pause can leave, and continues later", "[rc][tlm]") {
  MasterSystem s;
  Access write(tlm::TLM_WRITE_COMMAND, 7);  // outside: the thread does not end
  Thread caller("caller", [&] {
    for (;;) {
      s.m.initiator->b_transport(write.payload, write.delay);
      CHECK(write.payload.is_response_ok());
    }
  });
  s.control.activate(s.m);
  simulate([&] {
    wait(ns(13));
    s.control.deactivate(s.m);
    CHECK(sc_time_stamp() == ns(20));
    wait(ns(100));
    CHECK(s.memory.calls == 2);
    s.control.activate(s.m);
    wait(ns(15));
    CHECK(s.memory.calls == 4);
  });
}

TEST_CASE("debug transport passes open portals and moves nothing through closed ones", "[rc][tlm]") {
  MemorySystem t;
  Memory memory("memory_of_m");
  rc::reconfigurable<Master> m("master_m");
  rc::portal_group<decltype(group_of(m))> portals("portals_of_m");
  portals.bind_static(memory.target);
  portals.bind_dynamic(group_of(m));
  t.control.add(m);
  simulate([&] {
    Access write(tlm::TLM_WRITE_COMMAND, 9);
    CHECK(m.initiator->transport_dbg(write.payload) == 0);
    CHECK(t.master.initiator->transport_dbg(write.payload) == 0);
    t.control.activate(m + t.m);
    CHECK(m.initiator->transport_dbg(write.payload) == 1);
    CHECK(t.master.initiator->transport_dbg(write.payload) == 1);
    CHECK(memory.bytes[3] == 9);
    CHECK(t.m.bytes[3] == 9);
    CHECK(t.other.bytes[3] == 0);
    CHECK(sc_time_stamp() == SC_ZERO_TIME);
  });
}

TEST_CASE("direct memory pointers and nonblocking transport do not pass", "[rc][tlm]") {
  MasterSystem s;
  s.control.activate(s.m);
  simulate([&] {
    Access read(tlm::TLM_READ_COMMAND);
    tlm::tlm_dmi dmi;
    CHECK_FALSE(s.m.initiator->get_direct_mem_ptr(read.payload, dmi));
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    CHECK_THAT(error_of([&] { s.m.initiator->nb_transport_fw(read.payload, phase, read.delay); }),
               Contains("m.initiator: nonblocking transport does not pass portals; use b_transport()"));
  });
}
