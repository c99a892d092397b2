// SPDX-License-Identifier: Apache-2.0
#include "lzf.hpp"

#include "polygon_soup.hpp"

namespace cchip::mesh_io {
namespace {

[[noreturn]] void refuse() { throw FormatError("the compressed data is damaged; copy or download the file again"); }

/// Takes a byte off the front.
std::size_t take_byte(std::string_view& packed) {
  if (packed.empty()) refuse();
  const auto byte = static_cast<unsigned char>(packed.front());
  packed.remove_prefix(1);
  return byte;
}

}  // namespace

std::string unpack_lzf(std::string_view packed, std::size_t bytes) {
  constexpr std::size_t most_growth = 88;  // three bytes announce at most 264
  if (bytes / most_growth > packed.size()) refuse();
  std::string out;
  out.reserve(bytes);
  while (!packed.empty()) {
    const std::size_t control = take_byte(packed);
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() || length > bytes - out.size()) refuse();
      out.append(packed.substr(0, length));
      packed.remove_prefix(length);
      continue;
    }
    std::size_t length = (control >> 5U) + 2;
    if (length == 9) length += take_byte(packed);
    const std::size_t distance = ((control & 31U) << 8U) + take_byte(packed) + 1;
    if (distance > out.size() || length > bytes - out.size()) refuse();
    // What is copied may overlap what it is copied to: then it repeats.
    for (std::size_t from = out.size() - distance; length > 0; --length) out += out[from++];
  }
  if (out.size() != bytes) refuse();
  return out;
}

}  // namespace cchip::mesh_io
