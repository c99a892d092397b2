// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cchip/internal/model/point_tri.hpp>
#include <stdexcept>
#include <string>

namespace cchip::model {

namespace {

// __extension__ (no warning about a type outside ISO C++) needs typedef.
__extension__ typedef __int128 Wide;  // NOLINT(modernize-use-using)

constexpr int axes_per_pair = 7;

}  // namespace

GridPrimitive point_operand(const Vec3i& centre, std::int32_t radius, int coord_w) {
  const std::int32_t range = std::int32_t{1} << coord_w;
  if (radius < 0 || radius >= range) {
    throw std::invalid_argument("point_operand: radius " + std::to_string(radius) + " is not in 0.." +
                                std::to_string(range - 1) + "; choose a coarser grid");
  }
  GridPrimitive point;
  point.v[0] = centre;
  point.v[1].x() = radius >= range / 2 ? radius - range : radius;  // the same bits as a signed coordinate
  return point;
}

std::int32_t radius_of(const GridPrimitive& point, int coord_w) {
  return point.v[1].x() & ((std::int32_t{1} << coord_w) - 1);
}

std::bitset<7> point_axes(const GridPrimitive& point, const GridPrimitive& triangle, int coord_w) {
  // Gram matrix of the vertices as seen from the point, and its cofactors
  std::array<std::array<Wide, 3>, 3> g{};
  std::array<std::array<Wide, 3>, 3> c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (int d = 0; d < 3; ++d) {
        g[i][j] += Wide{triangle.v[i][d] - point.v[0][d]} * (triangle.v[j][d] - point.v[0][d]);
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3;
      const std::size_t i2 = (i + 2) % 3;
      const std::size_t j1 = (j + 1) % 3;
      const std::size_t j2 = (j + 2) % 3;
      c[i][j] = g[i1][j1] * g[i2][j2] - g[i1][j2] * g[i2][j1];
    }
  }
  const Wide radius = radius_of(point, coord_w);
  const Wide square = radius * radius;
  std::array<Wide, 3> row{};
  Wide normal = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) row[k] += c[k][j];
    normal += row[k];
  }
  std::bitset<7> separated;
  separated[0] = g[0][0] * c[0][0] + g[0][1] * c[0][1] + g[0][2] * c[0][2] > square * normal;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const Wide side = g[i][i] - 2 * g[i][j] + g[j][j];
    separated[1 + i] = c[k][k] > square * side && row[k] <= 0;
    separated[4 + i] = g[i][i] > square && g[i][j] >= g[i][i] && g[i][k] >= g[i][i];
  }
  return separated;
}

PairResult point_tri_answer(const PairRequest& request, int coord_w) {
  if (request.mode > PairMode::directed) {
    return {request.tag, true, true, false, {AxisClass::illegal, 0, 0}, 0};
  }
  const std::bitset<7> separated = point_axes(request.pair.a, request.pair.b, coord_w);
  PairResult result;
  result.tag = request.tag;
  result.grid = separated.none();
  result.definite = request.pair.eta == 0;
  result.hit = result.grid || !result.definite;
  result.beats = axes_per_pair;
  constexpr std::array<AxisClass, 7> classes = {AxisClass::normal_b, AxisClass::cross,    AxisClass::cross,
                                                AxisClass::cross,    AxisClass::normal_a, AxisClass::normal_a,
                                                AxisClass::normal_a};
  for (std::size_t axis = 7; axis-- > 0;) {
    if (separated[axis]) result.axis = {classes[axis], 0, static_cast<std::uint8_t>(axis == 0 ? 0 : (axis - 1) % 3)};
  }
  return result;
}

PointTri::PointTri(int coord_w, std::size_t contexts)
    : coord_w_(coord_w),
      contexts_(contexts),
      waiting_(contexts),
      axes_(static_cast<std::size_t>(defs::point_axes_latency(coord_w) + 1)),
      results_(contexts) {}

void PointTri::clock(const std::optional<PairRequest>& pair, bool m_result_ready) {
  const bool accept = pair && ready_;
  const bool answer = m_result_ready && results_.m_valid();

  results_.clock(axes_.q().has_value(), axes_.q().value_or(PairResult{}), m_result_ready);

  const bool take = busy_ == 0;
  const bool start = take && waiting_.m_valid();
  axes_.clock(start ? std::optional(point_tri_answer(waiting_.m_data(), coord_w_)) : std::nullopt);
  busy_ = start ? axes_per_pair - 1 : take ? 0 : busy_ - 1;
  waiting_.clock(accept, pair.value_or(PairRequest{}), take);

  pairs_ = pairs_ + (accept ? 1 : 0) - (answer ? 1 : 0);
  ready_ = awake_ && pairs_ != contexts_;
  awake_ = true;
  idle_ = pairs_ == 0;
}

void PointTri::reset() {
  pairs_ = 0;
  ready_ = false;
  awake_ = false;
  idle_ = true;
  busy_ = 0;
  waiting_.reset();
  axes_.reset();
  results_.reset();
}

}  // namespace cchip::model
