// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cchip/internal/reference/eigen_sat.hpp>
#include <cchip/program/usage_error.hpp>

#include "demo.hpp"
#include "support.hpp"

using namespace cchip;
using namespace cchip::app;
using namespace cchip::test;

namespace {

/// Right on the grid, certain only where nothing was rounded.
EngineAnswer honest(const GridPair& pair) { return answer(eigen_intersects(pair, 16), pair.eta == 0); }
/// Wrong on the grid, although it admits uncertainty.
EngineAnswer lying(const GridPair& pair) { return answer(!eigen_intersects(pair, 16), false); }
/// Right on the grid, but certain where rounding forbids it.
EngineAnswer boasting(const GridPair& pair) { return answer(eigen_intersects(pair, 16), true); }

DemoCounts run(ScriptedEngine::Answer answer, const DemoRun& what) {
  ScriptedEngine engine(answer);
  return run_demo_pairs(engine, what.mode, what.a, what.b);
}

/// The run with these kinds, pose and programme.
const DemoRun& find(const std::vector<DemoRun>& runs, const std::string& kinds, const std::string& pose,
                    PairMode mode = PairMode::directed) {
  for (const DemoRun& run : runs) {
    if (run.kinds == kinds && run.pose == pose && run.mode == mode) return run;
  }
  throw std::runtime_error("no run " + kinds + " " + pose);
}

}  // namespace

TEST_CASE("demo: apart, touching, deep, linked are what they say", "[system][demo]") {
  const std::vector<DemoRun> runs = make_demo_runs();
  const DemoRun& flat = find(runs, "tri-tri", "touching");
  CHECK(flat.a.faces.size() >= 2000);
  CHECK(flat.b.faces.size() >= 2000);
  const DemoCounts apart = run(honest, find(runs, "tri-tri", "apart"));
  const DemoCounts touching = run(honest, flat);
  const DemoCounts deep = run(honest, find(runs, "tri-tri", "deep"));
  CHECK(apart.pairs > 1000);
  CHECK(apart.hits == 0);
  CHECK(touching.hits > 100);
  CHECK(touching.indefinite == 0);  // on the grid without rounding
  CHECK(deep.hits > 100);
  const DemoCounts cut = run(honest, find(runs, "tri-quad", "deep"));
  const DemoCounts linked = run(honest, find(runs, "quad-quad", "linked"));
  const DemoCounts crossing = run(honest, find(runs, "quad-quad", "deep"));
  CHECK(cut.hits > 100);
  CHECK(linked.pairs > 10);
  CHECK(linked.hits == 0);
  CHECK(crossing.hits > 100);
  for (const DemoCounts& c : {apart, touching, deep, cut, linked, crossing}) CHECK(c.mismatches == 0);

  DemoRun lifted = flat;
  for (Vec3d& v : lifted.b.vertices) v.z() += 0x1p-50;  // an exact contact ends at the first step up
  CHECK(run(honest, lifted).hits == 0);
}

TEST_CASE("demo: all kinds run with both programmes", "[system][demo]") {
  const std::vector<DemoRun> runs = make_demo_runs();
  for (const DemoRun& one : runs) {
    CAPTURE(one.kinds, one.pose);
    const Kind a = one.kinds.substr(0, 3) == "tri" ? Kind::tri : Kind::quad;
    const Kind b = one.kinds.substr(one.kinds.find('-') + 1, 3) == "tri" ? Kind::tri : Kind::quad;
    for (const Mesh::Face& face : one.a.faces) REQUIRE(face.kind == a);
    for (const Mesh::Face& face : one.b.faces) REQUIRE(face.kind == b);
    CHECK_NOTHROW(find(runs, one.kinds, one.pose, PairMode::exhaustive));
    CHECK_NOTHROW(find(runs, one.kinds, one.pose, PairMode::directed));
  }
}

TEST_CASE("demo: wrong answers are counted", "[system][demo]") {
  const std::vector<DemoRun> runs = make_demo_runs();
  for (const std::string kinds : {"tri-tri", "tri-quad", "quad-quad"}) {
    const DemoCounts lies = run(lying, find(runs, kinds, "deep"));
    CHECK(lies.pairs > 0);
    CHECK(lies.mismatches == lies.pairs);
  }
  // The corner of B is 1e-9 above the plane z = x of A, too little for the grid.
  DemoRun near{"tri-tri", "near", PairMode::exhaustive, {}, {}};
  near.a.vertices = {Vec3d(0, 0, 0), Vec3d(4, 0, 4), Vec3d(0, 4, 0)};
  near.b.vertices = {Vec3d(1, 1, 1 + 1e-9), Vec3d(1, 1, 3), Vec3d(1, 2, 3)};
  near.a.faces = near.b.faces = {{Kind::tri, {0, 1, 2, 0}}};
  CHECK(run(boasting, near).mismatches == 1);
  CHECK(run(honest, near).mismatches == 0);
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
  for (const std::string module : {"tri_quad", "quad_quad"}) {
    CHECK(std::filesystem::file_size(folder.path("waves/sim_" + module + ".fst")) > 10000);
  }
}

TEST_CASE("demo: a wave folder that cannot be made", "[system][demo]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "");
  const Outcome outcome = run_cchip({"demo", "--waves", file + "/waves"});
  CHECK(outcome.code == exit_usage);
  CHECK(outcome.err ==
        "cchip: " + file + "/waves: the folder cannot be made (Not a directory); give another with --waves\n");
}
