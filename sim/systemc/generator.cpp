// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cchip/levels/generator.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace cchip::levels {
namespace {

using Random = std::mt19937_64;

int integer(Random& random, int least, int greatest) {
  return std::uniform_int_distribution<int>(least, greatest)(random);
}

double to_unit(double x) { return std::round(x * matrix_unit) / matrix_unit; }

Matrix make_matrix(const Eigen::Matrix3d& left, const Vec3d& right) {
  Matrix m;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      m.entry.at(static_cast<std::size_t>(4 * row + column)) = column < 3 ? left(row, column) : right[row];
    }
  }
  return m;
}

/// An exact matrix whose inverse is exact, too: a signed permutation over a power of two.
Eigen::Matrix3d axis_aligned(Random& random) {
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
  const int first = integer(random, 0, 2);
  const int step = integer(random, 1, 2);
  const double scale = std::ldexp(1.0, -integer(random, 0, 2));
  for (int row = 0; row < 3; ++row) left(row, (first + step * row) % 3) = integer(random, 0, 1) == 0 ? scale : -scale;
  return left;
}

Eigen::Matrix3d any_rotation(Random& random) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return q.normalized().toRotationMatrix().unaryExpr(&to_unit);
}

/// `pair` with a random matrix m and with A moved by the inverse of m. Multiplying A by m, as the level does, brings A
/// back to where it was, exactly so unless m is a rotation.
StimulusPair with_matrix(const GridPair& pair, Random& random) {
  const bool exact = integer(random, 0, 1) == 0;
  const Eigen::Matrix3d left = exact ? axis_aligned(random) : any_rotation(random);
  Vec3d right = pair.a.v[0].cast<double>();
  for (double& x : right) x += exact ? integer(random, -100, 100) : to_unit(integer(random, -99999, 99999) / 1000.0);
  StimulusPair result;
  result.m = make_matrix(left, right);
  result.a = pair.a;
  result.b = pair.b;
  const Eigen::Matrix3d back = left.inverse();
  for (std::size_t i = 0; i < pair.a.vertex_count(); ++i) {  // of a point the first alone counts
    result.a.v[i] = (back * (pair.a.v[i].cast<double>() - right)).array().round().cast<std::int32_t>();
  }
  result.mode = integer(random, 0, 1) == 0 ? PairMode::exhaustive : PairMode::directed;
  return result;
}

bool is_legal(const StimulusPair& pair) {
  try {
    check_pair(pair);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// Endless source of pairs of one kind.
class Source {
 public:
  /// \param points of A the first vertex alone counts, as the centre of a sphere that just reaches B, or just does not
  Source(Kind a, Kind b, std::uint64_t seed, bool points = false)
      : pairs_(coord_w, seed, a, b), classes_(stimulus::classes_of(a, b)), random_(seed), points_(points) {}
  StimulusPair draw() {
    while (true) {  // a rotation can move a vertex over the rim of the grid
      const GridPair drawn = pairs_.draw(classes_[pairs_.draw_class()].value);
      StimulusPair pair = with_matrix(drawn, random_);
      if (points_) pair.radius = std::max(0, nearest_vertex(drawn) - integer(random_, 0, 2) * integer(random_, 0, 99));
      if (is_legal(pair)) return pair;
    }
  }

 private:
  /// Grid steps from A's first vertex to the nearest vertex of B, rounded.
  static std::int32_t nearest_vertex(const GridPair& pair) {
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < pair.b.vertex_count(); ++i) {
      least = std::min(least, (pair.b.v[i] - pair.a.v[0]).cast<double>().norm());
    }
    return static_cast<std::int32_t>(std::lround(least));
  }

  stimulus::PairSource pairs_;
  std::vector<stimulus::PairClassInfo> classes_;
  Random random_;
  bool points_;
};

}  // namespace

Stimulus generate(const GeneratorOptions& options) {
  if (options.object_pairs < 1 || options.object_pairs > options.pairs) {
    throw std::invalid_argument(std::to_string(options.object_pairs) + " object pairs of " +
                                std::to_string(options.pairs) + " primitive pairs; ask for 1 or more, none empty");
  }
  Random random(options.seed);
  std::vector<Source> sources = {Source{Kind::tri, Kind::tri, random()}, Source{Kind::tri, Kind::quad, random()},
                                 Source{Kind::quad, Kind::quad, random()}};
  if (options.points) sources.push_back(Source{Kind::tri, Kind::tri, random(), true});
  const int kinds = static_cast<int>(sources.size());
  Stimulus stimulus;
  stimulus.reserve(options.pairs);
  int kind = integer(random, 0, kinds - 1);
  int step = integer(random, 0, 1) == 0 ? 1 : kinds - 1;  // either way through all kinds
  for (std::size_t object = 0; object < options.object_pairs; ++object) {
    const std::size_t end = options.pairs * (object + 1) / options.object_pairs;
    while (stimulus.size() < end) {
      stimulus.push_back(sources.at(static_cast<std::size_t>(kind)).draw());
      stimulus.back().object_pair = object;
    }
    kind = (kind + step) % kinds;
    if (object + 2 >= sources.size()) step = integer(random, 1, kinds - 1);
  }
  return stimulus;
}

}  // namespace cchip::levels
