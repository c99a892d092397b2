// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a pair passes through: local grid, engine, exact resolution of what the engine leaves open, output.
#ifndef CCHIP_COMMANDS_PAIR_RUNNER_HPP
#define CCHIP_COMMANDS_PAIR_RUNNER_HPP

#include <cchip/internal/driver/pair_engine.hpp>
#include <cchip/stimulus/pair_job.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "row_writer.hpp"

namespace cchip::app {

/// Totals of a run, the last line of every command.
struct Summary {
  std::uint64_t pairs = 0;
  std::uint64_t hits = 0;
  std::uint64_t mismatches = 0;
  std::uint64_t indefinite = 0;                ///< answers that the engine left open and the host resolved
  std::uint64_t beats = 0;                     ///< axes of all pairs
  std::uint64_t clocks = 0;                    ///< clocks that the engine simulated; 0 without hardware
  std::optional<std::uint64_t> left_out = {};  ///< faces that could not be used, if such are left out
};

/// "pairs=N hits=H mismatches=M indefinite=I beats_mean=B clocks=C", then " left_out=L" if such faces are left out
std::string to_line(const Summary& summary);
/// The same for people: "2 pairs, 1 touches, 4.50 axes a pair, 12 clocks". What did not happen is left out.
std::string to_sentence(const Summary& summary);

struct RunOptions {
  PairMode mode = PairMode::exhaustive;
  Format format = Format::table;
  /// Answers are compared with the expected ones: the table shows the differing rows only, the other formats report
  /// them on `messages`.
  bool compare = false;
  /// Pairs that go to the engine together; this bounds the memory.
  std::size_t batch = 4096;
  /// Called for each pair that hits, if set.
  std::function<void(const PairJob&)> on_hit = {};
};

/// Takes pairs one by one, answers them in batches and writes one row per pair, in order.
class PairRunner {
 public:
  using Locate = std::function<std::string(const PairJob&)>;

  /// `locate` names the location of a pair for error messages; `passed_names` are the columns in PairJob::passed.
  PairRunner(PairEngine& engine, const RunOptions& options, const std::vector<std::string>& passed_names, Locate locate,
             std::ostream& out, std::ostream& messages);

  /// \throws UsageError no local grid fits the pair
  void add(PairJob job);
  /// Answers the remaining pairs. Call once, at the end.
  Summary finish();
  std::uint64_t pairs_taken() const { return summary_.pairs + jobs_.size(); }

 private:
  void answer_batch();
  void write_row(const PairJob& job, const EngineAnswer& answer, bool hit);

  PairEngine& engine_;
  RunOptions options_;
  Locate locate_;
  std::ostream& messages_;
  std::unique_ptr<RowWriter> writer_;
  std::vector<PairJob> jobs_;
  std::vector<GridPair> grid_pairs_;
  Summary summary_;
};

}  // namespace cchip::app

#endif
