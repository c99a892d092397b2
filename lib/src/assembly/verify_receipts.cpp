// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cchip/assembly_receipts.hpp>
#include <cchip/certificate_file.hpp>
#include <cchip/check.hpp>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "mesh_trees.hpp"
#include "receipt_file.hpp"
#include "run_all.hpp"
#include "solid_rays.hpp"
#include "texts.hpp"

namespace cchip {
namespace {

using assembly::Receipt;
using assembly::RuleBook;
using RuleKind = AssemblyRule::Kind;

struct Finding {
  ReceiptState state;
  std::string text;
};

/// Where the pieces of a surface are that shares no point with a solid.
struct Pieces {
  bool all_outside = true;
  bool all_inside = true;
};

/// Of two meshes whose surfaces share no point: the pieces of one against the other, which is closed.
Pieces pieces_of(std::size_t side, const AssemblyPart& part, const AssemblyPart& solid,
                 const std::array<std::vector<certificate_check::Point>, 2>& points) {
  Pieces pieces;
  for (const std::uint32_t vertex : assembly::vertex_of_each_piece(part.object.mesh())) {
    const assembly::PointSide at = assembly::side_of(points[side][vertex], solid.object.mesh(), points[1 - side]);
    pieces.all_outside = pieces.all_outside && at.is_outside();
    pieces.all_inside = pieces.all_inside && at.is_known && at.is_odd && at.winds;
  }
  return pieces;
}

enum class Nested { apart, a_in_b, b_in_a, unknown };

/// Two parts in their poses whose surfaces share no point. Surfaces that are open are in nothing.
Nested nested(const AssemblyPart& a, const AssemblyPart& b, const Pose& pose_b) {
  const auto points = certificate_check::posed_vertices({&a.object.mesh(), &b.object.mesh()}, {&a.pose, &pose_b});
  const Pieces of_a = b.object.is_closed() ? pieces_of(0, a, b, points) : Pieces{true, false};
  const Pieces of_b = a.object.is_closed() ? pieces_of(1, b, a, points) : Pieces{true, false};
  if (of_a.all_outside && of_b.all_outside) return Nested::apart;
  if (of_a.all_inside && of_b.all_outside) return Nested::a_in_b;
  if (of_b.all_inside && of_a.all_outside) return Nested::b_in_a;
  return Nested::unknown;
}

/// Is the distance of two points at most d? By fractions.
bool is_short(const Vec3d& p, const Vec3d& q, double d) {
  using Fraction = boost::multiprecision::cpp_rational;
  Fraction square = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Fraction difference = Fraction(p[i]) - Fraction(q[i]);
    square += difference * difference;
  }
  return square <= Fraction(d) * Fraction(d);
}

class Verifier {
 public:
  Verifier(const Assembly& assembly, const RuleBook& rules, const std::string& folder, assembly::MeshTrees& trees,
           std::size_t a, std::size_t b)
      : folder_(folder),
        trees_(trees),
        a_(assembly.parts[a]),
        b_(assembly.parts[b]),
        clearance_(rules.clearance_of(a, b)) {
    if (const auto number = rules.rule_of(a, b)) {
      rule_ = &assembly.rules[*number];
      first_in_second_ = rules.is_in_order(*number, a, b);
      second_in_first_ = rules.is_in_order(*number, b, a);
    }
    kind_ = rule_ != nullptr ? rule_->kind : RuleKind::nothing;
  }

  Finding look_at(const Receipt& receipt) const {
    const Receipt now = assembly::receipt_of(a_, b_);
    if (now.mesh_a != receipt.mesh_a) return {ReceiptState::stale, "the mesh of " + a_.name + " is another one"};
    if (now.mesh_b != receipt.mesh_b) return {ReceiptState::stale, "the mesh of " + b_.name + " is another one"};
    if (now.poses != receipt.poses) return {ReceiptState::stale, "the poses are others"};
    if (kind_ == RuleKind::same) {
      if (is_same_mesh_and_place()) return {ReceiptState::proved, "are the same mesh in the same place"};
      return {ReceiptState::unproved, "whether they are the same does not follow from a receipt"};
    }
    if (receipt.common_point) return look_at_point(*receipt.common_point);
    if (receipt.file.empty()) return {ReceiptState::unproved, "no proof was found"};
    return look_at_certificate(receipt);
  }

 private:
  /// By their numbers, not by hashes.
  bool is_same_mesh_and_place() const {
    const Mesh& a = a_.object.mesh();
    const Mesh& b = b_.object.mesh();
    const auto is_same = [](const Mesh::Face& x, const Mesh::Face& y) {
      return x.kind == y.kind && x.vertex == y.vertex;
    };
    return a_.pose.matrix() == b_.pose.matrix() && a.vertices == b.vertices &&
           std::equal(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(), is_same);
  }

  Finding look_at_point(const Vec3d& point) const {
    if (!a_.object.is_closed() || !b_.object.is_closed() || !assembly::is_common_point(point, a_, b_)) {
      return {ReceiptState::refused, "the point is not inside both"};
    }
    const std::string words = "share volume, at " + assembly::rounded_text(point[0]) + ", " +
                              assembly::rounded_text(point[1]) + ", " + assembly::rounded_text(point[2]);
    const bool is_enough = kind_ == RuleKind::nothing || kind_ == RuleKind::clearance || kind_ == RuleKind::touching;
    if (is_enough) return {ReceiptState::violation, words};
    return {ReceiptState::unproved, words + "; that the rule forbids it is not proved"};
  }

  Finding look_at_certificate(const Receipt& receipt) const {
    std::optional<Certificate> c;
    const CertificateTree* tree_a = nullptr;
    const CertificateTree* tree_b = nullptr;
    try {
      std::ifstream file(folder_ + "/" + receipt.file, std::ios::binary);
      if (!file) return {ReceiptState::refused, receipt.file + " cannot be read"};
      c = read_certificate(file);
      if (c->version == 3) {
        tree_a = &trees_.of(a_.object.mesh());
        tree_b = &trees_.of(b_.object.mesh());
      }
    } catch (const std::runtime_error& error) {
      return {ReceiptState::refused, receipt.file + ": " + error.what()};
    }
    Pose pose_b = b_.pose;
    if (receipt.translation) pose_b.translation() = *receipt.translation;
    const CertificateVerdict verdict = tree_a != nullptr
                                           ? check_certificate(*tree_a, a_.pose, *tree_b, pose_b, *c)
                                           : check_certificate(a_.object.mesh(), a_.pose, b_.object.mesh(), pose_b, *c);
    if (!verdict.accepted) return {ReceiptState::refused, receipt.file + ": " + verdict.reason};
    if (!receipt.translation) return look_at_claim(*c);
    if (kind_ != RuleKind::overlap || !is_short(*receipt.translation, b_.pose.translation(), rule_->limit)) {
      return {ReceiptState::refused, "the translation is longer than the rule accepts"};
    }
    if (shares_no_volume(*c, pose_b)) return {ReceiptState::proved, "are parted by a move that the rule accepts"};
    return {ReceiptState::unproved, "that the move parts them does not follow from the receipt"};
  }

  Finding look_at_claim(const Certificate& c) const {
    const bool is_strict = kind_ != RuleKind::touching && kind_ != RuleKind::overlap && kind_ != RuleKind::inside;
    if (!c.contacts.empty() && is_strict && (c.within == 0 || c.within <= clearance_)) {
      const bool is_near = c.within > 0;
      if (!is_near || c.below || c.within < clearance_) {
        return {ReceiptState::violation, is_near ? "are too near" : "share a point"};
      }
    }
    if (kind_ == RuleKind::inside) return look_at_inside(c);
    if (is_strict ? is_clear(c) : shares_no_volume(c, b_.pose)) {
      return {ReceiptState::proved, is_strict ? "are apart" : "share no volume"};
    }
    if (c.relation == Relation::crossing && kind_ != RuleKind::overlap) {
      return {ReceiptState::violation, "have surfaces that cross"};
    }
    return {ReceiptState::unproved, "whether they share volume does not follow from the receipt"};
  }
  Finding look_at_inside(const Certificate& c) const {
    if (!have_no_contact(c)) return {ReceiptState::unproved, "whether one is inside the other does not follow"};
    const Nested found = nested(a_, b_, b_.pose);
    if (found == Nested::unknown) return {ReceiptState::unproved, "on which side their pieces are is not known"};
    const bool is_right =
        (found == Nested::a_in_b && first_in_second_) || (found == Nested::b_in_a && second_in_first_);
    if (is_right) return {ReceiptState::proved, "are one inside the other"};
    return {ReceiptState::violation, "are not one inside the other as the rule wants it"};
  }

  static bool have_no_contact(const Certificate& c) {
    return c.all && c.contacts.empty() && c.least == Relation::touching && !c.along;
  }
  /// No point is shared, and if a clearance is wanted, none is nearer.
  bool is_clear(const Certificate& c) const {
    if (!have_no_contact(c)) return false;
    if (clearance_ > 0 && c.within < clearance_) return false;
    return nested(a_, b_, b_.pose) == Nested::apart;
  }
  bool shares_no_volume(const Certificate& c, const Pose& pose_b) const {
    // Far along the way the parts are apart, and on it no piece gets inside another without a contact.
    if (c.along) return true;
    if (have_no_contact(c)) return nested(a_, b_, pose_b) == Nested::apart;
    // Surfaces that are open share none if they do not cross.
    return !a_.object.is_closed() && !b_.object.is_closed() && c.relation == Relation::touching;
  }

  const std::string& folder_;
  assembly::MeshTrees& trees_;
  const AssemblyPart& a_;
  const AssemblyPart& b_;
  double clearance_;
  const AssemblyRule* rule_ = nullptr;
  RuleKind kind_ = RuleKind::nothing;
  bool first_in_second_ = false;
  bool second_in_first_ = false;
};

}  // namespace

const char* name_of(ReceiptState state) {
  switch (state) {
    case ReceiptState::proved:
      return "proved";
    case ReceiptState::violation:
      return "violation";
    case ReceiptState::unproved:
      return "unproved";
    case ReceiptState::missing:
      return "missing";
    case ReceiptState::stale:
      return "stale";
    case ReceiptState::refused:
      return "refused";
  }
  return "";
}

std::size_t ReceiptReport::count(ReceiptState state) const {
  return static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [state](const CheckedReceipt& pair) { return pair.state == state; }));
}

ReceiptReport verify_receipts(const Assembly& assembly, const std::string& folder, unsigned threads) {
  const RuleBook rules(assembly);
  std::map<std::pair<std::string, std::string>, Receipt> receipts;
  for (Receipt& receipt : assembly::read_receipt_index(folder)) {
    receipts[{receipt.a, receipt.b}] = std::move(receipt);
  }
  const assembly::PairsToProve to_prove = assembly::pairs_to_prove(assembly, rules);
  ReceiptReport report;
  report.by_boxes = to_prove.by_boxes;
  report.pairs.resize(to_prove.pairs.size());
  assembly::MeshTrees trees([&](const Mesh& mesh) {
    const std::string name = assembly::tree_file_name(hash_mesh(mesh));
    std::ifstream file(folder + "/" + name, std::ios::binary);
    if (!file) throw std::runtime_error(name + " cannot be read");
    return read_certificate_tree(mesh, file);
  });
  assembly::run_all(report.pairs.size(), threads, [&](std::size_t i) {
    CheckedReceipt& pair = report.pairs[i];
    std::tie(pair.a, pair.b) = to_prove.pairs[i];
    const std::string& name_a = assembly.parts[pair.a].name;
    const std::string& name_b = assembly.parts[pair.b].name;
    const auto found = receipts.find({name_a, name_b});
    Finding finding = {ReceiptState::missing, "there is no receipt"};
    if (found != receipts.end())
      finding = Verifier(assembly, rules, folder, trees, pair.a, pair.b).look_at(found->second);
    pair.state = finding.state;
    const bool is_sentence = pair.state == ReceiptState::proved || pair.state == ReceiptState::violation;
    pair.text = name_a + " and " + name_b + (is_sentence ? " " : ": ") + finding.text;
  });
  return report;
}

}  // namespace cchip
