// SPDX-License-Identifier: Apache-2.0
#include "pair_proof.hpp"

#include <optional>

namespace cchip {
namespace {

using certificate_check::Int;
using certificate_check::Point;

using certificate_check::dot;

Int dot(const std::vector<Int>& d, const Point& p) { return d[0] * p[0] + d[1] * p[1] + d[2] * p[2]; }

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
/// the weights of either sum to 1, and t, the least of all, is as great as can be. w, u, t >= 0. Or, with a ray r, the
/// point of B is moved by t r, and t is no part of the weights.
/// The simplex method with Bland's rule, which ends, in integers: the table is multiplied by its last pivot, so all
/// divisions are without remainder (J. Edmonds, "Systems of distinct representatives and linear algebra", 1967).
class WeightProgramme {
 public:
  WeightProgramme(const std::vector<Point>& a, const std::vector<Point>& b, const Point* ray = nullptr)
      : weights_(a.size() + b.size()) {
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
      for (std::size_t j = 0; j < weights_ && ray == nullptr; ++j) table_[i][weights_] += table_[i][j];
      if (ray != nullptr && i < 3) table_[i][weights_] = -(*ray)[i];
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
  /// After meet(): makes t as great as can be. \returns whether it is above 0
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
      if (dot(d, p) >= dot(d, q)) return false;
    }
  }
  return true;
}

/// A short direction close to `d` that `separates` as well, if one does.
template <class Separates>
std::vector<Int> short_direction(const std::vector<Int>& d, const Separates& separates) {
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
    if (separates(rounded)) return reduced(rounded);
  }
  return reduced(d);
}

Point cross_product(const Point& x, const Point& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

bool is_zero(const Point& x) { return x[0] == 0 && x[1] == 0 && x[2] == 0; }

std::vector<Int> as_vector(const Point& x) { return {x[0], x[1], x[2]}; }

Point minus(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }

/// Weights of some vertices of A and of B; those of either have the sum `total`.
struct NamedPoints {
  std::vector<std::pair<std::size_t, Int>> a;
  std::vector<std::pair<std::size_t, Int>> b;
  Int total = 1;
};

/// The nearest points of two hulls that share none: of a vertex and a vertex, edge or triangle of the other, or of two
/// edges, those whose weights are positive and whose distance is least.
class NearestPoints {
 public:
  NearestPoints(const std::vector<Point>& a, const std::vector<Point>& b) : a_(a), b_(b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; j < b.size(); ++j) consider({{{i, 1}}, {{j, 1}}, 1});
    }
    for (const bool turned : {false, true}) {
      const std::vector<Point>& points = turned ? a : b;
      for (std::size_t v = 0; v < (turned ? b : a).size(); ++v) {
        for (std::size_t i = 0; i < points.size(); ++i) {
          for (std::size_t j = 0; j < i; ++j) {
            vertex_edge(turned, v, i, j);
            for (std::size_t k = 0; k < j; ++k) vertex_face(turned, v, {i, j, k});
          }
        }
      }
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t k = 0; k < b.size(); ++k) {
          for (std::size_t m = 0; m < k; ++m) edges(i, j, k, m);
        }
      }
    }
  }
  const NamedPoints& points() const { return best_; }
  /// From the point of A to that of B, times `total`.
  const Point& way() const { return way_; }

 private:
  void consider(const NamedPoints& named) {
    Point way = {0, 0, 0};
    for (const auto& [vertex, weight] : named.b) {
      for (std::size_t axis = 0; axis < 3; ++axis) way[axis] += weight * b_[vertex][axis];
    }
    for (const auto& [vertex, weight] : named.a) {
      for (std::size_t axis = 0; axis < 3; ++axis) way[axis] -= weight * a_[vertex][axis];
    }
    const Int square = dot(way, way);
    if (square_ && square * best_.total * best_.total >= *square_ * named.total * named.total) return;
    square_ = square;
    best_ = named;
    way_ = way;
  }
  void consider_turned(bool turned, const NamedPoints& named) {
    consider(turned ? NamedPoints{named.b, named.a, named.total} : named);
  }
  void vertex_edge(bool turned, std::size_t v, std::size_t i, std::size_t j) {
    const std::vector<Point>& points = turned ? a_ : b_;
    const Point edge = minus(points[j], points[i]);
    const Int length = dot(edge, edge);
    const Int part = dot(edge, minus((turned ? b_ : a_)[v], points[i]));
    if (part <= 0 || part >= length) return;
    consider_turned(turned, {{{v, length}}, {{i, length - part}, {j, part}}, length});
  }
  void vertex_face(bool turned, std::size_t v, const std::array<std::size_t, 3>& corner) {
    const std::vector<Point>& points = turned ? a_ : b_;
    const Point& p = (turned ? b_ : a_)[v];
    const auto edge = [&](std::size_t i) { return minus(points[corner[(i + 2) % 3]], points[corner[(i + 1) % 3]]); };
    const Point normal = cross_product(edge(2), edge(0));
    const Int total = dot(normal, normal);
    NamedPoints named = {{{v, total}}, {}, total};
    for (std::size_t i = 0; i < 3; ++i) {
      const Int weight = dot(normal, cross_product(edge(i), minus(p, points[corner[(i + 1) % 3]])));
      if (weight <= 0) return;
      named.b.emplace_back(corner[i], weight);
    }
    consider_turned(turned, named);
  }
  void edges(std::size_t i, std::size_t j, std::size_t k, std::size_t m) {
    const Point u = minus(a_[j], a_[i]);
    const Point v = minus(b_[m], b_[k]);
    const Point r = minus(b_[k], a_[i]);
    const Int uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), ur = dot(u, r), vr = dot(v, r);
    const Int total = uu * vv - uv * uv;
    const Int s = ur * vv - uv * vr;
    const Int t = uv * ur - uu * vr;
    if (s <= 0 || s >= total || t <= 0 || t >= total) return;
    consider({{{i, total - s}, {j, s}}, {{k, total - t}, {m, t}}, total});
  }

  const std::vector<Point>& a_;
  const std::vector<Point>& b_;
  NamedPoints best_;
  Point way_ = {0, 0, 0};
  std::optional<Int> square_;  // of the way
};

std::vector<Digits> weights_of(const std::vector<std::pair<std::size_t, Int>>& named, std::size_t count) {
  std::vector<Int> weights(count);
  for (const auto& [vertex, weight] : named) weights[vertex] = weight;
  return digits(reduced(std::move(weights)));
}

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
        if (dot(as_vector(n), edges[m]) == 0) continue;
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
    cell.direction = digits(short_direction(programme.direction(false),
                                            [&](const std::vector<Int>& d) { return strictly_below(d, a, b); }));
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

std::optional<CertificateCell> prove_clear(const std::vector<Point>& points_a, const std::vector<Point>& points_b,
                                           const Point& along) {
  std::vector<Point> a = points_a;
  std::vector<Point> b = points_b;
  shorten(a, b);
  CertificateCell cell;
  cell.kind = CertificateCell::Kind::separated;
  WeightProgramme programme(a, b, &along);
  const bool meets = programme.meet();
  if (meets && programme.meet_inside()) return std::nullopt;
  const auto separates = [&](const std::vector<Int>& d) {
    const Int rise = dot(d, along);
    return rise >= 0 && strictly_below(d, a, b);
  };
  cell.direction = digits(short_direction(programme.direction(meets), separates));
  return cell;
}

CertificateCell prove_distance(const std::vector<Point>& a, const std::vector<Point>& b, const Int& within,
                               bool below) {
  using CellKind = CertificateCell::Kind;
  CertificateCell cell;
  cell.kind = CellKind::near;
  WeightProgramme programme(a, b);
  if (programme.meet()) {
    const std::vector<Int> weights = programme.weights();
    const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(a.size());
    cell.weights_a = digits(reduced({weights.begin(), middle}));
    cell.weights_b = digits(reduced({middle, weights.end()}));
    return cell;
  }
  const NearestPoints nearest(a, b);
  const Int square = dot(nearest.way(), nearest.way());
  const Int most = within * nearest.points().total;
  if (below ? square < most * most : square <= most * most) {
    cell.weights_a = weights_of(nearest.points().a, a.size());
    cell.weights_b = weights_of(nearest.points().b, b.size());
    return cell;
  }
  cell.kind = CellKind::separated;
  const auto separates = [&](const std::vector<Int>& d) {
    std::optional<Int> gap;
    for (const Point& p : a) {
      for (const Point& q : b) {
        const Int here = dot(d, q) - dot(d, p);
        if (!gap || here < *gap) gap = here;
      }
    }
    const Int least = within * within * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return *gap > 0 && (below ? *gap * *gap >= least : *gap * *gap > least);
  };
  cell.direction = digits(short_direction(as_vector(nearest.way()), separates));
  return cell;
}

}  // namespace cchip
