// SPDX-License-Identifier: Apache-2.0
// collide() under poses that are singular, sheared, mirrored, huge, tiny and nearly touching, against predicates that
// know neither poses nor doubles. Vertices and entries of poses are integers times powers of two, so all points of the
// world are integers times one power of two, exactly: the oracle gets these integers. Poses of any doubles, of which it
// must compute with numbers of any length, are a row of their own.
#include <cchip/collide.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/judge/brute_force.hpp>
#include <cchip/stimulus/pair_source.hpp>
#include <cmath>

#include "commands.hpp"
#include "grid_mesh.hpp"
#include "lib/random_poses.hpp"

namespace cchip::campaign {
namespace {

using Matrix = Eigen::Matrix<std::int64_t, 3, 3>;
using Vector = Eigen::Matrix<std::int64_t, 3, 1>;

enum Map { undone, turned, mirrored, sheared, flat, line, doubles, map_count };
constexpr std::array<const char*, map_count> map_names = {
    "class of pairs, map undone", "quarter turns",        "mirrored", "any integers, sheared", "singular, rank 2",
    "singular, rank 1 or 0",      "any doubles, last bit"};
enum Scale { one, huge, tiny, subnormal, scale_count };
constexpr std::array<const char*, scale_count> scale_names = {"1", "huge", "tiny", "subnormal"};

struct Counted {
  std::uint64_t pairs = 0;
  std::uint64_t queries = 0;
  std::uint64_t open = 0;
  std::array<std::uint64_t, 3> relations = {};
  std::uint64_t wrong = 0;  ///< queries: alone, in a batch, or by the device without SIMD
  Counted& operator+=(const Counted& x) {
    pairs += x.pairs;
    queries += x.queries;
    open += x.open;
    for (std::size_t i = 0; i < relations.size(); ++i) relations[i] += x.relations[i];
    wrong += x.wrong;
    return *this;
  }
};

/// Primitives of the grid, and the power of two of a step.
struct Body {
  std::vector<GridPrimitive> faces;
  int exponent = 0;
};

/// x -> linear x + translation in integers.
struct Place {
  Matrix linear = Matrix::Identity();
  Vector translation = Vector::Zero();
  Vector of(const Vec3i& v) const { return linear * v.cast<std::int64_t>() + translation; }
  /// The same for a body whose coordinates have the exponent, in a world of another one.
  Pose pose(int body, int world) const {
    Pose result = Pose::Identity();
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        result.linear()(i, k) = std::ldexp(static_cast<double>(linear(i, k)), world - body);
      }
      result.translation()[i] = std::ldexp(static_cast<double>(translation[i]), world);
    }
    return result;
  }
};

GridPrimitive moved(GridPrimitive primitive, const Place& place) {
  for (Vec3i& v : primitive.v) v = place.of(v).cast<std::int32_t>();
  return primitive;
}

class Scene {
 public:
  Scene(const CollideOptions& options, const std::vector<ShapeInfo>& shapes, std::uint64_t seed)
      : random_(seed), options_(options) {
    for (const ShapeInfo& shape : shapes) {
      sources_.emplace_back(options.coord_w, random_(), shape.a, shape.b);
      classes_.push_back(classes_of(shape.a, shape.b));
    }
    request_.contacts = CollisionRequest::Contacts::all;
    request_.relation = true;
  }

  /// Two bodies in a handful of poses.
  void run(Table<Counted>& table, std::uint64_t part, std::uint64_t& pairs) {
    const std::size_t shape = below(sources_.size());
    const std::size_t count = below(8) == 0 ? 4 + below(12) : 1 + below(3);  // more than a SIMD vector holds, too
    PairSource& source = sources_[shape];
    std::vector<GridPair> drawn;
    for (std::size_t i = 0; i < count; ++i) drawn.push_back(source.draw(classes_[shape][source.draw_class()].value));
    for (GridPair& pair : drawn) {
      if (below(2) == 0) std::swap(pair.a, pair.b);
    }
    const auto map = static_cast<Map>(below(64) == 0 ? std::size_t{doubles} : below(doubles));
    const auto scale = static_cast<Scale>(map == doubles || below(2) == 0 ? std::size_t{one} : below(scale_count));
    Body a, b;
    Place at_a, at_b;
    if (map == undone) {
      at_a.linear = unimodular();
      at_b.linear = unimodular();
      const Place from_a{inverse(at_a.linear), Vector::Zero()}, from_b{inverse(at_b.linear), Vector::Zero()};
      for (const GridPair& pair : drawn) {
        a.faces.push_back(moved(pair.a, from_a));
        b.faces.push_back(moved(pair.b, from_b));
      }
    } else {
      for (const GridPair& pair : drawn) {
        a.faces.push_back(pair.a);
        b.faces.push_back(pair.b);
      }
    }
    const int world = exponent(scale);
    a.exponent = exponent_of_body(scale, world);
    b.exponent = exponent_of_body(scale, world);
    const Mesh mesh_a = mesh_of(a.faces, a.exponent), mesh_b = mesh_of(b.faces, b.exponent);
    const Object object_a(mesh_a), object_b(mesh_b);
    std::vector<PosePair> poses;
    std::vector<std::vector<Contact>> truths;
    Counted& row = table.rows[static_cast<std::size_t>(map) * scale_count + static_cast<std::size_t>(scale)];
    for (int n = 0; n < 8; ++n) {
      if (map == doubles) {
        poses.push_back(any_doubles(mesh_a, mesh_b));
        truths.push_back(brute_force_contacts(mesh_a, poses.back().a, mesh_b, poses.back().b));
        row.pairs += count * count;
        for (const Contact& contact : truths.back()) ++row.relations[static_cast<std::size_t>(*contact.relation)];
        row.relations[0] += count * count - truths.back().size();
        continue;
      }
      if (map == undone) {
        at_a.translation = at_b.translation = any_vector(1 << below(28));
      } else {
        at_a.linear = linear(map);
        at_b.linear = linear(below(4) == 0 ? static_cast<Map>(below(doubles)) : map);
        at_a.translation = any_vector(1 << below(28));
        meet(a, at_a, b, at_b);
      }
      poses.push_back({at_a.pose(a.exponent, world), at_b.pose(b.exponent, world)});
      truths.push_back(truth(a, at_a, b, at_b, row));
    }
    pairs += count * count * poses.size();
    row.queries += poses.size();
    const std::vector<CollisionResult> batch = collide(*device_, object_a, object_b, poses, request_);
    for (std::size_t n = 0; n < poses.size(); ++n) {
      const CollisionResult answer = collide(*device_, object_a, poses[n].a, object_b, poses[n].b, request_);
      row.open += answer.stats.open;
      const CollisionResult plain = collide(*plain_, object_a, poses[n].a, object_b, poses[n].b, request_);
      if (is(answer, truths[n]) && is(batch[n], truths[n]) && is(plain, truths[n])) continue;
      ++row.wrong;
      table.examples.add(part, example(mesh_a, mesh_b, poses[n], truths[n], answer));
    }
  }

 private:
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
  std::int64_t within(std::int64_t most) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(2 * most + 1)) - most;
  }
  Vector any_vector(std::int64_t most) { return {within(most), within(most), within(most)}; }

  Matrix turn() {
    Matrix m = Matrix::Zero();
    std::array<Eigen::Index, 3> axes = {0, 1, 2};
    std::shuffle(axes.begin(), axes.end(), random_);
    for (std::size_t i = 0; i < 3; ++i) m(static_cast<Eigen::Index>(i), axes[i]) = below(2) == 0 ? 1 : -1;
    return m;
  }
  static std::int64_t determinant(const Matrix& m) { return m.row(0).dot(m.row(1).cross(m.row(2))); }
  Matrix unimodular() {
    Matrix m = turn();
    for (std::size_t n = below(4); n > 0; --n) {
      const auto i = static_cast<Eigen::Index>(below(3));
      m.row(i) += within(3) * m.row((i + 1 + static_cast<Eigen::Index>(below(2))) % 3);
    }
    return m;
  }
  static Matrix inverse(const Matrix& m) {
    Matrix result;
    for (Eigen::Index i = 0; i < 3; ++i) {
      result.col(i) = determinant(m) * m.row((i + 1) % 3).cross(m.row((i + 2) % 3)).transpose();
    }
    return result;
  }
  Matrix linear(Map map) {
    Matrix m = turn();
    switch (map) {
      case turned:
      case mirrored:
        if ((determinant(m) < 0) != (map == mirrored)) m.row(0) *= -1;
        break;
      case flat:
        for (Eigen::Index i = 0; i < 2; ++i) m.row(i) = any_vector(3).transpose();
        m.row(2) = within(2) * m.row(0) + within(2) * m.row(1);
        break;
      case line:
        m.row(0) = any_vector(3).transpose() * static_cast<std::int64_t>(below(5) != 0);
        m.row(1) = within(2) * m.row(0);
        m.row(2) = within(2) * m.row(0);
        break;
      default:
        for (Eigen::Index i = 0; i < 3; ++i) m.row(i) = any_vector(4).transpose();
    }
    return m;
  }

  /// Moves B so that a vertex of B comes to one of A, to the middle of an edge, or a step beside it, or anywhere near.
  void meet(const Body& a, const Place& at_a, const Body& b, Place& at_b) {
    const GridPrimitive& p = a.faces[below(a.faces.size())];
    const GridPrimitive& q = b.faces[below(b.faces.size())];
    at_b.translation.setZero();
    const Vector at = at_a.of(p.v[below(p.vertex_count())]);
    const Vector to = at_a.of(p.v[below(p.vertex_count())]);
    Vector target = at;
    if (below(2) == 0) target = (at + to) / 2;
    switch (below(4)) {
      case 0:
        break;
      case 1:
        target += any_vector(1);
        break;
      case 2:
        target[static_cast<Eigen::Index>(below(3))] += within(1);
        break;
      default:
        target += any_vector(1 + (to - at).cwiseAbs().maxCoeff());
    }
    at_b.translation = target - at_b.of(q.v[below(q.vertex_count())]);
  }

  /// Of the world's integers.
  int exponent(Scale scale) {
    switch (scale) {
      case huge:
        return 200 + static_cast<int>(below(268));
      case tiny:
        return -300 - static_cast<int>(below(600));
      case subnormal:
        return -1074 + static_cast<int>(below(60));
      default:
        return 0;
    }
  }
  /// Of a mesh in it: entries of the map have the difference, and may be as large as 2^500.
  int exponent_of_body(Scale scale, int world) {
    if (scale == one) return 0;
    const int least = std::max(-1074, world - 490), most = std::min(960, world + 1074);
    return least + static_cast<int>(below(static_cast<std::size_t>(most - least + 1)));
  }

  /// By integers alone.
  std::vector<Contact> truth(const Body& a, const Place& at_a, const Body& b, const Place& at_b, Counted& row) const {
    std::vector<Contact> contacts;
    for (std::uint32_t i = 0; i < a.faces.size(); ++i) {
      for (std::uint32_t k = 0; k < b.faces.size(); ++k) {
        const GridPair pair{moved(a.faces[i], at_a), moved(b.faces[k], at_b)};
        const Relation relation = exact_relation(pair);
        ++row.relations[static_cast<std::size_t>(relation)];
        ++row.pairs;
        if (relation != Relation::apart) contacts.push_back({i, k, relation});
      }
    }
    return contacts;
  }

  PosePair any_doubles(const Mesh& a, const Mesh& b) {
    PosePair poses;
    const auto any = [&](const Mesh& mesh) {
      const auto c = cchip_test::pose_classes[below(std::size(cchip_test::pose_classes))];
      return cchip_test::random_pose(c, mesh.vertices.front().norm() + 1, random_);
    };
    poses.a = any(a);
    poses.b = any(b);
    // a vertex of B into a face of A, in the last bit or the one before
    const Mesh::Face& face = a.faces[below(a.faces.size())];
    const Mesh::Face& other = b.faces[below(b.faces.size())];
    std::array<double, 3> weight{};
    double sum = 0;
    for (double& w : weight) sum += w = static_cast<double>(below(3));
    Vec3d target = Vec3d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      target += (sum == 0 ? i == 0 : weight[i] / sum) * (poses.a * a.vertices[face.vertex[i]]);
    }
    const Vec3d vertex = poses.b.linear() * b.vertices[other.vertex[below(3)]];
    poses.b.translation() = target - vertex;
    for (double& x : poses.b.translation()) {
      for (std::size_t n = below(3); n > 0; --n) x = std::nextafter(x, below(2) == 0 ? -INFINITY : INFINITY);
    }
    return poses;
  }

  static bool is(const CollisionResult& answer, const std::vector<Contact>& truth) {
    Relation relation = Relation::apart;
    for (const Contact& contact : truth) relation = std::max(relation, *contact.relation);
    return answer.contacts == truth && answer.hit == !truth.empty() && answer.relation == relation;
  }

  static std::string example(const Mesh& a, const Mesh& b, const PosePair& poses, const std::vector<Contact>& truth,
                             const CollisionResult& answer) {
    std::string text = fmt::format("{} contacts, {} answered;", truth.size(), answer.contacts.size());
    const auto add = [&](const char* name, const Mesh& mesh, const Pose& pose) {
      text += fmt::format(" {}:", name);
      for (const Vec3d& v : mesh.vertices) text += fmt::format(" ({:a}, {:a}, {:a})", v.x(), v.y(), v.z());
      text += " pose";
      for (Eigen::Index i = 0; i < 3; ++i) {
        for (Eigen::Index k = 0; k < 4; ++k) text += fmt::format(" {:a}", pose.matrix()(i, k));
      }
    };
    add("A", a, poses.a);
    add("B", b, poses.b);
    return text;
  }

  std::mt19937_64 random_;
  const CollideOptions& options_;
  std::vector<PairSource> sources_;
  std::vector<std::vector<PairClassInfo>> classes_;
  CollisionRequest request_;
  std::unique_ptr<Device> device_ = open_cpu_device({1, ""});
  std::unique_ptr<Device> plain_ = open_cpu_device({1, "plain"});
};

}  // namespace

int run_collide(const CollideOptions& options) {
  const StopWatch watch;
  const std::vector<ShapeInfo> shapes = options.shapes();
  const auto table = sum_of_parts<Table<Counted>>(part_count(options.pairs), options.threads, [&](std::uint64_t part) {
    Table<Counted> counted(map_count * scale_count);
    Scene scene(options, shapes, options.seed_of(part));
    for (std::uint64_t pairs = 0; pairs < pairs_of_part(options.pairs, part);) scene.run(counted, part, pairs);
    return counted;
  });
  fmt::print("seed={} coord_w={}\n{:<27} {:<9} {:>10} {:>11} {:>11} {:>11} {:>11} {:>9} {:>6}\n", options.seed,
             options.coord_w, "map", "scale", "queries", "pairs", "apart", "touching", "crossing", "open", "wrong");
  const auto print = [](const char* map, const char* scale, const Counted& row) {
    fmt::print("{:<27} {:<9} {:>10} {:>11} {:>11} {:>11} {:>11} {:>9} {:>6}\n", map, scale, row.queries, row.pairs,
               row.relations[0], row.relations[1], row.relations[2], row.open, row.wrong);
  };
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].queries > 0) print(map_names[i / scale_count], scale_names[i % scale_count], table.rows[i]);
  }
  const Counted sum = table.sum();
  print("all", "", sum);
  table.examples.print();
  fmt::print("queries={} pairs={} apart={} touching={} crossing={} wrong={} seconds={:.1f} seed={}\n", sum.queries,
             sum.pairs, sum.relations[0], sum.relations[1], sum.relations[2], sum.wrong, watch.seconds(), options.seed);
  Goals goals;
  options.check(goals, sum.pairs, sum.relations[1] + sum.relations[2]);
  return sum.wrong != 0 || goals.missed() ? wrong_result : 0;
}

}  // namespace cchip::campaign
