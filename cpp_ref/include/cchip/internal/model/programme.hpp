// SPDX-License-Identifier: Apache-2.0
/// \file
/// The axis programmes (EXHAUSTIVE, DIRECTED and what they lead to) as the controller runs them.
#ifndef CCHIP_INTERNAL_MODEL_PROGRAMME_HPP
#define CCHIP_INTERNAL_MODEL_PROGRAMME_HPP

#include <cchip/internal/model/sat.hpp>
#include <optional>

namespace cchip::model {

/// What the beats nA and nB say about a pair.
struct Sides {
  std::array<int, 4> b = {};  ///< sign of nA . (W_j - V0)
  std::array<int, 4> a = {};  ///< sign of nB . (V_i - W0)
  std::array<int, 3> normal_a = {};
  std::array<int, 3> normal_b = {};
  int largest = 0;  ///< component of the largest |nA|
  bool warped_a = false;
  bool warped_b = false;
  bool certain = true;  ///< every side holds for the unrounded vertices, too
};

/// State of a pair's programme; travels with its beat.
struct State {
  Programme programme = Programme::normals;
  AxisCode code;
  int beats = 0;  ///< beats issued before this one
  Sides sides;
  AxisCode second;  ///< crossing: the axis after this one
  bool certain = true;
  /// Every axis so far overlaps by more than the error in both directions. False from the start if eta is 0, where no
  /// proof is needed, or unknown, where there is none.
  bool deep = false;
};

/// What a programme finds out about a pair.
struct Outcome {
  bool grid = false;
  bool definite = false;
  AxisCode witness;
  int beats = 0;
  bool hit() const { return grid || !definite; }
  PairResult result(std::uint16_t tag) const { return {tag, hit(), grid, definite, witness, beats}; }
};

struct Options {
  Shape shape;
  bool warped_exact = true;
  /// A hit is also definite if every facet normal of A - B overlaps by more than the error. False: only signs make a
  /// hit definite, for comparisons; the RTL has no such switch.
  bool depth = true;
};

/// First state of a pair in a mode (reserved ones give Programme::illegal).
State first_state(const Options& options, PairMode mode, int err);
/// The axis the state asks for.
AxisBeat beat_of(const State& state, int err);
/// The beat of an EXHAUSTIVE pair that follows at once; nullopt after its last.
std::optional<State> following_beat(const Options& options, const State& state);

/// What the verdict on nA (on nB) says, written to `sides`.
void record_normal_a(Sides& sides, const Shape& shape, const Verdict& verdict);
void record_normal_b(Sides& sides, const Shape& shape, const Verdict& verdict);
/// First state of the programme that continues with a pair when neither normal separates.
State plan(const Options& options, const Sides& sides, int beats);

/// What follows a verdict: an outcome, or a state with the next beat, or (EXHAUSTIVE, not the last
/// axis) neither.
struct Step {
  std::optional<Outcome> outcome;
  std::optional<State> next;
};

/// What the verdicts of one EXHAUSTIVE pair have shown so far; they arrive one after the other.
struct Exhaustive {
  bool separated = false;
  bool certain_gap = false;
  bool certain = false;  ///< signs of nA, then of both normals, then also of the crossing axes
  bool deep = false;     ///< State::deep after the latest verdict
  AxisCode witness;
  Sides sides;
  State plan;  ///< what the normals lead to
};

/// \param found is read and written for EXHAUSTIVE pairs only.
Step advance(const Options& options, const State& state, const Verdict& verdict, int err, Exhaustive& found);

/// Runs a whole programme on one pair.
Outcome run_programme(const Options& options, const GridPair& pair, PairMode mode, int coord_w);

}  // namespace cchip::model

#endif
