// SPDX-License-Identifier: Apache-2.0
// What the driver of the reconfigurable subsystem hands to a machine before the first pair.
#include <catch2/catch.hpp>
#include <cchip/driver/reconfig_driver.hpp>
#include <cchip/internal/wire/registers.hpp>
#include <map>
#include <string>

using namespace cchip;

namespace {

/// A machine without slots' work: it keeps what is written.
class Recorder : public PairMachine {
 public:
  explicit Recorder(std::uint32_t port_w) : port_w_(port_w) {}
  std::uint32_t read_register(std::uint32_t offset) override {
    namespace c = registers::capabilities;
    if (offset != c::offset) return 0;
    return 2U << c::slots_shift | port_w_ << c::cfg_w_shift | 16U << c::coord_w_shift;
  }
  void write_register(std::uint32_t offset, std::uint32_t value) override { written[offset] = value; }
  void write_memory(std::uint64_t address, const Bytes& bytes) override { memory[address] = bytes; }
  Bytes read_memory(std::uint64_t, std::size_t size) override { return Bytes(size); }
  bool send(const KindRequest&) override { return false; }
  std::optional<KindResult> receive() override { return std::nullopt; }
  bool interrupt() override { return false; }
  void proceed() override {}

  std::map<std::uint32_t, std::uint32_t> written;
  std::map<std::uint64_t, Bytes> memory;

 private:
  std::uint32_t port_w_;
};

/// A user's bitstreams: any payload that no simulated device would take.
Bytes users_bitstream(std::uint8_t slot, ModuleId id) {
  return make_bitstream(slot, id, Bytes(100 + 4 * static_cast<std::size_t>(id), slot));
}

}  // namespace

TEST_CASE("reconfig driver: a user's bitstreams reach the machine with their table", "[ref][reconfig_driver]") {
  Recorder machine(32);
  ReconfigOptions options;
  options.bitstream = users_bitstream;
  run_reconfig(machine, {}, options);
  REQUIRE(machine.memory.size() == 6);
  for (std::uint8_t slot = 0; slot < 2; ++slot) {
    for (const ModuleId id : {ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad}) {
      const std::uint32_t index = std::uint32_t{defs::table_modules} * slot + static_cast<std::uint32_t>(id);
      const std::uint32_t address = machine.written.at(registers::bitstream_address::offset(index));
      CHECK(address % defs::bitstream_align == 0);
      CHECK(machine.memory.at(address) == users_bitstream(slot, id));
      CHECK(machine.written.at(registers::bitstream_size::offset(index)) == machine.memory.at(address).size());
      CHECK(machine.written.at(registers::bitstream_valid::offset(index)) == 1);
    }
  }
}

TEST_CASE("reconfig driver: without a user's bitstreams the simulated device gets its own", "[ref][reconfig_driver]") {
  Recorder machine(8);
  ReconfigOptions options;
  options.payload_bytes = 77;
  options.seed = 5;
  run_reconfig(machine, {}, options);
  const std::uint32_t address = machine.written.at(registers::bitstream_address::offset(defs::table_modules + 3));
  CHECK(machine.memory.at(address) ==
        make_bitstream(1, ModuleId::quad_quad, make_payload(1, ModuleId::quad_quad, 77, 5)));
}

TEST_CASE("reconfig driver: nothing is written if one bitstream is wrong", "[ref][reconfig_driver]") {
  const auto refused = [](std::uint32_t port_w, auto bitstream) {
    Recorder machine(port_w);
    ReconfigOptions options;
    options.bitstream = bitstream;
    std::string text;
    try {
      run_reconfig(machine, {}, options);
    } catch (const BitstreamError& error) {
      text = error.what();
    }
    CHECK(machine.memory.empty());
    CHECK(machine.written.empty());
    return text;
  };
  CHECK(refused(8,
                [](std::uint8_t slot, ModuleId id) {
                  Bytes bytes = users_bitstream(slot, id);
                  if (slot == 1 && id == ModuleId::quad_quad) bytes.pop_back();
                  return bytes;
                }) ==
        "slot 1, module quad_quad: bitstream byte 8, length: 112 bytes announced, 111 follow the header; generate or "
        "copy the file again");
  CHECK(refused(8, [](std::uint8_t, ModuleId id) { return users_bitstream(0, id); }) ==
        "slot 1, module tri_tri: bitstream byte 5, slot: it is for slot 0, not 1; give the file that was made for this "
        "slot");
  CHECK(
      refused(32, [](std::uint8_t slot, ModuleId id) { return make_bitstream(slot, id, Bytes(17)); }) ==
      "slot 0, module tri_tri: bitstream byte 8, length: 17 bytes are no whole words of the configuration port; append "
      "zeros up to a multiple of 4 before the CRC is computed");
}
