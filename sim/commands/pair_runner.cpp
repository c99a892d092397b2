// SPDX-License-Identifier: Apache-2.0
#include "pair_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cchip/internal/grid/local_grid.hpp>
#include <cchip/internal/grid/resolve.hpp>
#include <cchip/program/usage_error.hpp>

namespace cchip::app {
namespace {

const std::vector<std::string> answer_names = {"hit",  "hw_hit", "hw_grid",  "hw_definite",
                                               "axis", "beats",  "clock_in", "clock_out"};

std::vector<std::string> output_names(const RunOptions& options, const std::vector<std::string>& passed) {
  std::vector<std::string> ours = answer_names;
  if (options.compare && options.format == Format::table) ours.insert(ours.begin(), {"row", "expected"});
  return names_behind(passed, ours);
}

void append_hardware(std::vector<Cell>& cells, const EngineAnswer& answer) {
  cells.emplace_back(std::uint64_t{answer.hit});
  cells.emplace_back(std::uint64_t{answer.grid});
  cells.emplace_back(std::uint64_t{answer.definite});
  cells.emplace_back(to_words(answer.axis));
  cells.emplace_back(static_cast<std::uint64_t>(answer.beats));
  cells.emplace_back(answer.clocks->accepted);
  cells.emplace_back(answer.clocks->answered);
}

}  // namespace

std::string to_line(const Summary& s) {
  const double mean = s.pairs == 0 ? 0.0 : static_cast<double>(s.beats) / static_cast<double>(s.pairs);
  const std::string line = fmt::format("pairs={} hits={} mismatches={} indefinite={} beats_mean={:.2f} clocks={}",
                                       s.pairs, s.hits, s.mismatches, s.indefinite, mean, s.clocks);
  return s.left_out ? line + fmt::format(" left_out={}", *s.left_out) : line;
}

std::string to_sentence(const Summary& s) {
  const auto counted = [](std::uint64_t count, const char* one, const char* many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
  };
  std::string line = counted(s.pairs, "pair", "pairs") + ", " + counted(s.hits, "touches", "touch");
  if (s.mismatches > 0) line += ", " + counted(s.mismatches, "answer differs", "answers differ");
  if (s.indefinite > 0) line += fmt::format(", {} left to the host", s.indefinite);
  if (s.beats > 0 && s.pairs > 0) {
    line += fmt::format(", {:.2f} axes a pair", static_cast<double>(s.beats) / static_cast<double>(s.pairs));
  }
  if (s.clocks > 0) line += ", " + counted(s.clocks, "clock", "clocks");
  if (s.left_out.value_or(0) > 0) line += ", " + counted(*s.left_out, "face", "faces") + " left out";
  return line;
}

PairRunner::PairRunner(PairEngine& engine, const RunOptions& options, const std::vector<std::string>& passed_names,
                       Locate locate, std::ostream& out, std::ostream& messages)
    : engine_(engine),
      options_(options),
      locate_(std::move(locate)),
      messages_(messages),
      writer_(make_row_writer(options.format, out, output_names(options, passed_names))) {}

void PairRunner::add(PairJob job) {
  try {
    grid_pairs_.push_back(quantise(job.a, job.b, engine_.coord_w()).pair);
  } catch (const GridError& error) {
    throw UsageError(locate_(job) + ": " + error.what());
  }
  jobs_.push_back(std::move(job));
  if (jobs_.size() >= options_.batch) answer_batch();
}

Summary PairRunner::finish() {
  answer_batch();
  summary_.clocks = engine_.statistics().clocks;
  return summary_;
}

void PairRunner::answer_batch() {
  const std::vector<EngineAnswer> answers = engine_.run(grid_pairs_, options_.mode);
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    const bool hit = resolve(jobs_[i].a, jobs_[i].b, answers.at(i));
    ++summary_.pairs;
    summary_.hits += hit;
    if (hit && options_.on_hit) options_.on_hit(jobs_[i]);
    summary_.indefinite += !answers[i].definite;
    summary_.beats += static_cast<std::uint64_t>(answers[i].beats);
    write_row(jobs_[i], answers[i], hit);
  }
  writer_->flush();
  jobs_.clear();
  grid_pairs_.clear();
}

void PairRunner::write_row(const PairJob& job, const EngineAnswer& answer, bool hit) {
  const bool differs = job.expected && *job.expected != hit;
  summary_.mismatches += differs;
  const bool table_of_differences = options_.compare && options_.format == Format::table;
  if (table_of_differences && !differs) return;
  if (differs && !table_of_differences) {
    messages_ << fmt::format("cchip: {}: expected hit {:d}, got {:d}\n", locate_(job), *job.expected, hit);
  }
  std::vector<Cell> cells(job.passed.begin(), job.passed.end());
  if (table_of_differences) {
    cells.emplace_back(job.row);
    cells.emplace_back(std::uint64_t{*job.expected});
  }
  cells.emplace_back(std::uint64_t{hit});
  if (answer.clocks) {
    append_hardware(cells, answer);
  } else {
    cells.resize(cells.size() + answer_names.size() - 1);
  }
  writer_->write(cells);
}

}  // namespace cchip::app
