// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/shapes.hpp>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

namespace cchip {
namespace {

constexpr double pi = 3.14159265358979323846;

void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(message);
}

std::uint32_t add_vertex(Mesh& mesh, const Vec3d& p) {
  mesh.vertices.push_back(p);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void add_triangle(Mesh& mesh, std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  mesh.faces.push_back({Kind::tri, {i, j, k, 0}});
}

/// Closed loop of vertex numbers.
using Ring = std::vector<std::uint32_t>;

/// Band of faces between two rings of equal length; its front normal is (along `from`) x (`from` to `to`).
void add_band(Mesh& mesh, const Ring& from, const Ring& to, Kind kind = Kind::tri) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t n = (i + 1) % from.size();
    if (kind == Kind::quad) {
      mesh.faces.push_back({Kind::quad, {from[i], from[n], to[n], to[i]}});
      continue;
    }
    add_triangle(mesh, from[i], from[n], to[n]);
    add_triangle(mesh, from[i], to[n], to[i]);
  }
}

/// Point of a gear's outline in polar coordinates.
struct PolarPoint {
  double radius;
  double angle;
};

/// Outline of a spur gear, counter-clockwise: per tooth two points on the root circle and two on the
/// tip circle, so flanks are straight and narrow towards the tip.
std::vector<PolarPoint> gear_outline(double root_radius, double tip_radius, int teeth) {
  std::vector<PolarPoint> outline;
  const double pitch = 2 * pi / teeth;
  for (int tooth = 0; tooth < teeth; ++tooth) {
    const double start = tooth * pitch;
    outline.push_back({root_radius, start});
    outline.push_back({root_radius, start + 0.3 * pitch});
    outline.push_back({tip_radius, start + 0.45 * pitch});
    outline.push_back({tip_radius, start + 0.85 * pitch});
  }
  return outline;
}

Ring add_ring(Mesh& mesh, const std::vector<PolarPoint>& outline, double z) {
  Ring ring;
  for (const PolarPoint& p : outline) {
    ring.push_back(add_vertex(mesh, {p.radius * std::cos(p.angle), p.radius * std::sin(p.angle), z}));
  }
  return ring;
}

/// Wall of `layers` bands around the outline from z = low to z = high; returns its lowest and highest ring.
std::pair<Ring, Ring> add_wall(Mesh& mesh, const std::vector<PolarPoint>& outline, double low, double high, int layers,
                               bool front_outside) {
  const Ring lowest = add_ring(mesh, outline, low);
  Ring below = lowest;
  for (int layer = 1; layer <= layers; ++layer) {
    const Ring above = add_ring(mesh, outline, low + (high - low) * layer / layers);
    if (front_outside) {
      add_band(mesh, below, above);
    } else {
      add_band(mesh, above, below);
    }
    below = above;
  }
  return {lowest, below};
}

/// Fan from a new vertex on the z axis; front above if `up`.
void add_disc(Mesh& mesh, const Ring& ring, double z, bool up) {
  const std::uint32_t centre = add_vertex(mesh, {0, 0, z});
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::uint32_t n = ring[(i + 1) % ring.size()];
    if (up) {
      add_triangle(mesh, centre, ring[i], n);
    } else {
      add_triangle(mesh, centre, n, ring[i]);
    }
  }
}

constexpr std::array<std::array<std::uint32_t, 3>, 20> icosahedron_faces = {
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

/// Corner 0..11: (-+1, +-golden ratio, 0), and the components moved on by one and by two places.
Vec3d icosahedron_corner(std::uint32_t number) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  const double one = number % 2 == 0 ? -1 : 1;
  const double ratio = number / 2 % 2 == 0 ? golden : -golden;
  const std::uint32_t turn = number / 4;
  if (turn == 0) return {one, ratio, 0};
  if (turn == 1) return {0, one, ratio};
  return {ratio, 0, one};
}

}  // namespace

Mesh make_torus(double major_radius, double minor_radius, int around, int across, Kind kind) {
  require(minor_radius > 0 && major_radius > minor_radius, "torus: radii must satisfy major > minor > 0");
  require(around >= 3 && across >= 3, "torus: around and across must be at least 3");
  Mesh mesh;
  mesh.name = "torus";
  std::vector<Ring> rings;
  for (int i = 0; i < around; ++i) {
    const Eigen::AngleAxisd turn(2 * pi * i / around, Vec3d::UnitZ());
    Ring ring;
    for (int k = 0; k < across; ++k) {
      const double angle = 2 * pi * k / across;
      const Vec3d section(major_radius + minor_radius * std::cos(angle), 0, minor_radius * std::sin(angle));
      ring.push_back(add_vertex(mesh, turn * section));
    }
    rings.push_back(ring);
  }
  for (std::size_t i = 0; i < rings.size(); ++i) add_band(mesh, rings[(i + 1) % rings.size()], rings[i], kind);
  return mesh;
}

Mesh make_gear(double root_radius, double tip_radius, double bore_radius, double thickness, int teeth, int layers) {
  require(tip_radius > root_radius && root_radius > bore_radius && bore_radius >= 0,
          "gear: radii must satisfy tip > root > bore >= 0");
  require(thickness > 0 && teeth >= 3 && layers >= 1, "gear: thickness > 0, teeth >= 3 and layers >= 1 are needed");
  Mesh mesh;
  mesh.name = "gear";
  const double high = thickness / 2;
  std::vector<PolarPoint> outline = gear_outline(root_radius, tip_radius, teeth);
  const auto [outer_low, outer_high] = add_wall(mesh, outline, -high, high, layers, true);
  if (bore_radius > 0) {
    for (PolarPoint& p : outline) p.radius = bore_radius;
    const auto [inner_low, inner_high] = add_wall(mesh, outline, -high, high, layers, false);
    add_band(mesh, outer_high, inner_high);
    add_band(mesh, inner_low, outer_low);
  } else {
    add_disc(mesh, outer_high, high, true);
    add_disc(mesh, outer_low, -high, false);
  }
  return mesh;
}

Mesh make_sphere(double radius, int cuts, double noise, std::uint64_t seed) {
  require(radius > 0 && cuts >= 1 && cuts <= 1000 && noise >= 0 && noise < 1,
          "sphere: radius > 0, 1 <= cuts <= 1000 and 0 <= noise < 1 are needed");
  Mesh mesh;
  mesh.name = "sphere";
  std::mt19937_64 random(seed);
  // A point of a face of the icosahedron: its corners with their weights, of which the sum is `cuts`. Faces share the
  // points of their common edges, whose other weights are 0.
  using Weights = std::array<std::pair<std::uint32_t, int>, 3>;
  std::map<Weights, std::uint32_t> number_of;
  const auto vertex = [&](Weights w) {
    for (auto& [corner, weight] : w) {
      if (weight == 0) corner = 0;
    }
    std::sort(w.begin(), w.end());
    const auto [place, is_new] = number_of.try_emplace(w, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      Vec3d p = Vec3d::Zero();
      for (const auto& [corner, weight] : w) p += weight * icosahedron_corner(corner);
      const double u = static_cast<double>(random() >> 11U) * 0x1p-52 - 1;
      mesh.vertices.push_back(p.normalized() * (radius * (1 + noise * u)));
    }
    return place->second;
  };
  for (const auto& [i, j, k] : icosahedron_faces) {
    const auto at = [&, i = i, j = j, k = k](int y, int z) { return vertex({{{i, cuts - y - z}, {j, y}, {k, z}}}); };
    for (int y = 0; y < cuts; ++y) {
      for (int z = 0; y + z < cuts; ++z) {
        const std::uint32_t first = at(y, z);  // one after the other, so that the noise comes in this order
        const std::uint32_t second = at(y + 1, z);
        const std::uint32_t third = at(y, z + 1);
        add_triangle(mesh, first, second, third);
        if (y + z + 1 < cuts) add_triangle(mesh, second, at(y + 1, z + 1), third);
      }
    }
  }
  return mesh;
}

Mesh make_body(int cuts, double relief, std::uint64_t seed) {
  require(relief >= 0 && relief <= 1, "body: 0 <= relief <= 1 is needed");
  Mesh mesh = make_sphere(1, cuts);
  mesh.name = "body";
  struct Wave {
    Vec3d frequency;
    double phase;
    double height;
  };
  std::vector<Wave> waves;
  std::mt19937_64 random(seed);
  const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1; };  // -1..1
  for (int octave = 0; octave < 5; ++octave) {
    for (int i = 0; i < 6; ++i) {
      Vec3d direction = Vec3d::Zero();
      while (direction.norm() < 0.1 || direction.norm() > 1) {
        for (double& x : direction) x = unit();
      }
      waves.push_back({direction.normalized() * 2.5 * std::pow(2.1, octave), pi * unit(), std::pow(0.42, octave) / 3});
    }
  }
  for (Vec3d& v : mesh.vertices) {
    double sum = 0;
    for (const Wave& wave : waves) sum += wave.height * std::sin(wave.frequency.dot(v) + wave.phase);
    v *= std::exp(relief * sum);
  }
  return mesh;
}

Mesh subdivided(const Mesh& mesh) {
  Mesh fine;
  fine.name = mesh.name;
  fine.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t i, std::uint32_t k) {
    const auto [place, is_new] =
        middles.try_emplace(std::minmax(i, k), static_cast<std::uint32_t>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back((mesh.vertices[i] + mesh.vertices[k]) / 2);
    return place->second;
  };
  for (const Mesh::Face& face : mesh.faces) {
    const auto& [i, j, k, l] = face.vertex;
    if (face.kind == Kind::tri) {
      const std::uint32_t ij = middle(i, j);
      const std::uint32_t jk = middle(j, k);
      const std::uint32_t ki = middle(k, i);
      add_triangle(fine, i, ij, ki);
      add_triangle(fine, ij, j, jk);
      add_triangle(fine, ki, jk, k);
      add_triangle(fine, ij, jk, ki);
      continue;
    }
    const Vec3d sum = mesh.vertices[i] + mesh.vertices[j] + mesh.vertices[k] + mesh.vertices[l];
    const std::uint32_t centre = add_vertex(fine, sum / 4);
    const Ring corners = {i, j, k, l};
    const Ring edges = {middle(i, j), middle(j, k), middle(k, l), middle(l, i)};
    for (std::size_t n = 0; n < 4; ++n) {
      fine.faces.push_back({Kind::quad, {corners[n], edges[n], centre, edges[(n + 3) % 4]}});
    }
  }
  return fine;
}

Mesh normalised(Mesh mesh) {
  require(!mesh.vertices.empty(), "normalised: the mesh has no vertices");
  Vec3d low = mesh.vertices.front();
  Vec3d high = low;
  for (const Vec3d& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const Vec3d centre = low + (high - low) / 2;
  const double size = (high - low).norm();
  for (Vec3d& v : mesh.vertices) v = (v - centre) / (size > 0 ? size : 1);
  return mesh;
}

}  // namespace cchip
