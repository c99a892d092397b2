// SPDX-License-Identifier: Apache-2.0
/// \file
/// Leaves for the tests of rtl/transform, and its ports.
#ifndef CCHIP_TESTS_UNIT_TRANSFORM_TOOLS_HPP
#define CCHIP_TESTS_UNIT_TRANSFORM_TOOLS_HPP

#include <cchip/blocks/transform.hpp>
#include <cchip/internal/image/image_line.hpp>

#include "bv_tools.hpp"

namespace cchip::test {

/// A leaf with anything that its fields can hold; some are small or lie on a coarse grid, so that nothing is rounded.
inline Line random_leaf(Random& random, bvh::NodeKind kind, int extent) {
  const int width = kind == bvh::NodeKind::quad ? 24 : 20;
  bvh::LeafLine leaf;
  const bool coarse = chance(random, 20);
  const int zeros = coarse ? number(random, 1, width - 2) : 0;
  for (auto& o : leaf.origin)
    o = static_cast<std::int32_t>(random_word(random, 24) >> (coarse ? 20 : 0) << (coarse ? 20 : 0));
  leaf.extent = extent;
  leaf.rounded = !coarse || chance(random, 20);
  leaf.open = chance(random, 5);
  leaf.id = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())};
  for (std::size_t n = 0; n < bvh::vertices_in(kind); ++n) {
    for (auto& x : leaf.vertex[n]) x = static_cast<std::int32_t>(random_word(random, width) >> zeros << zeros);
    if (n > 0 && chance(random, 10)) leaf.vertex[n] = leaf.vertex[n - 1];
  }
  return encode(leaf, kind);
}

/// A leaf pair with any kinds and extents; `corrupt` of 100 have an illegal one.
inline model::LeafJob random_job(Random& random, int corrupt) {
  model::LeafJob job;
  job.query = random_query(random);
  if (chance(random, 20)) {
    // Nothing is rounded by the map.
    job.query.m = {};
    for (std::size_t i = 0; i < 3; ++i) job.query.m[i][i] = 1 << 30;
    for (auto& t : job.query.t) t = t >> 28 << 28;
    job.query.error = 0;
    job.query.shift = 0;
  }
  job.kind_a = static_cast<bvh::NodeKind>(number(random, 1, 3));
  job.kind_b = static_cast<bvh::NodeKind>(number(random, 1, 3));
  const auto extent = [&] { return chance(random, corrupt) ? number(random, 25, 31) : number(random, 0, 24); };
  const int extent_a = extent();
  // Mostly of about the same size, as where leaves touch.
  const int extent_b = chance(random, 60) && extent_a <= 24
                           ? std::clamp(extent_a - job.query.shift + number(random, -3, 3), 0, 24)
                           : extent();
  job.line_a = random_leaf(random, job.kind_a, extent_a);
  job.line_b = random_leaf(random, job.kind_b, extent_b);
  if (chance(random, 15)) {
    // M moves the origin of A's leaf by one bit alone, anywhere near or below the last one that survives the shift.
    bvh::LeafLine a = bvh::decode_leaf(job.line_a, job.kind_a);
    a.origin = {1, 1, 1};
    job.line_a = encode(a, job.kind_a);
    job.query.m = {};
    job.query.m[random() % 3][random() % 3] = 1 << number(random, 0, 15);
    for (auto& t : job.query.t) t = t >> 28 << 28;
  } else if (chance(random, 50)) {
    // The leaves lie at each other.
    const bvh::LeafLine a = bvh::decode_leaf(job.line_a, job.kind_a);
    const bvh::LeafLine b = bvh::decode_leaf(job.line_b, job.kind_b);
    for (std::size_t i = 0; i < 3; ++i) {
      double between = b.origin[i] + std::uniform_real_distribution<double>(-1, 1)(random) * std::ldexp(1.0, extent_b);
      for (std::size_t j = 0; j < 3; ++j)
        between -= job.query.m[i][j] * 0x1p-30 * std::ldexp(a.origin[j], -job.query.shift);
      const int zeros = job.query.error == 0 && !a.rounded ? 20 : 0;
      job.query.t[i] = std::clamp<std::int64_t>(std::llround(between * 0x1p8), -(std::int64_t{1} << 35),
                                                (std::int64_t{1} << 35) - 1) >>
                       zeros << zeros;
    }
  }
  return job;
}

template <class Top>
void set_job(Top& top, const model::LeafJob& job) {
  for (std::size_t i = 0; i < 9; ++i)
    sim::set_bits(top.s_m, static_cast<int>(32 * i), 32, static_cast<std::uint32_t>(job.query.m[i / 3][i % 3]));
  for (std::size_t i = 0; i < 3; ++i)
    sim::set_bits(top.s_t, static_cast<int>(36 * i), 36, static_cast<std::uint64_t>(job.query.t[i]));
  top.s_shift = static_cast<CData>(job.query.shift);
  top.s_error = static_cast<SData>(job.query.error);
  top.s_kinds = static_cast<CData>(static_cast<unsigned>(job.kind_b) << 2 | static_cast<unsigned>(job.kind_a));
  for (std::size_t i = 0; i < line_bytes; ++i) {
    sim::set_bits(top.s_lines, static_cast<int>(8 * i), 8, job.line_a[i]);
    sim::set_bits(top.s_lines, static_cast<int>(512 + 8 * i), 8, job.line_b[i]);
  }
}

/// Point of a port in grid steps.
template <class Port>
Vec3i get_point(const Port& port, int coord_w) {
  const model::Word3 v = get_word3(port, coord_w);
  return {static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2])};
}

/// A sender that holds a leaf pair until it is taken, and then shows another one at once or later.
class JobSource {
 public:
  explicit JobSource(int corrupt) : corrupt_(corrupt) {}
  /// The leaf pair of this clock, if any.
  const model::LeafJob* next(Random& random, int percent) {
    if (!job_ && chance(random, percent)) job_ = random_job(random, corrupt_);
    return job_ ? &*job_ : nullptr;
  }
  void taken() { job_.reset(); }

 private:
  int corrupt_;
  std::optional<model::LeafJob> job_;
};

}  // namespace cchip::test

#endif
