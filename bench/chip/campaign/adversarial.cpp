// SPDX-License-Identifier: Apache-2.0
// Scenes made to break rounding, through the simulated device against the CPU device: what CAD parts have and scanned
// meshes do not.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cchip/cpu_device.hpp>
#include <cchip/machines/simulated_chip.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <stdexcept>

#include "campaign.hpp"

namespace cchip::testing {
namespace {

/// Numbers of a scene.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  int number(int least, int most) {
    return least + static_cast<int>(random_() % static_cast<std::uint64_t>(most - least + 1));
  }
  bool percent(int p) { return number(0, 99) < p; }
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vec3d vector() { return {unit(), unit(), unit()}; }
  template <class T, std::size_t n>
  T of(const std::array<T, n>& list) {
    return list[random_() % n];
  }
  Random& engine() { return random_; }

 private:
  Random random_;
};

/// Faces one after the other, with vertices of their own.
class Builder {
 public:
  void face(const std::vector<Vec3d>& corners) {
    Mesh::Face face;
    face.kind = corners.size() == 4 ? Kind::quad : Kind::tri;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      face.vertex[i] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(corners[i]);
    }
    mesh_.faces.push_back(face);
  }
  /// The sides of a box, as quads or as triangles.
  void box(Draw& draw, const Vec3d& low, const Vec3d& high) {
    constexpr std::array<std::array<unsigned, 4>, 6> sides = {
        {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
    for (const auto& side : sides) {
      std::vector<Vec3d> corners;
      for (const unsigned corner : side) {
        Vec3d v;
        for (unsigned k = 0; k < 3; ++k) v[k] = (corner >> k & 1U) != 0 ? high[k] : low[k];
        corners.push_back(v);
      }
      if (draw.percent(50)) {
        face(corners);
      } else {
        face({corners[0], corners[1], corners[2]});
        face({corners[0], corners[2], corners[3]});
      }
    }
  }
  Mesh take() { return std::move(mesh_); }

 private:
  Mesh mesh_;
};

struct Parts {
  Mesh a, b;
};

/// Boxes whose corners lie on dyadic grids, with details down to 2^-18 of the part.
Mesh dyadic_part(Draw& draw) {
  Builder builder;
  for (int n = draw.number(2, 5); n > 0; --n) {
    const double size = std::ldexp(1.0, -draw.number(1, 3));
    const Vec3d low = Vec3d(draw.number(-6, 6), draw.number(-6, 6), draw.number(-6, 6)) / 8;
    Vec3d high = low + Vec3d::Constant(size);
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (draw.percent(5)) high[k] = low[k];
    }
    builder.box(draw, low, high);
  }
  for (int n = draw.number(3, 8); n > 0; --n) {
    const double unit = std::ldexp(1.0, -draw.number(8, 18));
    const Vec3d centre = Vec3d(draw.number(-4, 4), draw.number(-4, 4), draw.number(-4, 4)) / 8;
    for (int boxes = draw.number(2, 9); boxes > 0; --boxes) {
      Vec3d low, high;
      for (Eigen::Index k = 0; k < 3; ++k) {
        low[k] = centre[k] + unit * draw.number(-64, 60);
        high[k] = low[k] + unit * draw.of<int, 7>({0, 1, 2, 3, 8, 60, 126});
      }
      builder.box(draw, low, high);
    }
  }
  return builder.take();
}
Parts grid(Draw& draw, std::size_t /*faces*/) { return {dyadic_part(draw), dyadic_part(draw)}; }

/// A part about 0.8 long whose detail, 2.4e-4 wide on a grid of 2^-24, ends in a flat face at the least number of its
/// node's box; and one whose detail meets that face when it is turned by half a circle.
Parts flat_end(Draw& draw, std::size_t /*faces*/) {
  const auto frame = [](Builder& builder) {  // far triangles: the middle of the part's box is the origin
    for (const Vec3d& at :
         {Vec3d(0.4, 0.1, 0.4), Vec3d(-0.4, 0.2, -0.4), Vec3d(0.3, 0.4, 0.1), Vec3d(0.2, -0.4, 0.3),
          Vec3d(0.25, 0.3, 0.2), Vec3d(-0.3, 0.35, -0.2), Vec3d(0.35, 0.1, 0.3), Vec3d(-0.35, 0.2, -0.3)}) {
      const Vec3d in = -0.01 * at.cwiseSign();
      builder.face({at, at + Vec3d(in.x(), 0, 0), at + Vec3d(0, in.y(), 0)});
    }
  };
  const auto triangle = [](Builder& builder, const std::array<int, 9>& v) {
    const auto at = [&](std::size_t i) { return Vec3d(Vec3d(v[i], v[i + 1], v[i + 2]) * 0x1p-24); };
    builder.face({at(0), at(3), at(6)});
  };
  Builder a, b;
  frame(a);
  frame(b);
  const int wide = draw.number(256, 700);
  triangle(a, {-2048, -wide, -256, -2048, wide, -256, -2048, 0, wide});
  const int most = draw.number(1985, 2047);  // the other end of the node's box
  triangle(a, {1500, -300, -300, most, -200, 100, 1700, 300, 200});
  triangle(a, {1600, 300, -100, 1900, 100, 300, 1400, -300, 200});
  triangle(a, {900, 400, -300, 1300, -100, 400, 1200, -400, -200});
  triangle(a, {700, 300, 200, 1000, 250, -300, 800, -250, 100});
  const int tip = draw.number(1985, 2048);
  triangle(b, {tip, -40, 0, tip, 40, 0, 2110, 0, 5});
  triangle(b, {2400, -300, -200, 2500, 200, 100, 2450, 0, 300});
  triangle(b, {2700, -300, -200, 2800, 200, 100, 2750, 0, 300});
  return {a.take(), b.take()};
}

/// A plate of quads or triangles and parts that lie on it, in it and inside each other.
Mesh plates(Draw& draw, int cells) {
  Builder builder;
  const double step = 1.0 / cells;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const Vec3d low(i * step, j * step, 0);
      builder.box(draw, low, low + Vec3d(step, step, draw.percent(30) ? 0 : step * draw.number(1, 3)));
    }
  }
  return builder.take();
}
Parts flush(Draw& draw, std::size_t faces) {
  const auto most = static_cast<int>(std::sqrt(static_cast<double>(faces) / 12));
  const int cells = draw.number(1, std::max(1, std::min(most, 8)));
  return {plates(draw, cells), plates(draw, draw.percent(50) ? cells : draw.number(1, std::max(1, std::min(most, 8))))};
}

/// Faces that are long and thin in any direction, some of them segments and points.
Mesh sliver_part(Draw& draw, int faces) {
  Builder builder;
  for (int n = 0; n < faces; ++n) {
    const Vec3d from = draw.vector();
    const Vec3d along = draw.vector() * std::ldexp(1.0, -draw.number(0, 12));
    const Vec3d across = draw.vector() * std::ldexp(1.0, -draw.number(0, 40));
    switch (draw.number(0, 4)) {
      case 0:
        builder.face({from, from + along, from});
        break;
      case 1:
        builder.face({from, from, from});
        break;
      case 2:
        builder.face({from, from + along, from + along + across, from + across});
        break;
      default:
        builder.face({from, from + along, from + across});
        break;
    }
  }
  return builder.take();
}
Parts slivers(Draw& draw, std::size_t /*faces*/) {
  return {sliver_part(draw, draw.number(1, 60)), sliver_part(draw, draw.number(1, 60))};
}

/// Objects whose units are up to 2^15 apart, and a little beyond.
Parts units(Draw& draw, std::size_t /*faces*/) {
  Parts parts{
      draw.percent(50) ? dyadic_part(draw) : make_body(3, 0.3, draw.engine()()),
      draw.percent(50) ? dyadic_part(draw) : make_torus(1, 0.25, 12, 8, draw.percent(50) ? Kind::quad : Kind::tri)};
  const double scale = std::ldexp(1.0, draw.percent(30) ? draw.of<int, 4>({-16, -15, 15, 16}) : draw.number(-16, 16));
  for (Vec3d& v : parts.b.vertices) v *= scale;
  return parts;
}

/// From one face to as many as the settings allow.
Parts sizes(Draw& draw, std::size_t faces) {
  const auto mesh = [&](std::size_t limit) {
    if (limit < 48 || draw.percent(50)) return sliver_part(draw, draw.number(1, 4));
    const int cuts = draw.number(2, std::max(2, static_cast<int>(std::sqrt(static_cast<double>(limit) / 20))));
    return make_body(cuts, 0.3, draw.engine()());
  };
  Mesh large = mesh(faces);
  return {std::move(large), mesh(2000)};
}

/// Quads of every kind: planar, warped by a bit or by much, with corners that coincide, on one line, a point.
Mesh quad_part(Draw& draw, int faces) {
  Builder builder;
  for (int n = 0; n < faces; ++n) {
    const double size = std::ldexp(1.0, -draw.number(0, 8));
    const Vec3d corner = Vec3d(draw.number(-8, 8), draw.number(-8, 8), draw.number(-8, 8)) / 8;
    const Vec3d u = size * Vec3d(draw.number(-4, 4), draw.number(-4, 4), draw.number(-4, 4));
    const Vec3d v = size * Vec3d(draw.number(-4, 4), draw.number(-4, 4), draw.number(-4, 4));
    Vec3d last = corner + v;
    if (draw.percent(40)) last += size * std::ldexp(1.0, -draw.number(0, 44)) * draw.vector();  // warped
    std::vector<Vec3d> corners = {corner, corner + u, corner + u + v, last};
    if (draw.percent(10)) corners[2] = corners[1];
    if (draw.percent(10)) corners[3] = corners[0];
    builder.face(corners);
  }
  return builder.take();
}
Parts quads(Draw& draw, std::size_t /*faces*/) {
  return {quad_part(draw, draw.number(1, 80)), quad_part(draw, draw.number(1, 80))};
}

struct SceneKind {
  const char* name;
  Parts (*make)(Draw&, std::size_t);
};
constexpr std::array<SceneKind, 7> scene_kinds = {{{"grid", grid},
                                                   {"flat-end", flat_end},
                                                   {"flush", flush},
                                                   {"slivers", slivers},
                                                   {"units", units},
                                                   {"sizes", sizes},
                                                   {"quads", quads}}};

/// Signed permutations and what is near them, turns by 45 degrees, reflections, shears, any rotation.
Eigen::Matrix3d linear_part(Draw& draw) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  const int first = draw.number(0, 2);
  const int step = draw.number(1, 2);
  for (int i = 0; i < 3; ++i) m(i, (first + step * i) % 3) = draw.percent(60) ? -1 : 1;
  switch (draw.number(0, 9)) {
    case 0:
      m += 0x1p-19 * Eigen::Matrix3d::NullaryExpr([&](auto...) { return draw.unit(); });
      break;
    case 1:
      m = Eigen::AngleAxisd(static_cast<double>(EIGEN_PI) / 4, Vec3d::Unit(draw.number(0, 2))).toRotationMatrix() * m;
      break;
    case 2:
      m = Eigen::Quaterniond(draw.unit(), draw.unit(), draw.unit(), draw.unit()).normalized().toRotationMatrix();
      break;
    case 3:
      m(draw.number(0, 2), draw.number(0, 2)) += draw.of<double, 4>({-0.5, 0.25, 0.5, 1});
      break;
    case 4:
      m *= draw.of<double, 3>({0.5, 2, 0.75});
      break;
    default:
      break;
  }
  return m;
}

/// A vertex of B on one of A, exactly, a bit of the part's grid beside it, or a little off.
PosePair pose_of(Draw& draw, const Parts& parts) {
  PosePair pose;
  pose.b.linear() = linear_part(draw);
  const auto any = [&](const Mesh& mesh) { return mesh.vertices[draw.engine()() % mesh.vertices.size()]; };
  Vec3d at = any(parts.a) - pose.b.linear() * any(parts.b);
  for (Eigen::Index k = 0; k < 3; ++k) {
    switch (draw.number(0, 7)) {
      case 0:
        at[k] += draw.of<double, 2>({-1, 1}) * std::ldexp(1.0, -draw.number(8, 30));
        break;
      case 1:
        at[k] = std::nextafter(at[k], draw.percent(50) ? 1e300 : -1e300);
        break;
      default:
        break;
    }
  }
  if (draw.percent(5)) at.setZero();  // nested
  pose.b.translation() = at;
  if (draw.percent(20)) {  // both moved, far away
    const Vec3d away = Vec3d(draw.number(-512, 512), draw.number(-512, 512), draw.number(-512, 512));
    pose.a.translation() += away;
    pose.b.translation() += away;
  }
  return pose;
}

}  // namespace

int run_adversarial(const AdversarialSettings& settings) {
  std::vector<SceneKind> kinds;
  for (const SceneKind& kind : scene_kinds) {
    const auto& only = settings.kinds;
    if (only.empty() || std::find(only.begin(), only.end(), kind.name) != only.end()) kinds.push_back(kind);
  }
  if (kinds.empty() || kinds.size() < settings.kinds.size()) {
    std::string names;
    for (const SceneKind& kind : scene_kinds) names += std::string(names.empty() ? "" : ", ") + kind.name;
    throw std::invalid_argument("--kinds: an unknown kind of scene; there are " + names);
  }
  const std::unique_ptr<Device> cpu = open_cpu_device({1, ""});
  std::vector<Totals> totals(kinds.size());
  Random random(settings.seed);
  SimulatedChipOptions chip;
  chip.seed = settings.seed;
  chip.memory = any_memory(random);
  const std::unique_ptr<Device> device = open_simulated_chip(chip);
  fmt::print("seed={}\n", settings.seed);
  for (std::size_t scene = 0; scene < settings.scenes; ++scene) {
    Totals& now = totals[scene % kinds.size()];
    Draw draw(settings.seed + scene);
    const Parts parts = kinds[scene % kinds.size()].make(draw, settings.faces);
    const Object a(parts.a);
    const Object b(parts.b);
    const std::size_t differences = now.differences;
    for (const bool all : {false, true}) {
      std::vector<PosePair> poses((settings.poses + (all ? 9 : 0)) / (all ? 10 : 1));
      for (PosePair& pose : poses) pose = pose_of(draw, parts);
      compare(*cpu, *device, a, b, poses, all, now);
    }
    if (now.differences != differences) {
      fmt::print("scene {}, kind {}, seed {}: {} differences\n", scene, kinds[scene % kinds.size()].name,
                 settings.seed + scene, now.differences - differences);
    }
    std::fflush(stdout);
  }
  Totals all;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    fmt::print("{:<10} {}\n", kinds[k].name, totals[k].summary());
    all += totals[k];
  }
  fmt::print("{}\n", all.summary());
  return all.queries != 0 && all.differences == 0 ? 0 : 3;
}

}  // namespace cchip::testing
