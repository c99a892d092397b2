// SPDX-License-Identifier: Apache-2.0
#include "mesh_source.hpp"

#include <fmt/format.h>

#include <cchip/mesh_io/mesh_file.hpp>
#include <cchip/stimulus/usage_error.hpp>
#include <stdexcept>

namespace cchip::app {

Mesh load_mesh_file(const std::string& path, std::ostream& notices) {
  try {
    Mesh mesh = load_mesh(path, FaceKinds::triangles_and_quads);
    if (mesh.polygons_cut > 0) {
      notices << fmt::format("cchip: {}: {} faces with more than four corners or a dent were cut into triangles\n",
                             path, mesh.polygons_cut);
    }
    return mesh;
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
}

const std::vector<std::string>& mesh_pair_names() {
  static const std::vector<std::string> names = {"face_a", "face_b"};
  return names;
}

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

}  // namespace cchip::app
