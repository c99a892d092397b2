// SPDX-License-Identifier: Apache-2.0
#include <cchip/mesh/shapes.hpp>
#include <cmath>
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

}  // namespace cchip
