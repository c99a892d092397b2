// SPDX-License-Identifier: Apache-2.0
// The depth rule of docs/develop/architecture.md (certainty) against the exact oracle. A hit may be called definite
// exactly if the cube of half-width eta lies in A - B: every translation of A by a corner of the cube, which is an
// error that eta allows, must still meet B. The oracle answers that for each of the eight corners and knows no axis.
#include <catch2/catch.hpp>
#include <cchip/internal/grid/canonical.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/model/programme.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/stimulus/campaign.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <limits>
#include <optional>
#include <set>

using namespace cchip;
using namespace cchip::stimulus;

namespace {

/// Steps of the fine grid in one grid step.
constexpr int fine = 64;

/// The cube of half-width `reach` / fine lies in the interior of A - B: convex, so its corners are enough. Then the
/// primitives cross, for any error within the cube.
bool cube_inside(const GridPair& pair, int reach) {
  for (unsigned corner = 0; corner < 8; ++corner) {
    GridPair moved = pair;
    for (std::size_t i = 0; i < 4; ++i) {
      for (Eigen::Index d = 0; d < 3; ++d) {
        moved.a.v[i][d] = fine * pair.a.v[i][d] + ((corner >> d & 1U) != 0 ? reach : -reach);
        moved.b.v[i][d] = fine * pair.b.v[i][d];
      }
    }
    if (exact_relation(moved) != Relation::crossing) return false;
  }
  return true;
}

/// A rule with a mistake in it.
enum class Mistake { none, eta_less_one, one_direction, normal_left_out, cross_left_out };

/// \param left_out the axis that is left out: of the cross axes the first that is not deep
model::Verdict verdict(const model::Options& o, const model::AxisBeat& beat, const GridPair& pair, int coord_w,
                       Mistake mistake, std::optional<AxisCode>& left_out) {
  model::Verdict v = model::sat_pipeline(o.shape, beat, pair.a, pair.b, coord_w);
  const int shift = model::error_shift(pair.eta);
  const model::Selection s = model::sat_select(o.shape, beat.code, pair.a, pair.b);
  model::Projections p = model::sat_project(o.shape, model::sat_axis(s, coord_w), s, shift, coord_w);
  if (mistake == Mistake::eta_less_one) {
    p.gap_bound = (p.gap_bound >> shift) * ((1 << shift) - 1);
    v.compare.deep = model::sat_compare(o.shape, beat, s.own, p, coord_w).deep;
  }
  if (mistake == Mistake::one_direction) {
    std::int64_t least_own = 0;
    std::int64_t most_other = std::numeric_limits<std::int64_t>::min();
    for (std::size_t i = 0; i < o.shape.points(); ++i) {
      if (i < 2 && s.own[i]) {
        least_own = std::min(least_own, p.p[i]);
      } else {
        most_other = std::max(most_other, p.p[i]);
      }
    }
    v.compare.deep = most_other - least_own > p.gap_bound;
  }
  if (mistake == Mistake::normal_left_out && beat.code.cls == AxisClass::normal_b) v.compare.deep = true;
  if (mistake == Mistake::cross_left_out && beat.code.cls == AxisClass::cross && !v.compare.deep && !v.zero_axis()) {
    if (!left_out) left_out = beat.code;
    v.compare.deep = *left_out == beat.code;
  }
  return v;
}

model::Outcome run(const model::Options& o, const GridPair& pair, PairMode mode, int coord_w, Mistake mistake,
                   std::optional<AxisCode>& left_out) {
  model::State s = model::first_state(o, mode, pair.eta);
  model::Exhaustive found;
  for (;;) {
    const model::Verdict v = verdict(o, model::beat_of(s, pair.eta), pair, coord_w, mistake, left_out);
    const model::Step step = model::advance(o, s, v, pair.eta, found);
    if (step.outcome) return *step.outcome;
    s = step.next ? *step.next : model::following_beat(o, s).value();
  }
}

}  // namespace

TEST_CASE("depth rule: definite exactly if every translation by a corner of the cube of the error still hits",
          "[ref][depth]") {
  const std::uint64_t seed = sim::seed_from_environment();
  for (const ShapeInfo& shape : all_shapes) {
    std::array<std::array<int, 2>, 5> contradictions = {};
    std::array<std::set<unsigned>, 2> needed;  // cross axes without which a wrong hit is called definite
    for (const int coord_w : {5, 8, 16}) {
      PairSource source(coord_w, seed + static_cast<std::uint64_t>(coord_w), shape.a, shape.b);
      const auto classes = classes_of(shape.a, shape.b);
      const model::Options with = shape.options();
      model::Options signs_only = with;
      signs_only.depth = false;
      int proved = 0, more = 0, one_step_short = 0, same_beats = 0;
      for (int n = 0; n < 12000; ++n) {
        GridPair pair = source.draw(classes[source.draw_class()].value);
        constexpr std::array<int, 6> etas = {1, 2, 3, 4, 8, 14};
        pair.eta = etas[static_cast<std::size_t>(source.integer(0, source.coin() ? 0 : 5))];
        pair.a = canonical_quad(pair.a);
        pair.b = canonical_quad(pair.b);
        if (!exact_intersects(pair)) continue;
        const int bound = 1 << model::error_shift(pair.eta);
        const bool inside = cube_inside(pair, bound * fine);
        const bool inside_eta = inside || cube_inside(pair, pair.eta * fine);
        const bool beyond = inside && cube_inside(pair, bound * fine + 1);
        one_step_short += inside_eta ? 0 : cube_inside(pair, (pair.eta - 1) * fine + 1) ? 1 : 0;
        for (const PairMode mode : {PairMode::exhaustive, PairMode::directed}) {
          const model::Outcome signs = model::run_programme(signs_only, pair, mode, coord_w);
          const model::Outcome o = model::run_programme(with, pair, mode, coord_w);
          INFO(shape.name << ' ' << to_text(pair) << " mode " << static_cast<int>(mode));
          REQUIRE(o.grid);
          // sound: what is called definite survives every error that is a translation
          if (o.definite) REQUIRE(inside);
          // complete: no rule could call more pairs definite, up to the strict comparison
          if (beyond) REQUIRE(o.definite);
          // answers that the signs decide stay as they are, beat by beat
          if (signs.definite) REQUIRE((o.definite && o.beats == signs.beats));
          REQUIRE(o.beats <= signs.beats + (mode == PairMode::directed ? int(with.shape.a * with.shape.b) : 0));
          proved += o.definite ? 1 : 0;
          more += o.definite && !signs.definite ? 1 : 0;
          same_beats += o.beats == signs.beats ? 1 : 0;
          for (std::size_t m = 0; m < contradictions.size(); ++m) {
            std::optional<AxisCode> left_out;
            const model::Outcome wrong = run(with, pair, mode, coord_w, static_cast<Mistake>(m), left_out);
            if (!wrong.definite || inside_eta) continue;
            ++contradictions[m][static_cast<std::size_t>(mode)];
            if (left_out) needed[static_cast<std::size_t>(mode)].insert(8U * left_out->k + left_out->l);
          }
        }
      }
      INFO(shape.name << ", " << coord_w << " bit: " << proved << " definite, " << more << " by depth, "
                      << one_step_short << " one step short, " << same_beats << " in the same beats");
      CHECK(proved > 100);
      CHECK(more > 20);
      CHECK(one_step_short > 20);
    }
    for (std::size_t mode = 0; mode < 2; ++mode) {
      CHECK(contradictions[static_cast<std::size_t>(Mistake::none)][mode] == 0);
      for (const Mistake m :
           {Mistake::eta_less_one, Mistake::one_direction, Mistake::normal_left_out, Mistake::cross_left_out}) {
        INFO("mistake " << static_cast<int>(m) << ", mode " << mode);
        CHECK(contradictions[static_cast<std::size_t>(m)][mode] > 0);
      }
      // whichever side of A and of B it is made of, no cross axis may be left out
      for (unsigned k = 0; k < static_cast<unsigned>(shape.a); ++k) {
        for (unsigned l = 0; l < static_cast<unsigned>(shape.b); ++l) {
          INFO(shape.name << ", mode " << mode << ", e_" << k << " x f_" << l);
          CHECK(needed[mode].count(8U * k + l) == 1);
        }
      }
    }
  }
}
