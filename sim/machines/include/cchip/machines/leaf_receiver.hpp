// SPDX-License-Identifier: Apache-2.0
/// \file
/// What stands behind the broad phase's leaf pairs when it is simulated alone: it tests them as the functional model
/// does, after the clocks of a lane that takes an axis per clock.
#ifndef CCHIP_MACHINES_LEAF_RECEIVER_HPP
#define CCHIP_MACHINES_LEAF_RECEIVER_HPP

#include <array>
#include <cchip/internal/wire/query.hpp>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace cchip::sim {

struct LeafReceiverOptions {
  std::uint64_t transform = 28;  ///< clocks from a leaf pair to the first axis of its first primitives
  std::uint64_t ahead = 64;      ///< clocks of work that wait in front of the lane
  std::uint64_t first = 41;      ///< clocks from an axis to what becomes of it, of a pair's first one and of the others
  std::uint64_t others = 35;
  std::uint64_t jitter = 0;  ///< up to this many more, at random
  bool held = false;         ///< gives no results
  bool only_hits = false;    ///< holds back the results without a definite hit, and their room
  bool all_open = false;     ///< no hit is definite
};

/// Outcome of a query.
struct BroadPhaseAnswer {
  std::optional<DoneRecord> done;
  std::vector<PairRecord> pairs;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> leaf_pairs;  ///< lines of A and of B
  std::uint64_t started = 0;                                        ///< clocks
  std::uint64_t ended = 0;
};

struct LeafPair {
  unsigned context = 0;
  unsigned epoch = 0;
  unsigned kinds = 0;           ///< B's above A's
  bool failed = false;          ///< a line could not be read
  std::array<Line, 2> lines{};  ///< A's, B's
};

class LeafReceiver {
 public:
  struct Result {
    std::uint64_t due = 0;
    unsigned context = 0;
    unsigned epoch = 0;
    unsigned hits = 0;
    unsigned open = 0;
    QueryCode code = QueryCode::ok;
  };

  /// \param random outlives this
  explicit LeafReceiver(std::mt19937_64& random) : random_(random) {}

  LeafReceiverOptions options;

  /// Tests a leaf pair. \param answer of its query, to which hits are added
  /// \returns clocks for which it keeps the lane busy
  std::uint64_t take(const LeafPair& leaves, const Query& query, std::uint64_t now, BroadPhaseAnswer& answer);
  /// The result on offer, which stays until it is taken; none: null.
  const Result* offer(std::uint64_t now);
  void taken() { given_.reset(); }
  /// Is there room for one more leaf pair from this clock on? True once for each that was taken.
  bool credit(std::uint64_t now);
  /// Drops what is in flight.
  void clear();

 private:
  struct Work {
    std::uint64_t beats = 0;  ///< of all pairs of primitives
    std::uint64_t most = 1;   ///< of one of them
  };
  Work test(const LeafPair& leaves, const Query& query, BroadPhaseAnswer& answer, Result& result) const;

  std::mt19937_64& random_;
  std::deque<Result> results_;  // in the order of their clocks
  std::optional<Result> given_;
  std::deque<std::uint64_t> credits_;
  std::uint64_t lane_free_ = 0;
};

}  // namespace cchip::sim

#endif
