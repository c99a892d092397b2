// SPDX-License-Identifier: Apache-2.0
/// \file
/// Queries to the chip and the records that it answers with.
#ifndef CCHIP_INTERNAL_WIRE_QUERY_HPP
#define CCHIP_INTERNAL_WIRE_QUERY_HPP

#include <array>
#include <cchip/internal/wire/definitions.hpp>
#include <cchip/internal/wire/line.hpp>
#include <cstdint>

namespace cchip {

enum class QueryMode : std::uint8_t { first = 0, all = 1 };

/// Does A, moved, touch B? A point u of A's frame lies at M 2^-shift u + t in the frame of B, both frames those of the
/// images, in which objects lie in [-1/2, 1/2)^3.
struct Query {
  std::uint32_t base_a = 0;  ///< address of the image of A divided by 64
  std::uint32_t base_b = 0;
  /// M, 30 fraction bits, |M_ij| <= 1.
  std::array<std::array<std::int32_t, 3>, 3> m = {};
  /// t, 32 fraction bits, 36 bits.
  std::array<std::int64_t, 3> t = {};
  int shift = 0;  ///< 0..15
  /// Bound, in 2^-38 of B's unit and infinity norm, on the distance of M 2^-shift u + t from the exact position, for
  /// every u in [-1/2, 1/2]^3; 12 bits.
  std::uint32_t error = 0;
  QueryMode mode = QueryMode::first;
  bool swapped = false;  ///< A is the user's second object
  std::uint32_t tag = 0;
};

inline constexpr int query_m_fraction = 30;
inline constexpr int query_t_fraction = 32;
inline constexpr int query_error_fraction = 38;
inline constexpr int query_shift_max = 15;

namespace query_field {
inline constexpr Field base_a = {"base_a", 0, 32};
inline constexpr Field base_b = {"base_b", 32, 32};
inline constexpr Field m = {"m", 64, 32, 9, true};  ///< row by row
inline constexpr Field t = {"t", 352, 36, 3, true};
inline constexpr Field error = {"error", 460, 12};
inline constexpr Field shift = {"shift", 472, 4};
inline constexpr Field mode = {"mode", 476, 1};
inline constexpr Field swapped = {"swapped", 477, 1};
inline constexpr Field tag = {"tag", 480, 32};
inline constexpr std::array<Field, 9> all = {base_a, base_b, m, t, error, shift, mode, swapped, tag};
}  // namespace query_field

Line encode(const Query& query);
Query decode_query(const Line& line);

/// A pair of faces in contact: proven, or for the host to decide. In the user's order.
struct PairRecord {
  std::uint32_t tag = 0;
  std::uint32_t id_a = 0;
  std::uint32_t id_b = 0;
  bool definite = false;
  friend bool operator==(const PairRecord& x, const PairRecord& y) {
    return x.tag == y.tag && x.id_a == y.id_a && x.id_b == y.id_b && x.definite == y.definite;
  }
};

/// The last record of a query.
struct DoneRecord {
  std::uint32_t tag = 0;
  QueryCode code = QueryCode::ok;
  QueryAnswer answer = QueryAnswer::no;
  std::uint32_t steps = 0;  ///< node pairs expanded
  std::uint32_t pairs = 0;  ///< pair records before this one
};

/// 16 bytes.
using RecordBytes = std::array<std::uint8_t, 16>;

namespace record_field {
inline constexpr Field tag = {"tag", 0, 32};
inline constexpr Field done = {"done", 32, 1};  ///< 0: pair, 1: done
// of a pair
inline constexpr Field definite = {"definite", 33, 1};
inline constexpr Field id_a = {"id_a", 64, 32};
inline constexpr Field id_b = {"id_b", 96, 32};
// of done
inline constexpr Field answer = {"answer", 33, 2};
inline constexpr Field code = {"code", 40, 8};
inline constexpr Field steps = {"steps", 64, 32};
inline constexpr Field pairs = {"pairs", 96, 32};
}  // namespace record_field

RecordBytes encode(const PairRecord& record);
RecordBytes encode(const DoneRecord& record);
/// True for the record that ends a query.
bool is_done(const RecordBytes& bytes);
PairRecord decode_pair(const RecordBytes& bytes);
DoneRecord decode_done(const RecordBytes& bytes);

}  // namespace cchip

#endif
