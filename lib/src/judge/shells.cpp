// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/internal/judge/shells.hpp>
#include <cmath>
#include <numeric>

#include "edges.hpp"
#include "exact/common_part.hpp"

namespace cchip {
namespace {

using exact::BigInt;

/// Smallest exponent of the coordinates, with odd mantissas.
int exponent_of(const Mesh& mesh) {
  int least = std::numeric_limits<double>::max_exponent;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const Primitive p = mesh.primitive(f);
    for (std::size_t i = 0; i < p.vertex_count(); ++i) {
      for (const double x : p.v[i]) {
        if (x != 0 && std::ilogb(x) - std::numeric_limits<double>::digits < least) {
          least = std::min(least, exact::odd(exact::Scaled(x)).exponent);
        }
      }
    }
  }
  return least;
}

/// Does each triangle of the face have an area, and do those of a quad that is flat lie beside each other?
bool has_area(const Primitive& p) {
  using exact::operator-;
  const Pose here = Pose::Identity();
  const std::array<exact::Vec<BigInt>, 4> v = exact::scaled_points(p, here, exact::common_exponent(p, here, 0));
  const exact::Vec<BigInt> normal = exact::cross(v[1] - v[0], v[2] - v[0]);
  if (exact::is_zero(normal)) return false;
  if (p.kind == Kind::tri) return true;
  const exact::Vec<BigInt> other = exact::cross(v[2] - v[0], v[3] - v[0]);
  if (exact::is_zero(other)) return false;
  return !exact::is_zero(exact::cross(normal, other)) || exact::sign_of_dot(normal, other) > 0;
}

/// The same, in doubles where they are certain.
bool certainly_has_area(const Primitive& p) {
  const auto is_certain = [](const Vec3d& u, const Vec3d& v) {
    const Vec3d normal = u.cross(v);
    const double size = u.cwiseAbs().maxCoeff() * v.cwiseAbs().maxCoeff();
    return size > 0x1p-500 && size < 0x1p500 && normal.cwiseAbs().maxCoeff() > 0x1p-40 * size;
  };
  // A difference of two doubles is off by at most 2^-53 of itself.
  const Vec3d u = p.v[1] - p.v[0];
  const Vec3d v = p.v[2] - p.v[0];
  if (!is_certain(u, v)) return false;
  if (p.kind == Kind::tri) return true;
  const Vec3d w = p.v[3] - p.v[0];
  return is_certain(v, w) && u.cross(v).normalized().dot(v.cross(w).normalized()) > 0x1p-20;
}

bool share_area(const Object& object, const Contact& contact) {
  const Pose here = Pose::Identity();
  for (const std::uint32_t i : object.parts(contact.face_a)) {
    for (const std::uint32_t k : object.parts(contact.face_b)) {
      const auto part = exact::common_part(object.mesh().primitive(i), here, object.mesh().primitive(k), here);
      if (part && part->kind == Intersection::Kind::polygon) return true;
    }
  }
  return false;
}

void find_overlap(const Object& object, Shells& shells) {
  constexpr std::size_t some = 64;  // all of them only if these do not tell
  for (const std::size_t most : {some, std::numeric_limits<std::size_t>::max()}) {
    const std::vector<Contact> contacts = self_contacts(object, most);
    shells.simple = contacts.empty();
    for (const Contact& contact : contacts) {
      if (contact.relation != Relation::crossing && !share_area(object, contact)) continue;
      shells.overlap = contact;
      return;
    }
    if (contacts.size() < most) return;
  }
}

/// Joins faces over edges that exactly two use.
void find_shells(const Object& object, Shells& shells) {
  const Mesh& mesh = object.mesh();
  std::vector<std::uint32_t> root(mesh.faces.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&root](std::uint32_t f) {
    while (root[f] != f) f = root[f] = root[root[f]];
    return f;
  };
  for (const Edge& edge : find_edges(mesh, object.same_place())) {
    if (edge.uses == 2) root[find(edge.face)] = find(edge.last_face);
  }
  shells.of_face.resize(mesh.faces.size());
  std::vector<std::uint32_t> number(mesh.faces.size(), std::numeric_limits<std::uint32_t>::max());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    std::uint32_t& shell = number[find(f)];
    if (shell == std::numeric_limits<std::uint32_t>::max()) {
      shell = static_cast<std::uint32_t>(shells.first_face.size());
      shells.first_face.push_back(f);
    }
    shells.of_face[f] = shell;
  }
}

Shells make_shells(const Object& object) {
  Shells shells;
  const Mesh& mesh = object.mesh();
  shells.exponent = exponent_of(mesh);
  find_overlap(object, shells);
  for (std::uint32_t f = 0; f < mesh.faces.size() && shells.simple; ++f) {
    const Primitive p = mesh.primitive(f);
    shells.simple = certainly_has_area(p) || has_area(p);
  }
  find_shells(object, shells);
  return shells;
}

}  // namespace

const Shells& Object::shells() const {
  Edges& edges = *data().edges;
  const std::lock_guard<std::mutex> lock(edges.shells_mutex);
  if (!edges.shells) edges.shells = make_shells(*this);
  return *edges.shells;
}

const Shells& shells_of(const Object& object) { return object.shells(); }

std::optional<Contact> shell_overlap(const Object& object) { return object.shells().overlap; }

}  // namespace cchip
