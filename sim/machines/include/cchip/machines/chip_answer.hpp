// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a simulated chip answers to a query, and whether that is right.
#ifndef CCHIP_MACHINES_CHIP_ANSWER_HPP
#define CCHIP_MACHINES_CHIP_ANSWER_HPP

#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/internal/wire/query.hpp>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace cchip::sim {

/// What came back for a query.
struct ChipAnswer {
  std::optional<DoneRecord> done;
  std::vector<PairRecord> pairs;
};

/// What is wrong with the answer to a query, empty if nothing.
inline std::string compare_answer(const Query& query, const ChipAnswer& answer, const model::BroadPhaseResult& expected,
                                  std::uint32_t open_limit) {
  using Key = std::tuple<std::uint32_t, std::uint32_t, bool>;
  if (!answer.done) return "no answer";
  std::multiset<Key> got, wanted;
  bool definite = false;
  for (const PairRecord& x : answer.pairs) {
    got.emplace(x.id_a, x.id_b, x.definite);
    definite = definite || x.definite;
  }
  for (const PairRecord& x : expected.pairs) wanted.emplace(x.id_a, x.id_b, x.definite);
  const DoneRecord& done = *answer.done;
  const bool first = query.mode == QueryMode::first;
  // A query for the first hit ends at a definite one or at the limit of open ones, whichever comes first: that depends
  // on the order when there are both.
  if (first && (done.code == QueryCode::host || expected.done.code == QueryCode::host)) {
    const bool ends_by_hit = done.answer == QueryAnswer::yes && done.code == QueryCode::ok && definite;
    const bool ends_by_limit = done.code == QueryCode::host && answer.pairs.size() >= open_limit && !definite;
    return ends_by_hit || ends_by_limit ? "" : "end at the limit of open pairs";
  }
  if (done.code != expected.done.code) return "code";
  if (done.answer != expected.done.answer) return "answer";
  if (first && done.answer == QueryAnswer::yes) return definite ? "" : "no definite hit";
  if (got != wanted) return "records";
  if (done.steps != expected.done.steps) return "steps";
  return "";
}

}  // namespace cchip::sim

#endif
