// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/bvh/dop26.hpp>
#include <cchip/certificate/certify.hpp>
#include <cchip/certificate/check.hpp>
#include <cchip/collide/face_pairs.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "certificate/pair_proof.hpp"

namespace cchip {
namespace {

using certificate_check::Int;
using certificate_check::Point;
using CellKind = CertificateCell::Kind;

/// Directions that sets of faces are tried on: those of the 26-DOPs in the frame of A and in that of B.
constexpr std::size_t direction_count = 2 * bvh::directions.size();
using Directions = std::array<std::array<int, 3>, direction_count>;

Directions directions_of(const std::array<const Pose*, 2>& poses) {
  Directions result = {};
  std::size_t n = 0;
  for (const Pose* pose : poses) {
    for (const std::array<int, 3>& d : bvh::directions) {
      Vec3d turned = pose->linear() * Vec3d(d[0], d[1], d[2]);
      turned *= 1024 / turned.cwiseAbs().maxCoeff();
      if (!turned.allFinite()) turned = 1024 * Vec3d(d[0], d[1], d[2]);  // a pose that is flat
      int divisor = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        result[n][i] = static_cast<int>(std::lround(turned[static_cast<Eigen::Index>(i)]));
        divisor = std::gcd(divisor, result[n][i]);
      }
      for (int& x : result[n]) x /= divisor;
      ++n;
    }
  }
  return result;
}

/// The faces of one mesh, halved again and again at the median.
struct Tree {
  struct Node {
    std::uint32_t begin = 0, end = 0;                     ///< in `order`
    std::uint32_t first = 0, second = 0;                  ///< nodes, if there is more than one face
    std::array<double, direction_count> least, greatest;  ///< rounded
    double size = 0;
  };
  std::vector<std::uint32_t> order;
  std::vector<Node> nodes;
};

class TreeBuilder {
 public:
  TreeBuilder(const Mesh& mesh, const std::vector<Vec3d>& points, const Directions& directions)
      : mesh_(mesh), points_(points), directions_(directions) {}
  Tree build() {
    tree_.order.resize(mesh_.faces.size());
    std::iota(tree_.order.begin(), tree_.order.end(), 0U);
    tree_.nodes.reserve(2 * tree_.order.size());
    node(0, static_cast<std::uint32_t>(tree_.order.size()));
    return std::move(tree_);
  }

 private:
  const Vec3d& corner(std::uint32_t face, std::size_t k) const { return points_[mesh_.faces[face].vertex[k]]; }
  std::size_t corners(std::uint32_t face) const { return static_cast<std::size_t>(mesh_.faces[face].kind); }

  std::uint32_t node(std::uint32_t begin, std::uint32_t end) {
    const auto number = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    Tree::Node n;
    n.begin = begin;
    n.end = end;
    n.least.fill(std::numeric_limits<double>::infinity());
    n.greatest.fill(-std::numeric_limits<double>::infinity());
    Vec3d low = Vec3d::Constant(std::numeric_limits<double>::infinity());
    Vec3d high = -low;
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t face = tree_.order[i];
      for (std::size_t k = 0; k < corners(face); ++k) {
        const Vec3d& p = corner(face, k);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
        for (std::size_t d = 0; d < direction_count; ++d) {
          const double value = directions_[d][0] * p[0] + directions_[d][1] * p[1] + directions_[d][2] * p[2];
          n.least[d] = std::min(n.least[d], value);
          n.greatest[d] = std::max(n.greatest[d], value);
        }
      }
    }
    Eigen::Index axis = 0;
    n.size = (high - low).maxCoeff(&axis);
    if (end - begin > 1) {
      const std::uint32_t middle = begin + (end - begin) / 2;
      const auto key = [&](std::uint32_t face) {
        double sum = 0;
        for (std::size_t k = 0; k < corners(face); ++k) sum += corner(face, k)[axis];
        return sum / static_cast<double>(corners(face));
      };
      const auto at = [&](std::uint32_t i) { return tree_.order.begin() + static_cast<std::ptrdiff_t>(i); };
      std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t x, std::uint32_t y) {
        const double kx = key(x), ky = key(y);
        return kx < ky || (kx == ky && x < y);
      });
      n.first = node(begin, middle);
      n.second = node(middle, end);
    }
    tree_.nodes[number] = n;
    return number;
  }

  const Mesh& mesh_;
  const std::vector<Vec3d>& points_;
  const Directions& directions_;
  Tree tree_;
};

std::vector<Digits> digits(const std::array<int, 3>& d, int sign) {
  return {std::to_string(sign * d[0]), std::to_string(sign * d[1]), std::to_string(sign * d[2])};
}

class Maker {
 public:
  Maker(const CollisionQuery& query, const CollisionRequest& request)
      : query_(query), request_(request), checker_{{&query.a->mesh(), &query.b->mesh()}, {}} {
    checker_.points = certificate_check::place(checker_.mesh, {query.pose_a, query.pose_b});
    certificate_.hash_a = hash_mesh(*checker_.mesh[0]);
    certificate_.hash_b = hash_mesh(*checker_.mesh[1]);
    certificate_.hash_poses = hash_poses(*query.pose_a, *query.pose_b);
    if (request.counts == CollisionRequest::Counts::crossing) certificate_.least = Relation::crossing;
  }

  /// The proof of one contact, if a pair of parts of the two faces proves it; else nothing.
  std::optional<Certificate> prove_contact(const Contact& contact) {
    for (const std::uint32_t face_a : query_.a->parts(contact.face_a)) {
      for (const std::uint32_t face_b : query_.b->parts(contact.face_b)) {
        const CertificateCell cell = pair(face_a, face_b);
        if (ends_search(cell)) return one_contact(cell);
      }
    }
    return std::nullopt;
  }

  Certificate search() {
    const Directions directions = directions_of({query_.pose_a, query_.pose_b});
    const std::array<std::vector<Vec3d>, 2> points = rounded_points();
    trees_[0] = TreeBuilder(*checker_.mesh[0], points[0], directions).build();
    trees_[1] = TreeBuilder(*checker_.mesh[1], points[1], directions).build();
    directions_ = directions;
    if (!descend(0, 0)) return one_contact(certificate_.cells.back());
    certificate_.order_a = trees_[0].order;
    certificate_.order_b = trees_[1].order;
    claim_all();
    return std::move(certificate_);
  }

 private:
  bool ends_search(const CertificateCell& cell) const {
    return request_.contacts == CollisionRequest::Contacts::first &&
           cell.kind == (request_.tells_relation() ? CellKind::cross : CellKind::meet);
  }

  CertificateCell pair(std::uint32_t face_a, std::uint32_t face_b) const {
    std::array<std::vector<Point>, 2> points;
    const std::array<std::uint32_t, 2> face = {face_a, face_b};
    for (const std::size_t side : {0U, 1U}) {
      for (std::size_t k = 0; k < checker_.corners(side, face[side]); ++k) {
        points[side].push_back(checker_.corner(side, face[side], k));
      }
    }
    CertificateCell cell = prove_pair(points[0], points[1], request_.tells_relation());
    cell.face_a = face_a;
    cell.face_b = face_b;
    return cell;
  }

  Certificate one_contact(CertificateCell cell) {
    Certificate result = certificate_;
    result.all = false;
    result.contacts = {contact(cell)};
    if (cell.kind == CellKind::cross) result.relation = Relation::crossing;
    result.cells.assign(1, std::move(cell));
    return result;
  }
  Certificate::Contact contact(const CertificateCell& cell) const {
    Certificate::Contact result = {checker_.mesh[0]->number_in_file(cell.face_a),
                                   checker_.mesh[1]->number_in_file(cell.face_b), std::nullopt};
    if (cell.kind == CellKind::cross) result.relation = Relation::crossing;
    if (cell.kind == CellKind::touch) result.relation = Relation::touching;
    return result;
  }
  void claim_all() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::optional<Relation>> contacts;
    Relation relation = Relation::apart;
    for (const CertificateCell& cell : certificate_.cells) {
      if (cell.kind < CellKind::meet) continue;
      const Certificate::Contact found = contact(cell);
      if (found.relation) relation = std::max(relation, *found.relation);
      if (certificate_.least == Relation::crossing && found.relation != Relation::crossing) continue;
      std::optional<Relation>& known = contacts[{found.face_a, found.face_b}];
      known = std::max(known, found.relation);
    }
    for (const auto& [faces, known] : contacts) certificate_.contacts.push_back({faces.first, faces.second, known});
    if (request_.tells_relation()) certificate_.relation = relation;
  }

  /// Doubles close to the points, about a vertex of B, which candidates are chosen by; every one is checked exactly.
  std::array<std::vector<Vec3d>, 2> rounded_points() const {
    const Point& origin = checker_.corner(1, 0, 0);
    const auto relative = [&](const Point& p) { return Point{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]}; };
    Int all = 1;
    for (const std::size_t side : {0U, 1U}) {
      for (const Mesh::Face& face : checker_.mesh[side]->faces) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) {
          for (const Int& x : relative(checker_.points[side][face.vertex[k]])) all |= abs(x);
        }
      }
    }
    const unsigned bits = msb(all);
    const unsigned shift = bits > 500 ? bits - 500 : 0;  // such coordinates are doubles
    std::array<std::vector<Vec3d>, 2> result;
    for (const std::size_t side : {0U, 1U}) {
      for (const Point& p : checker_.points[side]) {
        const Point q = relative(p);
        const Int divisor = Int(1) << shift;
        result[side].emplace_back(Int(q[0] / divisor).convert_to<double>(), Int(q[1] / divisor).convert_to<double>(),
                                  Int(q[2] / divisor).convert_to<double>());
      }
    }
    return result;
  }

  static std::vector<std::uint32_t> faces(const Tree& tree, const Tree::Node& node) {
    return {tree.order.begin() + static_cast<std::ptrdiff_t>(node.begin),
            tree.order.begin() + static_cast<std::ptrdiff_t>(node.end)};
  }

  /// Separates two sets along one of the fixed directions, if that is easy.
  bool separate(const Tree::Node& a, const Tree::Node& b) {
    for (std::size_t d = 0; d < direction_count; ++d) {
      const double size = std::max(std::max(std::abs(a.least[d]), std::abs(a.greatest[d])),
                                   std::max(std::abs(b.least[d]), std::abs(b.greatest[d])));
      for (const int sign : {1, -1}) {
        const double gap = sign > 0 ? b.least[d] - a.greatest[d] : a.least[d] - b.greatest[d];
        if (!(gap > 0x1p-45 * size)) continue;  // closer ones are left to pairs of faces
        CertificateCell cell;
        cell.direction = digits(directions_[d], sign);
        if (checker_.overlap(cell.direction, {faces(trees_[0], a), faces(trees_[1], b)}) >= 0) continue;
        certificate_.cells.push_back(std::move(cell));
        return true;
      }
    }
    return false;
  }

  /// Appends the cells of two sets. \returns false if the search has ended at a contact, the last cell
  bool descend(std::uint32_t node_a, std::uint32_t node_b) {
    const Tree::Node& a = trees_[0].nodes[node_a];
    const Tree::Node& b = trees_[1].nodes[node_b];
    if (separate(a, b)) return true;
    const bool single_a = a.end - a.begin == 1;
    const bool single_b = b.end - b.begin == 1;
    if (single_a && single_b) {
      certificate_.cells.push_back(pair(trees_[0].order[a.begin], trees_[1].order[b.begin]));
      return !ends_search(certificate_.cells.back());
    }
    CertificateCell split;
    const bool of_b = single_a || (!single_b && b.size > a.size);
    split.kind = of_b ? CellKind::split_b : CellKind::split_a;
    const Tree::Node& parent = of_b ? b : a;
    split.at = trees_[of_b ? 1 : 0].nodes[parent.second].begin;
    certificate_.cells.push_back(split);
    for (const std::uint32_t child : {parent.first, parent.second}) {
      if (!(of_b ? descend(node_a, child) : descend(child, node_b))) return false;
    }
    return true;
  }

  CollisionQuery query_;
  CollisionRequest request_;
  certificate_check::Checker checker_;
  Directions directions_ = {};
  std::array<Tree, 2> trees_;
  Certificate certificate_;
};

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error("certify: the answer is wrong: " + what + "; please report it with both meshes and poses");
}

std::string name(const Contact& contact) {
  return "faces " + std::to_string(contact.face_a) + " of A and " + std::to_string(contact.face_b) + " of B";
}

void check_request(const CollisionQuery& query, const CollisionRequest& request) {
  check_query(query, request);
  if (request.within > 0) refuse("there is none for a distance; ask with within = 0");
}

}  // namespace

Certificate certify(const CollisionQuery& query, const CollisionRequest& request) {
  check_request(query, request);
  return Maker(query, request).search();
}

Certificate certify(const CollisionQuery& query, const CollisionRequest& request, const CollisionResult& answer) {
  check_request(query, request);
  Maker maker(query, request);
  const bool first = request.contacts == CollisionRequest::Contacts::first;
  if (first && answer.hit && !answer.contacts.empty() &&
      (!request.tells_relation() || answer.relation == Relation::crossing)) {
    const Contact& contact = answer.contacts.front();
    if (std::optional<Certificate> certificate = maker.prove_contact(contact)) return *std::move(certificate);
    refuse(name(contact) + " are no such contact");
  }
  Certificate certificate = maker.search();
  if (answer.hit != !certificate.contacts.empty()) refuse(answer.hit ? "there is no contact" : "there is a contact");
  if (answer.relation && answer.relation != certificate.relation) refuse("the relation is another one");
  for (const Contact& contact : answer.contacts) {
    const auto same = [&](const Certificate::Contact& c) {
      return c.face_a == contact.face_a && c.face_b == contact.face_b &&
             (!contact.relation || contact.relation == c.relation);
    };
    if (std::none_of(certificate.contacts.begin(), certificate.contacts.end(), same)) {
      refuse(name(contact) + " are no such contact");
    }
  }
  if (!first && answer.contacts.size() != std::min(request.max_contacts, certificate.contacts.size())) {
    refuse("it has another number of contacts than there are");
  }
  return certificate;
}

}  // namespace cchip
