// SPDX-License-Identifier: Apache-2.0
// One query of two small objects and the records that the functional model expects, for bench_chip.v: files for
// $readmemh, 16 bytes a line.
//   cchip_query_vectors MEMORY RECORDS [triangle]   MEMORY: the query, then both images, from address 0 on; triangle:
//   of
//                                                   triangles alone, for a chip with their test alone (default: and
//                                                   quads)
#include <algorithm>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/internal/tree/tree.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/shapes.hpp>
#include <iostream>
#include <optional>

namespace {

using namespace cchip;

bvh::Image image_of(const Mesh& mesh) { return bvh::make_image(mesh, bvh::build_tree(mesh)); }

/// Bytes as numbers of 16 bytes, the highest digit first.
template <class Bytes>
void write_hex(std::ostream& out, const Bytes& bytes) {
  static_assert(sizeof(Bytes) % 16 == 0);
  static constexpr char digits[] = "0123456789abcdef";
  for (auto part = bytes.begin(); part != bytes.end(); part += 16) {
    for (auto byte = part + 16; byte != part;) {
      --byte;
      out << digits[*byte >> 4U] << digits[*byte & 15U];
    }
    out << '\n';
  }
}

void write_vectors(const std::string& memory_path, const std::string& records_path, Kind kind) {
  // triangles through quads: pairs of both kinds of leaves, certain ones and apart ones
  const bvh::Image a = image_of(make_sphere(1, 1));
  const bvh::Image b = image_of(make_torus(1, 0.4, 6, 4, kind));
  std::optional<Query> query =
      bvh::make_query(a.header(), Pose(Eigen::Translation3d(1.75, 0.1, 0.2)), b.header(), Pose::Identity());
  if (!query) throw std::runtime_error("a pose that the chip does not take");
  const std::uint32_t line_a = 1;  // behind the query
  const auto line_b = static_cast<std::uint32_t>(line_a + a.lines.size());
  query->base_a = query->swapped ? line_b : line_a;
  query->base_b = query->swapped ? line_a : line_b;
  query->mode = QueryMode::all;  // its records, in any order, do not depend on timing
  query->tag = 0xC0111DE5;
  const model::BroadPhaseResult expected = model::run_query(*query, query->swapped ? b : a, query->swapped ? a : b);

  sim::OutputFile memory(memory_path), records(records_path);
  memory.stream() << "@0\n";  // with an address, $readmemh accepts fewer words than the memory has
  records.stream() << "@0\n";
  write_hex(memory.stream(), encode(*query));
  for (const bvh::Image* image : {&a, &b})
    for (const Line& line : image->lines) write_hex(memory.stream(), line);
  for (const PairRecord& pair : expected.pairs) write_hex(records.stream(), encode(pair));
  write_hex(records.stream(), encode(expected.done));
  memory.commit();
  records.commit();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const bool triangles = argc == 4 && std::string(argv[3]) == "triangle";
    if (argc != 3 && !triangles) throw std::invalid_argument("usage: cchip_query_vectors MEMORY RECORDS [triangle]");
    write_vectors(argv[1], argv[2], triangles ? Kind::tri : Kind::quad);
  } catch (const std::exception& error) {
    std::cerr << "cchip_query_vectors: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
