// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/wire/bitstream.hpp>
#include <stdexcept>
#include <string>

using namespace cchip;

namespace {

std::uint32_t word(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(bytes.at(at + i)) << 8 * i;
  return value;
}

}  // namespace

TEST_CASE("bitstream: CRC-32 of the check string of its standard", "[ref][bitstream]") {
  const std::string text = "123456789";
  REQUIRE(crc32(Bytes(text.begin(), text.end())) == 0xCBF43926);
  REQUIRE(crc32({}) == 0);
}

TEST_CASE("bitstream: the payload names slot and module, ends in its CRC, has one sync word", "[ref][bitstream]") {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const std::size_t bytes = 16 + seed % 37;
    const Bytes payload = make_payload(1, ModuleId::tri_quad, bytes, seed);
    REQUIRE(payload.size() == bytes);
    REQUIRE(word(payload, 0) == defs::bitstream_sync);
    REQUIRE(word(payload, 4) == 0x0201);
    REQUIRE(word(payload, bytes - 4) == crc32(Bytes(payload.begin(), payload.end() - 4)));
    for (std::size_t at = 1; at + 4 <= bytes; ++at) REQUIRE(word(payload, at) != defs::bitstream_sync);
  }
  REQUIRE(make_payload(0, ModuleId::tri_tri, 64, 1) != make_payload(0, ModuleId::tri_tri, 64, 2));
  REQUIRE_THROWS_AS(make_payload(0, ModuleId::tri_tri, 15), std::invalid_argument);
}

TEST_CASE("bitstream: header and payload", "[ref][bitstream]") {
  const Bytes payload = make_payload(1, ModuleId::quad_quad, 21);
  const Bytes bytes = make_bitstream(1, ModuleId::quad_quad, payload);
  REQUIRE(bytes.size() == payload.size() + 16);
  REQUIRE(word(bytes, 0) == 0x43434250);
  REQUIRE(word(bytes, 4) == 0x0103);
  REQUIRE(word(bytes, 8) == 21);
  REQUIRE(word(bytes, 12) == crc32(payload));
  REQUIRE(std::equal(payload.begin(), payload.end(), bytes.begin() + 16));
}

TEST_CASE("bitstream: the paper's sizes and eq. (4)", "[ref][bitstream]") {
  REQUIRE(8 * default_payload_bytes(ModuleId::tri_tri) == 5504088);
  REQUIRE(8 * default_payload_bytes(ModuleId::quad_quad) == 5409976);
  REQUIRE(default_payload_bytes(ModuleId::tri_tri, 32) == 688012);
  // 8 bit at 50 MHz in clocks of 100 MHz: 13.76022 ms
  REQUIRE(transfer_clocks(688011, 8, 2) == 1376022);
  REQUIRE(transfer_clocks(688011, 32, 1) == 172003);
}
