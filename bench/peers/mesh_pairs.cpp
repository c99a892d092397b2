// SPDX-License-Identifier: Apache-2.0
#include "mesh_pairs.hpp"

#include <algorithm>
#include <cchip/mesh_file.hpp>
#include <cchip/shapes.hpp>
#include <cmath>
#include <stdexcept>

namespace cchip::testing {
namespace {

Mesh model(const std::string& path) { return load_mesh(std::string(CCHIP_TEST_MODELS) + "/" + path); }

double radius(const Mesh& mesh) {
  double greatest = 0;
  for (const Vec3d& v : mesh.vertices) greatest = std::max(greatest, v.norm());
  return greatest;
}

double diagonal(const Mesh& mesh) {
  Vec3d low = mesh.vertices.front();
  Vec3d high = low;
  for (const Vec3d& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return (high - low).norm();
}

Mesh unit_segment() {
  Mesh mesh;
  mesh.name = "segment";
  mesh.vertices = {Vec3d(0, 0, 0), Vec3d(1, 0, 0)};
  mesh.faces = {{Kind::tri, {0, 1, 1, 0}}};
  return mesh;
}

/// Adds n x n squares of two triangles each; corner and sides in space.
void add_plate(Mesh& mesh, const Vec3d& corner, const Vec3d& u, const Vec3d& v, int n) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k <= n; ++k) mesh.vertices.emplace_back(corner + i / double(n) * u + k / double(n) * v);
  }
  const auto number = [base, n](int i, int k) { return base + static_cast<std::uint32_t>(i * (n + 1) + k); };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      mesh.faces.push_back({Kind::tri, {number(i, k), number(i + 1, k), number(i + 1, k + 1), 0}});
      mesh.faces.push_back({Kind::tri, {number(i, k), number(i + 1, k + 1), number(i, k + 1), 0}});
    }
  }
}

Mesh plate(const Vec3d& corner, int n) {
  Mesh mesh;
  mesh.name = "plate";
  add_plate(mesh, corner, Vec3d::UnitX(), Vec3d::UnitY(), n);
  return mesh;
}

Mesh box(const Vec3d& corner, const Vec3d& size, int n) {
  Mesh mesh;
  mesh.name = "box";
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d u = size[(axis + 1) % 3] * Vec3d::Unit((axis + 1) % 3);
    const Vec3d v = size[(axis + 2) % 3] * Vec3d::Unit((axis + 2) % 3);
    add_plate(mesh, corner, v, u, n);
    add_plate(mesh, corner + size[axis] * Vec3d::Unit(axis), u, v, n);
  }
  return mesh;
}

/// A tube without ends of radius r and length 4, of 2 x around x along triangles.
Mesh tube(int around, int along, double r) {
  Mesh mesh;
  mesh.name = "tube";
  for (int k = 0; k <= along; ++k) {
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * 3.14159265358979 * i / around;
      mesh.vertices.emplace_back(r * std::cos(turn), r * std::sin(turn), 4.0 * k / along);
    }
  }
  const auto number = [around](int i, int k) { return static_cast<std::uint32_t>(k * around + i % around); };
  for (int k = 0; k < along; ++k) {
    for (int i = 0; i < around; ++i) {
      mesh.faces.push_back({Kind::tri, {number(i, k), number(i + 1, k), number(i + 1, k + 1), 0}});
      mesh.faces.push_back({Kind::tri, {number(i, k), number(i + 1, k + 1), number(i, k + 1), 0}});
    }
  }
  return mesh;
}

Mesh lump(int n, double size) {
  Mesh mesh = make_sphere(1, n);
  mesh.name = "lump";
  for (Vec3d& v : mesh.vertices) v *= size * (1 + 0.15 * std::sin(5 * v.x()) * std::cos(4 * v.y()));
  return mesh;
}

}  // namespace

std::vector<MeshPair> nested_pairs() {
  return {{"spheres", make_sphere(1, 32), make_sphere(1.125, 32), false},
          {"lumps", lump(32, 1), lump(32, 1.05), false},
          {"tubes, same triangles", tube(60, 60, 1), tube(60, 60, 1.1), false},
          {"shaft in bush", tube(60, 60, 1), tube(64, 50, 1.05), false},
          {"part in housing", box({-0.5, -0.4, -0.3}, {1, 0.8, 0.6}, 24), make_sphere(0.75, 24), false}};
}

const char* name_of(FlushPlace place) {
  switch (place) {
    case FlushPlace::together:
      return "together";
    case FlushPlace::shifted:
      return "shifted";
    case FlushPlace::turned:
      return "turned";
    case FlushPlace::apart:
      break;
  }
  return "apart";
}

std::vector<MeshPair> flush_pairs() {
  return {{"plates", plate({0, 0, 0}, 24), plate({0.01, 0.01, 0}, 24), false},
          {"boxes", box({-0.5, -0.4, -0.3}, {1, 0.8, 0.3}, 12), box({-0.2, -0.3, 0}, {0.5, 0.7, 0.6}, 12), false}};
}

PosePair flush_poses(FlushPlace place, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double range) {
    const double x = range * unit(random);
    const double y = range * unit(random);
    return Vec3d(x, y, range * unit(random));
  };
  const bool is_turned = place == FlushPlace::turned || place == FlushPlace::apart;
  const Vec3d translation = vector(1);
  PosePair poses;
  poses.a = make_pose(translation, is_turned ? vector(180) : Vec3d(0, 0, 0));
  poses.b = poses.a;
  if (place == FlushPlace::shifted || place == FlushPlace::apart) {
    Vec3d along = vector(0.1);
    along.z() = 0;
    poses.b.translation() += poses.a.linear() * along;
  }
  return poses;
}

const std::vector<std::string>& mesh_pair_names() {
  static const std::vector<std::string> names = {"body-body",   "limbs-limbs",   "gear-ring", "body-animal",
                                                 "quads-limbs", "animal-spider", "body-tiny"};
  return names;
}

MeshPair mesh_pair(const std::string& name) {
  MeshPair pair;
  if (name == "body-body") {  // two scanned figures
    pair = {name, make_body(59, 0.25, 1), make_body(59, 0.25, 2)};
  } else if (name == "limbs-limbs") {  // with arms and hollows, of different sizes
    pair = {name, make_body(49, 0.8, 3), make_body(39, 0.8, 4)};
  } else if (name == "gear-ring") {  // machine parts: flat and round faces, long triangles
    pair = {name, make_gear(1.25, 1.5, 0.5, 0.5, 96, 12), make_torus(1, 0.25, 104, 64)};
  } else if (name == "body-animal") {  // one with 19 times the faces of the other
    pair = {name, make_body(59, 0.25, 5), model("OFF/Wuson.off")};
  } else if (name == "quads-limbs") {  // quads against triangles
    pair = {name, make_torus(1, 0.4, 192, 128, Kind::quad), make_body(32, 0.8, 6)};
  } else if (name == "animal-spider") {  // small ones, drawn by hand
    pair = {name, model("OFF/Wuson.off"), model("OBJ/spider.obj")};
  } else if (name == "body-tiny") {  // sizes 10,000 : 1
    pair = {name, make_body(59, 0.25, 7), make_body(22, 0.25, 8), false};
  } else {
    std::string known;
    for (const std::string& n : mesh_pair_names()) known += (known.empty() ? "" : ", ") + n;
    throw std::invalid_argument("no pair of meshes is called " + name + ": there are " + known);
  }
  pair.a = normalised(std::move(pair.a));
  pair.b = normalised(std::move(pair.b));
  if (name == "body-tiny") {
    for (Vec3d& v : pair.b.vertices) v *= 1e-4;
  }
  return pair;
}

std::string describe_faces(const Mesh& mesh) {
  const auto quads = std::count_if(mesh.faces.begin(), mesh.faces.end(),
                                   [](const Mesh::Face& face) { return face.kind == Kind::quad; });
  return std::to_string(mesh.faces.size()) + (quads != 0 ? " quads" : "");
}

const char* name_of(PoseClass pose_class) {
  switch (pose_class) {
    case PoseClass::touch:
      return "touch";
    case PoseClass::near:
      return "near";
    case PoseClass::deep:
      return "deep";
    case PoseClass::far:
      return "far";
    case PoseClass::graze:
      break;
  }
  return "graze";
}

PosePair Approach::at(double from_centre) const {
  PosePair poses = {pose_a, pose_b};
  poses.b.translation() += from_centre * direction;
  return poses;
}

PoseMaker::PoseMaker(Device& device, const Object& a, const Object& b, std::uint64_t seed)
    : device_(device),
      a_(a),
      b_(b),
      segment_(unit_segment()),
      random_(seed),
      radius_a_(radius(a.mesh())),
      radius_b_(radius(b.mesh())),
      size_(std::min(diagonal(a.mesh()), diagonal(b.mesh()))) {}

Vec3d PoseMaker::direction() {
  std::normal_distribution<double> normal;
  Vec3d result;
  for (double& x : result) x = normal(random_);
  return result.normalized();
}

Pose PoseMaker::turned() {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond turn;
  for (double& x : turn.coeffs()) x = normal(random_);
  Pose pose = Pose::Identity();
  pose.linear() = turn.normalized().toRotationMatrix();
  return pose;
}

bool PoseMaker::hit(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b) {
  return collide(device_, a, pose_a, b, pose_b).hit;
}

Approach PoseMaker::approach() {
  for (;;) {
    Approach result;
    result.pose_a = turned();
    result.pose_b = turned();
    result.pose_a.translation() = radius_a_ * direction();
    result.pose_b.translation() = result.pose_a.translation();
    result.direction = direction();
    double far = radius_a_ + radius_b_;
    const double step = std::min(0.01 * radius_a_, 0.5 * radius_b_);
    if (radius_b_ < 0.1 * radius_a_) {
      // B is so small that the steps would be many: where does the line to the centre of A meet it first?
      double free = 0;
      double cut = far;
      Pose ray = Pose::Identity();
      ray.linear().setZero();
      ray.translation() = result.pose_a.translation() + far * result.direction;
      const auto reach = [&](double length) {
        ray.linear().col(0) = -length * result.direction;
        return hit(a_, result.pose_a, segment_, ray);
      };
      if (!reach(cut)) continue;
      while (cut - free > step) (reach((free + cut) / 2) ? cut : free) = (free + cut) / 2;
      far += 2 * radius_b_ - free;
    }
    const auto touches = [&](double distance) {
      const PosePair poses = result.at(distance);
      return hit(a_, poses.a, b_, poses.b);
    };
    double near = far - step;
    while (near > 0 && !touches(near)) {
      far = near;
      near -= step;
    }
    if (near <= 0) continue;  // B lies inside a hole of A, or the other way round
    while (far - near > 1e-9 * size_) {
      const double middle = (near + far) / 2;
      (touches(middle) ? near : far) = middle;
    }
    result.distance = near;
    return result;
  }
}

PosePair PoseMaker::pose(const Approach& approach, PoseClass pose_class) {
  switch (pose_class) {
    case PoseClass::touch:
      return approach.at(approach.distance * uniform(0.95, 1.05));
    case PoseClass::near:
      return approach.at(approach.distance * uniform(1.001, 1.02));
    case PoseClass::deep:
      return approach.at(approach.distance * uniform(0.3, 0.7));
    case PoseClass::far:
      return approach.at(approach.distance * uniform(1.2, 2));
    case PoseClass::graze:
      break;
  }
  const double off = size_ * std::pow(10, uniform(-6, -3));
  return approach.at(approach.distance + (uniform(0, 1) < 0.5 ? -off : off));
}

std::vector<PosePair> PoseMaker::path(std::size_t count, double step) {
  const Approach start = approach();
  const Vec3d contact = start.distance * start.direction;
  Vec3d place = contact;
  std::vector<PosePair> poses;
  Pose turn = start.pose_b;
  const double most_turn = step * 0.5 * 3.14159265358979 / 180;
  while (poses.size() < count) {
    place += (step * size_ * 1e-3) * direction() + 0.01 * (contact - place);  // wanders, but not away
    turn.linear() = (Eigen::AngleAxisd(uniform(0, most_turn), direction()) * Eigen::Quaterniond(turn.linear()))
                        .normalized()
                        .toRotationMatrix();
    poses.push_back({start.pose_a, turn});
    poses.back().b.translation() += place;
  }
  return poses;
}

}  // namespace cchip::testing
