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

struct Checker {
  std::array<const Mesh*, 2> mesh;
  std::array<std::vector<Point>, 2> points;
  Int within = 0;  ///< in their unit
  bool below = false;
  std::optional<Point> along = std::nullopt;  ///< times any power of two

  const Point& corner(std::size_t side, std::uint32_t face, std::size_t k) const {
    return points[side][mesh[side]->faces[face].vertex[k]];
  }
  std::size_t corners(std::size_t side, std::uint32_t face) const {
    return static_cast<std::size_t>(mesh[side]->faces[face].kind);
  }

  /// The greatest value of A's faces minus the least of B's along the direction: of its sign alone there is use.
  Int overlap(const std::vector<Digits>& direction, const std::array<std::vector<std::uint32_t>, 2>& faces) const {
    const std::vector<Int> d = integers(direction, 3);
    require(d[0] != 0 || d[1] != 0 || d[2] != 0, "the direction is 0");
    std::array<std::optional<Int>, 2> end;  // the greatest of A, the least of B
    for (const std::size_t side : {0U, 1U}) {
      const auto take = [&, side](std::uint32_t vertex) {
        Int value = dot(d, points[side][vertex]);
        if (!end[side] || (side == 0 ? value > *end[side] : value < *end[side])) end[side] = std::move(value);
      };
      for_each_vertex(side, faces[side], take);
    }
    return *end[0] - *end[1];
  }

  /// Does the direction keep the faces of A below those of B, as the claim wants it?
  bool separates(const std::vector<Digits>& direction, const std::array<std::vector<std::uint32_t>, 2>& faces) const {
    const Int gap = -overlap(direction, faces);
    const std::vector<Int> d = integers(direction, 3);
    if (along) {
      const Int rise = dot(d, *along);
      return gap > 0 ? rise >= 0 : gap == 0 && rise > 0;
    }
    if (gap <= 0 || within == 0) return gap > 0;
    const Int least = within * within * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return below ? gap * gap >= least : gap * gap > least;
  }

  /// Calls `take` for the vertices of the faces: for each once, if there are many faces.
  template <class Take>
  void for_each_vertex(std::size_t side, const std::vector<std::uint32_t>& faces, const Take& take) const {
    std::vector<bool> taken(faces.size() < 64 ? 0 : points[side].size());
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
        for (std::size_t axis = 0; axis < 3; ++axis) sum[side][axis] += weights[k] * corner(side, face[side], k)[axis];
      }
      require(total[side] > 0, "all weights are 0");
    }
    Int square = 0;  // of the distance of the points, times both totals
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Int difference = sum[0][axis] * total[1] - sum[1][axis] * total[0];
      square += difference * difference;
    }
    if (cell.kind == CellKind::near) {
      const Int most = within * total[0] * total[1];
      require(below ? square < most * most : square <= most * most, "the points are too far apart");
      return;
    }
    require(square == 0, "the points differ");
    if (cell.kind == CellKind::touch)
      require(overlap(cell.direction, {{{face[0]}, {face[1]}}}) <= 0, "A is not below B");
    if (cell.kind != CellKind::cross) return;
    std::vector<Point> e;
    for (const CertificateCell::Edge edge : cell.span) {
      const std::size_t side = edge.of_b;
      require(edge.vertex < corners(side, face[side]), "an edge ends at no vertex");
      const Point &p = corner(side, face[side], 0), &q = corner(side, face[side], edge.vertex);
      e.push_back({q[0] - p[0], q[1] - p[1], q[2] - p[2]});
    }
    Int determinant = 0;
    for (std::size_t x = 0, y = 1, z = 2; x < 3; ++x, y = (x + 1) % 3, z = (x + 2) % 3)
      determinant += e[0][x] * (e[1][y] * e[2][z] - e[1][z] * e[2][y]);
    require(determinant != 0, "the edges do not span space");
  }
};

}  // namespace certificate_check

/// Does the claim of the certificate follow from its cells, and do these hold for the meshes in their poses? Never
/// throws but for want of memory. Time is at most proportional to the pairs of faces and the size of the certificate.
inline CertificateVerdict check_certificate(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b,
                                            const Certificate& certificate) {
  using namespace certificate_check;
  using CellKind = CertificateCell::Kind;
  const Certificate& c = certificate;
  const char* const other_contacts = "other contacts than claimed";
  std::size_t number = 0;
  try {
    require(c.version == (c.within > 0 || c.along ? 2 : 1), "unknown version");
    for (const Mesh* m : {&a, &b})
      require(m->file_face.empty() || m->file_face.size() == m->faces.size(), "a broken mesh");
    require(c.within >= 0 && std::isfinite(c.within) && (c.within > 0 || !c.below), "no distance");
    Placed placed = place({&a, &b}, {&pose_a, &pose_b}, c.within);
    Checker checker = {{&a, &b}, std::move(placed.points), std::move(placed.length), c.below};
    if (c.along) {
      require(c.all && c.contacts.empty() && !c.relation && c.within == 0, "no claim of a translation");
      checker.along = whole_point(*c.along);
      require(*checker.along != Point{0, 0, 0}, "the translation is 0");
    }
    require(c.hash_a == hash_mesh(a) && c.hash_b == hash_mesh(b), "the certificate is of other meshes");
    require(c.hash_poses == hash_poses(pose_a, pose_b), "the certificate is of other poses");
    // Of two faces of the files: kinds of the cells that name a point of their parts.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<CellKind>> found;
    using Sets = std::array<std::array<std::size_t, 2>, 2>;  // of A and of B: begin and end in the order
    std::vector<Sets> open;                                  // cells that are to come
    if (c.all) {
      for (const std::size_t side : {0U, 1U}) {
        const std::vector<std::uint32_t>& order = side == 0 ? c.order_a : c.order_b;
        std::vector<bool> seen(checker.mesh[side]->faces.size());
        bool once = !seen.empty() && order.size() == seen.size();
        for (std::size_t i = 0; once && i < order.size(); ++i) {
          once = order[i] < seen.size() && !seen[order[i]];
          if (once) seen[order[i]] = true;
        }
        require(once, "an order does not hold each face once");
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
        require(sets[side][0] < cell.at && cell.at < sets[side][1], "a split leaves one half empty");
        first[side][1] = second[side][0] = cell.at;
        open.insert(open.end(), {second, first});
      } else if (cell.kind == CellKind::separated) {
        require(c.all, "a claim of one contact needs a point");
        const auto in_a = c.order_a.begin(), in_b = c.order_b.begin();
        const auto at = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
        require(checker.separates(cell.direction, {{{in_a + at(sets[0][0]), in_a + at(sets[0][1])},
                                                    {in_b + at(sets[1][0]), in_b + at(sets[1][1])}}}),
                c.within > 0 ? "A is not far enough below B" : "A is not strictly below B");
      } else {
        require(cell.kind <= CellKind::near && (cell.kind == CellKind::near) == (c.within > 0) && !c.along,
                "unknown kind of cell");
        const bool single = sets[0][1] - sets[0][0] == 1 && sets[1][1] - sets[1][0] == 1;
        require(!c.all || (single && cell.face_a == c.order_a[sets[0][0]] && cell.face_b == c.order_b[sets[1][0]]),
                "the point of other faces");
        checker.check_point(cell);
        found[{a.number_in_file(cell.face_a), b.number_in_file(cell.face_b)}].insert(cell.kind);
      }
      ++number;
    }
    require(open.empty(), "cells are missing");
    Relation strongest = Relation::apart;
    bool all_told = c.all && c.version == 1;
    require(c.least == Relation::touching || (c.least == Relation::crossing && c.version == 1),
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

}  // namespace cchip

#endif
