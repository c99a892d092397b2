// SPDX-License-Identifier: Apache-2.0
#include "pair_proof.hpp"

#include <optional>

namespace cchip {
namespace {

using certificate_check::Int;
using certificate_check::Point;

std::vector<Digits> digits(const std::vector<Int>& numbers) {
  std::vector<Digits> result;
  for (const Int& number : numbers) result.push_back(number.str());
  return result;
}

/// Divides by the greatest common divisor.
std::vector<Int> reduced(std::vector<Int> numbers) {
  Int divisor = 0;
  for (const Int& number : numbers) divisor = gcd(divisor, number);
  if (divisor > 1) {
    for (Int& number : numbers) number /= divisor;
  }
  return numbers;
}

/// A linear programme for points w a_i of A and u b_j of B with weights w_i + t and u_j + t: both are the same point,
/// the weights of either sum to 1, and t, the least of all, is as great as can be. w, u, t >= 0.
/// The simplex method with Bland's rule, which ends, in integers: the table is multiplied by its last pivot, so all
/// divisions are without remainder (J. Edmonds, "Systems of distinct representatives and linear algebra", 1967).
class WeightProgramme {
 public:
  WeightProgramme(const std::vector<Point>& a, const std::vector<Point>& b) : weights_(a.size() + b.size()) {
    for (auto& row : table_) row.resize(weights_ + 1 + equations + 1);
    for (std::size_t j = 0; j < weights_; ++j) {
      const bool of_b = j >= a.size();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (of_b) {
          table_[axis][j] = -b[j - a.size()][axis];
        } else {
          table_[axis][j] = a[j][axis];
        }
      }
      table_[of_b ? 4 : 3][j] = 1;
    }
    for (std::size_t i = 0; i < equations; ++i) {
      for (std::size_t j = 0; j < weights_; ++j) table_[i][weights_] += table_[i][j];
      table_[i][artificial(i)] = 1;
      basis_[i] = artificial(i);
      table_[i].back() = i < 3 ? 0 : 1;
      for (std::size_t j = 0; j <= weights_; ++j) table_[feasible][j] -= table_[i][j];
      table_[feasible].back() -= table_[i].back();
    }
    table_[greatest][weights_] = -1;
  }

  /// Finds a common point. \returns whether there is one
  bool meet() {
    minimise(feasible);
    if (table_[feasible].back() != 0) return false;
    for (std::size_t i = 0; i < equations; ++i) {  // artificial variables, all 0 now, leave the basis
      for (std::size_t j = 0; basis_[i] > weights_ && j <= weights_; ++j) {
        if (table_[i][j] != 0) pivot(i, j);
      }
    }
    return true;
  }
  /// After meet(): makes the least weight as great as can be. \returns whether it is above 0
  bool meet_inside() {
    minimise(greatest);
    return table_[greatest].back() != 0;
  }
  /// All weights, of A and then of B, times a common factor.
  std::vector<Int> weights() const {
    std::vector<Int> result(weights_);
    Int least = 0;
    for (std::size_t i = 0; i < equations; ++i) {
      if (basis_[i] < weights_) result[basis_[i]] = table_[i].back();
      if (basis_[i] == weights_) least = table_[i].back();
    }
    for (Int& weight : result) weight += least;
    return result;
  }
  /// The dual solution: a direction along which A lies strictly below B if meet() was false, or nowhere above B and
  /// not wholly at the same value if meet_inside() was.
  std::vector<Int> direction(bool met) const {
    std::vector<Int> result(3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis] = met ? Int(-table_[greatest][artificial(axis)]) : Int(factor_ - table_[feasible][artificial(axis)]);
    }
    return result;
  }

 private:
  static constexpr std::size_t equations = 5;
  static constexpr std::size_t feasible = equations;      // row: reduced costs of the sum of artificial variables
  static constexpr std::size_t greatest = equations + 1;  // row: those of -t
  std::size_t artificial(std::size_t i) const { return weights_ + 1 + i; }

  void minimise(std::size_t cost) {
    for (;;) {
      std::size_t column = 0;
      while (column <= weights_ && table_[cost][column] >= 0) ++column;
      if (column > weights_) return;
      std::optional<std::size_t> row;
      for (std::size_t i = 0; i < equations; ++i) {
        if (table_[i][column] <= 0) continue;
        if (row) {
          const Int here = table_[i].back() * table_[*row][column];
          const Int there = table_[*row].back() * table_[i][column];
          if (here > there || (here == there && basis_[i] > basis_[*row])) continue;
        }
        row = i;
      }
      pivot(row.value(), column);  // weights are bounded, so there is one
    }
  }
  void pivot(std::size_t row, std::size_t column) {
    const Int by = table_[row][column];
    for (std::size_t i = 0; i < table_.size(); ++i) {
      if (i == row) continue;
      const Int take = table_[i][column];
      for (std::size_t j = 0; j < table_[i].size(); ++j) {
        table_[i][j] = (table_[i][j] * by - take * table_[row][j]) / factor_;
      }
    }
    factor_ = by;
    basis_[row] = column;
    if (factor_ > 0) return;
    factor_ = -factor_;
    for (auto& line : table_) {
      for (Int& entry : line) entry = -entry;
    }
  }

  std::size_t weights_;
  Int factor_ = 1;
  std::array<std::vector<Int>, equations + 2> table_;
  std::array<std::size_t, equations> basis_ = {};
};

/// Relative to the first point of B, without common factors of two: short numbers.
void shorten(std::vector<Point>& a, std::vector<Point>& b) {
  const Point origin = b[0];
  Int all = 0;
  for (std::vector<Point>* points : {&a, &b}) {
    for (Point& point : *points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] -= origin[axis];
        all |= abs(point[axis]);
      }
    }
  }
  if (all == 0) return;
  const Int common = Int(1) << lsb(all);
  for (std::vector<Point>* points : {&a, &b}) {
    for (Point& point : *points) {
      for (Int& x : point) x /= common;
    }
  }
}

bool strictly_below(const std::vector<Int>& d, const std::vector<Point>& a, const std::vector<Point>& b) {
  for (const Point& p : a) {
    for (const Point& q : b) {
      if (certificate_check::dot(d, p) >= certificate_check::dot(d, q)) return false;
    }
  }
  return true;
}

/// A short direction close to `d` that separates as well, if one does.
std::vector<Int> short_direction(const std::vector<Int>& d, const std::vector<Point>& a, const std::vector<Point>& b) {
  unsigned bits = 0;
  for (const Int& x : d) bits = x == 0 ? bits : std::max(bits, msb(abs(x)) + 1);
  for (const unsigned keep : {3U, 6U, 10U, 16U, 24U, 34U, 52U}) {
    if (keep >= bits) break;
    std::vector<Int> rounded(3);
    for (std::size_t i = 0; i < 3; ++i) {
      const Int half = Int(1) << (bits - keep - 1);
      rounded[i] = (abs(d[i]) + half) >> (bits - keep);
      if (d[i] < 0) rounded[i] = -rounded[i];
    }
    if (strictly_below(rounded, a, b)) return reduced(rounded);
  }
  return reduced(d);
}

Point cross_product(const Point& x, const Point& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

bool is_zero(const Point& x) { return x[0] == 0 && x[1] == 0 && x[2] == 0; }

std::vector<Int> as_vector(const Point& x) { return {x[0], x[1], x[2]}; }

/// Fills `span` of the cell with three edges that span space, or `direction` with one that is orthogonal to all edges.
bool span_space(const std::vector<Point>& a, const std::vector<Point>& b, CertificateCell& cell) {
  std::vector<Point> edges;
  std::vector<CertificateCell::Edge> names;
  for (const bool of_b : {false, true}) {
    const std::vector<Point>& points = of_b ? b : a;
    for (std::size_t k = 1; k < points.size(); ++k) {
      edges.push_back({points[k][0] - points[0][0], points[k][1] - points[0][1], points[k][2] - points[0][2]});
      names.push_back({of_b, static_cast<std::uint8_t>(k)});
    }
  }
  Point line = {0, 0, 0};
  Point normal = {0, 0, 0};
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!is_zero(edges[i])) line = edges[i];
    for (std::size_t k = 0; k < i; ++k) {
      const Point n = cross_product(edges[i], edges[k]);
      if (is_zero(n)) continue;
      normal = n;
      for (std::size_t m = 0; m < k; ++m) {
        if (certificate_check::dot(as_vector(n), edges[m]) == 0) continue;
        cell.span = {names[m], names[k], names[i]};
        return true;
      }
    }
  }
  for (std::size_t axis = 0; is_zero(normal) && axis < 3; ++axis) {
    Point unit = {0, 0, 0};
    unit[axis] = 1;
    normal = is_zero(line) ? unit : cross_product(line, unit);
  }
  cell.direction = digits(reduced(as_vector(normal)));
  return false;
}

}  // namespace

CertificateCell prove_pair(const std::vector<Point>& points_a, const std::vector<Point>& points_b, bool tell_crossing) {
  using CellKind = CertificateCell::Kind;
  std::vector<Point> a = points_a;
  std::vector<Point> b = points_b;
  shorten(a, b);
  CertificateCell cell;
  WeightProgramme programme(a, b);
  if (!programme.meet()) {
    cell.kind = CellKind::separated;
    cell.direction = digits(short_direction(programme.direction(false), a, b));
    return cell;
  }
  cell.kind = CellKind::meet;
  if (tell_crossing) {
    cell.kind = CellKind::touch;
    if (!programme.meet_inside()) {
      cell.direction = digits(reduced(programme.direction(true)));
    } else if (span_space(a, b, cell)) {
      cell.kind = CellKind::cross;
    }
  }
  const std::vector<Int> weights = programme.weights();
  const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(a.size());
  cell.weights_a = digits(reduced({weights.begin(), middle}));
  cell.weights_b = digits(reduced({middle, weights.end()}));
  return cell;
}

}  // namespace cchip
