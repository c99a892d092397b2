// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/model/point_tri.hpp>
#include <cchip/levels/stimulus.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

namespace cchip::levels {
namespace {

constexpr std::int32_t limit = std::int32_t{1} << (coord_w - 1);

void check_matrix(const Matrix& m) {
  for (std::size_t i = 0; i < m.entry.size(); ++i) {
    const double entry = m.entry[i];
    const double largest = i % 4 == 3 ? unplaced_max : matrix_entry_max;
    const std::string name = "m" + std::to_string(i / 4) + std::to_string(i % 4);
    if (!(std::abs(entry) <= largest)) {
      throw std::invalid_argument(name + " is beyond " + std::to_string(static_cast<int>(largest)) +
                                  "; scale the vertices instead");
    }
    if (std::floor(entry * matrix_unit) != entry * matrix_unit) {
      throw std::invalid_argument(name + " is no multiple of 1/" + std::to_string(matrix_unit) + "; round it to one");
    }
  }
}

template <class InRange>
void check_vertices(const GridPrimitive& p, std::size_t count, const char* what, InRange in_range) {
  for (std::size_t i = 0; i < count; ++i) {
    if (in_range(p.v[i])) continue;
    throw std::invalid_argument("vertex " + std::to_string(i) + " of " + what + "; move or scale the primitive");
  }
}

bool on_grid(const Vec3i& v) { return v.minCoeff() >= -limit && v.maxCoeff() < limit; }

/// "tri-quad", "point-tri".
std::string kinds_of_pair(const StimulusPair& pair) {
  const auto name = [](Kind kind) { return std::string(kind == Kind::tri ? "tri" : "quad"); };
  return (pair.radius ? "point" : name(pair.a.kind)) + "-" + name(pair.b.kind);
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Matrix& m) {
  for (const double entry : m.entry) out << entry << ' ';
  return out;
}

ModuleId test_of(const StimulusPair& pair) {
  if (pair.radius) return ModuleId::point_tri;
  if (pair.a.kind == Kind::quad) return ModuleId::quad_quad;
  return pair.b.kind == Kind::quad ? ModuleId::tri_quad : ModuleId::tri_tri;
}

std::vector<ObjectPair> object_pairs(const Stimulus& stimulus) {
  std::vector<ObjectPair> result;
  for (std::size_t i = 0; i < stimulus.size(); ++i) {
    if (i == 0 || stimulus[i].object_pair != stimulus[i - 1].object_pair) {
      result.push_back({test_of(stimulus[i]), i, 0});
    }
    ++result.back().count;
  }
  return result;
}

GridPrimitive place(const Matrix& m, const GridPrimitive& p) {
  using RowMajor = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> matrix(m.entry.data());
  GridPrimitive result;
  result.kind = p.kind;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) {
    const Vec3d x = matrix.leftCols<3>() * p.v[i].cast<double>() + matrix.col(3);
    result.v[i] = (x.array() + 0.5).floor().cast<std::int32_t>();
  }
  return result;
}

std::size_t vertex_count_a(const StimulusPair& pair) { return pair.radius ? 1 : pair.a.vertex_count(); }

GridPair placed(const StimulusPair& pair) {
  const GridPrimitive a = place(pair.m, pair.a);
  return {pair.radius ? model::point_operand(a.v[0], *pair.radius, coord_w) : a, pair.b, 0};
}

void check_pair(const StimulusPair& pair) {
  if (pair.radius && (pair.a.kind != Kind::tri || pair.b.kind != Kind::tri)) {
    throw std::invalid_argument("a point and a quad; split the quad into triangles");
  }
  if (pair.radius && (*pair.radius < 0 || *pair.radius >= 2 * limit)) {
    throw std::invalid_argument("a radius of " + std::to_string(*pair.radius) + "; make it 0 to " +
                                std::to_string(2 * limit - 1));
  }
  if (pair.a.kind == Kind::quad && pair.b.kind == Kind::tri) {
    throw std::invalid_argument("a quad and a triangle; make the triangle a and the quad b");
  }
  check_matrix(pair.m);
  const std::size_t of_a = vertex_count_a(pair);
  check_vertices(pair.a, of_a, "a is beyond 2^19",
                 [](const Vec3i& v) { return v.minCoeff() >= -unplaced_max && v.maxCoeff() <= unplaced_max; });
  check_vertices(place(pair.m, pair.a), of_a, "m a is off the grid of 16 bits", on_grid);
  check_vertices(pair.b, pair.b.vertex_count(), "b is off the grid of 16 bits", on_grid);
}

void check_order(const StimulusPair& last, const StimulusPair& next) {
  if (next.object_pair < last.object_pair) {
    throw std::invalid_argument("object_pair " + std::to_string(next.object_pair) + " follows " +
                                std::to_string(last.object_pair) + "; sort the rows by object_pair");
  }
  if (next.object_pair == last.object_pair && test_of(next) != test_of(last)) {
    throw std::invalid_argument("object_pair " + std::to_string(next.object_pair) + " has " + kinds_of_pair(last) +
                                " and " + kinds_of_pair(next) + "; give each kind an object_pair of its own");
  }
}

}  // namespace cchip::levels
