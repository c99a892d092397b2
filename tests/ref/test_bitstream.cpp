// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/internal/wire/bitstream.hpp>
#include <initializer_list>
#include <stdexcept>
#include <string>

using namespace cchip;

namespace {

std::uint32_t word(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(bytes.at(at + i)) << 8 * i;
  return value;
}

Bytes with_byte(Bytes bytes, std::size_t at, std::uint8_t value) {
  bytes.at(at) = value;
  return bytes;
}

void require_refused(const Bytes& bytes, SwapCode code, const std::string& text, int port_w = 8) {
  try {
    decode_bitstream(bytes, port_w);
    FAIL("accepted: " << text);
  } catch (const BitstreamError& error) {
    CHECK(error.what() == text);
    CHECK(error.code() == code);
  }
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

TEST_CASE("bitstream: what is made is read again", "[ref][bitstream]") {
  for (const std::uint8_t slot : std::initializer_list<std::uint8_t>{0, 1, 255}) {
    for (const ModuleId id :
         {ModuleId::blank, ModuleId::tri_tri, ModuleId::tri_quad, ModuleId::quad_quad, ModuleId::point_tri}) {
      for (const std::size_t size : {16, 17, 20, 100}) {
        const Bytes payload = make_payload(slot, id, size);
        const Bytes bytes = make_bitstream(slot, id, payload);
        const BitstreamHeader header = decode_bitstream(bytes);
        CHECK(header.magic == defs::bitstream_magic);
        CHECK(header.slot == slot);
        CHECK(header.module_id == id);
        CHECK(header.length == size);
        CHECK(header.crc == crc32(payload));
        CHECK(join_bitstream(header, payload) == bytes);
        CHECK_NOTHROW(check_bitstream(bytes, slot, id));
        if (size % 4 == 0) CHECK_NOTHROW(decode_bitstream(bytes, 32));
      }
    }
  }
}

TEST_CASE("bitstream: a file cut anywhere, or one byte too long, is refused", "[ref][bitstream]") {
  Bytes bytes = make_bitstream(0, ModuleId::tri_tri, make_payload(0, ModuleId::tri_tri, 32));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    CAPTURE(size);
    CHECK_THROWS_AS(decode_bitstream(cut), BitstreamError);
  }
  bytes.push_back(0);
  CHECK_THROWS_AS(decode_bitstream(bytes), BitstreamError);
}

TEST_CASE("bitstream: any bit that is turned over is refused, or names another slot or module", "[ref][bitstream]") {
  const Bytes bytes = make_bitstream(1, ModuleId::quad_quad, make_payload(1, ModuleId::quad_quad, 24));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    CAPTURE(bit);
    const std::size_t at = bit / 8;
    const Bytes wrong = with_byte(bytes, at, static_cast<std::uint8_t>(bytes[at] ^ 1U << bit % 8));
    CHECK_THROWS_AS(check_bitstream(wrong, 1, ModuleId::quad_quad), BitstreamError);
  }
}

TEST_CASE("bitstream: errors say where, what and what to do", "[ref][bitstream]") {
  const Bytes bytes = make_bitstream(1, ModuleId::tri_quad, make_payload(1, ModuleId::tri_quad, 21));
  require_refused({1, 2, 3}, SwapCode::magic,
                  "bitstream byte 0, header: the file ends after 3 bytes, the header has 16; generate or copy the file "
                  "again");
  require_refused(with_byte(bytes, 0, 0x51), SwapCode::magic,
                  "bitstream byte 0, magic: 0x43434251 is not 0x43434250; give a file that begins with the header of a "
                  "bitstream");
  require_refused(with_byte(bytes, 7, 1), SwapCode::magic,
                  "bitstream byte 6, reserved: two bytes are not 0; generate or copy the file again");
  require_refused(with_byte(bytes, 4, 5), SwapCode::module,
                  "bitstream byte 4, module: there is no module 5; generate or copy the file again");
  require_refused(
      with_byte(bytes, 8, 20), SwapCode::length,
      "bitstream byte 8, length: 20 bytes announced, 21 follow the header; generate or copy the file again");
  require_refused(make_bitstream(0, ModuleId::tri_tri, Bytes(15)), SwapCode::length,
                  "bitstream byte 8, length: a payload of 15 bytes is too short; make it 16 or longer");
  require_refused(
      bytes, SwapCode::length,
      "bitstream byte 8, length: 21 bytes are no whole words of the configuration port; append zeros up to a "
      "multiple of 4 before the CRC is computed",
      32);
  Bytes damaged = make_bitstream(0, ModuleId::tri_tri, Bytes(16));
  damaged.back() = 1;
  require_refused(
      damaged, SwapCode::crc,
      "bitstream byte 12, CRC: 0xECBB4B55 is not that of the payload, 0x9BBC7BC3; generate or copy the file "
      "again");
  try {
    check_bitstream(bytes, 0, ModuleId::tri_quad);
    FAIL("accepted");
  } catch (const BitstreamError& error) {
    CHECK(error.code() == SwapCode::slot);
    CHECK(error.what() ==
          std::string("bitstream byte 5, slot: it is for slot 1, not 0; give the file that was made for "
                      "this slot"));
  }
  try {
    check_bitstream(bytes, 1, ModuleId::tri_tri);
    FAIL("accepted");
  } catch (const BitstreamError& error) {
    CHECK(error.code() == SwapCode::module);
    CHECK(error.what() ==
          std::string("bitstream byte 4, module: it is tri_quad, not tri_tri; give the file of that module"));
  }
}
