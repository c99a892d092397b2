// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/functional_test.hpp>
#include <cmath>

namespace cchip::levels {

std::ostream& operator<<(std::ostream& out, const Vertices& x) {
  for (const auto& v : x.v) out << '(' << v[0] << ' ' << v[1] << ' ' << v[2] << ')';
  return out;
}

std::vector<Integers> vertices_of(const Vertices& p, std::size_t count) {
  std::vector<Integers> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back({p.v[i][0], p.v[i][1], p.v[i][2]});
  return result;
}

std::vector<Integers> placed_vertices_of(const Vertices& p, std::size_t count, const Matrix& m) {
  const auto fixed = [&](std::size_t row, std::size_t column) {
    return static_cast<std::int64_t>(m.entry[4 * row + column] * matrix_unit);
  };
  std::vector<Integers> result = vertices_of(p, count);
  for (Integers& v : result) {
    Integers sum{};
    for (std::size_t row = 0; row < 3; ++row) {
      sum[row] = fixed(row, 0) * v[0] + fixed(row, 1) * v[1] + fixed(row, 2) * v[2] + fixed(row, 3);
      sum[row] = (sum[row] + matrix_unit / 2) >> 10;
    }
    v = sum;
  }
  return result;
}

}  // namespace cchip::levels
