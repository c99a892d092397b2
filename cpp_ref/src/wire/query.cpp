// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/wire/query.hpp>

namespace cchip {
namespace {

RecordBytes first_bytes(const Line& line) {
  RecordBytes bytes;
  std::copy_n(line.begin(), bytes.size(), bytes.begin());
  return bytes;
}

Line line_of(const RecordBytes& bytes) {
  Line line = {};
  std::copy(bytes.begin(), bytes.end(), line.begin());
  return line;
}

std::uint32_t word(const Line& line, const Field& field) { return static_cast<std::uint32_t>(get(line, field)); }

}  // namespace

Line encode(const Query& query) {
  namespace f = query_field;
  Line line = {};
  put(line, f::base_a, query.base_a);
  put(line, f::base_b, query.base_b);
  for (std::size_t i = 0; i < 9; ++i) put(line, f::m, query.m[i / 3][i % 3], i);
  for (std::size_t i = 0; i < 3; ++i) put(line, f::t, query.t[i], i);
  put(line, f::error, query.error);
  put(line, f::shift, query.shift);
  put(line, f::mode, static_cast<int>(query.mode));
  put(line, f::swapped, query.swapped ? 1 : 0);
  put(line, f::tag, query.tag);
  return line;
}

Query decode_query(const Line& line) {
  namespace f = query_field;
  Query query;
  query.base_a = word(line, f::base_a);
  query.base_b = word(line, f::base_b);
  for (std::size_t i = 0; i < 9; ++i) query.m[i / 3][i % 3] = static_cast<std::int32_t>(get(line, f::m, i));
  for (std::size_t i = 0; i < 3; ++i) query.t[i] = get(line, f::t, i);
  query.error = word(line, f::error);
  query.shift = static_cast<int>(get(line, f::shift));
  query.mode = static_cast<QueryMode>(get(line, f::mode));
  query.swapped = get(line, f::swapped) != 0;
  query.tag = word(line, f::tag);
  return query;
}

RecordBytes encode(const PairRecord& record) {
  namespace f = record_field;
  Line line = {};
  put(line, f::tag, record.tag);
  put(line, f::definite, record.definite ? 1 : 0);
  put(line, f::id_a, record.id_a);
  put(line, f::id_b, record.id_b);
  return first_bytes(line);
}

RecordBytes encode(const DoneRecord& record) {
  namespace f = record_field;
  Line line = {};
  put(line, f::tag, record.tag);
  put(line, f::done, 1);
  put(line, f::answer, static_cast<int>(record.answer));
  put(line, f::code, static_cast<int>(record.code));
  put(line, f::steps, record.steps);
  put(line, f::pairs, record.pairs);
  return first_bytes(line);
}

bool is_done(const RecordBytes& bytes) { return get(line_of(bytes), record_field::done) != 0; }

PairRecord decode_pair(const RecordBytes& bytes) {
  namespace f = record_field;
  const Line line = line_of(bytes);
  return {word(line, f::tag), word(line, f::id_a), word(line, f::id_b), get(line, f::definite) != 0};
}

DoneRecord decode_done(const RecordBytes& bytes) {
  namespace f = record_field;
  const Line line = line_of(bytes);
  return {word(line, f::tag), static_cast<QueryCode>(get(line, f::code)),
          static_cast<QueryAnswer>(get(line, f::answer)), word(line, f::steps), word(line, f::pairs)};
}

}  // namespace cchip
