// SPDX-License-Identifier: Apache-2.0
// Queries: from two posed objects to the chip's answer, by the functional model, against exact arithmetic.
#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/model/broad_phase.hpp>
#include <cchip/internal/model/leaf_pair.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <set>

#include "bvh_meshes.hpp"

using namespace cchip;
using namespace cchip::bvh;
using namespace cchip::testing;
using Eigen::Affine3d;
using Big = boost::multiprecision::cpp_int;

namespace {

/// Rounded to a grid on which poses times vertices have no rounding error in doubles.
Vec3d on_grid(const Vec3d& v) { return (v * 0x1p20).array().round().matrix() * 0x1p-20; }
Mesh on_grid(Mesh mesh) {
  for (Vec3d& v : mesh.vertices) v = on_grid(v);
  return mesh;
}
Affine3d on_grid(Affine3d pose) {
  pose.matrix() = (pose.matrix() * 0x1p20).array().round().matrix() * 0x1p-20;
  return pose;
}

struct Body {
  Mesh mesh;
  Tree tree;
  Image image;
  explicit Body(const Mesh& m) : mesh(on_grid(m)), tree(build_tree(mesh)), image(make_image(mesh, tree)) {}
};

Primitive moved(const Affine3d& pose, Primitive p) {
  for (Vec3d& v : p.v) v = pose * v;
  return p;
}

using FacePairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// Every pair of faces, exactly.
FacePairs brute_force(const Body& a, const Affine3d& pose_a, const Body& b, const Affine3d& pose_b) {
  FacePairs found;
  std::vector<std::pair<Primitive, Dop26>> others;
  for (std::size_t j = 0; j < b.mesh.faces.size(); ++j) {
    const Primitive q = moved(pose_b, b.mesh.primitive(j));
    others.emplace_back(q, make_dop26(q));
  }
  for (std::uint32_t i = 0; i < a.mesh.faces.size(); ++i) {
    const Primitive p = moved(pose_a, a.mesh.primitive(i));
    const Dop26 dop = make_dop26(p);
    for (std::uint32_t j = 0; j < others.size(); ++j) {
      if (overlap(dop, others[j].second) && exact_intersects(p, others[j].first)) found.emplace(i, j);
    }
  }
  return found;
}

/// The same by descending both trees with the bounding boxes of the moved boxes: slow, loose and simple.
FacePairs descend(const Body& a, const Affine3d& pose_a, const Body& b, const Affine3d& pose_b) {
  struct Box {
    Vec3d least;
    Vec3d greatest;
  };
  const auto box_of = [](const TreeNode& node, const Affine3d& pose) {
    Box box{Vec3d::Constant(1e300), Vec3d::Constant(-1e300)};
    for (unsigned corner = 0; corner < 8; ++corner) {
      Vec3d v;
      for (unsigned i = 0; i < 3; ++i) v[i] = (corner >> i & 1U) != 0 ? node.dop.greatest[i] : node.dop.least[i];
      const Vec3d at = pose * v;
      box.least = box.least.cwiseMin(at);
      box.greatest = box.greatest.cwiseMax(at);
    }
    const double margin = 0x1p-40 * (1 + box.least.cwiseAbs().maxCoeff() + box.greatest.cwiseAbs().maxCoeff());
    return Box{box.least.array() - margin, box.greatest.array() + margin};
  };
  FacePairs found;
  const std::function<void(std::size_t, std::size_t)> visit = [&](std::size_t i, std::size_t j) {
    const TreeNode& p = a.tree.nodes[i];
    const TreeNode& q = b.tree.nodes[j];
    const Box x = box_of(p, pose_a);
    const Box y = box_of(q, pose_b);
    if ((x.least.array() > y.greatest.array()).any() || (y.least.array() > x.greatest.array()).any()) return;
    const bool p_inner = p.kind == NodeKind::inner;
    const bool q_inner = q.kind == NodeKind::inner;
    for (std::size_t k = 0; k < (p_inner ? p.count : 1); ++k) {
      for (std::size_t l = 0; l < (q_inner ? q.count : 1); ++l) {
        if (p_inner || q_inner) visit(p_inner ? p.first + k : i, q_inner ? q.first + l : j);
      }
    }
    if (p_inner || q_inner) return;
    for (std::size_t k = 0; k < p.count; ++k) {
      for (std::size_t l = 0; l < q.count; ++l) {
        const std::uint32_t face_a = a.tree.faces[p.first + k];
        const std::uint32_t face_b = b.tree.faces[q.first + l];
        if (exact_intersects(moved(pose_a, a.mesh.primitive(face_a)), moved(pose_b, b.mesh.primitive(face_b)))) {
          found.emplace(face_a, face_b);
        }
      }
    }
  };
  visit(0, 0);
  return found;
}

struct Posed {
  Affine3d a;
  Affine3d b;
  bool sheared = false;  ///< objects of like sizes may then be for the host, whichever plays A
};

/// Poses of many classes; in some the objects touch without depth, coplanar faces included.
Posed random_poses(std::mt19937_64& random, const Mesh& a, const Mesh& b) {
  const auto rotation = [&random] {
    std::normal_distribution<double> normal;
    const double w = normal(random);
    const double x = normal(random);
    const double y = normal(random);
    return Eigen::Quaterniond(w, x, y, normal(random)).normalized().toRotationMatrix();
  };
  const auto permutation = [&random] {
    Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
    const auto first = static_cast<Eigen::Index>(random() % 3);
    const bool flip = random() % 2 == 0;
    for (Eigen::Index i = 0; i < 3; ++i) m(i, (flip ? first + 2 * i : first + i) % 3) = random() % 2 == 0 ? 1 : -1;
    return m;
  };
  Posed pose{Affine3d::Identity(), Affine3d::Identity()};
  const std::uint64_t kind = random() % 8;
  if (kind < 4) pose.a.linear() = rotation();
  if (kind < 3) pose.b.linear() = rotation();
  if (kind == 2) pose.a.linear() *= 0.3 + 0.1 * static_cast<double>(random() % 20);
  pose.sheared = kind == 3;
  if (pose.sheared) {
    for (Eigen::Index i = 0; i < 3; ++i) pose.b.linear().row(i) += random_vector(random, 0.3).transpose();
  }
  if (kind >= 4 && kind < 7) pose.a.linear() = permutation();
  if (kind == 6) pose.b.linear() = permutation();
  pose.a = on_grid(pose.a);
  pose.b = on_grid(pose.b);
  // a vertex of A onto a vertex of B, and a move, often none
  const Vec3d va = pose.a * a.vertices[random() % a.vertices.size()];
  const Vec3d vb = pose.b * b.vertices[random() % b.vertices.size()];
  const std::array<double, 4> moves = {0, 0, 0.01, 1};
  pose.a.translation() = vb - va + on_grid(random_vector(random, moves[random() % moves.size()]));
  return pose;
}

model::BroadPhaseResult ask(const Body& a, const Body& b, const Posed& pose, QueryMode mode,
                            const model::BroadPhaseOptions& options = {}) {
  std::optional<Query> query = make_query(a.image.header(), pose.a, b.image.header(), pose.b);
  REQUIRE(query);
  query->mode = mode;
  query->tag = 77;
  const Query sent = decode_query(encode(*query));
  return sent.swapped ? model::run_query(sent, b.image, a.image, options)
                      : model::run_query(sent, a.image, b.image, options);
}

struct Tally {
  std::size_t queries = 0;
  std::size_t touching = 0;
  std::size_t open = 0;
  std::size_t pairs = 0;
  std::size_t to_host = 0;
  std::size_t refused = 0;
};

/// Open pairs are resolved exactly, like the host does; then ALL must give the pairs that meet, and FIRST whether any
/// does.
void check_query(const Body& a, const Body& b, const Posed& pose, const FacePairs& truth, std::mt19937_64& random,
                 Tally& tally) {
  if (pose.sheared && !make_query(a.image.header(), pose.a, b.image.header(), pose.b)) {
    ++tally.refused;
    return;
  }
  const model::BroadPhaseResult all = ask(a, b, pose, QueryMode::all);
  REQUIRE(all.done.code == QueryCode::ok);
  FacePairs found;
  FacePairs reported;
  for (const PairRecord& pair : all.pairs) {
    const std::pair<std::uint32_t, std::uint32_t> ids = {pair.id_a, pair.id_b};
    REQUIRE(reported.insert(ids).second);
    const bool meet = truth.count(ids) != 0;
    if (pair.definite) REQUIRE(meet);
    if (meet) found.insert(ids);
    tally.open += pair.definite ? 0 : 1;
  }
  const bool equal = found == truth;  // keep the sets themselves out of the message
  REQUIRE(equal);
  model::BroadPhaseOptions shuffled;
  shuffled.random_order = &random;
  shuffled.stack = 1000000;
  const model::BroadPhaseResult other = ask(a, b, pose, QueryMode::all, shuffled);
  FacePairs again;
  for (const PairRecord& pair : other.pairs) again.emplace(pair.id_a, pair.id_b);
  const bool same = again == reported;
  REQUIRE(same);
  REQUIRE(other.counts.steps == all.counts.steps);
  REQUIRE(other.counts.box_tests == all.counts.box_tests);
  REQUIRE(other.counts.leaf_pairs == all.counts.leaf_pairs);
  REQUIRE(other.counts.primitive_pairs == all.counts.primitive_pairs);
  REQUIRE(other.counts.open_pairs == all.counts.open_pairs);

  const model::BroadPhaseResult first = ask(a, b, pose, QueryMode::first);
  if (first.done.code == QueryCode::host) {
    ++tally.to_host;
  } else {
    REQUIRE(first.done.code == QueryCode::ok);
    bool answer = first.done.answer == QueryAnswer::yes;
    if (first.done.answer == QueryAnswer::open) {
      for (const PairRecord& pair : first.pairs) answer = answer || truth.count({pair.id_a, pair.id_b}) != 0;
    }
    REQUIRE(answer == !truth.empty());
  }
  ++tally.queries;
  tally.touching += truth.empty() ? 0 : 1;
  tally.pairs += all.counts.primitive_pairs;
}

/// x 2^200
Big fixed(double x) {
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  return mantissa == 0 ? Big(0) : Big(mantissa) << static_cast<unsigned>(exponent - 53 + 200);
}

}  // namespace

TEST_CASE("query: descriptors and records keep every field", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  for (int n = 0; n < 1000; ++n) {
    Line line = {};
    for (const Field& f : query_field::all) {
      for (std::size_t i = 0; i < f.count; ++i) put(line, f, static_cast<std::int64_t>(random()), i);
    }
    REQUIRE(encode(decode_query(line)) == line);
    const auto word = [&random] { return static_cast<std::uint32_t>(random()); };
    const PairRecord pair = {word(), word(), word(), random() % 2 == 0};
    REQUIRE(decode_pair(encode(pair)) == pair);
    REQUIRE_FALSE(is_done(encode(pair)));
    const DoneRecord done = {word(), QueryCode::stack, static_cast<QueryAnswer>(random() % 3), word(), word()};
    const RecordBytes bytes = encode(done);
    REQUIRE(is_done(bytes));
    const DoneRecord again = decode_done(bytes);
    REQUIRE(again.tag == done.tag);
    REQUIRE(again.code == done.code);
    REQUIRE(again.answer == done.answer);
    REQUIRE(again.steps == done.steps);
    REQUIRE(again.pairs == done.pairs);
  }
}

TEST_CASE("query: the map is within its error bound of the poses, exactly", "[ref]") {
  // B's map undone: with r = PB (cB + 2^eB v) + pB - (PA (cA + 2^eA u) + pA), the position v of u is off by PB^-1 r
  // 2^-eB, and PB^-1 = adjugate / determinant.
  std::mt19937_64 random(sim::seed_from_environment());
  std::size_t none = 0;
  std::size_t exact = 0;
  std::size_t swapped = 0;
  for (int n = 0; n < 3000; ++n) {
    Posed pose{Affine3d::Identity(), Affine3d::Identity()};
    HeaderLine a;
    HeaderLine b;
    a.exponent = static_cast<int>(random() % 12) - 6;
    b.exponent = a.exponent + static_cast<int>(random() % 12) - 6;
    for (HeaderLine* h : {&a, &b}) h->centre = n % 4 == 0 ? Vec3d(1, -2.5, 3) : random_vector(random, 8);
    for (Affine3d* p : {&pose.a, &pose.b}) {
      if (n % 4 != 0) {
        std::uniform_real_distribution<double> entry(-1, 1);
        for (Eigen::Index i = 0; i < 9; ++i)
          p->linear()(i / 3, i % 3) += n % 4 == 1 ? entry(random) : 1e-7 * entry(random);
        p->translation() = random_vector(random, 4);
      }
    }
    const std::optional<Query> query = make_query(a, pose.a, b, pose.b);
    if (!query) {
      ++none;
      continue;
    }
    exact += query->error == 0 ? 1 : 0;
    if (query->swapped) {
      std::swap(a, b);
      std::swap(pose.a, pose.b);
      ++swapped;
    }
    const bool clamped = std::any_of(query->t.begin(), query->t.end(),
                                     [](std::int64_t t) { return std::abs(t) >= std::int64_t{1} << 34; });
    if (clamped) continue;
    for (unsigned corner = 0; corner < 8; ++corner) {
      // everything in 2^-200 of the mesh's unit, products in 2^-400
      std::array<Big, 3> x_a;
      std::array<Big, 3> x_b;
      for (unsigned i = 0; i < 3; ++i) {
        const double u = (corner >> i & 1U) != 0 ? 0.5 : -0.5;
        x_a[i] = fixed(a.centre[i]) + fixed(std::ldexp(u, a.exponent));
        Big v = fixed(std::ldexp(static_cast<double>(query->t[i]), b.exponent - query_t_fraction));
        for (unsigned j = 0; j < 3; ++j) {
          const double uj = (corner >> j & 1U) != 0 ? 0.5 : -0.5;
          v += fixed(std::ldexp(query->m[i][j] * uj, b.exponent - query_m_fraction - query->shift));
        }
        x_b[i] = fixed(b.centre[i]) + v;
      }
      std::array<Big, 3> r;
      std::array<std::array<Big, 3>, 3> p;
      for (unsigned i = 0; i < 3; ++i) {
        r[i] = (fixed(pose.b(i, 3)) - fixed(pose.a(i, 3))) << 200U;
        for (unsigned j = 0; j < 3; ++j) {
          p[i][j] = fixed(pose.b(i, j));
          r[i] += p[i][j] * x_b[j] - fixed(pose.a(i, j)) * x_a[j];
        }
      }
      const auto minor = [&p](unsigned i, unsigned j) {
        return Big(p[(i + 1) % 3][(j + 1) % 3] * p[(i + 2) % 3][(j + 2) % 3] -
                   p[(i + 1) % 3][(j + 2) % 3] * p[(i + 2) % 3][(j + 1) % 3]);
      };
      Big determinant = 0;
      for (unsigned j = 0; j < 3; ++j) determinant += p[0][j] * minor(0, j);
      const Big bound = abs(determinant) * fixed(std::ldexp(query->error, b.exponent - query_error_fraction));
      for (unsigned i = 0; i < 3; ++i) {
        Big off = 0;
        for (unsigned j = 0; j < 3; ++j) off += minor(j, i) * r[j];  // 2^-800, like determinant times a length
        const bool within = abs(off) <= bound;
        REQUIRE(within);
      }
    }
  }
  REQUIRE(none < 1000);
  REQUIRE(exact > 500);
  REQUIRE(swapped > 500);
}

TEST_CASE("query: what the chip does not take", "[ref]") {
  const HeaderLine unit;
  const Affine3d same = Affine3d::Identity();
  REQUIRE(make_query(unit, same, unit, same));
  HeaderLine other;
  other.exponent = 15;
  REQUIRE(make_query(unit, same, other, same)->shift == 15);
  REQUIRE(make_query(other, same, unit, same)->swapped);
  other.exponent = 80;
  REQUIRE_FALSE(make_query(unit, same, other, same));
  Affine3d singular = same;
  singular.linear().row(1) = singular.linear().row(0);
  REQUIRE_FALSE(make_query(unit, same, unit, singular));
  Affine3d bad = same;
  bad(0, 3) = std::nan("");
  REQUIRE_FALSE(make_query(unit, bad, unit, same));
  bad(0, 3) = 1e308;
  bad.linear() *= 1e308;
  REQUIRE_FALSE(make_query(unit, bad, unit, same));
}

TEST_CASE("broad phase: small meshes, all classes of poses, equal to brute force", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::vector<Body> objects;
  objects.emplace_back(make_torus(1, 0.4, 8, 6));
  objects.emplace_back(noisy(make_torus(1, 0.4, 7, 5, Kind::quad), 0.02, random));
  objects.emplace_back(make_torus(1, 0.4, 8, 4, Kind::quad));
  objects.emplace_back(make_gear(0.7, 1, 0.3, 0.4, 5, 1));
  objects.emplace_back(soup(40, false, random));
  objects.emplace_back(soup(40, true, random));
  Mesh one;
  add_face(one, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  objects.emplace_back(one);
  Mesh small = make_torus(1, 0.4, 6, 5);
  for (Vec3d& v : small.vertices) v *= 1e-3;
  objects.emplace_back(small);
  Mesh cube;
  for (int side = 0; side < 6; ++side) {
    const auto point = [side](double u, double v) {
      Vec3d p;
      p[side % 3] = side < 3 ? 0 : 1;
      p[(side + 1) % 3] = u;
      p[(side + 2) % 3] = v;
      return p;
    };
    add_face(cube, {point(0, 0), point(1, 0), point(1, 1), point(0, 1)});
  }
  objects.emplace_back(cube);
  Tally tally;
  for (int n = 0; n < 4000; ++n) {
    const Body& a = objects[random() % objects.size()];
    const Body& b = random() % 4 == 0 ? a : objects[random() % objects.size()];
    const Posed pose = random_poses(random, a.mesh, b.mesh);
    const FacePairs truth = brute_force(a, pose.a, b, pose.b);
    check_query(a, b, pose, truth, random, tally);
    if (n % 20 == 0) REQUIRE(descend(a, pose.a, b, pose.b) == truth);
  }
  CAPTURE(tally.queries, tally.touching, tally.open, tally.pairs, tally.to_host);
  CHECK(tally.touching > 1000);
  CHECK(tally.touching < 3800);
  CHECK(tally.to_host < 1000);
  WARN("queries=" << tally.queries << " touching=" << tally.touching << " primitive_pairs=" << tally.pairs
                  << " open=" << tally.open << " to_host=" << tally.to_host << " refused=" << tally.refused);
}

TEST_CASE("broad phase: differences of vertices are within eta of the exact ones", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::vector<Body> bodies;
  bodies.emplace_back(noisy(make_torus(1, 0.4, 20, 12), 0.02, random));
  bodies.emplace_back(noisy(make_torus(1, 0.4, 20, 12, Kind::quad), 0.02, random));
  bodies.emplace_back(soup(100, true, random));
  std::array<std::size_t, 16> etas = {};
  for (int n = 0; n < 20000; ++n) {
    const Body& a = bodies[random() % bodies.size()];
    const Body& b = bodies[random() % bodies.size()];
    Posed pose = random_poses(random, a.mesh, b.mesh);
    pose.b = Affine3d::Identity();  // positions in B's frame, and their differences, are exact doubles then
    const HeaderLine header_b = b.image.header();
    const std::optional<Query> query = make_query(a.image.header(), pose.a, header_b, pose.b);
    if (!query || query->swapped) continue;
    const auto leaf_of = [&random](const Body& body, NodeKind& kind) {
      std::size_t i = 0;
      do i = random() % body.tree.nodes.size();
      while (body.tree.nodes[i].kind == NodeKind::inner);
      kind = body.tree.nodes[i].kind;
      return decode_leaf(body.image.lines[i + 1], kind);
    };
    NodeKind kind_a{};
    NodeKind kind_b{};
    const LeafLine leaf_a = leaf_of(a, kind_a);
    const LeafLine leaf_b = leaf_of(b, kind_b);
    const model::MovedLeaves moved_leaves = model::move_leaves(leaf_a, kind_a, leaf_b, kind_b, *query);
    const GridPair pair = model::normalise(moved_leaves, kind_a, 0, kind_b, 0, 16);
    if (!moved_leaves.open) ++etas[static_cast<std::size_t>(pair.eta)];
    struct Vertex {
      Vec3d exact;
      std::array<std::int64_t, 3> units;
      Vec3i grid;
    };
    std::vector<Vertex> vertices;
    for (std::size_t i = 0; i < pair.a.vertex_count(); ++i) {
      vertices.push_back({pose.a * a.mesh.primitive(leaf_a.id[0]).v[i], moved_leaves.a.vertex[i], pair.a.v[i]});
    }
    for (std::size_t i = 0; i < pair.b.vertex_count(); ++i) {
      vertices.push_back({b.mesh.primitive(leaf_b.id[0]).v[i], moved_leaves.b.vertex[i], pair.b.v[i]});
    }
    // The grid's step, from the span of the vertices in units.
    std::int64_t span = 0;
    for (const Vertex& p : vertices) {
      for (const Vertex& q : vertices) {
        for (std::size_t i = 0; i < 3; ++i) span = std::max(span, p.units[i] - q.units[i]);
        REQUIRE(std::abs(p.units[0]) < std::int64_t{1} << (model::moved_w - 1));
      }
    }
    int shift = 0;
    while ((shift > 0 ? span + (std::int64_t{1} << (shift - 1)) : span) >> shift > 65535) ++shift;
    const int extent = std::max({leaf_a.extent - query->shift, leaf_b.extent, model::extent_least});
    const double step = std::ldexp(1.0, shift + extent - 48 + header_b.exponent);
    for (const Vertex& p : vertices) {
      REQUIRE(p.grid.minCoeff() >= -32768);
      REQUIRE(p.grid.maxCoeff() <= 32767);
      for (const Vertex& q : vertices) {
        const Vec3d grid = (p.grid - q.grid).cast<double>();
        const Vec3d exact = (p.exact - q.exact) / step;
        REQUIRE((grid - exact).cwiseAbs().maxCoeff() <= pair.eta);
      }
    }
  }
  WARN("eta 0: " << etas[0] << ", 1: " << etas[1] << ", 2: " << etas[2] << ", 3: " << etas[3]);
  REQUIRE(etas[0] > 10);
  REQUIRE(etas[2] > 1000);
}

TEST_CASE("broad phase: quads that rounding bends get no wrong definite answer", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::size_t definite = 0;
  std::size_t open = 0;
  for (int n = 0; n < 10000; ++n) {
    // A planar quad with a corner that hardly stands out, by less than a step of the pair's grid or by many.
    const double bulge = std::ldexp(1.0, -static_cast<int>(random() % 19));
    Mesh quad;
    const Vec3d u = random_vector(random, 1);
    const Vec3d v = random_vector(random, 1);
    const Vec3d from = random_vector(random, 1);
    const auto at = [&](double x, double y) { return Vec3d(from + x * u + y * v); };
    std::vector<Vec3d> corners = {at(0, 0), at(0.5, -bulge), at(1, 0), at(0.5, 1)};
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(random() % 4), corners.end());
    add_face(quad, corners);
    // A triangle or quad that crosses its plane near that corner.
    Mesh other;
    const Vec3d w = u.cross(v);
    const Vec3d tip = at(0.5, -2 * bulge * std::uniform_real_distribution<double>(0, 1)(random));
    std::vector<Vec3d> points = {tip, tip - v + w + 0.1 * u, tip - v - w};
    if (random() % 2 == 0) points.push_back(tip - w);
    add_face(other, points);
    const Body a(quad);
    const Body b(other);
    const Posed pose{Affine3d::Identity(), Affine3d::Identity()};
    Posed turned = random_poses(random, a.mesh, b.mesh);
    turned.a.translation().setZero();
    if (turned.sheared) continue;
    turned.b = turned.a;
    for (const Posed& p : {pose, turned}) {
      if (!make_query(a.image.header(), p.a, b.image.header(), p.b)) continue;
      const FacePairs truth = brute_force(a, p.a, b, p.b);
      const model::BroadPhaseResult result = ask(a, b, p, QueryMode::all);
      REQUIRE(result.done.code == QueryCode::ok);
      const bool hit = !truth.empty();
      if (result.done.answer == QueryAnswer::yes) REQUIRE(hit);
      if (result.done.answer == QueryAnswer::no) REQUIRE_FALSE(hit);
      ++(result.done.answer == QueryAnswer::open ? open : definite);
    }
  }
  WARN("definite=" << definite << " open=" << open);
  REQUIRE(definite > 1000);
  REQUIRE(open > 100);
}

TEST_CASE("broad phase: limits and lines that make no sense end a query with a code", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Body torus(noisy(make_torus(1, 0.4, 30, 20), 0.01, random));
  Posed pose{Affine3d::Identity(), Affine3d::Identity()};
  pose.a.translation() = Vec3d(0.25, 0, 0);
  const Query query = [&] {
    Query q = *make_query(torus.image.header(), pose.a, torus.image.header(), pose.b);
    q.mode = QueryMode::all;
    return q;
  }();
  const auto code = [&](const Image& image, const model::BroadPhaseOptions& options = {}) {
    return model::run_query(query, image, image, options).done.code;
  };
  REQUIRE(code(torus.image) == QueryCode::ok);
  model::BroadPhaseOptions options;
  options.step_limit = 10;
  REQUIRE(model::run_query(query, torus.image, torus.image, options).counts.steps == 10);
  REQUIRE(code(torus.image, options) == QueryCode::steps);
  options = {};
  options.stack = 2;
  REQUIRE(code(torus.image, options) == QueryCode::stack);
  Query wrong = query;
  wrong.m[1][1] = (1 << query_m_fraction) + 1;
  REQUIRE(model::run_query(wrong, torus.image, torus.image).done.code == QueryCode::bad_descriptor);
  const auto changed = [&](std::size_t line, const Field& field, std::int64_t value, std::size_t index = 0,
                           std::size_t base = 0) {
    Image image = torus.image;
    put(image.lines[line], field, value, index, base);
    return code(image);
  };
  REQUIRE(changed(0, header_field::magic, 0) == QueryCode::bad_descriptor);
  REQUIRE(changed(0, header_field::version, 9) == QueryCode::bad_descriptor);
  REQUIRE(changed(0, header_field::root, 0xffffff) == QueryCode::outside);
  REQUIRE(changed(1, inner_field::step, 19) == QueryCode::corrupt);
  REQUIRE(changed(1, child_field::box, -64, 1, inner_field::child.lsb) == QueryCode::corrupt);  // greatest < least
  REQUIRE(changed(1, inner_field::first, 1) == QueryCode::outside);
  REQUIRE(changed(1, inner_field::first, 0xffffff) == QueryCode::outside);
  // a query ends for any bits
  for (int n = 0; n < 300; ++n) {
    Image image = torus.image;
    for (int i = 0; i < 20; ++i) {
      const std::size_t bit = 512 + random() % (512 * (image.lines.size() - 1));
      image.lines[bit / 512][bit % 512 / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    }
    options = {};
    options.step_limit = 20000;
    REQUIRE(code(image, options) <= QueryCode::bad_descriptor);
  }
}

TEST_CASE("broad phase: larger meshes, no touching pair is missed", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::vector<Body> objects;
  objects.emplace_back(noisy(make_torus(1, 0.4, 60, 30), 0.01, random));
  objects.emplace_back(noisy(make_torus(1, 0.4, 40, 20, Kind::quad), 0.005, random));
  objects.emplace_back(make_gear(0.7, 1, 0.3, 0.4, 24, 6));
  Tally tally;
  for (int n = 0; n < 60; ++n) {
    const Body& a = objects[random() % objects.size()];
    const Body& b = objects[random() % objects.size()];
    const Posed pose = random_poses(random, a.mesh, b.mesh);
    check_query(a, b, pose, descend(a, pose.a, b, pose.b), random, tally);
  }
  CHECK(tally.touching > 20);
  WARN("queries=" << tally.queries << " touching=" << tally.touching << " primitive_pairs=" << tally.pairs
                  << " open=" << tally.open << " to_host=" << tally.to_host << " refused=" << tally.refused);
}
