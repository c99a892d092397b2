// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/mesh.hpp>
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

struct Box {
  Vec3d least;
  Vec3d greatest;
};

std::vector<Box> face_boxes(const Mesh& mesh) {
  std::vector<Box> boxes(mesh.faces.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Primitive p = mesh.primitive(i);
    boxes[i] = {p.v[0], p.v[0]};
    for (std::size_t k = 1; k < p.vertex_count(); ++k) {
      boxes[i].least = boxes[i].least.cwiseMin(p.v[k]);
      boxes[i].greatest = boxes[i].greatest.cwiseMax(p.v[k]);
    }
  }
  return boxes;
}

bool overlap(const Box& p, const Box& q) {
  return (p.least.array() <= q.greatest.array()).all() && (q.least.array() <= p.greatest.array()).all();
}

/// Faces of one mesh in the order in which a sweep along x meets them, and those it is in.
class Sweep {
 public:
  explicit Sweep(const Mesh& mesh) : boxes_(face_boxes(mesh)), order_(boxes_.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
    std::stable_sort(order_.begin(), order_.end(),
                     [this](std::uint32_t i, std::uint32_t j) { return boxes_[i].least.x() < boxes_[j].least.x(); });
  }
  bool done() const { return next_ == order_.size(); }
  /// Where the next face begins; there must be one.
  double next_x() const { return boxes_[order_[next_]].least.x(); }
  /// Enters the next face and returns its number.
  std::uint32_t enter() {
    active_.push_back(order_[next_]);
    return order_[next_++];
  }
  /// Leaves the faces that end before x and calls `visit` for those whose box overlaps the given one.
  template <class Visit>
  void meet(const Box& box, const Visit& visit) {
    const auto is_behind = [&](std::uint32_t i) { return boxes_[i].greatest.x() < box.least.x(); };
    active_.erase(std::remove_if(active_.begin(), active_.end(), is_behind), active_.end());
    for (const std::uint32_t i : active_) {
      if (overlap(boxes_[i], box)) visit(i);
    }
  }
  const Box& box(std::uint32_t face) const { return boxes_[face]; }

 private:
  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> active_;
  std::size_t next_ = 0;
};

}  // namespace

Primitive Mesh::primitive(std::size_t face) const {
  Primitive p;
  p.kind = faces[face].kind;
  for (std::size_t i = 0; i < p.vertex_count(); ++i) p.v[i] = vertices[faces[face].vertex[i]];
  return p;
}

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

Mesh transformed(const Mesh& mesh, const Eigen::Isometry3d& pose) {
  Mesh result = mesh;
  for (Vec3d& p : result.vertices) p = pose * p;
  return result;
}

void sweep_box_pairs(const Mesh& a, const Mesh& b, const std::function<void(CandidatePair)>& visit) {
  Sweep sweep_a(a);
  Sweep sweep_b(b);
  while (!sweep_a.done() || !sweep_b.done()) {
    if (sweep_b.done() || (!sweep_a.done() && sweep_a.next_x() <= sweep_b.next_x())) {
      const std::uint32_t i = sweep_a.enter();
      sweep_b.meet(sweep_a.box(i), [&](std::uint32_t j) { visit({i, j}); });
    } else {
      const std::uint32_t j = sweep_b.enter();
      sweep_a.meet(sweep_b.box(j), [&](std::uint32_t i) { visit({i, j}); });
    }
  }
}

}  // namespace cchip
