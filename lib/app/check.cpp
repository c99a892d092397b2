// SPDX-License-Identifier: Apache-2.0
#include "check.hpp"

#include <fmt/format.h>

#include <cchip/certificate_file.hpp>
#include <cchip/certify.hpp>
#include <cchip/check.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/usage_error.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "mesh_source.hpp"
#include "pose.hpp"

namespace cchip::app {
namespace {

/// A file of the command line, or standard input.
class Input {
 public:
  Input(const std::string& path, const Streams& streams) : standard_(path == "-" ? &streams.in : nullptr) {
    if (standard_ != nullptr) return;
    file_.open(path, std::ios::binary);
    if (file_ && !std::filesystem::is_directory(path)) return;
    throw UsageError(fmt::format("{}: the file cannot be read ({}); check its name and permissions", path,
                                 file_ ? "is a directory" : std::strerror(errno)));
  }
  std::istream& stream() { return standard_ != nullptr ? *standard_ : file_; }

 private:
  std::istream* standard_;
  std::ifstream file_;
};

/// What a certificate claims, in words.
std::string claim_in_words(const Certificate& c) {
  std::string words;
  if (!c.all) {
    words = fmt::format("face {} of A {} face {} of B", c.contacts[0].face_a, c.within > 0 ? "is near" : "meets",
                        c.contacts[0].face_b);
  } else if (c.contacts.empty()) {
    words = "no contacts";
  } else {
    words = fmt::format("{} contact{} and no others", c.contacts.size(), c.contacts.size() == 1 ? "" : "s");
  }
  if (c.within > 0) words += fmt::format(", {} {}", c.below ? "nearer than" : "within", c.within);
  if (c.relation) {
    words += *c.relation == Relation::apart      ? ", apart"
             : *c.relation == Relation::touching ? ", touching"
                                                 : ", crossing";
  }
  return words;
}

class Checking {
 public:
  Checking(const CheckOptions& options, const Streams& streams)
      : options_(options), streams_(streams), input_(options.certificates, streams), reader_(input_.stream()) {}

  int run() {
    if (options_.poses_file.empty()) {
      const Pose pose = parse_pose_options(options_.pose, options_.pose_matrix);
      read_meshes();
      check_next(pose);
    } else {
      check_poses();
    }
    if (next()) throw wrong_number("more");
    streams_.out << fmt::format("certificates={} accepted={} refused={}\n", checked_, checked_ - refused_, refused_);
    return refused_ != 0 ? exit_refused : left_out_ != 0 ? exit_left_out : exit_ok;
  }

 private:
  void read_meshes() {
    MeshReader reader(streams_, options_.lenient, options_.single);
    a_ = reader.read(options_.file_a);
    b_ = reader.read(options_.file_b);
    left_out_ = reader.faces_left_out();
    if (options_.tree_a.empty()) return;
    trees_.emplace(read_tree(options_.tree_a, a_), read_tree(options_.tree_b, b_));
  }
  void check_poses() {
    Input poses(options_.poses_file, streams_);
    CsvReader csv(poses.stream(), options_.poses_file);
    CsvRow row;
    if (!csv.next(row)) {
      throw row_error(options_.poses_file, 1,
                      "the file is empty; write a first row with the column names r00 to r22, tx, ty, tz");
    }
    const PoseColumns columns(row, options_.poses_file, "");
    read_meshes();
    while (csv.next(row)) check_next(columns.parse(row).pose);
  }

  std::optional<Certificate> next() {
    try {
      return reader_.next();
    } catch (const std::runtime_error& error) {
      throw UsageError(options_.certificates + ": " + error.what() +
                       "; give a file that cchip collide --certificate has written");
    }
  }
  UsageError wrong_number(const char* which) const {
    return UsageError(
        fmt::format("{}: it holds {} certificates than there are poses, {}; give the poses and the file "
                    "of one run of cchip collide",
                    options_.certificates, which, checked_));
  }

  void check_next(const Pose& pose) {
    const std::optional<Certificate> certificate = next();
    if (!certificate) throw wrong_number("fewer");
    const CertificateVerdict verdict =
        trees_ ? check_certificate(trees_->first, Pose::Identity(), trees_->second, pose, *certificate)
               : check_certificate(a_, Pose::Identity(), b_, pose, *certificate);
    ++checked_;
    if (!options_.poses_file.empty()) streams_.out << "certificate " << checked_ << ' ';
    if (verdict.accepted) {
      streams_.out << "accepted: " << claim_in_words(*certificate) << '\n';
      return;
    }
    ++refused_;
    const bool of_claim = verdict.cell == certificate->cells.size();
    streams_.out << "refused: " << (of_claim ? "claim" : fmt::format("cell {}", verdict.cell)) << ": " << verdict.reason
                 << '\n';
  }

  const CheckOptions& options_;
  const Streams& streams_;
  Input input_;
  CertificateReader reader_;
  Mesh a_;
  Mesh b_;
  std::optional<std::pair<CertificateTree, CertificateTree>> trees_;
  std::uint64_t left_out_ = 0;
  std::uint64_t checked_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace

int run_check(const CheckOptions& options, const Streams& streams) {
  check_standard_input({options.file_a, options.file_b, options.certificates, options.poses_file});
  return Checking(options, streams).run();
}

int run_tree(const TreeOptions& options, const Streams& streams) {
  sim::check_outputs({{"MESH", options.mesh}}, {{"FILE", options.file}});
  sim::OutputFile file(options.file);
  MeshReader reader(streams, options.lenient, options.single);
  const Mesh mesh = reader.read(options.mesh);
  write_certificate_tree(make_certificate_tree(mesh), file.stream());
  file.commit();
  return reader.faces_left_out() != 0 ? exit_left_out : exit_ok;
}

CertificateTree read_tree(const std::string& path, const Mesh& mesh) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw UsageError(fmt::format("{}: the file cannot be read ({}); check its name and permissions", path,
                                 file ? "is a directory" : std::strerror(errno)));
  }
  try {
    return read_certificate_tree(mesh, file);
  } catch (const std::runtime_error& error) {
    throw UsageError(path + ": " + error.what() + "; make it of this mesh with cchip tree");
  }
}

}  // namespace cchip::app
