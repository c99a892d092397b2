// SPDX-License-Identifier: Apache-2.0
// The worked pair of the triangle test's datasheet: prints it, and with `check` compares 10^5 random pairs.
// The words come from examples/tri_tri_words.c; the answer is the functional model's, and exact integers on the words
// and exact arithmetic on the doubles judge it.
#include <fmt/format.h>

#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/model/programme.hpp>
#include <cchip/internal/wire/axis.hpp>
#include <cstring>
#include <random>
#include <string>

extern "C" {
#include "tri_tri_words.h"
}

namespace {

using namespace cchip;

GridPrimitive on_grid(const std::uint64_t (&words)[3]) {
  GridPrimitive p;
  for (std::size_t i = 0; i < 9; ++i) {
    const auto bits = static_cast<std::uint16_t>(words[i / 4] >> (16 * (i % 4)));
    p.v[i / 3][static_cast<Eigen::Index>(i % 3)] = static_cast<std::int16_t>(bits);
  }
  return p;
}
Primitive in_space(const double (&v)[9]) {
  Primitive p;
  for (std::size_t i = 0; i < 3; ++i) p.v[i] = Vec3d(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
  return p;
}
PairResult answer(const GridPair& pair) {
  return model::run_programme({{3, 3}, true}, pair, PairMode::directed, 16).result(1);
}

int print() {
  const double a[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const double b[9] = {0.2, 0.2, -0.5, 0.3, 0.2, 0.5, 0.25, 0.8, 0.5};
  cchip_words words;
  if (cchip_tri_tri_words(a, b, &words) != 0) return 1;
  GridPair pair{on_grid(words.a), on_grid(words.b), static_cast<int>(words.eta)};
  const PairResult result = answer(pair);
  const auto port = [](const std::uint64_t(&w)[3]) {
    return fmt::format("192'h{:016x}{:016x}{:016x}", w[2], w[1], w[0]);
  };
  fmt::print(
      "A            (0, 0, 0) (1, 0, 0) (0, 1, 0)\nB            (0.2, 0.2, -0.5) (0.3, 0.2, 0.5) (0.25, 0.8, 0.5)\n");
  fmt::print("grid         a step is 2^{}, 0 is the middle of the pair's box\n", words.exponent);
  fmt::print("on the grid  {}\n", to_text(pair));
  fmt::print("s_pair_a     {}\ns_pair_b     {}\ns_pair_err   {}\ns_pair_mode  1 (DIRECTED)\n", port(words.a),
             port(words.b), words.eta);
  fmt::print("m_result     hit {} grid {} definite {} axis 9'h{:03x} ({}) beats {}\n", result.hit ? 1 : 0,
             result.grid ? 1 : 0, result.definite ? 1 : 0, to_bits(result.axis), to_words(result.axis), result.beats);
  return 0;
}

int check() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t pairs = 0, wrong = 0, definite = 0, hits = 0;
  for (int n = 0; n < 100000; ++n) {
    double a[9], b[9];
    const double scale = std::ldexp(1.0, static_cast<int>(random() % 60) - 30);
    for (double& x : a) x = scale * unit(random);
    for (double& x : b) x = scale * unit(random);
    cchip_words words;
    if (cchip_tri_tri_words(a, b, &words) != 0) return 1;
    const GridPair pair{on_grid(words.a), on_grid(words.b), static_cast<int>(words.eta)};
    const PairResult result = answer(pair);
    const bool exact = exact_intersects(in_space(a), in_space(b));
    ++pairs;
    hits += exact ? 1 : 0;
    definite += result.definite ? 1 : 0;
    wrong += result.grid != exact_intersects(pair) || (result.definite && result.grid != exact) ? 1 : 0;
  }
  fmt::print("pairs={} hits={} definite={} wrong={}\n", pairs, hits, definite, wrong);
  return wrong == 0 && definite > pairs * 99 / 100 ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) { return argc > 1 && std::strcmp(argv[1], "check") == 0 ? check() : print(); }
