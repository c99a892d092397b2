// SPDX-License-Identifier: Apache-2.0
/// \file
/// Two small objects for tests of the chip, queries of them, and a memory that is hard to live with.
#ifndef CCHIP_BENCH_CHIP_OBJECTS_HPP
#define CCHIP_BENCH_CHIP_OBJECTS_HPP

#include <cchip/internal/image/image.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/internal/tree/tree.hpp>
#include <cchip/shapes.hpp>
#include <cchip/sim/axi_lines.hpp>
#include <optional>
#include <random>
#include <vector>

namespace cchip::testing {

inline bvh::Image image_of(const Mesh& mesh) { return bvh::make_image(mesh, bvh::build_tree(mesh)); }

/// Two objects whose images lie in the memory of a bench, and queries of them at random poses.
struct Objects {
  bvh::Image a, b;
  std::uint64_t line_a = 0, line_b = 0;

  explicit Objects(Kind kind_b) : a(image_of(make_body(6, 0.3, 3))), b(image_of(make_torus(1, 0.4, 36, 24, kind_b))) {}

  template <class Bench>
  void place(Bench& bench) {
    line_a = bench.place(a);
    line_b = bench.place(b);
  }

  Query query(std::mt19937_64& random) const {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto turned = [&] {
      Pose pose = Pose::Identity();
      pose.linear() =
          Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized().toRotationMatrix();
      return pose;
    };
    for (;;) {
      Pose pose_b = turned();
      pose_b.translation() = Vec3d(unit(random), unit(random), unit(random)) * 2.2;
      std::optional<Query> query = bvh::make_query(a.header(), turned(), b.header(), pose_b);
      if (!query) continue;
      query->base_a = static_cast<std::uint32_t>(query->swapped ? line_b : line_a);
      query->base_b = static_cast<std::uint32_t>(query->swapped ? line_a : line_b);
      query->mode = random() % 2 != 0 ? QueryMode::all : QueryMode::first;
      return *query;
    }
  }

  model::BroadPhaseResult expected(const Query& query, const model::BroadPhaseOptions& options = {}) const {
    return model::run_query(query, query.swapped ? b : a, query.swapped ? a : b, options);
  }
};

inline std::vector<Query> queries_of(const Objects& objects, std::mt19937_64& random, std::size_t count) {
  std::vector<Query> queries;
  for (std::size_t i = 0; i < count; ++i) queries.push_back(objects.query(random));
  return queries;
}

/// A memory that does everything that AXI allows.
inline sim::AxiLinesOptions wild() {
  sim::AxiLinesOptions options;
  options.latency = 20;
  options.jitter = 120;
  options.reorder = true;
  options.ready_percent = 60;
  options.valid_percent = 70;
  return options;
}

}  // namespace cchip::testing

#endif
