// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/eigen_reference.hpp>

#include "demo.hpp"
#include "support.hpp"
#include "usage_error.hpp"

using namespace cchip;
using namespace cchip::app;
using namespace cchip::test;

namespace {

/// Right on the grid, certain only where nothing was rounded.
EngineAnswer honest(const GridPair& pair) { return {eigen_intersects(pair, 16), pair.eta == 0, std::nullopt}; }
/// Wrong on the grid, although it admits to be uncertain.
EngineAnswer lying(const GridPair& pair) { return {!eigen_intersects(pair, 16), false, std::nullopt}; }
/// Right on the grid, but sure of it where rounding forbids.
EngineAnswer boasting(const GridPair& pair) { return {eigen_intersects(pair, 16), true, std::nullopt}; }

DemoCounts run(ScriptedEngine::Answer answer, const DemoScene& scene, const Eigen::Isometry3d& pose) {
  ScriptedEngine engine(answer);
  return run_demo_pose(engine, PairMode::exhaustive, scene.torus, transformed(scene.gear, pose));
}

}  // namespace

TEST_CASE("demo: apart, touching, deep are what they say", "[system][demo]") {
  const DemoScene scene = make_demo_scene();
  CHECK(scene.torus.faces.size() >= 2000);
  CHECK(scene.gear.faces.size() >= 2000);
  REQUIRE(scene.poses.size() == 3);
  const DemoCounts apart = run(honest, scene, scene.poses[0].gear);
  const DemoCounts touching = run(honest, scene, scene.poses[1].gear);
  const DemoCounts deep = run(honest, scene, scene.poses[2].gear);
  CHECK(apart.pairs > 1000);
  CHECK(apart.hits == 0);
  CHECK(touching.hits > 100);
  CHECK(touching.indefinite == 0);  // on the grid as it is
  CHECK(deep.hits > 100);
  CHECK(apart.mismatches + touching.mismatches + deep.mismatches == 0);

  Eigen::Isometry3d lifted = scene.poses[1].gear;
  lifted.translation().z() += 0x1p-50;  // an exact contact ends at the first step up
  CHECK(run(honest, scene, lifted).hits == 0);
}

TEST_CASE("demo: wrong answers are counted", "[system][demo]") {
  const DemoScene scene = make_demo_scene();
  const DemoCounts lies = run(lying, scene, scene.poses[2].gear);
  CHECK(lies.pairs > 0);
  CHECK(lies.mismatches + lies.special == lies.pairs);
  // The corner of B is 1e-9 above the plane z = x of A, too little for the grid.
  Mesh a;
  a.vertices = {Vec3d(0, 0, 0), Vec3d(4, 0, 4), Vec3d(0, 4, 0)};
  Mesh b;
  b.vertices = {Vec3d(1, 1, 1 + 1e-9), Vec3d(1, 1, 3), Vec3d(1, 2, 3)};
  a.faces = b.faces = {{Kind::tri, {0, 1, 2, 0}}};
  ScriptedEngine wrong(boasting);
  CHECK(run_demo_pose(wrong, PairMode::exhaustive, a, b).mismatches == 1);
  ScriptedEngine right(honest);
  CHECK(run_demo_pose(right, PairMode::exhaustive, a, b).mismatches == 0);
}

TEST_CASE("demo: through the hardware, with its waveform", "[system][demo]") {
  const TemporaryFolder folder;
  const Outcome outcome = run_cchip({"demo", "--waves", folder.path("waves")});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.code == exit_ok);
  CHECK(outcome.err.empty());
  CHECK(count(last_line(outcome.out), "pairs") > 10000);
  CHECK(count(last_line(outcome.out), "hits") > 1000);
  CHECK(count(last_line(outcome.out), "mismatches") == 0);
  CHECK(count(last_line(outcome.out), "clocks") > 100000);
  CHECK(std::filesystem::file_size(folder.path("waves/sim.fst")) > 10000);
  CHECK(folder.read("waves/sim.gtkw").find("sim.fst") != std::string::npos);
  const std::string command = "gtkwave " + folder.path("waves/sim.fst") + " " + folder.path("waves/sim.gtkw");
  CHECK(outcome.out.find(command) != std::string::npos);
}

TEST_CASE("demo: a wave folder that cannot be made", "[system][demo]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "");
  const Outcome outcome = run_cchip({"demo", "--waves", file + "/waves"});
  CHECK(outcome.code == exit_usage);
  CHECK(outcome.err ==
        "cchip: " + file + "/waves: the folder cannot be made (Not a directory); give another with --waves\n");
}
