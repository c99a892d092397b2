// SPDX-License-Identifier: Apache-2.0
// Any bytes as a bitstream, with the right CRC: a header that makes the same bytes again, or an error of one line.
#include <cchip/internal/wire/bitstream.hpp>

#include "require.hpp"

using namespace cchip;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, data + size);
  constexpr std::size_t header_bytes = defs::bitstream_header;
  if (size >= header_bytes && size % 16 != 15) {  // some keep the CRC that they have
    const std::uint32_t crc = crc32(data + header_bytes, size - header_bytes);
    for (std::size_t i = 0; i < 4; ++i) bytes[header_bytes - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  }
  try {
    const BitstreamHeader header = decode_bitstream(bytes, size % 2 == 0 ? 8 : 32);
    const Bytes payload(bytes.begin() + header_bytes, bytes.end());
    require(join_bitstream(header, payload) == bytes, "a bitstream keeps its bytes");
    require(make_bitstream(header.slot, header.module_id, payload) == bytes, "length and CRC are right");
    check_bitstream(bytes, 0, ModuleId::tri_tri);
  } catch (const BitstreamError& error) {
    require_one_line(error);
    require(error.code() != SwapCode::ok, "an error has a code");
  }
  return 0;
}
