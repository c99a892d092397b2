// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks certificates (docs/cpp/certificates.md). Trusts nothing: it uses plain data of this library and Boost's
/// integers, no code of the search, of the predicates or of the maker. Needs Boost.Multiprecision.
#ifndef CCHIP_CHECK_HPP
#define CCHIP_CHECK_HPP

#include <algorithm>
#include <cchip/certificate.hpp>
#include <cchip/internal/certificate/exact_points.hpp>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace cchip {

struct CertificateVerdict {
  bool accepted = false;
  std::string reason;    ///< why not
  std::size_t cell = 0;  ///< the first cell that fails; the number of cells if the claim does not follow from them
};

namespace certificate_check {

/// A set of faces: an interval of an order, which may be that of a tree.
struct Faces {
  const std::uint32_t* order;
  CertificateTree::Set set;
  const CertificateTree* tree = nullptr;
  const std::uint32_t* begin() const { return order + set.begin; }
  const std::uint32_t* end() const { return order + set.end; }
};

struct Checker {
  std::array<const Mesh*, 2> mesh;
  Placement placement;
  bool below = false;
  std::optional<Point> along = std::nullopt;  ///< times any power of two

  Point corner(std::size_t side, std::uint32_t face, std::size_t k) const {
    return placement.posed(side, mesh[side]->vertices[mesh[side]->faces[face].vertex[k]]);
  }
  std::size_t corners(std::size_t side, std::uint32_t face) const {
    return static_cast<std::size_t>(mesh[side]->faces[face].kind);
  }

  /// The greatest value of A minus the least of B along the direction: of its sign alone there is use.
  Int overlap(const Point& direction, const std::array<Faces, 2>& faces) const {
    return greatest(0, direction, faces[0]) + greatest(1, {-direction[0], -direction[1], -direction[2]}, faces[1]);
  }

  /// Does the direction keep the faces of A below those of B, as the claim wants it?
  bool separates(const Point& d, const std::array<Faces, 2>& faces) const {
    const Int gap = -overlap(d, faces);
    if (along) {
      const Int rise = dot(d, *along);
      return gap > 0 ? rise >= 0 : gap == 0 && rise > 0;
    }
    const Int& within = placement.length();
    if (gap <= 0 || within == 0) return gap > 0;
    const Int least = within * within * dot(d, d);
    return below ? gap * gap >= least : gap * gap > least;
  }

  Int greatest(std::size_t side, const Point& direction, const Faces& faces) const {
    const Placement::Functional value = placement.functional(side, direction);
    std::optional<Int> greatest;
    const auto take = [&](Int here) {
      if (!greatest || here > *greatest) greatest = std::move(here);
    };
    const auto on_faces = [&](const CertificateTree::Set& set) {
      for_each_vertex(side, {faces.order, set}, [&](std::uint32_t vertex) {
        take(value(placement.of_mesh(side, mesh[side]->vertices[vertex])));
      });
    };
    const auto on_box = [&](const CertificateTree::Box& box) {  // at the corner that the signs of the factors choose
      Vec3d corner = box.low;
      for (Eigen::Index i = 0; i < 3; ++i) {
        if (value.factors[static_cast<std::size_t>(i)] > 0) corner[i] = box.high[i];
      }
      take(value(placement.of_mesh(side, corner)));
    };
    if (faces.tree != nullptr) {
      faces.tree->for_hull(faces.set, on_faces, on_box);
    } else {
      on_faces(faces.set);
    }
    return *std::move(greatest);
  }

  /// Calls `take` for the vertices of the faces: for each once, if there are many faces.
  template <class Take>
  void for_each_vertex(std::size_t side, const Faces& faces, const Take& take) const {
    std::vector<bool> taken(faces.set.size() < 64 ? 0 : mesh[side]->vertices.size());
    for (const std::uint32_t face : faces) {
      for (std::size_t k = 0; k < corners(side, face); ++k) {
        const std::uint32_t vertex = mesh[side]->faces[face].vertex[k];
        if (!taken.empty() && taken[vertex]) continue;
        if (!taken.empty()) taken[vertex] = true;
        take(vertex);
      }
    }
  }

  void check_point(const CertificateCell& cell) const {
    using CellKind = CertificateCell::Kind;
    const std::array<std::uint32_t, 2> face = {cell.face_a, cell.face_b};
    std::array<Int, 2> total;
    std::array<Point, 2> sum;
    for (const std::size_t side : {0U, 1U}) {
      require(face[side] < mesh[side]->faces.size(), "there is no such face");
      const std::vector<Int> weights = integers(side == 0 ? cell.weights_a : cell.weights_b, corners(side, face[side]));
      for (std::size_t k = 0; k < weights.size(); ++k) {
        require(weights[k] >= (cell.kind == CellKind::cross ? 1 : 0), "a weight is too small");
        total[side] += weights[k];
        const Point p = corner(side, face[side], k);
        for (std::size_t axis = 0; axis < 3; ++axis) sum[side][axis] += weights[k] * p[axis];
      }
      require(total[side] > 0, "all weights are 0");
    }
    Int square = 0;  // of the distance of the points, times both totals
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Int difference = sum[0][axis] * total[1] - sum[1][axis] * total[0];
      square += difference * difference;
    }
    if (cell.kind == CellKind::near) {
      const Int most = placement.length() * total[0] * total[1];
      require(below ? square < most * most : square <= most * most, "the points are too far apart");
      return;
    }
    require(square == 0, "the points differ");
    if (cell.kind == CellKind::touch)
      require(overlap(direction_of(cell.direction), {{{face.data(), {0, 1}}, {face.data(), {1, 2}}}}) <= 0,
              "A is not below B");
    if (cell.kind != CellKind::cross) return;
    std::vector<Point> e;
    for (const CertificateCell::Edge edge : cell.span) {
      const std::size_t side = edge.of_b;
      require(edge.vertex < corners(side, face[side]), "an edge ends at no vertex");
      const Point p = corner(side, face[side], 0), q = corner(side, face[side], edge.vertex);
      e.push_back({q[0] - p[0], q[1] - p[1], q[2] - p[2]});
    }
    Int determinant = 0;
    for (std::size_t x = 0, y = 1, z = 2; x < 3; ++x, y = (x + 1) % 3, z = (x + 2) % 3)
      determinant += e[0][x] * (e[1][y] * e[2][z] - e[1][z] * e[2][y]);
    require(determinant != 0, "the edges do not span space");
  }
};

/// What a certificate is checked against. The trees are those that a certificate may cite, or null.
struct Sides {
  std::array<const CheckedMesh*, 2> mesh;
  std::array<const CertificateTree*, 2> tree;
};

inline CertificateVerdict check(const Sides& sides, const Pose& pose_a, const Pose& pose_b, const Certificate& c) {
  using CellKind = CertificateCell::Kind;
  const char* const other_contacts = "other contacts than claimed";
  const Mesh &a = sides.mesh[0]->mesh(), &b = sides.mesh[1]->mesh();
  const bool cites = c.version == 3;  // its sets are those of trees
  const bool is_measured = c.within > 0 || c.along;
  std::size_t number = 0;
  try {
    require(cites ? c.all : c.version == (is_measured ? 2 : 1), "unknown version");
    require(c.within >= 0 && std::isfinite(c.within) && (c.within > 0 || !c.below), "no distance");
    Checker checker = {{&a, &b}, Placement(sides.mesh, {&pose_a, &pose_b}, c.within), c.below};
    if (c.along) {
      require(c.all && c.contacts.empty() && !c.relation && c.within == 0, "no claim of a translation");
      checker.along = whole_point(*c.along);
      require(*checker.along != Point{0, 0, 0}, "the translation is 0");
    }
    require(c.hash_a == sides.mesh[0]->hash() && c.hash_b == sides.mesh[1]->hash(),
            "the certificate is of other meshes");
    require(c.hash_poses == hash_poses(pose_a, pose_b), "the certificate is of other poses");
    std::array<const std::vector<std::uint32_t>*, 2> order = {&c.order_a, &c.order_b};
    if (cites) {
      require(sides.tree[0] != nullptr && sides.tree[1] != nullptr, "it cites trees, and none are given");
      require(c.tree_a == sides.tree[0]->tree_hash() && c.tree_b == sides.tree[1]->tree_hash(), "it cites other trees");
      require(c.order_a.empty() && c.order_b.empty(), "an order beside a tree");
      order = {&sides.tree[0]->order(), &sides.tree[1]->order()};
    }
    // Of two faces of the files: kinds of the cells that name a point of their parts.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<CellKind>> found;
    using Sets = std::array<CertificateTree::Set, 2>;  // of A and of B
    std::vector<Sets> open;                            // cells that are to come
    if (c.all) {
      for (const std::size_t side : {0U, 1U}) {
        if (!cites) check_order(*order[side], checker.mesh[side]->faces.size());
      }
      open.push_back({{{0, a.faces.size()}, {0, b.faces.size()}}});
    }
    require(c.all || (c.order_a.size() + c.order_b.size() == 0 && c.cells.size() == 1), "one contact is one cell");
    for (const CertificateCell& cell : c.cells) {
      require(!c.all || !open.empty(), "a cell too many");
      const Sets sets = c.all ? open.back() : Sets{};
      if (c.all) open.pop_back();
      if (cell.kind == CellKind::split_a || cell.kind == CellKind::split_b) {
        Sets first = sets, second = sets;
        const std::size_t side = cell.kind == CellKind::split_b;
        const std::size_t at = cites ? sets[side].middle() : cell.at;
        require(sets[side].begin < at && at < sets[side].end, "a split leaves one half empty");
        first[side].end = second[side].begin = at;
        open.insert(open.end(), {second, first});
      } else if (cell.kind == CellKind::separated) {
        require(c.all, "a claim of one contact needs a point");
        const auto faces = [&](std::size_t side) {
          return Faces{order[side]->data(), sets[side], cites ? sides.tree[side] : nullptr};
        };
        require(checker.separates(direction_of(cell.direction), {{faces(0), faces(1)}}),
                c.within > 0 ? "A is not far enough below B" : "A is not strictly below B");
      } else {
        require(cell.kind <= CellKind::near && (cell.kind == CellKind::near) == (c.within > 0) && !c.along,
                "unknown kind of cell");
        const bool single = sets[0].size() == 1 && sets[1].size() == 1;
        require(!c.all ||
                    (single && cell.face_a == (*order[0])[sets[0].begin] && cell.face_b == (*order[1])[sets[1].begin]),
                "the point of other faces");
        checker.check_point(cell);
        found[{a.number_in_file(cell.face_a), b.number_in_file(cell.face_b)}].insert(cell.kind);
      }
      ++number;
    }
    require(open.empty(), "cells are missing");
    Relation strongest = Relation::apart;
    bool all_told = c.all && !is_measured;
    require(c.least == Relation::touching || (c.least == Relation::crossing && !is_measured),
            "unknown kind of contacts");
    auto claimed = c.contacts.begin();
    for (const auto& [faces, kinds] : found) {
      const Relation relation = kinds.count(CellKind::cross) != 0 ? Relation::crossing : Relation::touching;
      const bool told =
          c.within == 0 && (relation == Relation::crossing || (c.all && kinds.count(CellKind::meet) == 0));
      strongest = std::max(strongest, relation);
      all_told = all_told && told;
      require(told || c.least == Relation::touching, "not told whether two faces cross");
      if (relation < c.least) continue;
      require(claimed != c.contacts.end() && faces == std::pair(claimed->face_a, claimed->face_b), other_contacts);
      require(!claimed->relation || (told && *claimed->relation == relation), "two faces are not so related");
      ++claimed;
    }
    require(claimed == c.contacts.end(), other_contacts);
    all_told = all_told || strongest == Relation::crossing;
    require(!c.relation || (all_told && strongest == *c.relation), "another relation than claimed");
  } catch (const std::invalid_argument& error) {
    return {false, error.what(), number};
  }
  return {true, "", number};
}

}  // namespace certificate_check

/// Does the claim of the certificate follow from its cells, and do these hold for the meshes in their poses? Never
/// throws but for want of memory. Time is at most proportional to the pairs of faces and the size of the certificate.
inline CertificateVerdict check_certificate(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b,
                                            const Certificate& certificate) {
  try {
    const CheckedMesh checked_a(a), checked_b(b);
    return certificate_check::check({{&checked_a, &checked_b}, {}}, pose_a, pose_b, certificate);
  } catch (const std::invalid_argument& error) {
    return {false, error.what(), 0};
  }
}

/// The same of meshes with trees, which a certificate of version 3 cites: time is proportional to the size of the
/// certificate then.
inline CertificateVerdict check_certificate(const CertificateTree& a, const Pose& pose_a, const CertificateTree& b,
                                            const Pose& pose_b, const Certificate& certificate) {
  return certificate_check::check({{&a, &b}, {&a, &b}}, pose_a, pose_b, certificate);
}

}  // namespace cchip

#endif
