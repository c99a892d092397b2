// SPDX-License-Identifier: Apache-2.0
// Pairs of every class and the results that the bit-exact model expects, for bench_primtest.v.
//   cchip_pair_vectors KIND FILE PAIRS SEED      KIND: tri_tri, tri_quad, quad_quad; PAIRS: at most 65536
#include <algorithm>
#include <cchip/program/output_file.hpp>
#include <cchip/stimulus/campaign.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cchip/stimulus/pair_vector.hpp>
#include <iostream>
#include <random>

namespace {

using namespace cchip;
using stimulus::ShapeInfo;

/// Pairs that follow each other in one mix of programmes.
constexpr int run_length = 100;
constexpr int tags = 1 << defs::tag_w;

const ShapeInfo& find_shape(std::string kind) {
  std::replace(kind.begin(), kind.end(), '_', '-');
  for (const ShapeInfo& shape : stimulus::all_shapes) {
    if (kind == shape.name) return shape;
  }
  throw std::invalid_argument(kind + ": no such kind, one of tri_tri, tri_quad, quad_quad");
}

/// Runs of EXHAUSTIVE, of DIRECTED, and of both with a reserved mode now and then.
PairMode draw_mode(int index, std::mt19937_64& random) {
  const int mix = index / run_length % 3;
  if (mix < 2) return static_cast<PairMode>(mix);
  return static_cast<PairMode>(random() % 16 == 0 ? 2 + random() % 2 : random() % 2);
}

/// What is on the pins of the unused vertex slot of a triangle must not matter.
void fill_unused_slot(GridPrimitive& p, std::mt19937_64& random) {
  if (p.kind == Kind::tri) p.v[3] = Vec3i::NullaryExpr([&] { return static_cast<std::int16_t>(random()); });
}

bench::Vector to_vector(const ShapeInfo& shape, const GridPair& pair, PairMode mode, int index) {
  const PairResult expected =
      model::run_programme(shape.options(), pair, mode, bench::coord_w).result(tag_of(static_cast<std::size_t>(index)));
  bench::Vector vector;
  vector.set(bench::side_a, pair.a);
  vector.set(bench::side_b, pair.b);
  vector.set(bench::tag, expected.tag);
  vector.set(bench::mode, static_cast<std::uint64_t>(mode));
  vector.set(bench::err, static_cast<std::uint64_t>(pair.eta));
  vector.set(bench::hit, expected.hit ? 1 : 0);
  vector.set(bench::grid, expected.grid ? 1 : 0);
  vector.set(bench::definite, expected.definite ? 1 : 0);
  vector.set(bench::axis, to_bits(expected.axis));
  vector.set(bench::beats, static_cast<std::uint64_t>(expected.beats));
  vector.set(bench::rm_id, std::uint64_t(shape.id));
  return vector;
}

void write_vectors(const ShapeInfo& shape, const std::string& path, int pairs, std::uint64_t seed) {
  if (pairs < 1 || pairs > tags) throw std::invalid_argument("PAIRS must be 1 to 65536: every pair has its own tag");
  sim::OutputFile out(path);
  stimulus::PairSource source(bench::coord_w, seed, shape.a, shape.b);
  std::mt19937_64 random(seed);
  const auto classes = stimulus::classes_of(shape.a, shape.b);
  for (int i = 0; i < pairs; ++i) {
    GridPair pair = source.draw(classes[static_cast<std::size_t>(i) % classes.size()].value);
    pair.eta = static_cast<int>(random() % 2 == 0 ? 0 : random() % 16);
    fill_unused_slot(pair.a, random);
    fill_unused_slot(pair.b, random);
    out.stream() << to_vector(shape, pair, draw_mode(i, random), i).line() << '\n';
  }
  out.commit();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() != 4) throw std::invalid_argument("usage: cchip_pair_vectors KIND FILE PAIRS SEED");
    write_vectors(find_shape(arguments[0]), arguments[1], std::stoi(arguments[2]), std::stoull(arguments[3]));
  } catch (const std::exception& error) {
    std::cerr << "cchip_pair_vectors: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
