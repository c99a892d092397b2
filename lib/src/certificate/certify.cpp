// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/certify.hpp>
#include <cchip/check.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/judge/near_parts.hpp>
#include <cchip/internal/tree/dop26.hpp>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "box_division.hpp"
#include "pair_proof.hpp"

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

/// The faces of one mesh, halved again and again at the median, as far as a search asks for.
class Tree {
 public:
  struct Node {
    std::uint32_t begin = 0, end = 0;                     ///< in the order
    std::uint32_t first = 0, second = 0;                  ///< nodes, after divide()
    std::array<double, direction_count> least, greatest;  ///< rounded
    double size = 0;
    Eigen::Index longest = 0;  ///< axis of the box
  };

  Tree() = default;
  /// \param points of the vertices, rounded; kept
  Tree(const Mesh& mesh, std::vector<Vec3d> points, const Directions& directions)
      : order(mesh.faces.size()), mesh_(&mesh), points_(std::move(points)), taken_(points_.size()) {
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t d = 0; d < direction_count; ++d) {
      for (std::size_t i = 0; i < 3; ++i) directions_[i][d] = directions[d][i];
    }
    add(0, static_cast<std::uint32_t>(order.size()));
  }
  /// Stays where it is.
  const Node& node(std::uint32_t number) const { return nodes_[number]; }
  /// Makes the halves of a node of more than one face, if it has none yet.
  void divide(std::uint32_t number) {
    if (nodes_[number].first != 0) return;
    const std::uint32_t begin = nodes_[number].begin, end = nodes_[number].end;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const Eigen::Index axis = nodes_[number].longest;
    const auto key = [&](std::uint32_t face) {
      double sum = 0;
      for (std::size_t k = 0; k < corners(face); ++k) sum += points_[vertex(face, k)][axis];
      return sum / static_cast<double>(corners(face));
    };
    const auto at = [&](std::uint32_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t x, std::uint32_t y) {
      const double kx = key(x), ky = key(y);
      return kx < ky || (kx == ky && x < y);
    });
    const std::uint32_t first = add(begin, middle);
    const std::uint32_t second = add(middle, end);
    nodes_[number].first = first;
    nodes_[number].second = second;
  }

  std::vector<std::uint32_t> order;

 private:
  std::size_t corners(std::uint32_t face) const { return static_cast<std::size_t>(mesh_->faces[face].kind); }
  std::uint32_t vertex(std::uint32_t face, std::size_t k) const { return mesh_->faces[face].vertex[k]; }

  std::uint32_t add(std::uint32_t begin, std::uint32_t end) {
    Node n;
    n.begin = begin;
    n.end = end;
    n.least.fill(std::numeric_limits<double>::infinity());
    n.greatest.fill(-std::numeric_limits<double>::infinity());
    Vec3d low = Vec3d::Constant(std::numeric_limits<double>::infinity());
    Vec3d high = -low;
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    for (std::uint32_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < corners(order[i]); ++k) {
        const std::uint32_t v = vertex(order[i], k);
        if (taken_[v] == number + 1) continue;
        taken_[v] = number + 1;
        const Vec3d& p = points_[v];
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
        for (std::size_t d = 0; d < direction_count; ++d) {
          const double value = directions_[0][d] * p[0] + directions_[1][d] * p[1] + directions_[2][d] * p[2];
          n.least[d] = std::min(n.least[d], value);
          n.greatest[d] = std::max(n.greatest[d], value);
        }
      }
    }
    n.size = (high - low).maxCoeff(&n.longest);
    nodes_.push_back(n);
    return number;
  }

  const Mesh* mesh_ = nullptr;
  std::vector<Vec3d> points_;
  std::array<std::array<double, direction_count>, 3> directions_ = {};
  std::vector<std::uint32_t> taken_;  ///< of each vertex: the last node that has seen it, from 1
  std::deque<Node> nodes_;            ///< keeps their places
};

std::vector<Digits> digits(const std::array<int, 3>& d, int sign) {
  return {std::to_string(sign * d[0]), std::to_string(sign * d[1]), std::to_string(sign * d[2])};
}

/// Sets of faces by trees that are made for one certificate, tried along fixed directions.
class DopDivision {
 public:
  using Node = std::uint32_t;

  DopDivision(const std::array<const Mesh*, 2>& meshes, std::array<std::vector<Vec3d>, 2> points,
              const Directions& directions, double within, bool moves)
      : directions_(directions), within_(within), moves_(moves) {
    for (const std::size_t side : {0U, 1U}) trees_[side] = Tree(*meshes[side], std::move(points[side]), directions);
    for (std::size_t d = 0; d < direction_count; ++d) {
      lengths_[d] = std::hypot(directions[d][0], directions[d][1], directions[d][2]);
    }
  }

  static Node root(std::size_t /*side*/) { return 0; }
  Node first_half(std::size_t side, Node n) { return divided(side, n).first; }
  Node second_half(std::size_t side, Node n) { return divided(side, n).second; }
  std::uint32_t split_at(std::size_t side, Node n) { return node(side, divided(side, n).second).begin; }
  bool is_single(std::size_t side, Node n) const { return node(side, n).end - node(side, n).begin == 1; }
  std::uint32_t face(std::size_t side, Node n) const { return trees_[side].order[node(side, n).begin]; }
  double size(std::size_t side, Node n) const { return node(side, n).size; }
  certificate_check::Faces faces(std::size_t side, Node n) const {
    return {trees_[side].order.data(), {node(side, n).begin, node(side, n).end}};
  }

  template <class Accept>
  bool propose(Node node_a, Node node_b, const Accept& accept) const {
    const Tree::Node &a = node(0, node_a), &b = node(1, node_b);
    for (std::size_t d = 0; d < direction_count; ++d) {
      const double size = std::max(std::max(std::abs(a.least[d]), std::abs(a.greatest[d])),
                                   std::max(std::abs(b.least[d]), std::abs(b.greatest[d])));
      for (const int sign : {1, -1}) {
        const double gap = sign > 0 ? b.least[d] - a.greatest[d] : a.least[d] - b.greatest[d];
        const double least = within_ == 0 ? 0 : (1 + 0x1p-40) * within_ * lengths_[d];
        // Closer ones are left to pairs of faces, but for those that are flush and part.
        if (!(gap - least > (moves_ ? -0x1p-45 : 0x1p-45) * size)) continue;
        if (accept(BoxDivision::Proposal{digits(directions_[d], sign), false})) return true;
      }
    }
    return false;
  }

  /// Each face once; sets that no cell divides are in ascending order, which makes the file short.
  std::vector<std::uint32_t> order(std::size_t side, const std::vector<CertificateCell>& cells) const {
    std::vector<std::uint32_t> order = trees_[side].order;
    std::vector<bool> begins(order.size());
    for (const CertificateCell& cell : cells) {
      if (cell.kind == (side == 0 ? CellKind::split_a : CellKind::split_b)) begins[cell.at] = true;
    }
    auto from = order.begin();
    for (auto i = from; i != order.end(); ++i) {
      if (!begins[static_cast<std::size_t>(i - order.begin())]) continue;
      std::sort(from, i);
      from = i;
    }
    std::sort(from, order.end());
    return order;
  }

 private:
  const Tree::Node& node(std::size_t side, Node n) const { return trees_[side].node(n); }
  const Tree::Node& divided(std::size_t side, Node n) {
    trees_[side].divide(n);
    return node(side, n);
  }

  Directions directions_;
  std::array<double, direction_count> lengths_ = {};  ///< about
  double within_;                                     ///< of the claim, about, in the unit of the rounded points
  bool moves_;                                        ///< the claim is of a translation
  std::array<Tree, 2> trees_;
};

class Maker {
 public:
  /// \param trees that the certificate cites; null: none
  Maker(const CollisionQuery& query, const CollisionRequest& request, bool below, const CitedTrees& trees)
      : query_(query),
        request_(request),
        own_(trees.a == nullptr ? std::make_unique<Own>(query) : nullptr),
        trees_{trees.a, trees.b},
        mesh_{trees.a == nullptr ? &own_->a : trees.a, trees.b == nullptr ? &own_->b : trees.b},
        checker_{{&query.a->mesh(), &query.b->mesh()},
                 certificate_check::Placement(mesh_, {query.pose_a, query.pose_b}, request.within),
                 below} {
    certificate_.within = request.within;
    certificate_.below = below;
    certificate_.version = request.within > 0 ? 2 : 1;
    certificate_.hash_a = mesh_[0]->hash();
    certificate_.hash_b = mesh_[1]->hash();
    certificate_.hash_poses = hash_poses(*query.pose_a, *query.pose_b);
    if (request.least == Relation::crossing) certificate_.least = Relation::crossing;
  }

  /// The proof of one contact, if a pair of parts of the two faces proves it; else nothing.
  std::optional<Certificate> prove_contact(const Contact& contact) {
    const PosedPairs pairs(*query_.pose_a, *query_.pose_b);
    std::optional<Certificate> proof;
    any_near_parts(query_, contact, [&](std::uint32_t face_a, std::uint32_t face_b) {
      if (request_.within == 0) {
        const Primitive a = query_.a->mesh().primitive(face_a);
        const Primitive b = query_.b->mesh().primitive(face_b);
        const PosedPairs::Answer met = pairs.decide(a, b, request_.tells_relation());
        if (request_.tells_relation() ? !met.crosses : !met.hit) return false;
      }
      const CertificateCell cell = pair(face_a, face_b);
      if (ends_search(cell)) proof = one_contact(cell);
      return proof.has_value();
    });
    return proof;
  }

  /// The proof that B is clear of A along a translation, if it is.
  std::optional<Certificate> prove_clear_along(const Vec3d& along) {
    certificate_.along = along;
    certificate_.version = 2;
    checker_.along = certificate_check::whole_point(along);
    Certificate certificate = search();
    if (is_blocked_) return std::nullopt;
    return certificate;
  }

  Certificate search() {
    if (trees_[0] != nullptr) {
      BoxDivision division(trees_, {query_.pose_a, query_.pose_b}, request_.within, certificate_.along);
      if (!descend(division, division.root(0), division.root(1))) return ended();
      certificate_.version = 3;
      certificate_.tree_a = trees_[0]->tree_hash();
      certificate_.tree_b = trees_[1]->tree_hash();
    } else {
      const Directions directions = directions_of({query_.pose_a, query_.pose_b});
      double within = 0;
      std::array<std::vector<Vec3d>, 2> points = rounded_points(within);
      DopDivision division(checker_.mesh, std::move(points), directions, within, checker_.along.has_value());
      if (!descend(division, division.root(0), division.root(1))) return ended();
      certificate_.order_a = division.order(0, certificate_.cells);
      certificate_.order_b = division.order(1, certificate_.cells);
    }
    claim_all();
    return std::move(certificate_);
  }

 private:
  /// The meshes of a query without trees.
  struct Own {
    explicit Own(const CollisionQuery& query) : a(query.a->mesh()), b(query.b->mesh()) {}
    CheckedMesh a, b;
  };

  /// After a search that has ended before all was looked at.
  Certificate ended() { return is_blocked_ ? Certificate() : one_contact(certificate_.cells.back()); }
  bool ends_search(const CertificateCell& cell) const {
    return request_.contacts == CollisionRequest::Contacts::first &&
           cell.kind == (request_.within > 0         ? CellKind::near
                         : request_.tells_relation() ? CellKind::cross
                                                     : CellKind::meet);
  }

  std::array<std::vector<Point>, 2> points_of(std::uint32_t face_a, std::uint32_t face_b) const {
    std::array<std::vector<Point>, 2> points;
    const std::array<std::uint32_t, 2> face = {face_a, face_b};
    for (const std::size_t side : {0U, 1U}) {
      for (std::size_t k = 0; k < checker_.corners(side, face[side]); ++k) {
        points[side].push_back(checker_.corner(side, face[side], k));
      }
    }
    return points;
  }
  std::optional<CertificateCell> clear_pair(std::uint32_t face_a, std::uint32_t face_b) const {
    const std::array<std::vector<Point>, 2> points = points_of(face_a, face_b);
    return prove_clear(points[0], points[1], *checker_.along);
  }
  CertificateCell pair(std::uint32_t face_a, std::uint32_t face_b) const {
    const std::array<std::vector<Point>, 2> points = points_of(face_a, face_b);
    CertificateCell cell = request_.within > 0
                               ? prove_distance(points[0], points[1], checker_.placement.length(), checker_.below)
                               : prove_pair(points[0], points[1], request_.tells_relation());
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
  /// \param within the length of the claim, in the unit of these
  std::array<std::vector<Vec3d>, 2> rounded_points(double& within) const {
    const Point origin = checker_.corner(1, 0, 0);
    unsigned bits = 0;
    std::array<std::vector<Point>, 2> relative = certificate_check::posed_vertices(checker_.placement, checker_.mesh);
    for (const std::size_t side : {0U, 1U}) {
      for (Point& p : relative[side]) {
        for (std::size_t i = 0; i < 3; ++i) {
          p[i] -= origin[i];
          if (p[i] != 0) bits = std::max(bits, static_cast<unsigned>(msb(abs(p[i]))));
        }
      }
    }
    const Int& length = checker_.placement.length();
    if (length != 0) bits = std::max(bits, static_cast<unsigned>(msb(length)));
    const unsigned shift = bits > 500 ? bits - 500 : 0;  // such coordinates are doubles
    within = Int(length >> shift).convert_to<double>();
    std::array<std::vector<Vec3d>, 2> result;
    for (const std::size_t side : {0U, 1U}) {
      for (Point& p : relative[side]) {
        for (Int& x : p) {
          if (shift != 0) x = x < 0 ? Int(-(-x >> shift)) : Int(x >> shift);
        }
        result[side].emplace_back(p[0].convert_to<double>(), p[1].convert_to<double>(), p[2].convert_to<double>());
      }
    }
    return result;
  }

  /// Appends the cells of two sets. \returns false if the search has ended at a contact, the last cell
  template <class Division>
  bool descend(Division& division, const typename Division::Node& a, const typename Division::Node& b) {
    const auto accept = [&](const BoxDivision::Proposal& proposal) {
      if (!proposal.is_certain && !checker_.separates(certificate_check::direction_of(proposal.direction),
                                                      {{division.faces(0, a), division.faces(1, b)}})) {
        return false;
      }
      certificate_.cells.emplace_back().direction = proposal.direction;
      return true;
    };
    if (division.propose(a, b, accept)) return true;
    const bool single_a = division.is_single(0, a);
    const bool single_b = division.is_single(1, b);
    if (single_a && single_b && checker_.along) {
      std::optional<CertificateCell> cell = clear_pair(division.face(0, a), division.face(1, b));
      is_blocked_ = !cell;
      if (cell) certificate_.cells.push_back(*std::move(cell));
      return !is_blocked_;
    }
    if (single_a && single_b) {
      certificate_.cells.push_back(pair(division.face(0, a), division.face(1, b)));
      return !ends_search(certificate_.cells.back());
    }
    const bool of_b = single_a || (!single_b && division.size(1, b) > division.size(0, a));
    CertificateCell& split = certificate_.cells.emplace_back();
    split.kind = of_b ? CellKind::split_b : CellKind::split_a;
    const std::size_t side = of_b ? 1 : 0;
    const typename Division::Node& parent = of_b ? b : a;
    split.at = division.split_at(side, parent);
    for (const bool second : {false, true}) {
      const auto child = second ? division.second_half(side, parent) : division.first_half(side, parent);
      if (!(of_b ? descend(division, a, child) : descend(division, child, b))) return false;
    }
    return true;
  }

  CollisionQuery query_;
  CollisionRequest request_;
  std::unique_ptr<Own> own_;
  std::array<const CertificateTree*, 2> trees_;
  std::array<const CheckedMesh*, 2> mesh_;
  certificate_check::Checker checker_;
  bool is_blocked_ = false;  ///< a search along a translation has met a pair of faces
  Certificate certificate_;
};

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error("certify: the answer is wrong: " + what + "; please report it with both meshes and poses");
}

std::string name(const Contact& contact) {
  return "faces " + std::to_string(contact.face_a) + " of A and " + std::to_string(contact.face_b) + " of B";
}

void check_request(const CollisionQuery& query, const CollisionRequest& request, const CitedTrees& trees) {
  CollisionRequest proved = request;
  proved.certificate = true;
  check_query(query, proved);
  if (trees.a == nullptr && trees.b == nullptr) return;
  if (trees.a == nullptr || trees.b == nullptr) {
    throw std::invalid_argument("certify: one tree is missing: give those of both objects, or none");
  }
  if (&trees.a->mesh() != &query.a->mesh() || &trees.b->mesh() != &query.b->mesh()) {
    throw std::invalid_argument("certify: a tree is of another mesh: make it of the object's mesh()");
  }
}

}  // namespace

Certificate certify(const CollisionQuery& query, const CollisionRequest& request, const CitedTrees& trees) {
  check_request(query, request, trees);
  return Maker(query, request, false, trees).search();
}

CertificateTree make_certificate_tree(const Mesh& mesh) {
  check_faces(mesh);
  return {mesh, certificate_order(mesh)};
}

Certificate certify_below(const CollisionQuery& query, double distance, CollisionRequest::Contacts contacts,
                          const CitedTrees& trees) {
  CollisionRequest request;
  request.contacts = contacts;
  request.within = distance;
  if (!(distance > 0))
    throw std::invalid_argument("certify_below: the distance is " + decimal_text(distance) + ": ask for one above 0");
  check_request(query, request, trees);
  return Maker(query, request, true, trees).search();
}

std::optional<Certificate> certify_clear_along(const CollisionQuery& query, const Vec3d& along,
                                               const CitedTrees& trees) {
  check_request(query, {}, trees);
  if (along.isZero(0) || !along.allFinite()) {
    throw std::invalid_argument("certify_clear_along: the translation is 0 or not finite: give another one");
  }
  return Maker(query, {}, false, trees).prove_clear_along(along);
}

Certificate certify(const CollisionQuery& query, const CollisionRequest& request, const CollisionResult& answer,
                    const CitedTrees& trees) {
  check_request(query, request, trees);
  Maker maker(query, request, false, trees);
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
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::optional<Relation>> proved;
  for (const Certificate::Contact& c : certificate.contacts) proved.emplace(std::pair(c.face_a, c.face_b), c.relation);
  for (const Contact& contact : answer.contacts) {
    const auto found = proved.find({contact.face_a, contact.face_b});
    if (found == proved.end() || (contact.relation && contact.relation != found->second)) {
      refuse(name(contact) + " are no such contact");
    }
  }
  if (!first && answer.contacts.size() != std::min(request.max_contacts, certificate.contacts.size())) {
    refuse("it has another number of contacts than there are");
  }
  return certificate;
}

void add_certificate(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& answer) {
  answer.certificate = std::make_shared<const Certificate>(certify(query, request, answer));
}

}  // namespace cchip
