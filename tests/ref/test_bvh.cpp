// SPDX-License-Identifier: Apache-2.0
// 26-DOPs, trees of them, and their images.
#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <cchip/internal/image/image.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>

#include "bvh_meshes.hpp"

using namespace cchip;
using namespace cchip::bvh;
using namespace cchip::testing;
using Big = boost::multiprecision::cpp_int;

namespace {

/// x 2^exponent in units of 2^-1300, which all doubles and all steps of leaves are multiples of.
Big fixed(double x, int exponent = 0) {
  int own = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &own), 53));
  return mantissa == 0 ? Big(0) : Big(mantissa) << static_cast<unsigned>(own - 53 + exponent + 1300);
}

using Point = std::array<Big, 3>;

Big along(std::size_t direction, const Point& p) {
  Big sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += directions[direction][i] * p[i];
  return sum;
}

Point exact(const Vec3d& v) { return {fixed(v.x()), fixed(v.y()), fixed(v.z())}; }

/// The vertex relative to the centre of the object, in the mesh's units.
Point from_centre(const Vec3d& v, const HeaderLine& header) {
  Point p = exact(v);
  for (std::size_t i = 0; i < 3; ++i) p[i] -= fixed(header.centre[static_cast<Eigen::Index>(i)]);
  return p;
}

/// Positions of a vertex on the directions in 2^-25 of the object's unit, rounded down and up.
struct Positions {
  std::array<std::int64_t, directions.size()> down;
  std::array<std::int64_t, directions.size()> up;
};

Positions positions_of(const Vec3d& v, const HeaderLine& header) {
  const Point p = from_centre(v, header);
  const Big unit = fixed(1, header.exponent - 25);
  Positions result{};
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const Big position = along(d, p);
    Big down = position / unit;
    if (down * unit > position) --down;
    result.down[d] = static_cast<std::int64_t>(down);
    result.up[d] = result.down[d] + (down * unit == position ? 0 : 1);
  }
  return result;
}

/// The volume of a child as the node's line gives it, in 2^-25.
Positions volume_of(const InnerLine& node, std::size_t child) {
  const ChildVolume& volume = node.child[child];
  Positions result{};
  for (std::size_t d = 0; d < directions.size(); ++d) {
    std::int64_t upper = 0;
    std::int64_t lower = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const int sign = directions[d][i];
      const std::int64_t origin = std::int64_t{node.origin[i]} * 128;
      const std::int64_t least = origin + volume.least[i] * (std::int64_t{2} << node.step);
      const std::int64_t greatest = origin + volume.greatest[i] * (std::int64_t{2} << node.step);
      upper += sign * (sign > 0 ? greatest : least);
      lower += sign * (sign > 0 ? least : greatest);
    }
    if (d >= first_face) {
      const int unit = node.step + node.cut_exponent + (d >= first_corner ? 1 : 0);
      upper -= volume.cut[d - first_face][0] * (std::int64_t{1} << unit);
      lower += volume.cut[d - first_face][1] * (std::int64_t{1} << unit);
    }
    result.down[d] = lower;
    result.up[d] = upper;
  }
  return result;
}

bool holds(const Positions& volume, const Positions& vertex) {
  for (std::size_t d = 0; d < directions.size(); ++d) {
    if (vertex.up[d] > volume.up[d] || vertex.down[d] < volume.down[d]) return false;
  }
  return true;
}

Image image_of(const Mesh& mesh) { return make_image(mesh, build_tree(mesh)); }

/// The image with one field of a line changed and the CRC made right again.
Bytes with_field(const Image& image, std::size_t line, const Field& field, std::int64_t value, std::size_t index = 0,
                 std::size_t base = 0) {
  Image changed = image;
  put(changed.lines[line], field, value, index, base);
  put(changed.lines[0], header_field::crc, image_crc(changed));
  return to_bytes(changed);
}

}  // namespace

TEST_CASE("dop26: every vertex is inside, and no plane is further out than rounding takes it", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  int rounded = 0;
  for (int n = 0; n < 3000; ++n) {
    Primitive p;
    p.kind = random() % 2 == 0 ? Kind::tri : Kind::quad;
    for (Vec3d& v : p.v) {
      for (double& c : v)
        c = std::ldexp(static_cast<double>(random() >> 11U), static_cast<int>(random() % 40)) - 0x1p60;
    }
    const Dop26 dop = make_dop26(p);
    for (std::size_t d = 0; d < directions.size(); ++d) {
      Big least = along(d, exact(p.v[0]));
      Big greatest = least;
      for (std::size_t i = 1; i < p.vertex_count(); ++i) {
        least = std::min(least, along(d, exact(p.v[i])));
        greatest = std::max(greatest, along(d, exact(p.v[i])));
      }
      const bool inside = fixed(dop.least[d]) <= least && fixed(dop.greatest[d]) >= greatest;
      REQUIRE(inside);
      const double ulp = 0x1p-51 * (p.v[0].lpNorm<1>() + p.v[1].lpNorm<1>() + p.v[2].lpNorm<1>() + p.v[3].lpNorm<1>());
      const bool tight = fixed(dop.least[d]) >= least - fixed(ulp) && fixed(dop.greatest[d]) <= greatest + fixed(ulp);
      REQUIRE(tight);
      rounded += fixed(dop.least[d]) != least ? 1 : 0;
    }
  }
  REQUIRE(rounded > 1000);
}

TEST_CASE("dop26: primitives that meet overlap at any scale", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  int hits = 0;
  int apart = 0;
  for (int n = 0; n < 20000; ++n) {
    const double range = std::ldexp(1.0, static_cast<int>(random() % 80) - 40);
    const Vec3d centre = Vec3d(1e3, -2e3, 3e3) * (random() % 2 == 0 ? 0.0 : 1.0);
    const auto primitive = [&] {
      Primitive p;
      p.kind = random() % 2 == 0 ? Kind::tri : Kind::quad;
      for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = centre + random_vector(random, range);
      return p;
    };
    const Primitive p = primitive();
    Primitive q = primitive();
    if (random() % 2 == 0) q.v[1] = p.v[2];  // they touch
    const bool hit = exact_intersects(p, q);
    const bool found = overlap(make_dop26(p), make_dop26(q));
    if (hit) REQUIRE(found);
    hits += hit ? 1 : 0;
    apart += found ? 0 : 1;
  }
  REQUIRE(hits > 5000);
  REQUIRE(apart > 1000);
}

TEST_CASE("dop26: each of the 13 directions separates", "[ref]") {
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const Vec3d n(directions[d][0], directions[d][1], directions[d][2]);
    const Vec3d u = n.unitOrthogonal();
    const Vec3d v = n.cross(u).normalized();
    // two large triangles in parallel planes, a little apart: only their normal tells them apart
    Primitive p;
    p.v = {10 * u, -5 * u + 8 * v, -5 * u - 8 * v, Vec3d::Zero()};
    Primitive q = p;
    for (Vec3d& x : q.v) x += 0.01 * n;
    INFO("direction " << n.transpose());
    REQUIRE_FALSE(overlap(make_dop26(p), make_dop26(q)));
    REQUIRE_FALSE(overlap(make_dop26(q), make_dop26(p)));
    REQUIRE(overlap(make_dop26(p), make_dop26(p)));
    Dop26 without = make_dop26(q);
    without.least[d] = make_dop26(p).least[d];
    REQUIRE(overlap(make_dop26(p), without));
  }
}

TEST_CASE("dop26: an overflow never separates", "[ref]") {
  const double huge = std::numeric_limits<double>::max();
  Primitive p;
  p.v = {Vec3d(huge, huge, huge), Vec3d(huge, huge, 0), Vec3d(0, 0, 0), Vec3d::Zero()};
  Primitive q;
  q.v = {Vec3d(0, 0, 0), Vec3d(huge, 0, huge), Vec3d(huge, huge, huge), Vec3d::Zero()};
  REQUIRE(overlap(make_dop26(p), make_dop26(q)));
  Primitive corner;
  corner.v = {Vec3d(huge, huge, huge), Vec3d(huge, huge, huge), Vec3d(huge, huge, huge), Vec3d::Zero()};
  REQUIRE(overlap(make_dop26(p), make_dop26(corner)));
  REQUIRE(make_dop26(corner).least[9] <= huge);  // 3 huge is more: a lower bound must not become infinite
}

TEST_CASE("tree: every face once, volumes nested, children behind their parent, depth bounded", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::array<std::size_t, 4> kinds = {};
  for (const Mesh& mesh : assorted_meshes(random)) {
    INFO(mesh.name);
    const Tree tree = build_tree(mesh);
    std::vector<int> seen(mesh.faces.size(), 0);
    std::size_t reached = 0;
    int depth = 0;
    const std::function<void(std::size_t, int)> visit = [&](std::size_t number, int level) {
      const TreeNode& node = tree.nodes[number];
      ++reached;
      depth = std::max(depth, level);
      ++kinds[static_cast<std::size_t>(node.kind)];
      for (std::size_t k = 0; k < node.count; ++k) {
        const std::size_t part = node.first + k;
        const bool inner = node.kind == NodeKind::inner;
        if (inner) REQUIRE(part > number);
        const Dop26 dop = inner ? tree.nodes[part].dop : make_dop26(mesh.primitive(tree.faces[part]));
        for (std::size_t d = 0; d < directions.size(); ++d) {
          REQUIRE(node.dop.least[d] <= dop.least[d]);
          REQUIRE(node.dop.greatest[d] >= dop.greatest[d]);
        }
        if (inner) {
          visit(part, level + 1);
        } else {
          ++seen[tree.faces[part]];
          REQUIRE((mesh.faces[tree.faces[part]].kind == Kind::quad) == (node.kind == NodeKind::quad));
        }
      }
      REQUIRE(node.count == (node.kind == NodeKind::inner ? node.count : primitives_in(node.kind)));
    };
    visit(0, 1);
    REQUIRE(tree.nodes[0].kind == NodeKind::inner);
    REQUIRE(reached == tree.nodes.size());
    REQUIRE(std::count(seen.begin(), seen.end(), 1) == static_cast<std::ptrdiff_t>(seen.size()));
    REQUIRE(depth == tree.depth);
    REQUIRE(depth <= tree_depth_max);
    const Tree singles = build_tree(mesh, TreeOptions{0});
    for (const TreeNode& node : singles.nodes) REQUIRE(node.kind != NodeKind::two_triangles);
  }
  for (const std::size_t count : kinds) REQUIRE(count > 100);
}

TEST_CASE("tree: 100,000 coincident faces, and faces in one point", "[ref]") {
  Mesh mesh;
  for (int i = 0; i < 100000; ++i) add_face(mesh, {{0.1, 0, 0}, {1, 0.3, 0}, {0, 1, 0.7}});
  const Tree coincident = build_tree(mesh);
  REQUIRE(coincident.depth <= 18);
  REQUIRE(parse_image(to_bytes(make_image(mesh, coincident))).lines.size() == coincident.nodes.size() + 1);
  for (Vec3d& v : mesh.vertices) v = Vec3d(-0.3, 0.7, 1e-300);
  const Tree point = build_tree(mesh);
  REQUIRE(point.depth <= 18);
  REQUIRE(parse_image(to_bytes(make_image(mesh, point))).lines.size() == point.nodes.size() + 1);
}

TEST_CASE("tree: what has no tree is refused", "[ref]") {
  Mesh mesh;
  REQUIRE_THROWS_WITH(build_tree(mesh), Catch::Contains("no faces"));
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -1e305}) {
    Mesh wrong;
    add_face(wrong, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    add_face(wrong, {{0, 0, 0}, {1, bad, 0}, {0, 1, 0}});
    REQUIRE_THROWS_WITH(build_tree(wrong), Catch::Contains("face 1: vertex 1 is not finite"));
  }
}

TEST_CASE("image: what is read is what was written", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  for (const Mesh& mesh : assorted_meshes(random)) {
    INFO(mesh.name);
    const Image image = image_of(mesh);
    REQUIRE(parse_image(to_bytes(image)).lines == image.lines);
  }
}

TEST_CASE("image: lines keep every value of every field", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const auto any = [&random](const Field& f) {
    const auto bits = static_cast<std::int64_t>(random() >> (64 - f.width));
    return f.is_signed ? bits - (std::int64_t{1} << (f.width - 1)) : bits;
  };
  for (int n = 0; n < 1000; ++n) {
    const auto check = [&](const auto& fields, const auto& again) {
      Line line = {};
      std::vector<std::int64_t> values;
      for (const Field& f : fields) {
        if (f.width > 64) continue;  // a child, made of fields
        for (std::size_t i = 0; i < f.count; ++i) put(line, f, values.emplace_back(any(f)), i);
      }
      std::size_t k = 0;
      for (const Field& f : fields) {
        if (f.width > 64) continue;
        for (std::size_t i = 0; i < f.count; ++i) REQUIRE(get(line, f, i) == values[k++]);
      }
      REQUIRE(again(line) == line);
    };
    check(header_field::all, [](const Line& l) { return encode(decode_header(l)); });
    check(inner_field::all, [](const Line& l) { return encode(decode_inner(l)); });
    namespace f = leaf_field;
    const std::array<Field, 6> triangles = {f::origin, f::extent, f::rounded, f::open, f::id, f::triangle};
    check(triangles,
          [](const Line& l) { return encode(decode_leaf(l, NodeKind::two_triangles), NodeKind::two_triangles); });
    Field one_id = f::id;
    one_id.count = 1;
    const std::array<Field, 6> quad = {f::origin, f::extent, f::rounded, f::open, one_id, f::quad};
    check(quad, [](const Line& l) { return encode(decode_leaf(l, NodeKind::quad), NodeKind::quad); });
    for (std::size_t child = 0; child < 4; ++child) {
      Line line = {};
      const std::size_t base = inner_field::child.lsb + child * inner_field::child.width;
      for (const Field& field : child_field::all) {
        for (std::size_t i = 0; i < field.count; ++i) put(line, field, any(field), i, base);
      }
      REQUIRE(encode(decode_inner(line)) == line);
    }
  }
}

TEST_CASE("image: no two fields of a line share a bit", "[ref]") {
  const auto check = [](const auto& fields) {
    std::vector<int> uses(8 * line_bytes, 0);
    for (const Field& f : fields) {
      for (std::size_t i = f.lsb; i < f.end(); ++i) ++uses[i];
    }
    REQUIRE(*std::max_element(uses.begin(), uses.end()) == 1);
  };
  check(header_field::all);
  check(inner_field::all);
  check(child_field::all);
  namespace f = leaf_field;
  check(std::array<Field, 6>{f::origin, f::extent, f::rounded, f::open, f::id, f::triangle});
  check(std::array<Field, 6>{f::origin, f::extent, f::rounded, f::open, f::id, f::quad});
}

TEST_CASE("image: every vertex is inside the box and the cuts of every node above, exactly", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::size_t cuts = 0;
  for (const Mesh& mesh : assorted_meshes(random)) {
    INFO(mesh.name);
    const Image image = image_of(mesh);
    const HeaderLine header = image.header();
    std::vector<Positions> vertices;
    for (const Vec3d& v : mesh.vertices) {
      vertices.push_back(positions_of(v, header));
      for (std::size_t i = 0; i < 3; ++i) {
        REQUIRE(vertices.back().down[i] >= -(1 << 24));
        REQUIRE(vertices.back().up[i] <= (1 << 24) - 2);
      }
    }
    std::vector<Positions> above;
    std::size_t outside = 0;
    const std::function<void(std::uint32_t)> visit = [&](std::uint32_t number) {
      const InnerLine node = decode_inner(image.lines[number]);
      for (std::size_t i = 0; i < static_cast<std::size_t>(node.children); ++i) {
        above.push_back(volume_of(node, i));
        for (const auto& cut : node.child[i].cut) cuts += cut[0] + cut[1] > 0 ? 1 : 0;
        const auto child = node.first + static_cast<std::uint32_t>(i);
        if (node.kind[i] == NodeKind::inner) {
          visit(child);
        } else {
          const LeafLine leaf = decode_leaf(image.lines[child], node.kind[i]);
          for (std::size_t p = 0; p < primitives_in(node.kind[i]); ++p) {
            const Mesh::Face& face = mesh.faces[leaf.id[p]];
            for (std::size_t v = 0; v < static_cast<std::size_t>(face.kind); ++v) {
              for (const Positions& volume : above) outside += holds(volume, vertices[face.vertex[v]]) ? 0 : 1;
            }
          }
        }
        above.pop_back();
      }
    };
    visit(header.root);
    REQUIRE(outside == 0);
  }
  REQUIRE(cuts > 1000);
}

TEST_CASE("image: vertices of leaves are the mesh's to half a step, exactly where it says so", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  std::size_t exact_leaves = 0;
  std::size_t rounded_leaves = 0;
  for (const Mesh& mesh : assorted_meshes(random)) {
    INFO(mesh.name);
    const Tree tree = build_tree(mesh);
    const Image image = make_image(mesh, tree);
    const HeaderLine header = image.header();
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
      const NodeKind kind = tree.nodes[n].kind;
      if (kind == NodeKind::inner) continue;
      const LeafLine leaf = decode_leaf(image.lines[n + 1], kind);
      const int step = leaf_step(kind, leaf.extent) + header.exponent;
      Big worst = 0;
      std::size_t k = 0;
      for (std::size_t p = 0; p < primitives_in(kind); ++p) {
        const Primitive face = mesh.primitive(leaf.id[p]);
        for (std::size_t v = 0; v < face.vertex_count(); ++v, ++k) {
          const Point wanted = from_centre(face.v[v], header);
          for (std::size_t i = 0; i < 3; ++i) {
            const Big got = fixed(leaf.origin[i], header.exponent - 24) + fixed(leaf.vertex[k][i], step);
            worst = std::max(worst, Big(abs(got - wanted[i])));
          }
        }
      }
      const bool near = worst <= fixed(1, step - 1);
      REQUIRE(near);
      REQUIRE(leaf.rounded == !worst.is_zero());
      ++(leaf.rounded ? rounded_leaves : exact_leaves);
    }
  }
  REQUIRE(exact_leaves > 100);
  REQUIRE(rounded_leaves > 100);
}

TEST_CASE("image: quads that rounding could make concave are open", "[ref]") {
  const auto open = [](const std::vector<Vec3d>& vertices) {
    Mesh mesh;
    add_face(mesh, vertices);
    return decode_leaf(image_of(mesh).lines[2], NodeKind::quad).open;
  };
  REQUIRE_FALSE(open({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  REQUIRE_FALSE(open({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}));
  REQUIRE(open({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}));      // crosses itself
  REQUIRE(open({{0, 0, 0}, {1, 0, 0}, {0.1, 0.1, 0}, {0, 1, 0}}));  // concave
  REQUIRE(open({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}));      // three in a line
  REQUIRE(open({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
}

TEST_CASE("image: damaged images are refused with line and field", "[ref]") {
  std::mt19937_64 random(sim::seed_from_environment());
  const Mesh mesh = soup(200, false, random);
  const Tree tree = build_tree(mesh);
  const Image image = make_image(mesh, tree);
  const auto lines = static_cast<std::int64_t>(image.lines.size());
  const auto refused = [](const Bytes& bytes, const std::string& line, const std::string& field) {
    REQUIRE_THROWS_WITH(parse_image(bytes), Catch::StartsWith("image line " + line + ", " + field + ": "));
  };
  const Bytes good = to_bytes(image);
  REQUIRE_NOTHROW(parse_image(good));

  SECTION("length") {
    Bytes bytes = good;
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{63}, std::size_t{64}, std::size_t{128}, good.size() - 1}) {
      bytes = good;
      bytes.resize(size);
      REQUIRE_THROWS_AS(parse_image(bytes), ImageError);
    }
    bytes = good;
    bytes.resize(good.size() - 64);
    refused(bytes, "0", "lines");
    bytes.resize(good.size() + 64);
    refused(bytes, "0", "lines");
  }
  SECTION("header") {
    namespace f = header_field;
    refused(with_field(image, 0, f::magic, 1), "0", "magic");
    refused(with_field(image, 0, f::version, 2), "0", "version");
    Image damaged = image;
    damaged.lines[5][7] ^= 4;
    refused(to_bytes(damaged), "0", "crc");
    refused(with_field(image, 0, f::exponent, 2000), "0", "exponent");
    refused(with_field(image, 0, f::exponent, -2000), "0", "exponent");
    refused(with_field(image, 0, f::root, 0), "0", "root");
    refused(with_field(image, 0, f::root, lines), "0", "root");
    refused(with_field(image, 0, f::depth, 1), "0", "depth");
    refused(with_field(image, 0, f::depth, 49), "0", "depth");
    refused(with_field(image, 0, f::depth, tree.depth + 1), "0", "depth");
    refused(with_field(image, 0, f::kinds, 1), "0", "kinds");
    REQUIRE_THROWS_AS(parse_image(with_field(image, 0, f::triangles, get(image.lines[0], f::triangles) - 1)),
                      ImageError);
    refused(with_field(image, 0, f::triangles, get(image.lines[0], f::triangles) + 1), "0", "triangles");
    refused(with_field(image, 0, f::triangles, 0xffffffff), "0", "triangles");
    refused(with_field(image, 0, f::quads, get(image.lines[0], f::quads) + 1), "0", "quads");
    refused(with_field(image, 0, f::inner, 1), "0", "inner");
    refused(with_field(image, 0, f::leaves, 1), "0", "leaves");
    refused(with_field(image, 0, f::centre, 0x7ff0000000000000, 1), "0", "centre");
    refused(with_field(image, 0, Field{"", 300, 1}, 1), "0", "reserved");
  }
  SECTION("inner nodes") {
    namespace f = inner_field;
    refused(with_field(image, 1, f::step, 19), "1", "step");
    refused(with_field(image, 1, f::step, 31), "1", "step");
    refused(with_field(image, 1, f::first, 1), "1", "first");  // a cycle
    refused(with_field(image, 1, f::first, 0), "1", "first");
    refused(with_field(image, 1, f::first, lines), "1", "first");
    refused(with_field(image, 1, f::first, lines - 3), "1", "first");
    refused(with_field(image, 1, Field{"", 94, 1}, 1), "1", "reserved");
    refused(with_field(image, 1, Field{"", 511, 1}, 1), "1", "reserved");
    refused(with_field(image, 1, child_field::box, 63, 2, f::child.lsb), "1", "box");
    Image flat = image;  // legal but for chips whose box test had a bit too few
    put(flat.lines[1], child_field::box, -64, 0, f::child.lsb);
    refused(with_field(flat, 1, child_field::box, -64, 1, f::child.lsb), "1", "box");
    // the root's last inner child given the children of the one before
    const InnerLine root = decode_inner(image.lines[1]);
    REQUIRE(root.kind[0] == NodeKind::inner);
    REQUIRE(root.kind[1] == NodeKind::inner);
    const std::int64_t shared = get(image.lines[root.first + 1], f::first);
    REQUIRE_THROWS_WITH(parse_image(with_field(image, root.first, f::first, shared)), Catch::Contains("two parents"));
    // a line that cannot be reached
    Image longer = image;
    longer.lines.emplace_back();
    put(longer.lines[0], header_field::lines, lines + 1);
    refused(with_field(longer, 0, header_field::root, 1), std::to_string(lines), "line");
    // kinds that contradict the lines
    for (std::size_t i = 0; i < 4; ++i) {
      for (int kind = 0; kind < 4; ++kind) {
        if (static_cast<int>(root.kind[i]) == kind) continue;
        REQUIRE_THROWS_AS(parse_image(with_field(image, 1, f::kind, kind, i)), ImageError);
      }
    }
    for (int children = 0; children < root.children - 1; ++children) {
      REQUIRE_THROWS_AS(parse_image(with_field(image, 1, f::children, children)), ImageError);
    }
  }
  SECTION("leaves") {
    namespace f = leaf_field;
    const auto line_of = [&](NodeKind kind) {
      std::size_t n = 0;
      while (tree.nodes[n].kind != kind) ++n;
      return n + 1;
    };
    const std::size_t two = line_of(NodeKind::two_triangles);
    const std::string text = std::to_string(two);
    refused(with_field(image, two, f::extent, 25), text, "extent");
    refused(with_field(image, two, f::open, 1), text, "open");
    refused(with_field(image, two, f::id, 200), text, "id");
    refused(with_field(image, two, f::id, get(image.lines[two], f::id, 1), 0), text, "id");
    refused(with_field(image, two, Field{"", 504, 1}, 1), text, "reserved");
    const std::size_t one = line_of(NodeKind::triangle);
    refused(with_field(image, one, f::triangle, 1, 9), std::to_string(one), "reserved");
    const std::size_t quad = line_of(NodeKind::quad);
    refused(with_field(image, quad, Field{"", 432, 1}, 1), std::to_string(quad), "reserved");
    refused(with_field(image, quad, f::id, 1, 1), std::to_string(quad), "reserved");
  }
  SECTION("any bits") {
    // With any content of the lines, reading ends with an image or with a message.
    int read = 0;
    for (int n = 0; n < 4000; ++n) {
      Image changed = image;
      const std::size_t flips = 1 + random() % 3;
      for (std::size_t i = 0; i < flips; ++i) {
        const std::size_t bit = 64 + random() % (512 * changed.lines.size() - 64);
        changed.lines[bit / 512][bit % 512 / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
      }
      put(changed.lines[0], header_field::crc, image_crc(changed));
      try {
        parse_image(to_bytes(changed));
        ++read;
      } catch (const ImageError&) {
      }
    }
    REQUIRE(read > 200);   // vertices, cuts
    REQUIRE(read < 3800);  // everything else
  }
}

// A part on a dyadic grid whose detail has its flat face where the least number of its node's boxes lies.
TEST_CASE("image: no box is flat at the least number", "[ref]") {
  Mesh mesh;
  const auto triangle = [&mesh](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {p, q, r});
    mesh.faces.push_back({Kind::tri, {first, first + 1, first + 2, 0}});
  };
  for (const double side : {-0.4, 0.4}) {  // the frame: the middle of the part is the origin
    triangle({side, side / 4, side}, {side * 0.9, side / 4, side}, {side, side / 8, side});
    triangle({side / 2, side, side / 4}, {side / 3, side, side / 4}, {side / 2, side * 0.9, side / 4});
  }
  const auto detail = [&triangle](const std::array<int, 9>& v) {
    const auto at = [&v](std::size_t i) { return Vec3d(Vec3d(v[i], v[i + 1], v[i + 2]) * 0x1p-24); };
    triangle(at(0), at(3), at(6));
  };
  detail({-2048, -512, -256, -2048, 512, -256, -2048, 0, 512});
  detail({1500, -300, -300, 2016, -200, 100, 1700, 300, 200});
  detail({1600, 300, -100, 1900, 100, 300, 1400, -300, 200});
  detail({900, 400, -300, 1300, -100, 400, 1200, -400, -200});
  detail({700, 300, 200, 1000, 250, -300, 800, -250, 100});
  const Image image = make_image(mesh, build_tree(mesh));
  REQUIRE_NOTHROW(parse_image(to_bytes(image)));
  int at_least = 0;
  std::vector<std::pair<std::uint32_t, NodeKind>> open = {{image.header().root, NodeKind::inner}};
  while (!open.empty()) {
    const auto [line, kind] = open.back();
    open.pop_back();
    if (kind != NodeKind::inner) continue;
    const InnerLine node = decode_inner(image.lines[line]);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(node.children); ++i) {
      open.emplace_back(node.first + i, node.kind[i]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        at_least += node.child[i].least[axis] == box_least ? 1 : 0;
        REQUIRE(node.child[i].greatest[axis] > box_least);
      }
    }
  }
  REQUIRE(at_least > 0);  // else the mesh no longer shows it
}
