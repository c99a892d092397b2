// SPDX-License-Identifier: Apache-2.0
#include "campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cchip/internal/exact/posed_pairs.hpp>

namespace cchip::testing {

sim::AxiLinesOptions any_memory(Random& random) {
  sim::AxiLinesOptions options;
  options.latency = random() % 150;
  options.write_latency = random() % 150;
  options.jitter = random() % 2 == 0 ? 0 : random() % 150;
  options.reorder = random() % 2 == 0;
  options.ready_percent = random() % 2 == 0 ? 100 : static_cast<unsigned>(40 + random() % 60);
  options.valid_percent = random() % 2 == 0 ? 100 : static_cast<unsigned>(40 + random() % 60);
  return options;
}

void make_rings_small(ChipDriverOptions& driver) {
  driver.query_log2 = 3;
  driver.record_log2 = 6;
}

ChipDriverOptions small_rings() {
  ChipDriverOptions options;
  options.memory_base = std::uint64_t{3} << 32U;
  options.memory_bytes = std::uint64_t{1} << 24U;
  make_rings_small(options);
  options.patience = 200000;
  options.reset_patience = 4000;
  return options;
}

Totals& Totals::operator+=(const Totals& other) {
  queries += other.queries;
  hits += other.hits;
  differences += other.differences;
  contacts += other.contacts;
  open += other.open;
  fallbacks += other.fallbacks;
  clocks += other.clocks;
  return *this;
}

std::string Totals::summary() const {
  return fmt::format("queries={} hits={} differences={} contacts={} open={} fallbacks={} clocks_mean={:.1f}", queries,
                     hits, differences, contacts, open, fallbacks,
                     static_cast<double>(clocks) / std::max(1.0, static_cast<double>(queries)));
}

namespace {

/// The device may name any contact.
bool named_contact_holds(const Object& a, const Object& b, const PosePair& pose, const CollisionResult& x) {
  if (!x.hit) return x.contacts.empty();
  if (x.contacts.size() != 1) return false;
  if (!a.mesh().file_face.empty() || !b.mesh().file_face.empty()) return true;  // numbers of cut polygons
  return PosedPairs(pose.a, pose.b)
      .decide(a.mesh().primitive(x.contacts[0].face_a), b.mesh().primitive(x.contacts[0].face_b))
      .hit;
}

}  // namespace

void compare(Device& right, Device& tried, const Object& a, const Object& b, const std::vector<PosePair>& poses,
             bool all, Totals& totals) {
  CollisionRequest request;
  if (all) request.contacts = CollisionRequest::Contacts::all;
  const std::vector<CollisionResult> expected = collide(right, a, b, poses, request);
  const std::vector<CollisionResult> got = collide(tried, a, b, poses, request);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const CollisionResult& x = got[i];
    ++totals.queries;
    totals.hits += x.hit ? 1 : 0;
    totals.contacts += x.contacts.size();
    totals.open += x.stats.open;
    totals.fallbacks += x.stats.fallbacks;
    totals.clocks += x.stats.clocks;
    const bool same = all ? x.hit == expected[i].hit && x.contacts == expected[i].contacts
                          : x.hit == expected[i].hit && named_contact_holds(a, b, poses[i], x);
    if (same) continue;
    ++totals.differences;
    fmt::print("a query differs: hit {} {}, contacts {} {}\n", x.hit, expected[i].hit, x.contacts.size(),
               expected[i].contacts.size());
  }
}

}  // namespace cchip::testing
