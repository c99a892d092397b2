// SPDX-License-Identifier: Apache-2.0
// The partition with each of its personas: it is the module that its RM_ID names, on every clock.
#include <cchip/stimulus/pair_source.hpp>
#include <models/cchip_pr_region.hpp>

#include "primtest_bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

/// A handful of pairs of every class, every answer checked with the exact oracle, every clock with the model.
template <class Config>
void check_persona(ModuleId id) {
  REQUIRE(Config::RM_ID == static_cast<int>(id));
  const PrimtestConfig config = primtest_config<Config>(id);
  stimulus::PairSource source(config.coord_w, sim::seed_from_environment(), config.kind_a, config.kind_b);
  std::vector<GridPair> pairs;
  for (const stimulus::PairClassInfo& info : stimulus::classes_of(config.kind_a, config.kind_b)) {
    for (int i = 0; i < 3; ++i) pairs.push_back(source.draw(info.value));
  }
  REQUIRE(pairs.size() >= 10);
  for (const PairMode mode : {PairMode::exhaustive, PairMode::directed}) exact_answers(config, pairs, mode);
}

}  // namespace

TEST_CASE("cchip_pr_region: RM_ID 1 is the triangle-triangle test", "[unit][cchip_pr_region]") {
  check_persona<region_tri_tri>(ModuleId::tri_tri);
}

TEST_CASE("cchip_pr_region: RM_ID 2 is the triangle-quad test", "[unit][cchip_pr_region]") {
  check_persona<region_tri_quad>(ModuleId::tri_quad);
}

TEST_CASE("cchip_pr_region: RM_ID 3 is the quad-quad test", "[unit][cchip_pr_region]") {
  check_persona<region_quad_quad>(ModuleId::quad_quad);
}

TEST_CASE("cchip_pr_region: RM_ID 0 is blank: never ready, never valid", "[unit][cchip_pr_region]") {
  require_never_answers<region_blank>();
}
