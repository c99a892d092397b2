// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks certificates (docs/cpp/certificates.md). Trusts nothing: it uses plain data of this library and Boost's
/// integers, no code of the search, of the predicates or of the maker. Needs Boost.Multiprecision.
#ifndef CCHIP_CERTIFICATE_CHECK_HPP
#define CCHIP_CERTIFICATE_CHECK_HPP

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/certificate/certificate.hpp>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace cchip {

struct CertificateVerdict {
  bool accepted = false;
  std::string reason;    ///< why not
  std::size_t cell = 0;  ///< the first cell that fails; the number of cells if the claim does not follow from them
};

namespace certificate_check {

using Int = boost::multiprecision::cpp_int;
using Point = std::array<Int, 3>;

inline void require(bool holds, const char* otherwise) {
  if (!holds) throw std::invalid_argument(otherwise);
}

/// The vertices of the faces of both meshes in their poses, all multiplied by the same power of two; exact.
inline std::array<std::vector<Point>, 2> place(const std::array<const Mesh*, 2>& mesh,
                                               const std::array<const Pose*, 2>& pose) {
  using Rational = boost::multiprecision::cpp_rational;
  const auto exact = [](double x) {
    require(std::isfinite(x), "a number of a mesh or a pose is not finite");
    return Rational(x);
  };
  std::array<std::vector<std::array<Rational, 3>>, 2> placed;
  Int scale = 1;  // denominators are powers of two, so the greatest is a multiple of all
  for (const std::size_t side : {0U, 1U}) {
    const std::vector<Vec3d>& vertices = mesh[side]->vertices;
    std::vector<bool> used(vertices.size());
    for (const Mesh::Face& face : mesh[side]->faces) {
      require(face.kind == Kind::tri || face.kind == Kind::quad, "a face is neither triangle nor quad");
      for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
        require(face.vertex[k] < used.size(), "a face has a vertex that does not exist");
        used[face.vertex[k]] = true;
      }
    }
    placed[side].resize(used.size());
    for (std::size_t v = 0; v < used.size(); ++v) {
      for (int row = 0; used[v] && row < 3; ++row) {
        Rational& x = placed[side][v][static_cast<std::size_t>(row)];
        x = exact((*pose[side])(row, 3));
        for (int i = 0; i < 3; ++i) x += exact((*pose[side])(row, i)) * exact(vertices[v][i]);
        scale = std::max(scale, Int(denominator(x)));
      }
    }
  }
  const auto whole = [&](const Rational& x) { return Int(numerator(x) * (scale / denominator(x))); };
  std::array<std::vector<Point>, 2> points;
  for (const std::size_t side : {0U, 1U}) {
    for (const auto& x : placed[side]) {
      points[side].push_back({whole(x[0]), whole(x[1]), whole(x[2])});
    }
  }
  return points;
}

inline std::vector<Int> integers(const std::vector<Digits>& texts, std::size_t count) {
  require(texts.size() == count, "wrong number of weights or components");
  std::vector<Int> result;
  for (const Digits& text : texts) {
    const std::size_t sign = !text.empty() && text[0] == '-';
    require(text.size() > sign && text.size() <= 20000 &&
                text.find_first_not_of("0123456789", sign) == std::string::npos &&
                (text[sign] != '0' || text.size() == 1),
            "not an integer of at most 20000 digits");
    result.emplace_back(text);
  }
  return result;
}

inline Int dot(const std::vector<Int>& d, const Point& p) { return d[0] * p[0] + d[1] * p[1] + d[2] * p[2]; }

struct Checker {
  std::array<const Mesh*, 2> mesh;
  std::array<std::vector<Point>, 2> points;

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
    std::array<Int, 2> end;
    for (const std::size_t side : {0U, 1U}) {
      bool first = true;
      for (const std::uint32_t face : faces[side]) {
        for (std::size_t k = 0; k < corners(side, face); ++k) {
          const Int value = dot(d, corner(side, face, k));
          if (first || (side == 0 ? value > end[0] : value < end[1])) end[side] = value;
          first = false;
        }
      }
    }
    return end[0] - end[1];
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
    for (std::size_t axis = 0; axis < 3; ++axis)
      require(sum[0][axis] * total[1] == sum[1][axis] * total[0], "the points differ");
    if (cell.kind == CellKind::touch)
      require(overlap(cell.direction, {{{face[0]}, {face[1]}}}) <= 0, "A is not below B");
    if (cell.kind != CellKind::cross) return;
    std::array<Point, 3> e;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t side = cell.span[i].of_b, vertex = cell.span[i].vertex;
      require(vertex < corners(side, face[side]), "an edge ends at no vertex");
      for (std::size_t axis = 0; axis < 3; ++axis)
        e[i][axis] = corner(side, face[side], vertex)[axis] - corner(side, face[side], 0)[axis];
    }
    const Int determinant = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
                            e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
                            e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    require(determinant != 0, "the edges do not span space");
  }
};

inline void check_order(const std::vector<std::uint32_t>& order, std::size_t faces) {
  require(faces > 0 && order.size() == faces, "an order does not hold each face once");
  std::vector<bool> seen(faces);
  for (const std::uint32_t face : order) {
    require(face < faces && !seen[face], "an order does not hold each face once");
    seen[face] = true;
  }
}

/// What the cells say of two faces of the files.
struct Finding {
  bool crosses = false;
  bool told = true;  ///< of each pair of their parts that meets, whether it crosses
};

}  // namespace certificate_check

/// Does the claim of the certificate follow from its cells, and do these hold for the meshes in their poses? Never
/// throws but for want of memory. Time is at most proportional to the pairs of faces and the size of the certificate.
inline CertificateVerdict check_certificate(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b,
                                            const Certificate& certificate) {
  using namespace certificate_check;
  using CellKind = CertificateCell::Kind;
  const Certificate& c = certificate;
  std::size_t number = 0;
  try {
    require(c.version == Certificate::current_version, "unknown version");
    require((a.file_face.empty() || a.file_face.size() == a.faces.size()) &&
                (b.file_face.empty() || b.file_face.size() == b.faces.size()),
            "file_face has another length than faces");
    const Checker checker = {{&a, &b}, place({&a, &b}, {&pose_a, &pose_b})};
    require(c.hash_a == hash_mesh(a) && c.hash_b == hash_mesh(b), "the certificate is of other meshes");
    require(c.hash_poses == hash_poses(pose_a, pose_b), "the certificate is of other poses");
    std::map<std::pair<std::uint32_t, std::uint32_t>, Finding> found;
    struct Range {
      std::size_t begin, end;
    };
    std::vector<std::array<Range, 2>> open;  // sets whose cells are to come
    if (c.all) {
      check_order(c.order_a, a.faces.size());
      check_order(c.order_b, b.faces.size());
      open.push_back({{{0, a.faces.size()}, {0, b.faces.size()}}});
    } else {
      require(c.order_a.empty() && c.order_b.empty() && c.cells.size() == 1,
              "a claim of one contact has one cell and no orders");
    }
    for (const CertificateCell& cell : c.cells) {
      std::array<Range, 2> sets = {};
      if (c.all) {
        require(!open.empty(), "a cell too many");
        sets = open.back();
        open.pop_back();
      }
      if (cell.kind == CellKind::split_a || cell.kind == CellKind::split_b) {
        std::array<Range, 2> first = sets, second = sets;
        const std::size_t side = cell.kind == CellKind::split_b;
        require(c.all && sets[side].begin < cell.at && cell.at < sets[side].end, "a split leaves one half empty");
        first[side].end = second[side].begin = cell.at;
        open.push_back(second);
        open.push_back(first);
      } else if (cell.kind == CellKind::separated) {
        require(c.all, "a claim of one contact needs a point");
        const auto part = [](const std::vector<std::uint32_t>& order, Range set) {
          const auto from = order.begin();
          return std::vector<std::uint32_t>(from + static_cast<std::ptrdiff_t>(set.begin),
                                            from + static_cast<std::ptrdiff_t>(set.end));
        };
        require(checker.overlap(cell.direction, {part(c.order_a, sets[0]), part(c.order_b, sets[1])}) < 0,
                "A is not strictly below B");
      } else {
        require(cell.kind <= CellKind::cross, "unknown kind of cell");
        if (c.all) {
          require(sets[0].end - sets[0].begin == 1 && sets[1].end - sets[1].begin == 1,
                  "a point for more than one pair of faces");
          require(cell.face_a == c.order_a[sets[0].begin] && cell.face_b == c.order_b[sets[1].begin],
                  "the point of other faces");
        }
        checker.check_point(cell);
        Finding& finding = found[{a.number_in_file(cell.face_a), b.number_in_file(cell.face_b)}];
        finding.crosses |= cell.kind == CellKind::cross;
        finding.told &= c.all && cell.kind != CellKind::meet;
      }
      ++number;
    }
    require(open.empty(), "cells are missing");
    Relation strongest = Relation::apart;
    bool told = c.all;
    require(c.least == Relation::touching || c.least == Relation::crossing,
            "contacts that are neither touching nor crossing");
    auto contact = c.contacts.begin();
    for (const auto& [faces, finding] : found) {
      strongest = std::max(strongest, finding.crosses ? Relation::crossing : Relation::touching);
      told = told && (finding.crosses || finding.told);
      if (c.least == Relation::crossing) require(finding.crosses || finding.told, "not told whether two faces cross");
      if (c.least == Relation::crossing && !finding.crosses) continue;
      require(contact != c.contacts.end() && faces == std::make_pair(contact->face_a, contact->face_b),
              "other contacts than claimed");
      const bool relation_told = finding.crosses || finding.told;
      const Relation relation = finding.crosses ? Relation::crossing : Relation::touching;
      require(!contact->relation || (relation_told && *contact->relation == relation), "two faces are not so related");
      ++contact;
    }
    require(contact == c.contacts.end(), "other contacts than claimed");
    if (c.relation)
      require(strongest == *c.relation && (told || strongest == Relation::crossing), "another relation than claimed");
  } catch (const std::invalid_argument& error) {
    return {false, error.what(), number};
  }
  return {true, "", number};
}

}  // namespace cchip

#endif
