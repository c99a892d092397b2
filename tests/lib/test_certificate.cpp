// SPDX-License-Identifier: Apache-2.0
// Answers with their proof: answers of the CPU device are certified and accepted; what was changed is accepted only
// where it is true as well, by a judge that shares nothing with the checker.
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <cchip/along.hpp>
#include <cchip/certificate_file.hpp>
#include <cchip/certify.hpp>
#include <cchip/check.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/device.hpp>
#include <cchip/distance.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/program/seed.hpp>
#include <cchip/scene.hpp>
#include <cchip/shapes.hpp>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>

#include "bvh_meshes.hpp"
#include "distance_oracle.hpp"
#include "random_poses.hpp"

using namespace cchip;
using namespace cchip_test;
using cchip::testing::make_box;
using cchip::testing::soup;
using Contacts = CollisionRequest::Contacts;
using CellKind = CertificateCell::Kind;
using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;

namespace {

struct Placed {
  Mesh mesh;
  Pose pose = Pose::Identity();
};

CollisionRequest request(Contacts contacts, bool relation, Relation least = Relation::touching) {
  CollisionRequest result;
  result.contacts = contacts;
  result.relation = relation;
  result.least = least;
  return result;
}

const std::vector<CollisionRequest> requests = {request(Contacts::first, false),
                                                request(Contacts::all, false),
                                                request(Contacts::first, true),
                                                request(Contacts::all, true),
                                                request(Contacts::first, false, Relation::crossing),
                                                request(Contacts::all, false, Relation::crossing)};

/// Does the certificate hold? Looks at every pair of faces by itself, in rationals, and at the claim by the exact
/// oracle.
class Judge {
 public:
  Judge(const Placed& a, const Placed& b) : side_{a, b} {
    for (const std::size_t s : {0U, 1U}) {
      for (const Vec3d& v : side_[s].mesh.vertices) {
        std::array<cpp_rational, 3> p;
        for (int row = 0; row < 3; ++row) {
          p[std::size_t(row)] = cpp_rational(side_[s].pose.translation()[row]);
          for (int i = 0; i < 3; ++i) {
            p[std::size_t(row)] += cpp_rational(side_[s].pose.linear()(row, i)) * cpp_rational(v[i]);
          }
        }
        points_[s].push_back(p);
      }
    }
  }

  bool holds(const Certificate& c) {
    if ((c.version != 3 && c.version != (c.within > 0 || c.along ? 2 : 1)) || c.hash_a != hash_mesh(side_[0].mesh) ||
        c.hash_b != hash_mesh(side_[1].mesh) || c.hash_poses != hash_poses(side_[0].pose, side_[1].pose)) {
      return false;
    }
    return proof_holds(c) && claim_holds(c);
  }

  /// The claim alone.
  bool claim_holds(const Certificate& c) {
    if (c.along) return clear_claim_holds(c);
    if (c.within > 0) return distance_claim_holds(c);
    const auto& [truth, strongest] = relations();
    if (c.relation && *c.relation != strongest) return false;
    std::set<std::pair<std::uint32_t, std::uint32_t>> claimed;
    for (const Certificate::Contact& contact : c.contacts) {
      const auto found = truth.find({contact.face_a, contact.face_b});
      if (found == truth.end() || found->second < c.least) return false;
      if (contact.relation && *contact.relation != found->second) return false;
      claimed.insert(found->first);
    }
    if (!c.all) return claimed.size() == 1;
    for (const auto& [faces, relation] : truth) {
      if (relation >= c.least && claimed.count(faces) == 0) return false;
    }
    return true;
  }

  /// Are the two faces as near as the claim says?
  bool is_near(std::uint32_t f, std::uint32_t g, const Certificate& c) {
    if (is_surely_far(f, g, c.within)) return false;
    std::optional<cpp_rational>& square = squares_[{f, g}];
    if (!square) square = square_of(f, g);
    const cpp_rational most = cpp_rational(c.within) * cpp_rational(c.within);
    return c.below ? *square < most : *square <= most;
  }

 private:
  using Faces = std::vector<std::uint32_t>;

  /// Is there no contact after any of some translations? They are short and long; others are left to the proof.
  bool clear_claim_holds(const Certificate& c) {
    if (!c.all || !c.contacts.empty() || c.relation || c.within > 0 || c.along->isZero(0)) return false;
    const std::array<double, 3> key = {(*c.along)[0], (*c.along)[1], (*c.along)[2]};
    const auto known = clear_.find(key);
    if (known != clear_.end()) return known->second;
    return clear_[key] = stays_clear(c);
  }
  bool stays_clear(const Certificate& c) const {
    for (const double part : {0x1p-30, 0x1p-10, 0.125, 0.5, 1.0, 1.75, 10.0}) {
      Pose moved = side_[1].pose;
      moved.translation() += part * *c.along;
      for (std::uint32_t f = 0; f < side_[0].mesh.faces.size(); ++f) {
        for (std::uint32_t g = 0; g < side_[1].mesh.faces.size(); ++g) {
          const Relation relation =
              exact_relation(side_[0].mesh.primitive(f), side_[0].pose, side_[1].mesh.primitive(g), moved);
          if (relation != Relation::apart && is_rounded_right(part * *c.along, moved)) return false;
        }
      }
    }
    return true;
  }
  /// Is the sum that makes a pose of the second side exact?
  bool is_rounded_right(const Vec3d& shift, const Pose& moved) const {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const cpp_rational sum = cpp_rational(side_[1].pose.translation()[i]) + cpp_rational(shift[i]);
      if (sum != cpp_rational(moved.translation()[i])) return false;
    }
    return true;
  }

  /// Are their boxes far apart, by much more than rounding?
  bool is_surely_far(std::uint32_t f, std::uint32_t g, double within) const {
    for (std::size_t x = 0; x < 3; ++x) {
      std::array<double, 2> least = {1e300, 1e300}, greatest = {-1e300, -1e300};
      for (const std::size_t s : {0U, 1U}) {
        for (std::size_t k = 0; k < corners(s, s == 0 ? f : g); ++k) {
          const auto at = corner(s, s == 0 ? f : g, k)[x].convert_to<double>();
          least[s] = std::min(least[s], at);
          greatest[s] = std::max(greatest[s], at);
        }
      }
      if (std::max(least[1] - greatest[0], least[0] - greatest[1]) > 1.001 * within + 1e-9) return true;
    }
    return false;
  }
  /// The square of the distance of two faces.
  cpp_rational square_of(std::uint32_t f, std::uint32_t g) const {
    constexpr int unit_bits = 300;  // coordinates are multiples of 2^-300
    const IntSquare<BigInt> square =
        square_of_distance(posed_points(side_[0].mesh.primitive(f), side_[0].pose, unit_bits),
                           posed_points(side_[1].mesh.primitive(g), side_[1].pose, unit_bits));
    return cpp_rational(square.over, square.under) / cpp_rational(cpp_int(1) << 2 * unit_bits);
  }

  bool distance_claim_holds(const Certificate& c) {
    if (c.relation || c.least != Relation::touching) return false;
    std::set<std::pair<std::uint32_t, std::uint32_t>> near;
    for (std::uint32_t f = 0; f < side_[0].mesh.faces.size(); ++f) {
      for (std::uint32_t g = 0; g < side_[1].mesh.faces.size(); ++g) {
        if (is_near(f, g, c)) near.emplace(side_[0].mesh.number_in_file(f), side_[1].mesh.number_in_file(g));
      }
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> claimed;
    for (const Certificate::Contact& contact : c.contacts) {
      if (contact.relation || near.count({contact.face_a, contact.face_b}) == 0) return false;
      claimed.emplace(contact.face_a, contact.face_b);
    }
    return c.all ? claimed == near : claimed.size() == 1;
  }

  /// Of all faces of the files that are not apart, and the strongest of all.
  struct Truth {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Relation> relations;
    Relation strongest = Relation::apart;
  };

  const Truth& relations() {
    if (truth_) return *truth_;
    truth_ = Truth();  // clang 14 knows no emplace() without arguments inside the class
    for (std::uint32_t f = 0; f < side_[0].mesh.faces.size(); ++f) {
      for (std::uint32_t g = 0; g < side_[1].mesh.faces.size(); ++g) {
        const Relation relation =
            exact_relation(side_[0].mesh.primitive(f), side_[0].pose, side_[1].mesh.primitive(g), side_[1].pose);
        if (relation == Relation::apart) continue;
        Relation& known = truth_->relations[{side_[0].mesh.number_in_file(f), side_[1].mesh.number_in_file(g)}];
        known = std::max(known, relation);
        truth_->strongest = std::max(truth_->strongest, relation);
      }
    }
    return *truth_;
  }

  bool proof_holds(const Certificate& c) {
    next_ = 0;
    if (c.version == 3) {
      const CertificateTree a = make_certificate_tree(side_[0].mesh), b = make_certificate_tree(side_[1].mesh);
      if (!c.all || c.tree_a != a.tree_hash() || c.tree_b != b.tree_hash()) return false;
      if (!c.order_a.empty() || !c.order_b.empty()) return false;
      Certificate with_orders = c;  // whose cells say more than these ask for: boxes are larger than what they hold
      with_orders.order_a = a.order();
      with_orders.order_b = b.order();
      return cells_hold(with_orders, 0, a.order().size(), 0, b.order().size()) && next_ == c.cells.size();
    }
    if (!c.all) {
      return c.cells.size() == 1 && c.cells[0].kind >= CellKind::meet && point_holds(c.cells[0], c);
    }
    for (const std::size_t s : {0U, 1U}) {  // a permutation
      Faces order = s == 0 ? c.order_a : c.order_b;
      std::sort(order.begin(), order.end());
      for (std::size_t i = 0; i < order.size(); ++i) {
        if (order[i] != i) return false;
      }
      if (order.size() != side_[s].mesh.faces.size()) return false;
    }
    return cells_hold(c, 0, c.order_a.size(), 0, c.order_b.size()) && next_ == c.cells.size();
  }
  bool cells_hold(const Certificate& c, std::size_t a0, std::size_t a1, std::size_t b0, std::size_t b1) {
    if (next_ >= c.cells.size()) return false;
    const CertificateCell& cell = c.cells[next_++];
    const auto place = [&](std::size_t begin, std::size_t end) { return c.version == 3 ? (begin + end) / 2 : cell.at; };
    switch (cell.kind) {
      case CellKind::split_a: {
        const std::size_t at = place(a0, a1);
        return a0 < at && at < a1 && cells_hold(c, a0, at, b0, b1) && cells_hold(c, at, a1, b0, b1);
      }
      case CellKind::split_b: {
        const std::size_t at = place(b0, b1);
        return b0 < at && at < b1 && cells_hold(c, a0, a1, b0, at) && cells_hold(c, a0, a1, at, b1);
      }
      case CellKind::separated:
        for (std::size_t i = a0; i < a1; ++i) {
          for (std::size_t k = b0; k < b1; ++k) {
            if (!below(cell, c.order_a[i], c.order_b[k], true, c)) return false;
          }
        }
        return true;
      case CellKind::meet:
      case CellKind::touch:
      case CellKind::cross:
      case CellKind::near:
        return a1 - a0 == 1 && b1 - b0 == 1 && cell.face_a == c.order_a[a0] && cell.face_b == c.order_b[b0] &&
               point_holds(cell, c);
    }
    return false;
  }
  const std::array<cpp_rational, 3>& corner(std::size_t s, std::uint32_t face, std::size_t k) const {
    return points_[s][side_[s].mesh.faces[face].vertex[k]];
  }
  std::size_t corners(std::size_t s, std::uint32_t face) const {
    return static_cast<std::size_t>(side_[s].mesh.faces[face].kind);
  }
  bool below(const CertificateCell& cell, std::uint32_t f, std::uint32_t g, bool strictly,
             const Certificate& c = {}) const {
    if (cell.direction.size() != 3) return false;
    std::array<cpp_rational, 3> d;
    for (std::size_t i = 0; i < 3; ++i) d[i] = cpp_rational(cell.direction[i]);
    if (d[0] == 0 && d[1] == 0 && d[2] == 0) return false;
    for (std::size_t i = 0; i < corners(0, f); ++i) {
      for (std::size_t k = 0; k < corners(1, g); ++k) {
        cpp_rational gap = 0;
        for (std::size_t x = 0; x < 3; ++x) gap += d[x] * (corner(1, g, k)[x] - corner(0, f, i)[x]);
        if (c.along) {
          cpp_rational rise = 0;
          for (std::size_t x = 0; x < 3; ++x) rise += d[x] * cpp_rational((*c.along)[Eigen::Index(x)]);
          if (gap < 0 || rise < 0 || (gap == 0 && rise == 0)) return false;
          continue;
        }
        if (gap < 0 || (strictly && gap == 0)) return false;
        const cpp_rational far =
            cpp_rational(c.within) * cpp_rational(c.within) * cpp_rational(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (c.within > 0 && (c.below ? gap * gap < far : gap * gap <= far)) return false;
      }
    }
    return true;
  }
  bool point_holds(const CertificateCell& cell, const Certificate& c) const {
    if ((cell.kind == CellKind::near) != (c.within > 0) || c.along) return false;
    std::array<std::array<cpp_rational, 3>, 2> point;
    for (const std::size_t s : {0U, 1U}) {
      const std::vector<Digits>& weights = s == 0 ? cell.weights_a : cell.weights_b;
      const std::uint32_t face = s == 0 ? cell.face_a : cell.face_b;
      if (face >= side_[s].mesh.faces.size() || weights.size() != corners(s, face)) return false;
      cpp_rational sum = 0;
      for (const Digits& text : weights) {
        const cpp_rational weight(text);
        if (weight < 0 || (weight == 0 && cell.kind == CellKind::cross)) return false;
        sum += weight;
      }
      if (sum == 0) return false;
      for (std::size_t k = 0; k < weights.size(); ++k) {
        for (std::size_t x = 0; x < 3; ++x) point[s][x] += cpp_rational(weights[k]) / sum * corner(s, face, k)[x];
      }
    }
    if (cell.kind == CellKind::near) {
      cpp_rational square = 0;
      for (std::size_t x = 0; x < 3; ++x) square += (point[0][x] - point[1][x]) * (point[0][x] - point[1][x]);
      const cpp_rational most = cpp_rational(c.within) * cpp_rational(c.within);
      return c.below ? square < most : square <= most;
    }
    if (point[0] != point[1]) return false;
    if (cell.kind == CellKind::touch) return below(cell, cell.face_a, cell.face_b, false);
    if (cell.kind == CellKind::meet) return true;
    std::array<std::array<cpp_rational, 3>, 3> m;  // elimination
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t s = cell.span[i].of_b ? 1 : 0;
      const std::uint32_t face = s == 0 ? cell.face_a : cell.face_b;
      if (cell.span[i].vertex >= corners(s, face)) return false;
      for (std::size_t x = 0; x < 3; ++x) m[i][x] = corner(s, face, cell.span[i].vertex)[x] - corner(s, face, 0)[x];
    }
    for (std::size_t x = 0; x < 3; ++x) {
      std::size_t pivot = x;
      while (pivot < 3 && m[pivot][x] == 0) ++pivot;
      if (pivot == 3) return false;
      std::swap(m[pivot], m[x]);
      for (std::size_t i = x + 1; i < 3; ++i) {
        const cpp_rational by = m[i][x] / m[x][x];
        for (std::size_t k = x; k < 3; ++k) m[i][k] -= by * m[x][k];
      }
    }
    return true;
  }

  std::array<Placed, 2> side_;
  std::array<std::vector<std::array<cpp_rational, 3>>, 2> points_;
  std::optional<Truth> truth_;
  std::map<std::array<double, 3>, bool> clear_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::optional<cpp_rational>> squares_;
  std::size_t next_ = 0;
};

/// Small meshes: apart, flush, piercing, degenerate.
std::array<Placed, 2> random_pair(std::mt19937_64& random) {
  std::array<Placed, 2> result;
  const std::uint64_t kind = random() % 4;
  for (Placed& p : result) {
    if (kind == 0) {  // degenerate and coplanar faces, warped quads
      p.mesh = soup(1 + random() % 6, true, random);
    } else if (kind == 1) {
      p.mesh = soup(1 + random() % 6, false, random);
    } else {  // boxes on a coarse grid: flush faces
      const Vec3d low = testing::random_vector(random, 2).array().round().matrix();
      p.mesh = make_box(low, low + Vec3d(1, 1, double(1 + random() % 2)));
      if (random() % 2 == 0) p.mesh = subdivided(p.mesh);
    }
    if (random() % 4 == 0) {  // faces that were cut: the file has fewer
      for (std::uint32_t i = 0; i < p.mesh.faces.size(); ++i) p.mesh.file_face.push_back(i / 2);
    }
  }
  if (kind != 2 && random() % 2 == 0) {
    const PoseClass c = pose_classes[random() % std::size(pose_classes)];
    result[0].pose = random_pose(c, 0.5, random);
    result[1].pose = random() % 3 == 0 ? result[0].pose : random_pose(c, 0.5, random);
  }
  return result;
}

/// A distance to ask for: that of two faces, if it is a double, a little less or more, or any.
double random_distance(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                       std::mt19937_64& random) {
  const double exact = distance(a, pose_a, b, pose_b).lower;
  const double any = 0.01 + double(random() % 1000) / 2000;
  const double result = random() % 4 == 0   ? std::nextafter(exact, 0)
                        : random() % 3 == 0 ? std::nextafter(exact, 10)
                        : random() % 2 == 0 ? exact
                                            : any;
  return result > 0 ? result : any;
}

Vec3d random_translation(std::mt19937_64& random) {
  if (random() % 2 == 0) return 3 * testing::random_vector(random, 1);
  Vec3d result = Vec3d::Zero();
  result[static_cast<Eigen::Index>(random() % 3)] = random() % 2 == 0 ? 0.1 : -7;
  return result;
}

/// Of any claim, with trees or without.
Certificate random_certificate(const std::array<Placed, 2>& pair, std::mt19937_64& random) {
  const Object a(pair[0].mesh), b(pair[1].mesh);
  const CollisionQuery query = {&a, &pair[0].pose, &b, &pair[1].pose};
  const CertificateTree tree_a = make_certificate_tree(a.mesh()), tree_b = make_certificate_tree(b.mesh());
  const CitedTrees trees = random() % 2 == 0 ? CitedTrees{&tree_a, &tree_b} : CitedTrees{};
  if (random() % 2 == 0) return certify(query, requests[random() % requests.size()], trees);
  if (random() % 3 == 0) {
    const std::optional<Certificate> clear = certify_clear_along(query, random_translation(random), trees);
    if (clear) return *clear;
  }
  const Contacts contacts = random() % 2 == 0 ? Contacts::first : Contacts::all;
  const double distance = random_distance(a, pair[0].pose, b, pair[1].pose, random);
  if (random() % 2 == 0) return certify_below(query, distance, contacts, trees);
  CollisionRequest within = request(contacts, false);
  within.within = distance;
  return certify(query, within, trees);
}

CertificateVerdict check(const std::array<Placed, 2>& pair, const Certificate& certificate) {
  if (certificate.version == 3) {
    return check_certificate(make_certificate_tree(pair[0].mesh), pair[0].pose, make_certificate_tree(pair[1].mesh),
                             pair[1].pose, certificate);
  }
  return check_certificate(pair[0].mesh, pair[0].pose, pair[1].mesh, pair[1].pose, certificate);
}

std::mt19937_64 generator(std::uint64_t test) { return std::mt19937_64(1000 * sim::seed_from_environment() + test); }

std::string describe(const Certificate& c) {
  std::ostringstream out;
  const auto tell = [&](const std::optional<Relation>& r) { out << (r ? std::to_string(int(*r)) : "-") << ' '; };
  if (c.along) out << "along " << c.along->transpose() << ' ';
  out << (c.all ? "all" : "one") << (c.below ? " below " : " within ") << c.within << " least " << int(c.least)
      << " relation ";
  tell(c.relation);
  for (const auto& contact : c.contacts) {
    out << "contact " << contact.face_a << ' ' << contact.face_b << ' ';
    tell(contact.relation);
  }
  for (const auto& cell : c.cells) {
    out << "\n" << int(cell.kind) << " at " << cell.at << " faces " << cell.face_a << ' ' << cell.face_b;
    for (const auto* numbers : {&cell.direction, &cell.weights_a, &cell.weights_b}) {
      out << ", ";
      for (const Digits& text : *numbers) out << text << ' ';
    }
  }
  return out.str();
}

/// Changes one field.
void mutate(Certificate& c, std::mt19937_64& random) {
  const auto other = [&](std::vector<Digits>& numbers) {
    if (numbers.empty()) return;
    Digits& text = numbers[random() % numbers.size()];
    const cpp_int number(text);
    switch (random() % 6) {
      case 0:
        text = cpp_int(number + 1).str();
        break;
      case 1:
        text = cpp_int(number - 1).str();
        break;
      case 2:
        text = cpp_int(-number).str();
        break;
      case 3:
        text = "0";
        break;
      case 4:
        text = cpp_int(number * 2).str();
        break;
      default:
        numbers.pop_back();
    }
  };
  const auto relation = [&]() -> std::optional<Relation> {
    const std::uint64_t n = random() % 4;
    if (n == 3) return std::nullopt;
    return static_cast<Relation>(n);
  };
  const auto number = [&](std::uint32_t n) { return random() % 2 == 0 ? n + 1 : n - (n > 0 ? 1 : 0); };
  CertificateCell& cell = c.cells[random() % c.cells.size()];
  switch (random() % 25) {
    case 24:
      if (c.along) (*c.along)[static_cast<Eigen::Index>(random() % 3)] *= random() % 2 == 0 ? -1 : 0.5;
      if (!c.along && random() % 4 == 0) c.along = random_translation(random);
      break;
    case 22:
      c.below = !c.below;
      break;
    case 23:
      c.within = random() % 3 == 0 ? 0 : std::nextafter(c.within, random() % 2 == 0 ? 0 : 10);
      break;
    case 18: {
      std::uint64_t& hash = *std::array<std::uint64_t*, 5>{&c.hash_a, &c.hash_b, &c.hash_poses, &c.tree_a,
                                                           &c.tree_b}[random() % (c.version == 3 ? 5 : 3)];
      hash ^= std::uint64_t{1} << random() % 64;
      break;
    }
    case 19:
      c.version = static_cast<int>(random() % 4);
      break;
    case 20:
      if (!c.contacts.empty()) {
        Certificate::Contact& contact = c.contacts[random() % c.contacts.size()];
        std::uint32_t& face = random() % 2 == 0 ? contact.face_a : contact.face_b;
        face = number(face);
      }
      break;
    case 21: {
      std::vector<std::uint32_t>& order = random() % 2 == 0 ? c.order_a : c.order_b;
      if (!order.empty()) {
        std::uint32_t& face = order[random() % order.size()];
        face = number(face);
      }
      break;
    }
    case 0:
      cell.kind = static_cast<CellKind>(random() % 7);
      break;
    case 1:
      cell.at = number(cell.at);
      break;
    case 2:
      cell.face_a = number(cell.face_a);
      break;
    case 3:
      cell.face_b = number(cell.face_b);
      break;
    case 4:
    case 5:
      other(cell.weights_a);
      break;
    case 6:
    case 7:
      other(cell.weights_b);
      break;
    case 8:
    case 9:
      other(cell.direction);
      break;
    case 10:
      cell.span[random() % 3] = {random() % 2 == 0, static_cast<std::uint8_t>(random() % 5)};
      break;
    case 11:
      c.cells.erase(c.cells.begin() + static_cast<std::ptrdiff_t>(random() % c.cells.size()));
      break;
    case 12:
      c.cells.insert(c.cells.begin() + static_cast<std::ptrdiff_t>(random() % c.cells.size()),
                     CertificateCell(c.cells[random() % c.cells.size()]));
      break;
    case 13:
      c.all = !c.all;
      break;
    case 14:
      c.relation = relation();
      break;
    case 15:
      if (!c.contacts.empty()) c.contacts[random() % c.contacts.size()].relation = relation();
      c.least = random() % 2 == 0 ? Relation::touching : Relation::crossing;
      break;
    case 16:
      if (random() % 2 == 0 && !c.contacts.empty()) {
        c.contacts.erase(c.contacts.begin() + static_cast<std::ptrdiff_t>(random() % c.contacts.size()));
      } else {
        c.contacts.push_back({static_cast<std::uint32_t>(random() % 8), static_cast<std::uint32_t>(random() % 8), {}});
      }
      break;
    default: {
      std::vector<std::uint32_t>& order = random() % 2 == 0 ? c.order_a : c.order_b;
      if (!order.empty()) std::swap(order[random() % order.size()], order[random() % order.size()]);
    }
  }
}

}  // namespace

TEST_CASE("certificate: answers of the CPU device are certified and accepted", "[lib][certificate]") {
  std::mt19937_64 random = generator(1);
  const auto device = open_cpu_device({1, ""});
  int certified = 0, refused = 0;
  std::map<CellKind, int> kinds;
  for (int n = 0; n < 300; ++n) {
    const std::array<Placed, 2> pair = random_pair(random);
    const Object a(pair[0].mesh), b(pair[1].mesh);
    for (const CollisionRequest& r : requests) {
      const CollisionResult answer = collide(*device, a, pair[0].pose, b, pair[1].pose, r);
      const CollisionQuery query = {&a, &pair[0].pose, &b, &pair[1].pose};
      const Certificate certificate = certify(query, r, answer);
      const CertificateVerdict verdict = check(pair, certificate);
      ++(verdict.accepted ? certified : refused);
      if (!verdict.accepted) UNSCOPED_INFO(verdict.reason << " in cell " << verdict.cell);
      CHECK(verdict.accepted);
      // The claim is that of the answer.
      CHECK(certificate.contacts.empty() == !answer.hit);
      if (answer.relation) CHECK(certificate.relation == answer.relation);
      if (r.contacts == Contacts::all) {
        REQUIRE(certificate.contacts.size() == answer.contacts.size());
        for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
          CHECK(certificate.contacts[i].face_a == answer.contacts[i].face_a);
          CHECK(certificate.contacts[i].face_b == answer.contacts[i].face_b);
          if (answer.contacts[i].relation) CHECK(certificate.contacts[i].relation == answer.contacts[i].relation);
        }
      }
      CHECK(check(pair, certify(query, r)).accepted);
      const CertificateTree tree_a = make_certificate_tree(a.mesh()), tree_b = make_certificate_tree(b.mesh());
      const Certificate cited = certify(query, r, answer, {&tree_a, &tree_b});
      CHECK(cited.version == (cited.all ? 3 : 1));
      CHECK(check(pair, cited).reason.empty());
      CHECK(cited.contacts.size() == certificate.contacts.size());
      for (const CertificateCell& cell : certificate.cells) ++kinds[cell.kind];
    }
  }
  std::cout << "certified=" << certified << " refused=" << refused << '\n';
  CHECK(refused == 0);
  CHECK(kinds.size() == 6);  // each kind of cell was there
}

TEST_CASE("certificate: answers about distances are certified and accepted", "[lib][certificate]") {
  std::mt19937_64 random = generator(9);
  const auto device = open_cpu_device({1, ""});
  std::map<std::string, int> kinds;
  for (int n = 0; n < 60; ++n) {
    const std::array<Placed, 2> pair = random_pair(random);
    const Object a(pair[0].mesh), b(pair[1].mesh);
    const CollisionQuery query = {&a, &pair[0].pose, &b, &pair[1].pose};
    Judge judge(pair[0], pair[1]);
    for (const Contacts contacts : {Contacts::first, Contacts::all}) {
      CollisionRequest r = request(contacts, false);
      r.within = random_distance(a, pair[0].pose, b, pair[1].pose, random);
      const CollisionResult answer = collide(*device, a, pair[0].pose, b, pair[1].pose, r);
      const Certificate certificate = certify(query, r, answer);
      CHECK(check(pair, certificate).reason.empty());
      CHECK(judge.holds(certificate));
      CHECK(certificate.contacts.empty() == !answer.hit);
      if (contacts == Contacts::all) CHECK(certificate.contacts.size() == answer.contacts.size());
      ++kinds[certificate.all ? certificate.contacts.empty() ? "none" : "all" : "one"];
      const Certificate below = certify_below(query, r.within, contacts);
      CHECK(check(pair, below).reason.empty());
      CHECK(judge.holds(below));
      ++kinds[below.contacts.size() == certificate.contacts.size() ? "as many below" : "fewer below"];
    }
  }
  for (const auto& [kind, count] : kinds) std::cout << kind << ' ' << count << '\n';
  CHECK(kinds.size() == 5);  // "fewer below" is drawn on purpose: the distance itself
  const std::array<Placed, 2> pair = random_pair(random);
  const Object a(pair[0].mesh);
  const CollisionQuery query = {&a, &pair[0].pose, &a, &pair[1].pose};
  CHECK_THROWS_WITH(certify_below(query, 0), Catch::StartsWith("certify_below: the distance is 0: "));
}

namespace {

/// Changes certificates at random and judges those that are accepted; prints what came of it.
void mutate_certificates(int pairs, std::mt19937_64& random) {
  int mutations = 0, accepted = 0, false_accepts = 0;
  for (int n = 0; n < pairs; ++n) {
    const std::array<Placed, 2> pair = random_pair(random);
    const Certificate certificate = random_certificate(pair, random);
    Judge judge(pair[0], pair[1]);
    REQUIRE(judge.holds(certificate));
    for (int m = 0; m < 25; ++m) {
      Certificate changed = certificate;
      mutate(changed, random);
      if (changed.cells.empty()) continue;
      const bool accepts = check(pair, changed).accepted;
      ++mutations;
      accepted += accepts ? 1 : 0;
      if (accepts && !judge.holds(changed)) {
        ++false_accepts;
        std::cout << "accepted although it does not hold: " << describe(certificate) << " changed to "
                  << describe(changed) << '\n';
      }
    }
  }
  std::cout << "mutations=" << mutations << " accepted=" << accepted << " false_accepts=" << false_accepts << '\n';
  CHECK(false_accepts == 0);
  CHECK(accepted > 0);
  CHECK(accepted < mutations);
}

}  // namespace

TEST_CASE("certificate: what was changed is accepted only where it is true", "[lib][certificate]") {
  std::mt19937_64 random = generator(2);
  mutate_certificates(70, random);
}

TEST_CASE("certificate: a hundred thousand changes", "[.mutations]") {
  std::mt19937_64 random = generator(8);
  mutate_certificates(4300, random);
}

TEST_CASE("certificate: lies are refused", "[lib][certificate]") {
  std::mt19937_64 random = generator(3);
  std::map<std::string, int> told;
  for (int n = 0; n < 200; ++n) {
    const std::array<Placed, 2> pair = random_pair(random);
    const Object a(pair[0].mesh), b(pair[1].mesh);
    const CollisionQuery query = {&a, &pair[0].pose, &b, &pair[1].pose};
    const Certificate truth = certify(query, request(Contacts::all, true));
    REQUIRE(truth.all);
    const auto refuses = [&](const std::string& lie, const Certificate& c) {
      ++told[lie];
      INFO(lie);
      CHECK_FALSE(check(pair, c).accepted);
    };
    for (std::size_t i = 0; i < truth.contacts.size(); ++i) {
      Certificate c = truth;
      c.contacts.erase(c.contacts.begin() + static_cast<std::ptrdiff_t>(i));
      refuses("a hit dropped", c);
      c = truth;
      Relation& relation = *c.contacts[i].relation;
      relation = relation == Relation::crossing ? Relation::touching : Relation::crossing;
      refuses("a relation swapped", c);
    }
    for (std::uint32_t f = 0; f < 3; ++f) {
      Certificate c = truth;
      const auto place = std::lower_bound(c.contacts.begin(), c.contacts.end(), f,
                                          [](const auto& x, std::uint32_t y) { return x.face_a <= y; });
      c.contacts.insert(place, {f, 1000, Relation::touching});
      refuses("a contact added", c);
    }
    for (const Relation relation : {Relation::apart, Relation::touching, Relation::crossing}) {
      if (relation == truth.relation) continue;
      Certificate c = truth;
      c.relation = relation;
      refuses("another relation", c);
    }
    for (std::size_t i = 0; i < truth.cells.size(); ++i) {
      if (truth.cells[i].kind < CellKind::meet) continue;
      Certificate c = truth;  // the contact, its cell too, is said to be separated
      c.cells[i].kind = CellKind::separated;
      c.cells[i].direction = {"1", "2", "-3"};
      refuses("a cell made separated", c);
    }
    std::array<Placed, 2> other = pair;
    other[1].pose.translation()[0] += 0.5;
    CHECK(check(other, truth).reason == "the certificate is of other poses");
    other = pair;
    other[0].mesh.vertices[0][2] += 1;
    CHECK_FALSE(check(other, truth).accepted);
    // A wrong answer has no certificate.
    CollisionResult wrong;
    wrong.hit = truth.contacts.empty();
    if (wrong.hit) wrong.contacts = {{0, 0, std::nullopt}};
    CHECK_THROWS_AS(certify(query, {}, wrong), std::runtime_error);
  }
  CHECK(told.size() == 5);
}

TEST_CASE("certificate: devices add it if the request asks", "[lib][certificate]") {
  std::mt19937_64 random = generator(6);
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(open_cpu_device({1, ""}));
  devices.push_back(open_cpu_device({3, ""}));
  for (const std::string& name : device_names()) {
    if (name != "cpu") devices.push_back(open_device(name));
  }
  for (int n = 0; n < 12; ++n) {
    const std::array<Placed, 2> pair = random_pair(random);
    const Object a(pair[0].mesh), b(pair[1].mesh);
    std::vector<std::array<Placed, 2>> placed;
    std::vector<PosePair> poses;
    for (int i = 0; i < 40; ++i) {
      placed.push_back(pair);
      placed.back()[1].pose.translation() += Vec3d(i % 5, 0, 0);
      poses.push_back({placed.back()[0].pose, placed.back()[1].pose});
    }
    CollisionRequest r = requests[static_cast<std::size_t>(n) % requests.size()];
    for (const auto& device : devices) {
      CAPTURE(device->name(), n);
      r.certificate = true;
      CollisionResult single;
      device->collide({&a, &poses[0].a, &b, &poses[0].b}, r, single);
      REQUIRE(single.certificate);
      CHECK(check(placed[0], *single.certificate).accepted);
      CHECK(single.hit == !single.certificate->contacts.empty());
      const std::vector<CollisionResult> many = collide(*device, a, b, poses, r);
      for (std::size_t i = 0; i < many.size(); ++i) {
        REQUIRE(many[i].certificate);
        CHECK(check(placed[i], *many[i].certificate).accepted);
        CHECK(many[i].hit == !many[i].certificate->contacts.empty());
      }
      // A batch that ends early leaves nothing to the next one.
      int taken = 0;
      collide(*device, a, b, poses, r, [&](std::size_t, const CollisionResult&) { return ++taken < 3; });
      r.certificate = false;
      device->collide({&a, &poses[0].a, &b, &poses[0].b}, r, single);
      CHECK_FALSE(single.certificate);
      for (const CollisionResult& result : collide(*device, a, b, poses, r)) CHECK_FALSE(result.certificate);
    }
  }
}

TEST_CASE("certificate: of the pairs of a scene", "[lib][certificate]") {
  std::mt19937_64 random = generator(7);
  Scene scene;
  std::map<Scene::Id, Placed> placed;
  for (int n = 0; n < 12; ++n) {
    for (Placed& p : random_pair(random)) {
      p.mesh.file_face.clear();
      placed[scene.add(Object(p.mesh), p.pose)] = p;
    }
  }
  CollisionRequest r = request(Contacts::all, true);
  r.certificate = true;
  const auto device = open_cpu_device({2, ""});
  const std::vector<Scene::Pair> touching = scene.contacts(*device, r);
  REQUIRE_FALSE(touching.empty());
  for (const Scene::Pair& pair : touching) {
    REQUIRE(pair.result.certificate);
    CHECK(pair.result.certificate->contacts.size() == pair.result.contacts.size());
    CHECK(check({placed[pair.a], placed[pair.b]}, *pair.result.certificate).accepted);
  }
  const std::optional<Scene::Pair> one = scene.find_contact(*device, r);
  REQUIRE(one);
  CHECK(check({placed[one->a], placed[one->b]}, *one->result.certificate).accepted);
}

TEST_CASE("certificate: none of a wrong answer", "[lib][certificate]") {
  const Mesh box = make_box({0, 0, 0}, {1, 1, 1});
  const Object a(box);
  const Pose here = Pose::Identity();
  Pose there = here;
  there.translation() = Vec3d(3, 0, 0);
  CollisionResult wrong;
  wrong.hit = true;
  wrong.contacts = {{0, 0, std::nullopt}};
  CHECK_THROWS_AS(add_certificate({&a, &here, &a, &there}, {}, wrong), std::runtime_error);
  CHECK_FALSE(wrong.certificate);
  wrong = {};
  CHECK_THROWS_AS(add_certificate({&a, &here, &a, &here}, {}, wrong), std::runtime_error);
}

TEST_CASE("certificate: hostile input ends with a reason", "[lib][certificate]") {
  const std::array<Placed, 2> pair = {{{make_box({0, 0, 0}, {1, 1, 1})}, {make_box({1, 0, 0}, {2, 1, 1})}}};
  const Object a(pair[0].mesh), b(pair[1].mesh);
  const Certificate good = certify({&a, &pair[0].pose, &b, &pair[1].pose}, request(Contacts::all, true));
  REQUIRE(check(pair, good).accepted);
  const auto reason = [&](const auto& change) {
    Certificate c = good;
    change(c);
    const CertificateVerdict verdict = check(pair, c);
    CHECK_FALSE(verdict.accepted);
    return verdict.reason;
  };
  std::size_t separated = 0;
  while (good.cells[separated].kind != CellKind::separated) ++separated;
  for (const std::string& text :
       {std::string(), std::string("-"), std::string("+1"), std::string("0x10"), std::string("01"), std::string("1e9"),
        std::string("1/2"), std::string(" 1"), std::string(1000000, '9')}) {
    CHECK(reason([&](Certificate& c) { c.cells[separated].direction[0] = text; }) ==
          "not an integer of at most 20000 digits");
  }
  CHECK(reason([](Certificate& c) { c.version = 2; }) == "unknown version");
  CHECK(reason([](Certificate& c) { c.cells.clear(); }) == "cells are missing");
  CHECK(reason([](Certificate& c) { c.cells.push_back(c.cells.back()); }) == "a cell too many");
  CHECK(reason([](Certificate& c) { c.order_a[0] = 0xffffffff; }) == "an order does not hold each face once");
  CHECK(reason([](Certificate& c) { c.order_b.resize(100); }) == "an order does not hold each face once");
  CHECK(reason([](Certificate& c) { c.cells[0].at = 0; }) == "a split leaves one half empty");
  CHECK(reason([](Certificate& c) { c.cells[0].at = 0xffffffff; }) == "a split leaves one half empty");
  CHECK(reason([](Certificate& c) { c.cells[0].kind = static_cast<CellKind>(17); }) == "unknown kind of cell");
  CHECK(reason([&](Certificate& c) { c.cells[separated].direction = {"0", "0", "0"}; }) == "the direction is 0");
  CHECK(reason([](Certificate& c) {
          c.all = false;
          c.order_a.clear();
          c.order_b.clear();
          c.cells.assign(1, {});
          c.cells[0].kind = CellKind::meet;
          c.cells[0].face_a = 0xffffffff;
        }) == "there is no such face");
  // The first cell that fails is named.
  Certificate c = good;
  c.cells[separated].direction = {"0", "0", "0"};
  CHECK(check(pair, c).cell == separated);
  // Meshes that are none.
  std::array<Placed, 2> broken = pair;
  broken[0].mesh.vertices[0][0] = std::numeric_limits<double>::quiet_NaN();
  CHECK(check(broken, good).reason == "a number of a mesh or a pose is not finite");
  broken = pair;
  broken[0].mesh.faces[0].vertex[2] = 8;
  CHECK(check(broken, good).reason == "a face has a vertex that does not exist");
}

TEST_CASE("certificate: coordinates at the ends of the doubles", "[lib][certificate]") {
  Mesh huge, tiny;
  testing::add_face(huge, {{-0x1p1000, 0, 0}, {0x1p1000, 0, 0}, {0, 0x1p1000, 0}});
  testing::add_face(tiny, {{0, 0, -0x1p-1074}, {0, 0, 0x1p-1074}, {0x1p-1074, 0, 0x1p-1074}});
  testing::add_face(tiny, {{0, 0, 0x1p-1074}, {0, 0, 0x1p-1073}, {0x1p-1074, 0, 0x1p-1074}});
  std::array<Placed, 2> pair = {{{huge}, {tiny}}};
  for (const double scale : {1.0, 0x1p500}) {
    pair[0].pose.linear() = scale * Eigen::Matrix3d::Identity();
    const Object a(huge), b(tiny);
    const Certificate c = certify({&a, &pair[0].pose, &b, &pair[1].pose}, request(Contacts::all, true));
    CHECK(check(pair, c).accepted);
    REQUIRE(c.contacts.size() == 1);
    CHECK(c.contacts[0].relation == Relation::touching);  // the vertex at z = 0 is on an edge of the triangle
  }
}

TEST_CASE("certificate: trees of meshes with boxes, in poses of all kinds", "[lib][certificate]") {
  std::mt19937_64 random = generator(11);
  const Object a(make_sphere(0.4, 3, 0.1)), b(make_sphere(0.3, 2, 0.1));
  const CertificateTree tree_a = make_certificate_tree(a.mesh()), tree_b = make_certificate_tree(b.mesh());
  const CitedTrees trees = {&tree_a, &tree_b};
  std::map<std::string, int> told;
  std::size_t cells = 0, of_orders = 0;
  for (int n = 0; n < 60; ++n) {
    std::array<Placed, 2> pair = {{{a.mesh()}, {b.mesh()}}};
    const PoseClass c = pose_classes[std::size_t(n) % std::size(pose_classes)];
    for (Placed& p : pair) p.pose = random_pose(c, 0.5, random);
    if (n % 3 == 0) pair[1].pose.linear() *= n % 2 == 0 ? 0x1p450 : 0x1p-450;
    const CollisionQuery query = {&a, &pair[0].pose, &b, &pair[1].pose};
    const auto holds = [&](const Certificate& certificate) {
      const CertificateVerdict verdict = check_certificate(tree_a, pair[0].pose, tree_b, pair[1].pose, certificate);
      INFO(n << ": " << verdict.reason << " in cell " << verdict.cell);
      CHECK(verdict.accepted);
      return verdict.accepted;
    };
    const Certificate certificate = certify(query, request(Contacts::all, true), trees);
    const Certificate with_orders = certify(query, request(Contacts::all, true));
    REQUIRE(holds(certificate));
    CHECK(certificate.relation == with_orders.relation);
    REQUIRE(certificate.contacts.size() == with_orders.contacts.size());
    for (std::size_t i = 0; i < certificate.contacts.size(); ++i) {
      CHECK(certificate.contacts[i].face_a == with_orders.contacts[i].face_a);
      CHECK(certificate.contacts[i].face_b == with_orders.contacts[i].face_b);
    }
    ++told[certificate.contacts.empty() ? "apart" : "contacts"];
    cells += certificate.cells.size();
    of_orders += with_orders.cells.size();
    if (certificate.contacts.empty()) {
      const double far = distance(a, pair[0].pose, b, pair[1].pose).lower;
      if (far > 0) {
        const Certificate below = certify_below(query, far, Contacts::first, trees);
        CHECK(below.contacts.empty());
        CHECK(holds(below));
        ++told["below"];
      }
    }
    const Vec3d along = random_translation(random);
    const std::optional<Certificate> clear = certify_clear_along(query, along, trees);
    CHECK(clear.has_value() == certify_clear_along(query, along).has_value());
    if (clear) {
      holds(*clear);
      ++told["clear"];
    }
  }
  for (const auto& [kind, count] : told) std::cout << kind << ' ' << count << '\n';
  std::cout << "cells=" << cells << " cells_with_orders=" << of_orders << '\n';
  CHECK(told.size() == 4);
}

TEST_CASE("certificate: what a tree is, and what it is not", "[lib][certificate]") {
  // A strip along a diagonal: the boxes of its eighths are cubes, which the direction does not part from the others.
  Mesh strip;
  for (int i = 0; i < 48; ++i) {
    const double x = i;
    testing::add_face(strip, {{x, x, x}, {x + 1, x + 1, x + 1}, {x, x + 0.5, x}});
  }
  std::array<Placed, 2> pair = {{{strip}, {strip}}};
  pair[1].pose.translation() = Vec3d(2, 0, 0);
  const Object a(strip), b(strip);
  const CertificateTree tree = make_certificate_tree(a.mesh()), same = make_certificate_tree(b.mesh());
  const CollisionQuery query = {&a, &pair[0].pose, &b, &pair[1].pose};
  Certificate c = certify(query, {}, {&tree, &same});
  REQUIRE(check(pair, c).accepted);
  CHECK(c.cells.size() > 1);
  const auto reason = [&](const Certificate& certificate) {
    return check_certificate(tree, pair[0].pose, same, pair[1].pose, certificate).reason;
  };
  Certificate changed = c;
  changed.cells.resize(1);
  changed.cells[0] = {};
  changed.cells[0].direction = {"1", "-1", "0"};
  CHECK(reason(changed) == "A is not strictly below B");
  changed.version = 1;  // which it does part the faces along
  changed.order_a = tree.order();
  changed.order_b = same.order();
  CHECK(reason(changed).empty());
  changed = c;
  changed.cells.assign(80, {});
  for (CertificateCell& cell : changed.cells) cell.kind = CellKind::split_a;
  CHECK(reason(changed) == "a split leaves one half empty");
  changed = c;
  changed.order_a = tree.order();
  CHECK(reason(changed) == "an order beside a tree");
  changed = c;
  changed.tree_b ^= 1U;
  CHECK(reason(changed) == "it cites other trees");
  changed = c;
  changed.all = false;
  CHECK(reason(changed) == "unknown version");
  CHECK(check_certificate(pair[0].mesh, pair[0].pose, pair[1].mesh, pair[1].pose, c).reason ==
        "it cites trees, and none are given");
  std::vector<std::uint32_t> order = tree.order();
  std::swap(order[0], order[5]);
  CHECK(check_certificate(CertificateTree(a.mesh(), order), pair[0].pose, same, pair[1].pose, c).reason ==
        "it cites other trees");
  order[0] = order[1];
  CHECK_THROWS_WITH(CertificateTree(a.mesh(), order), "an order does not hold each face once");
  order.pop_back();
  CHECK_THROWS_WITH(CertificateTree(a.mesh(), order), "an order does not hold each face once");
  CHECK_THROWS_WITH(make_certificate_tree(Mesh()), "an order does not hold each face once");
  CHECK_THROWS_WITH(certify(query, {}, {&tree, nullptr}), Catch::StartsWith("certify: one tree is missing: "));
  CHECK_THROWS_WITH(certify(query, {}, {&same, &tree}), Catch::StartsWith("certify: a tree is of another mesh: "));

  // Its file.
  std::ostringstream out;
  write_certificate_tree(tree, out);
  const std::string text = out.str();
  const auto read_tree = [&](const std::string& changed_text, const Mesh& mesh) {
    std::istringstream in(changed_text);
    return read_certificate_tree(mesh, in);
  };
  CHECK(read_tree(text, a.mesh()).tree_hash() == tree.tree_hash());
  CHECK(read_tree(text.substr(0, text.size() - 1), a.mesh()).tree_hash() == tree.tree_hash());
  CHECK_THROWS_WITH(read_tree(text + text, a.mesh()), "tree: more than one line");
  CHECK_THROWS_WITH(read_tree("", a.mesh()), "tree: the file is empty or cannot be read");
  CHECK_THROWS_WITH(read_tree("{\"collisionchip_tree\":2}", a.mesh()), "tree: no tree, or another version of it");
  CHECK_THROWS_WITH(read_tree("{\"collisionchip_tree\":1,\"order\":[[0,47]],\"mesh\":\"0000000000000000\"}", a.mesh()),
                    "tree: it is of another mesh");
  CHECK_THROWS_WITH(read_tree("{\"collisionchip_tree\":1,\"order\":[[0,4]],\"mesh\":\"0000000000000000\"}", a.mesh()),
                    "tree: an order does not hold each face once");
  CHECK_THROWS_WITH(read_tree("[", a.mesh()), Catch::StartsWith("tree: "));
}

namespace {

std::string written(const Certificate& certificate) {
  std::ostringstream out;
  write_certificate(certificate, out);
  return out.str();
}

Certificate read(const std::string& text) {
  std::istringstream in(text);
  return read_certificate(in);
}

/// Two boxes side by side, B moved by the pose; the page prints their certificate.
std::array<Placed, 2> boxes_of_the_page(double gap) {
  std::array<Placed, 2> pair = {{{make_box({0, 0, 0}, {1, 1, 1})}, {make_box({0, 0, 0}, {1, 1, 1})}}};
  pair[1].pose.translation() = Vec3d(1 + gap, 0, 0);
  return pair;
}

}  // namespace

TEST_CASE("certificate: that a translation clears a mesh is certified and accepted", "[lib][certificate]") {
  std::mt19937_64 random = generator(10);
  int clear = 0, touching = 0, blocked = 0;
  for (int n = 0; n < 120; ++n) {
    const std::array<Placed, 2> pair = random_pair(random);
    const Object a(pair[0].mesh), b(pair[1].mesh);
    const Vec3d along = random_translation(random);
    const auto certificate = certify_clear_along({&a, &pair[0].pose, &b, &pair[1].pose}, along);
    if (!certificate) {
      // There is a contact on the way: at once, or after a while.
      Pose moved = pair[1].pose;
      moved.translation() += 0x1p-30 * along;
      CHECK((first_contact(a, pair[0].pose, b, moved, along).touches ||
             clear_along(a, pair[0].pose, b, pair[1].pose, along).upper > 0 ||
             first_contact(a, pair[0].pose, b, pair[1].pose, along).upper > 0));
      ++blocked;
      continue;
    }
    CHECK(check(pair, *certificate).reason.empty());
    CHECK(Judge(pair[0], pair[1]).holds(*certificate));
    ++clear;
    touching += collide(a, pair[0].pose, b, pair[1].pose).hit ? 1 : 0;
    for (std::size_t i = 0; i < certificate->cells.size(); ++i) {  // a gap of 0 that the translation does not open
      if (certificate->cells[i].kind != CellKind::separated) continue;
      Certificate changed = *certificate;
      for (Digits& d : changed.cells[i].direction) d = cpp_int(-cpp_int(d)).str();
      CHECK_FALSE(check(pair, changed).accepted);
    }
  }
  std::cout << "clear=" << clear << " of them touching=" << touching << " blocked=" << blocked << '\n';
  CHECK(touching > 0);
  CHECK(clear > touching);
  CHECK(blocked > 0);
  const std::array<Placed, 2> boxes = boxes_of_the_page(0);
  const Object box(boxes[0].mesh);
  const CollisionQuery query = {&box, &boxes[0].pose, &box, &boxes[1].pose};
  CHECK(certify_clear_along(query, Vec3d(1, 0, 0))->cells.size() == 1);
  CHECK_FALSE(certify_clear_along(query, Vec3d(0, 1, 0)));
  CHECK_THROWS_WITH(certify_clear_along(query, Vec3d::Zero()),
                    Catch::StartsWith("certify_clear_along: the translation"));
}

TEST_CASE("certificate: a file keeps it, and a damaged one is refused or still true", "[lib][certificate]") {
  std::mt19937_64 random = generator(4);
  int unread = 0, refused = 0, accepted = 0;
  for (int n = 0; n < 60; ++n) {
    const std::array<Placed, 2> pair = random_pair(random);
    const Certificate c = random_certificate(pair, random);
    const std::string text = written(c);
    CHECK(written(read(text)) == text);
    CHECK(check(pair, read(text)).accepted);
    Judge judge(pair[0], pair[1]);
    for (int m = 0; m < 20; ++m) {
      std::string damaged = text;
      damaged[random() % damaged.size()] = "0123456789-\",[]{}:\nabx"[random() % 22];
      if (random() % 8 == 0) damaged.resize(random() % damaged.size());
      try {
        const Certificate changed = read(damaged);
        const bool accepts = check(pair, changed).accepted;
        ++(accepts ? accepted : refused);
        if (accepts && !judge.holds(changed)) FAIL("accepted although it does not hold: " << damaged);
      } catch (const std::runtime_error& error) {
        ++unread;
        CHECK(std::string(error.what()).rfind("certificate, line ", 0) == 0);
      }
    }
  }
  CHECK(unread > 0);
  CHECK(refused > 0);
  for (const std::string& text :
       {std::string(), std::string("{}"), std::string("[1]\n"), std::string("{\"collisionchip_certificate\":2}"),
        std::string(100000, '['), std::string("\xff\xfe")}) {
    CHECK_THROWS_WITH(read(text), Catch::StartsWith("certificate, line 1: "));
  }
}

TEST_CASE("certificate: the message about a long damaged line is short", "[lib][certificate]") {
  // The parser of JSON shows all that it read of a word: spaces before it, digits of a number that is too large.
  for (const std::string& line :
       {"{" + std::string(2000, '\t') + "n", "{\"collisionchip_certificate\":" + std::string(5000, '9') + "}",
        "{\"" + std::string(3000, 'x')}) {
    try {
      read(line + "\n");
      FAIL("accepted");
    } catch (const std::runtime_error& error) {
      const std::string text = error.what();
      CHECK(text.rfind("certificate, line 1: ", 0) == 0);
      CHECK(text.size() < 300);
    }
  }
}

TEST_CASE("certificate: readers refuse what is no number, and orders that do not end", "[lib][certificate]") {
  const std::array<Placed, 2> pair = boxes_of_the_page(0.5);
  const Object a(pair[0].mesh), b(pair[1].mesh);
  const std::string text = written(certify({&a, &pair[0].pose, &b, &pair[1].pose}, request(Contacts::all, false)));
  const auto with = [&text](const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return std::string(text).replace(at, what.size(), by);
  };
  REQUIRE_NOTHROW(read(text));
  for (const char* number : {"\"+1\"", "\"01\"", "\"1e3\"", "\"\\\"\"", "\"-\"", "\"\"", "\"1\\n\""}) {
    CHECK_THROWS_WITH(read(with("\"direction\":[\"1\"", std::string("\"direction\":[") + number)),
                      "certificate, line 2: not an integer of at most 20000 digits");
  }
  for (const char* run : {"[0,4294967295]", "[5,0]", "[0,5],[0,16777215]"}) {
    CHECK_THROWS_WITH(read(with("[0,5]", run)), "certificate, line 1: an order of more than 2^24 faces, or a run back");
  }
  CHECK_THROWS_WITH(read(with("[0,5]", "[0,1,2]")), "certificate, line 1: a run is the first and the last number");
  CHECK(check(pair, read(with("[0,5]", "[0,3],4,5"))).accepted);
  CHECK(check(pair, read(with("[0,5]", "[0,4]"))).reason == "an order does not hold each face once");
  CHECK_THROWS_WITH(read(text + text), "certificate: the file holds more than one; use CertificateReader");
  std::istringstream both(text + text);
  CertificateReader reader(both);
  CHECK(check(pair, reader.next().value()).accepted);
  CHECK(check(pair, reader.next().value()).accepted);
  CHECK_FALSE(reader.next());
  CHECK_FALSE(reader.next());
}

TEST_CASE("certificate: the page prints those of two boxes", "[lib][certificate]") {
  std::ifstream file(CCHIP_CERTIFICATE_PAGE);
  REQUIRE(file);
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  for (const auto& [gap, r] :
       {std::make_pair(0.5, request(Contacts::all, false)), std::make_pair(-0.5, request(Contacts::first, false))}) {
    const std::array<Placed, 2> pair = boxes_of_the_page(gap);
    const Object a(pair[0].mesh), b(pair[1].mesh);
    const Certificate c = certify({&a, &pair[0].pose, &b, &pair[1].pose}, r);
    CHECK(check(pair, c).accepted);
    INFO(written(c));
    CHECK(page.find(written(c)) != std::string::npos);
  }
}

namespace {

/// For check_agrees.py: a line of JSON with meshes, poses, the verdict of this checker, and more fields.
void print_case(const std::array<Placed, 2>& pair, bool accepted, const std::string& fields) {
  std::cout << "{\"meshes\":[";
  for (const std::size_t s : {0U, 1U}) {
    const Mesh& mesh = pair[s].mesh;
    std::cout << (s == 0 ? "[[" : ",[[");
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const Vec3d& v = mesh.vertices[i];
      std::cout << (i == 0 ? "[" : ",[") << v[0] << ',' << v[1] << ',' << v[2] << ']';
    }
    std::cout << "],[";
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      std::cout << (i == 0 ? "[" : ",[") << mesh.faces[i].vertex[0];
      for (std::size_t k = 1; k < std::size_t(mesh.faces[i].kind); ++k) std::cout << ',' << mesh.faces[i].vertex[k];
      std::cout << ']';
    }
    std::cout << "],[";
    for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) std::cout << (i == 0 ? "" : ",") << mesh.number_in_file(i);
    std::cout << "]]";
  }
  std::cout << "],\"poses\":[";
  const char* comma = "";
  for (const Placed& p : pair) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        std::cout << comma << p.pose(row, column);
        comma = ",";
      }
    }
  }
  std::cout << "],\"trees\":[";
  for (const std::size_t s : {0U, 1U}) {
    comma = s == 0 ? "[" : ",[";
    const CertificateTree tree = make_certificate_tree(pair[s].mesh);
    for (const std::uint32_t face : tree.order()) {
      std::cout << comma << face;
      comma = ",";
    }
    std::cout << ']';
  }
  std::cout << "],\"accepted\":" << (accepted ? "true" : "false") << ',' << fields << "}\n";
}

/// A string of JSON.
std::string in_quotes(const std::string& text) {
  std::string result = "\"";
  for (const char x : text) {
    const std::size_t control = std::string("\n\r\f\t").find(x);
    if (x == '"' || x == '\\') {
      result += {'\\', x};
    } else if (control != std::string::npos) {
      result += {'\\', "nrft"[control]};
    } else {
      result += x;
    }
  }
  return result + '"';
}

/// Does a file hold certificates of the pair, all of which are accepted?
bool accepts_file(const std::array<Placed, 2>& pair, const std::string& text) {
  std::istringstream in(text);
  CertificateReader reader(in);
  bool accepted = false;
  try {
    while (const std::optional<Certificate> certificate = reader.next()) {
      if (!check(pair, *certificate).accepted) return false;
      accepted = true;
    }
  } catch (const std::runtime_error&) {
    return false;
  }
  return accepted;
}

}  // namespace

TEST_CASE("certificate: cases for the checker in Python", "[.cases]") {
  std::mt19937_64 random = generator(5);
  std::cout.precision(17);
  for (int n = 0; n < 60; ++n) {
    const std::array<Placed, 2> pair = random_pair(random);
    const Certificate truth = random_certificate(pair, random);
    for (int m = 0; m < 10; ++m) {
      Certificate c = truth;
      if (m > 0) mutate(c, random);
      std::string lines;
      std::istringstream text(written(c));
      for (std::string line; std::getline(text, line);) lines += (lines.empty() ? "" : ",") + in_quotes(line);
      print_case(pair, accepts_file(pair, written(c)), "\"lines\":[" + lines + ']');
    }
  }
}

namespace {

struct FileCase {
  bool accepted;
  std::string text;
};

/// Files with what readers of JSON, of lines and of lists differ about.
/// \param all no contacts; \param one a contact; of different poses
std::array<std::vector<FileCase>, 2> file_cases(const std::string& all, const std::string& one) {
  const auto with = [](std::string text, const std::string& what, const std::string& by) {
    REQUIRE(text.find(what) != std::string::npos);
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
      text.replace(at, what.size(), by);
    }
    return text;
  };
  const auto extra = [&](const std::string& value) {
    return with(all, ",\"order_b\"", ",\"x\":" + value + ",\"order_b\"");
  };
  const std::string version = "\"collisionchip_certificate\":1";
  const std::string faces = "\"faces\":[0,4]", contacts = "\"contacts\":[[0,4,null]]";
  const std::vector<FileCase> of_all = {
      {true, all},
      {true, all + all},
      {false, all + one},
      {false, all + with(all, "\"1\"", "\"-1\"")},
      {false, ""},
      {false, "\n" + all},
      {false, all + "\n"},
      {true, all.substr(0, all.size() - 1)},
      {true, with(all, "\n", "\r\n")},
      {false, with(all, "\n", "\r")},
      {false, with(all, "\n", "\f")},
      {false, "\xef\xbb\xbf" + all},
      {false, with(all, "\n", "\n\xef\xbb\xbf")},
      {false, with(all, version, "\"collisionchip_certificate\":true")},
      {false, with(all, version, "\"collisionchip_certificate\":1.0")},
      {false, with(all, version, "\"collisionchip_certificate\":\"1\"")},
      {false, with(all, version, "\"collisionchip_certificate\":2")},
      {false, with(all, "{\"cell\"", "{" + version + ",\"cell\"")},
      {false, with(all, "{\"cell\"", "{\"collisionchip\\u005fcertificate\":1,\"cell\"")},
      {true, with(all, version, "\"collisionchip\\u005fcertificate\":1")},
      {true, extra("\"\xe2\x80\xa8\"")},
      {true, extra("\"\xc2\x85\"")},
      {true, extra("\"\\u2028\"")},
      {true, extra("\"\\ud83d\\ude00\"")},
      {false, extra("\"\\ud800\"")},
      {false, extra("{\"\\udc00\":1}")},
      {false, extra("NaN")},
      {false, extra("-Infinity")},
      {false, extra("1e999")},
      {true, extra("1e308")},
      {false, extra("1" + std::string(400, '0'))},
      {true, extra("1" + std::string(300, '0'))},
      {true, extra("-0")},
      {true, extra("[[[[]]]]")},
      {false, extra("[[[[1]]]]")},
      {false, extra("[[[[[]]]]]")},
      {false, extra("[[[{\"y\":1}]]]")},
      {true, extra("[[[{}]]]")},
      {false, extra("01")},
      {false, extra("'x'")},
      {false, extra("\"\t\"")},
      {false, with(all, "\"contacts\":[]", "\"contacts\":null")},
      {false, with(all, "\"contacts\":[]", "\"contacts\":{}")},
      {false, with(all, "\"contacts\":[]", "\"contacts\":\"\"")},
  };
  const std::vector<FileCase> of_one = {
      {true, one},
      {true, one + one + one},
      {false, with(one, "\"order_a\":[]", "\"order_a\":{}")},
      {false, with(one, "\"order_a\":[]", "\"order_a\":\"\"")},
      {false, with(one, contacts, "\"contacts\":[[0.0,4,null]]")},
      {false, with(one, contacts, "\"contacts\":[[false,4,null]]")},
      {false, with(one, contacts, "\"contacts\":[[-0,4,null]]")},
      {false, with(one, contacts, "\"contacts\":[[0,4]]")},
      {false, with(one, faces, "\"faces\":[0,4,1]")},
      {false, with(one, faces, "\"faces\":[0]")},
      {false, with(one, faces, "\"faces\":[-0,4]")},
      {false, with(one, faces, "\"faces\":[false,4]")},
      {false, with(one, faces, "\"faces\":[0.0,4]")},
  };
  return {of_all, of_one};
}

/// Calls `each` for each pair and case.
template <class Each>
void for_file_cases(const Each& each) {
  const std::array<std::array<Placed, 2>, 2> pairs = {boxes_of_the_page(0.5), boxes_of_the_page(-0.5)};
  std::array<std::string, 2> text;
  for (const std::size_t i : {0U, 1U}) {
    const Object a(pairs[i][0].mesh), b(pairs[i][1].mesh);
    text[i] = written(certify({&a, &pairs[i][0].pose, &b, &pairs[i][1].pose},
                              request(i == 0 ? Contacts::all : Contacts::first, false)));
  }
  const auto cases = file_cases(text[0], text[1]);
  for (const std::size_t i : {0U, 1U}) {
    for (const FileCase& one : cases[i]) each(pairs[i], one);
  }
}

}  // namespace

TEST_CASE("certificate: files that readers may differ about", "[lib][certificate]") {
  for_file_cases([](const std::array<Placed, 2>& pair, const FileCase& one) {
    INFO(one.text);
    CHECK(accepts_file(pair, one.text) == one.accepted);
  });
}

TEST_CASE("certificate: files for the checker in Python", "[.cases]") {
  std::cout.precision(17);
  for_file_cases([](const std::array<Placed, 2>& pair, const FileCase& one) {
    print_case(pair, one.accepted, "\"file\":" + in_quotes(one.text));
  });
}
