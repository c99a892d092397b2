// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/assembly_receipts.hpp>
#include <cchip/certificate_file.hpp>
#include <cchip/certify.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/intersection.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "mesh_trees.hpp"
#include "parting_way.hpp"
#include "receipt_file.hpp"
#include "run_all.hpp"
#include "solid_points.hpp"

namespace cchip {
namespace {

namespace fs = std::filesystem;
using assembly::Receipt;
using assembly::RuleBook;
using RuleKind = AssemblyRule::Kind;

/// Points near which two parts may share volume, each with directions into them.
struct Candidate {
  Vec3d at;
  std::vector<Vec3d> directions;
};

Vec3d middle_of(const Mesh& mesh, const Pose& pose, std::size_t face) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) sum += pose * mesh.vertices[mesh.faces[face].vertex[i]];
  return sum / 3;
}

std::vector<Candidate> candidates(const AssemblyPart& a, const AssemblyPart& b) {
  constexpr std::size_t most = 24;  // of each kind
  std::vector<Candidate> found;
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  request.max_contacts = 1000;
  const CollisionQuery query = {&a.object, &a.pose, &b.object, &b.pose};
  const std::vector<Contact> contacts = collide(a.object, a.pose, b.object, b.pose, request).contacts;
  for (std::size_t i = 0; i < std::min(most, contacts.size()); ++i) {
    const Contact& contact = contacts[i * contacts.size() / std::min(most, contacts.size())];
    const Vec3d normal_a = face_normal(a.object, a.pose, contact.face_a);
    const Vec3d normal_b = face_normal(b.object, b.pose, contact.face_b);
    for (const Intersection& shared : intersections(query, contact)) {
      Vec3d middle = Vec3d::Zero();
      for (const Vec3d& point : shared.points) middle += point / static_cast<double>(shared.points.size());
      found.push_back({middle, {-normal_a - normal_b, normal_a + normal_b, normal_a - normal_b, normal_b - normal_a}});
    }
  }
  for (const AssemblyPart* part : {&a, &b}) {
    const Mesh& mesh = part->object.mesh();
    for (std::size_t i = 0; i < std::min(most, mesh.faces.size()); ++i) {
      const std::size_t face = i * mesh.faces.size() / std::min(most, mesh.faces.size());
      const Vec3d normal = face_normal(part->object, part->pose, mesh.number_in_file(static_cast<std::uint32_t>(face)));
      found.push_back({middle_of(mesh, part->pose, face), {-normal, normal}});
    }
  }
  return found;
}

/// A point inside both parts, if one is found.
std::optional<Vec3d> find_common_point(const AssemblyPart& a, const AssemblyPart& b) {
  const std::vector<Candidate> all = candidates(a, b);
  double size = 0;
  for (const Candidate& candidate : all) size = std::max(size, (candidate.at - all[0].at).norm());
  for (const double depth : {0x1p-6, 0x1p-12, 0x1p-20, 0x1p-30, 0x1p-40}) {
    for (const Candidate& candidate : all) {
      for (const Vec3d& direction : candidate.directions) {
        const Vec3d point = candidate.at + depth * size * direction;
        if (point.allFinite() && assembly::is_common_point(point, a, b)) return point;
      }
    }
  }
  return std::nullopt;
}

/// Makes the proof of a pair's verdict, as far as there is one.
class Prover {
 public:
  Prover(const Assembly& assembly, const RuleBook& rules, std::size_t a, std::size_t b, std::size_t most_normals,
         assembly::MeshTrees& trees)
      : a_(assembly.parts[a]),
        b_(assembly.parts[b]),
        clearance_(rules.clearance_of(a, b)),
        most_(most_normals),
        trees_{&trees.of(a_.object.mesh()), &trees.of(b_.object.mesh())},
        receipt(assembly::receipt_of(a_, b_)) {
    if (const auto number = rules.rule_of(a, b)) rule_ = &assembly.rules[*number];
  }

  void prove(const AssemblyPair& pair) {
    const RuleKind kind = rule_ != nullptr ? rule_->kind : RuleKind::nothing;
    const bool are_solids = a_.object.is_closed() && b_.object.is_closed();
    if (kind == RuleKind::inside || pair.verdict == PairVerdict::apart || pair.verdict == PairVerdict::too_near) {
      certificate = clearance_ > 0 ? certify_below(query(), clearance_, CollisionRequest::Contacts::first, trees_)
                                   : certify(query(), all_contacts(false), trees_);
    } else if (pair.verdict == PairVerdict::touching && pair.is_violation) {
      certificate = certify(query(), {}, trees_);
    } else if (!pair.is_violation && kind == RuleKind::overlap && pair.way) {
      prove_parted(*pair.way, are_solids);
    } else if (!pair.is_violation && pair.verdict == PairVerdict::touching) {
      prove_no_volume(are_solids);
    } else if (are_solids) {
      receipt.common_point = find_common_point(a_, b_);
    } else {
      certificate = certify(query(), all_contacts(true), trees_);
    }
  }

 private:
  static CollisionRequest all_contacts(bool relation) {
    CollisionRequest request;
    request.contacts = CollisionRequest::Contacts::all;
    request.relation = relation;
    return request;
  }
  CollisionQuery query() const { return {&a_.object, &a_.pose, &b_.object, &b_.pose}; }

  /// Of parts that touch: a translation clears them at once and for ever.
  void prove_no_volume(bool are_solids) {
    const std::vector<Vec3d> normals = assembly::normals_of_contacts(a_, b_);
    for (std::size_t i = 0; i < std::min(most_, normals.size()); ++i) {
      for (const double sign : {1.0, -1.0}) {
        certificate = certify_clear_along(query(), sign * normals[i], trees_);
        if (certificate) return;
      }
    }
    if (!are_solids) certificate = certify(query(), all_contacts(true), trees_);
  }
  /// The same where a translation has parted them.
  void prove_parted(const PartingWay& way, bool are_solids) {
    Pose moved = b_.pose;
    moved.translation() += way.depth * way.direction;
    receipt.translation = moved.translation();
    const CollisionQuery there = {&a_.object, &a_.pose, &b_.object, &moved};
    certificate = certify_clear_along(there, way.direction, trees_);
    if (!certificate) certificate = certify(there, all_contacts(!are_solids), trees_);
  }

  const AssemblyPart& a_;
  const AssemblyPart& b_;
  const AssemblyRule* rule_ = nullptr;
  double clearance_;
  std::size_t most_;
  CitedTrees trees_;

 public:
  Receipt receipt;
  std::optional<Certificate> certificate;
};

/// Makes the folder, or empties it of receipts.
void prepare(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder + ": cannot be made (" + error.message() + "); give another folder");
  if (fs::is_empty(folder)) return;
  if (!fs::exists(folder + "/" + assembly::receipt_index)) {
    throw std::runtime_error(folder + ": holds files, but no " + assembly::receipt_index +
                             "; give a new folder, or one with receipts to replace");
  }
  const std::vector<Receipt> old = assembly::read_receipt_index(folder);
  fs::remove(folder + "/" + assembly::receipt_index);
  for (const Receipt& receipt : old) {
    if (!receipt.file.empty()) fs::remove(folder + "/" + receipt.file);
    for (const std::uint64_t mesh : {receipt.mesh_a, receipt.mesh_b}) {
      fs::remove(folder + "/" + assembly::tree_file_name(mesh));
    }
  }
}

std::string file_name(std::size_t number) {
  constexpr std::size_t digits = 6;
  const std::string text = std::to_string(number);
  return std::string(digits - std::min(digits, text.size()), '0') + text + ".jsonl";
}

/// \param write takes the stream
template <class Write>
void write_file(const std::string& path, const Write& write) {
  std::ofstream file(path, std::ios::binary);
  write(file);
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written; check the disk and the rights of the folder");
}

}  // namespace

void write_receipts(const Assembly& assembly, const AssemblyReport& report, const std::string& folder,
                    const ReceiptOptions& options) {
  const RuleBook rules(assembly);
  prepare(folder);
  const assembly::PairsToProve to_prove = assembly::pairs_to_prove(assembly, rules);
  std::vector<Receipt> receipts(to_prove.pairs.size());
  assembly::MeshTrees trees(make_certificate_tree);
  std::map<std::uint64_t, const Mesh*> cited;  // by hashes
  std::mutex mutex;
  assembly::run_all(receipts.size(), options.threads, [&](std::size_t i) {
    AssemblyPair pair;
    std::tie(pair.a, pair.b) = to_prove.pairs[i];
    const auto found =
        std::lower_bound(report.pairs.begin(), report.pairs.end(), pair,
                         [](const auto& x, const auto& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
    if (found != report.pairs.end() && found->a == pair.a && found->b == pair.b) pair = *found;
    Prover prover(assembly, rules, pair.a, pair.b, options.most_normals, trees);
    prover.prove(pair);
    if (prover.certificate) {
      prover.receipt.file = file_name(i + 1);
      write_file(folder + "/" + prover.receipt.file,
                 [&](std::ostream& out) { write_certificate(*prover.certificate, out); });
      if (prover.certificate->version == 3) {
        const std::lock_guard<std::mutex> lock(mutex);
        for (const std::size_t part : {pair.a, pair.b}) {
          const Mesh& mesh = assembly.parts[part].object.mesh();
          cited.emplace(trees.of(mesh).hash(), &mesh);
        }
      }
    }
    receipts[i] = std::move(prover.receipt);
  });
  for (const auto& [hash, mesh] : cited) {
    write_file(folder + "/" + assembly::tree_file_name(hash),
               [&, mesh = mesh](std::ostream& out) { write_certificate_tree(trees.of(*mesh), out); });
  }
  assembly::write_receipt_index(folder, receipts);
}

}  // namespace cchip
