// SPDX-License-Identifier: Apache-2.0
/// \file
/// The model's answers for one pair in both programmes, against the exact oracle.
#ifndef CCHIP_STIMULUS_JUDGE_HPP
#define CCHIP_STIMULUS_JUDGE_HPP

#include <cchip/internal/grid/coplanar.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/stimulus/campaign.hpp>
#include <cchip/stimulus/quads.hpp>

namespace cchip::stimulus {

/// Beats that decide a DIRECTED pair that is planar on the grid, not coplanar, not degenerate.
constexpr int general_position_beats = 4;
/// Most beats of such a pair with this answer: a hit that is inexact may visit every cross axis to become definite.
inline int most_general_position_beats(const GridPair& pair, bool grid) {
  const bool may_be_deep = grid && pair.eta != 0 && pair.eta != defs::err_unknown;
  return general_position_beats + (may_be_deep ? static_cast<int>(pair.a.vertex_count() * pair.b.vertex_count()) : 0);
}

inline bool is_general_position(const GridPair& pair) {
  return !is_warped(pair.a) && !is_warped(pair.b) && !is_degenerate(pair.a) && !is_degenerate(pair.b) &&
         !is_coplanar(pair);
}

/// Statistics of one class of pairs with eta = 0.
struct Judgement {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;                   ///< by the oracle
  std::uint64_t special = 0;                ///< coplanar, degenerate or warped
  std::array<std::uint64_t, 2> wrong = {};  ///< grid answer differs, or is not definite
  std::uint64_t false_no = 0;               ///< wrong "no", both programmes
  std::uint64_t too_many_beats = 0;         ///< DIRECTED, general position
  std::array<Spread, 2> beats;

  Judgement& operator+=(const Judgement& x) {
    pairs += x.pairs;
    hits += x.hits;
    special += x.special;
    for (std::size_t mode = 0; mode < 2; ++mode) {
      wrong[mode] += x.wrong[mode];
      beats[mode] += x.beats[mode];
    }
    false_no += x.false_no;
    too_many_beats += x.too_many_beats;
    return *this;
  }
  bool failed() const { return wrong[0] + wrong[1] + false_no + too_many_beats != 0; }
};

inline Judgement judge(const ShapeInfo& shape, const GridPair& pair, int coord_w) {
  Judgement j;
  const bool hit = exact_intersects(pair);
  const bool general = is_general_position(pair);
  j.pairs = 1;
  j.hits = hit ? 1 : 0;
  j.special = general ? 0 : 1;
  for (std::size_t mode = 0; mode < 2; ++mode) {
    const model::Outcome o = model::run_programme(shape.options(), pair, static_cast<PairMode>(mode), coord_w);
    j.wrong[mode] = o.grid != hit || !o.definite || o.hit() != hit ? 1 : 0;
    j.false_no += hit && !o.hit() ? 1 : 0;
    j.beats[mode].add(o.beats);
    if (mode == 1 && general && o.beats > general_position_beats) ++j.too_many_beats;
  }
  return j;
}

/// Prints a line per name and the sum; returns the sum.
inline Judgement print(const std::vector<std::string>& names, const Table<Judgement>& table) {
  constexpr const char* head = "{:<28} {:>11} {:>11} {:>11} {:>10} {:>10} {:>9} {:>11} {:>11} {:>8}\n";
  constexpr const char* row = "{:<28} {:>11} {:>11} {:>11} {:>10} {:>10} {:>9} {:>11.3f} {:>11.3f} {:>8}\n";
  fmt::print(head, "class", "pairs", "hits", "special", "wrong exh", "wrong dir", "false_no", "beats exh", "beats dir",
             "max dir");
  const auto line = [&](const std::string& name, const Judgement& j) {
    fmt::print(row, name, j.pairs, j.hits, j.special, j.wrong[0], j.wrong[1], j.false_no, j.beats[0].mean(),
               j.beats[1].mean(), j.beats[1].greatest);
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i < table.rows.size() && table.rows[i].pairs != 0) line(names[i], table.rows[i]);
  }
  const Judgement sum = table.sum();
  line("all", sum);
  return sum;
}

}  // namespace cchip::stimulus

#endif
