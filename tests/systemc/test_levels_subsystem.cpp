// SPDX-License-Identifier: Apache-2.0
#define SC_INCLUDE_DYNAMIC_PROCESSES
#include <catch2/catch.hpp>
#include <cchip/internal/wire/registers.hpp>
#include <cchip/levels/platform.hpp>
#include <cchip/levels/software_c3.hpp>
#include <cchip/program/seed.hpp>
#include <functional>

using namespace cchip;
using namespace cchip::levels;
namespace regs = cchip::registers;

namespace {

const sc_core::sc_time period(10, sc_core::SC_NS);

/// The subsystem of level 4 with its memory and software, and a thread that runs a test.
class Bench : public sc_core::sc_module {
 public:
  Platform platform{sim::seed_from_environment(), period, 4 * period};
  SoftwareC3 c3{"c3", 20000 * period};

  SC_HAS_PROCESS(Bench);
  Bench(const sc_core::sc_module_name& name, std::function<void(Bench&)> body)
      : sc_module(name), body_(std::move(body)) {
    c3.registers.bind(platform.subsystem.registers);
    c3.irq(platform.irq);
    SC_THREAD(run);
  }

  void announce(ModuleId id, const Bytes& bitstream) {
    c3.announce(id, platform.memory.append(bitstream), bitstream.size());
  }

  /// Answer for two triangles that share their plane and overlap.
  RtlResult ask(std::uint16_t tag) {
    RtlRequest request;
    request.tag = tag;
    request.pair.a.v = {Vec3i{0, 0, 0}, Vec3i{4, 0, 0}, Vec3i{0, 4, 0}, Vec3i::Zero()};
    request.pair.b = request.pair.a;
    platform.requests.write(request);
    return platform.results.read();
  }

 private:
  void run() {
    body_(*this);
    finished_ = true;
    sc_core::sc_stop();
  }
  void end_of_simulation() override { CHECK(finished_); }

  std::function<void(Bench&)> body_;
  bool finished_ = false;
};

void run_on_bench(const std::function<void(Bench&)>& body) {
  const Bench bench("bench", body);
  sc_core::sc_start();
}

Bytes bitstream_of(ModuleId id) { return make_bitstream(0, id, make_payload(0, id, 64)); }

std::string error_of(SoftwareC3& c3, ModuleId id) {
  try {
    c3.configure(id);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

/// A TLM-2.0 initiator beside the C3's.
class Prober : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<Prober> socket{"socket"};
  explicit Prober(const sc_core::sc_module_name& name) : sc_module(name) {}

  tlm::tlm_response_status access(tlm::tlm_command command, std::uint64_t address, std::uint32_t& data,
                                  unsigned bytes = 4, unsigned char* enables = nullptr) {
    tlm::tlm_generic_payload transaction;
    transaction.set_command(command);
    transaction.set_address(address);
    transaction.set_data_ptr(reinterpret_cast<unsigned char*>(&data));
    transaction.set_data_length(bytes);
    transaction.set_streaming_width(bytes);
    transaction.set_byte_enable_ptr(enables);
    transaction.set_byte_enable_length(enables == nullptr ? 0 : bytes);
    sc_core::sc_time delay = 3 * period;
    socket->b_transport(transaction, delay);
    return transaction.get_response_status();
  }
};

}  // namespace

TEST_CASE("levels subsystem: registers behind a TLM-2.0 socket", "[systemc][levels]") {
  Platform platform(sim::seed_from_environment(), period, period);
  Prober prober("prober");
  prober.socket.bind(platform.subsystem.registers);
  bool finished = false;
  sc_core::sc_spawn([&] {
    std::uint32_t data = 0;
    CHECK(prober.access(tlm::TLM_READ_COMMAND, regs::id::offset, data) == tlm::TLM_OK_RESPONSE);
    CHECK(data == regs::id::value_reset);
    CHECK(prober.access(tlm::TLM_READ_COMMAND, regs::capabilities::offset, data) == tlm::TLM_OK_RESPONSE);
    CHECK((data & regs::capabilities::slots_mask) == 1);
    data = 12345;
    CHECK(prober.access(tlm::TLM_WRITE_COMMAND, regs::maximum_age::offset, data) == tlm::TLM_OK_RESPONSE);
    data = 0;
    CHECK(prober.access(tlm::TLM_READ_COMMAND, regs::maximum_age::offset, data) == tlm::TLM_OK_RESPONSE);
    CHECK(data == 12345);
    CHECK(prober.access(tlm::TLM_READ_COMMAND, 0xFF8, data) == tlm::TLM_GENERIC_ERROR_RESPONSE);
    CHECK(prober.access(tlm::TLM_READ_COMMAND, 0x1000, data) == tlm::TLM_ADDRESS_ERROR_RESPONSE);
    CHECK(prober.access(tlm::TLM_READ_COMMAND, 0x000, data, 2) == tlm::TLM_BURST_ERROR_RESPONSE);
    CHECK(prober.access(tlm::TLM_IGNORE_COMMAND, 0x000, data) == tlm::TLM_COMMAND_ERROR_RESPONSE);
    std::array<unsigned char, 4> enables = {0xFF, 0xFF, 0xFF, 0xFF};
    CHECK(prober.access(tlm::TLM_READ_COMMAND, 0x000, data, 4, enables.data()) == tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
    CHECK(sc_core::sc_time_stamp() > 15 * period);  // the delays have passed
    finished = true;
    sc_core::sc_stop();
  });
  sc_core::sc_start(100, sc_core::SC_US);
  CHECK(finished);
}

TEST_CASE("levels subsystem: the empty slot gets a module, which answers", "[systemc][levels]") {
  run_on_bench([](Bench& b) {
    b.announce(ModuleId::tri_tri, bitstream_of(ModuleId::tri_tri));
    CHECK(error_of(b.c3, ModuleId::tri_tri) == "no error");
    const RtlResult result = b.ask(77);
    CHECK(result.tag == 77);
    CHECK(result.grid);
    CHECK(result.definite);
    CHECK(error_of(b.c3, ModuleId::tri_tri) ==
          "the swap to module 1 ended with code 1; see docs/hardware/registers.md");
  });
}

TEST_CASE("levels subsystem: damaged, missing and foreign bitstreams are reported, a good one repairs",
          "[systemc][levels]") {
  run_on_bench([](Bench& b) {
    const auto ends_with = [&](ModuleId id, SwapCode code) {
      CHECK_THAT(error_of(b.c3, id),
                 Catch::Contains("ended with code " + std::to_string(static_cast<int>(code)) + ";"));
    };
    ends_with(ModuleId::tri_tri, SwapCode::request);  // not announced
    Bytes damaged = bitstream_of(ModuleId::tri_tri);
    damaged.back() ^= 1;
    b.announce(ModuleId::tri_tri, damaged);
    ends_with(ModuleId::tri_tri, SwapCode::crc);
    b.announce(ModuleId::tri_tri, bitstream_of(ModuleId::quad_quad));
    ends_with(ModuleId::tri_tri, SwapCode::module);
    b.c3.announce(ModuleId::tri_tri, 1 << 20, 80);  // beyond the memory
    ends_with(ModuleId::tri_tri, SwapCode::bus);
    b.announce(ModuleId::tri_tri, bitstream_of(ModuleId::tri_tri));
    CHECK(error_of(b.c3, ModuleId::tri_tri) == "no error");
    CHECK(b.ask(5).grid);
  });
}

TEST_CASE("levels subsystem: software does not wait for ever for a swap", "[systemc][levels]") {
  run_on_bench([](Bench& b) {
    const Bytes slow = make_bitstream(0, ModuleId::tri_tri, make_payload(0, ModuleId::tri_tri, 30000));
    b.announce(ModuleId::tri_tri, slow);  // 60,000 clocks
    CHECK(error_of(b.c3, ModuleId::tri_tri) == "the swap to module 1 did not end in 200 us");
  });
}
