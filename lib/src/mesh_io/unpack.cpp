// SPDX-License-Identifier: Apache-2.0
#include "unpack.hpp"

#include "polygon_soup.hpp"

#ifdef CCHIP_WITH_ZLIB
#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <new>
#endif

namespace cchip::mesh_io {

#ifdef CCHIP_WITH_ZLIB

namespace {

constexpr std::string_view gzip_mark = "\x1f\x8b";

/// zlib's state for one gzip file.
class Inflater {
 public:
  explicit Inflater(std::string_view packed) : packed_(packed) {
    if (inflateInit2(&state_, MAX_WBITS + gzip_only) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&state_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Appends to `content` what one step gives; false at the end of the last member.
  bool step(std::string& content) {
    // zlib counts in unsigned int, so a large file is fed to it in parts.
    const std::size_t fed = std::min<std::size_t>(packed_.size(), std::numeric_limits<uInt>::max());
    state_.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed_.data()));  // zlib does not write to it
    state_.avail_in = static_cast<uInt>(fed);
    state_.next_out = buffer_;
    state_.avail_out = sizeof buffer_;
    const int result = inflate(&state_, Z_NO_FLUSH);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    packed_.remove_prefix(fed - state_.avail_in);
    const std::size_t made = sizeof buffer_ - state_.avail_out;
    content.append(reinterpret_cast<const char*>(buffer_), made);
    if (result == Z_STREAM_END) {
      if (packed_.substr(0, gzip_mark.size()) != gzip_mark) return false;
      inflateReset(&state_);
      return true;
    }
    if (result == Z_BUF_ERROR || (packed_.empty() && made == 0)) {
      throw FormatError("the gzip file is truncated; copy or download it again");
    }
    if (result != Z_OK) throw FormatError("the gzip file is damaged; copy or download it again");
    return true;
  }

 private:
  static constexpr int gzip_only = 16;  // added to the size of the window: the format with a header and a checksum
  std::string_view packed_;
  z_stream state_ = {};
  Bytef buffer_[1 << 16] = {};
};

}  // namespace

bool can_unpack_gzip() { return true; }

std::string unpack_gzip(std::string_view packed, std::uint64_t most_bytes) {
  std::string content;
  Inflater inflater(packed);
  for (bool more = true; more;) {
    more = inflater.step(content);
    if (content.size() > most_bytes) {
      throw FormatError("the gzip file holds more than " + std::to_string(most_bytes) +
                        " bytes, which is the limit; if it is a mesh indeed, unpack it first");
    }
  }
  return content;
}

#else

bool can_unpack_gzip() { return false; }

std::string unpack_gzip(std::string_view, std::uint64_t) { throw FormatError("is packed with gzip; unpack it first"); }

#endif

}  // namespace cchip::mesh_io
