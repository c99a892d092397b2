// SPDX-License-Identifier: Apache-2.0
#include "candidates.hpp"

#include <algorithm>
#include <string>

namespace cchip::app {

void for_each_candidate(const Mesh& a, const Mesh& b, std::uint64_t limit, const std::function<void(PairJob)>& take) {
  std::uint64_t count = 0;
  sweep_box_pairs(a, b, [&](CandidatePair candidate) {
    if (limit != 0 && count == limit) return;
    PairJob job;
    job.a = a.primitive(candidate.face_a);
    job.b = b.primitive(candidate.face_b);
    job.row = ++count;
    job.passed = {std::to_string(candidate.face_a), std::to_string(candidate.face_b)};
    take(std::move(job));
  });
}

std::uint64_t count_candidates(const Mesh& a, const Mesh& b, std::uint64_t limit) {
  std::uint64_t count = 0;
  sweep_box_pairs(a, b, [&](CandidatePair) { ++count; });
  return limit == 0 ? count : std::min(count, limit);
}

void add_hit(HitPicture& picture, const PairJob& job) {
  picture.add_hit_a(std::stoull(job.passed.at(0)), true);
  picture.add_hit_b(std::stoull(job.passed.at(1)), true);
}

}  // namespace cchip::app
