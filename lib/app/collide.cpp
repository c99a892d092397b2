// SPDX-License-Identifier: Apache-2.0
#include "collide.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cchip/certificate_file.hpp>
#include <cchip/certify.hpp>
#include <cchip/device.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/intersection.hpp>
#include <cchip/point_cloud.hpp>
#include <cchip/point_file.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/progress.hpp>
#include <cchip/program/usage_error.hpp>
#include <cchip/solids.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "check.hpp"
#include "hardware.hpp"
#include "html_view.hpp"
#include "mesh_source.hpp"
#include "pose.hpp"

namespace cchip::app {
namespace {

constexpr std::size_t batch = 1024;
constexpr std::size_t contacts_shown = 10;   // in a table
constexpr std::size_t curves_from = 100000;  // contacts of which a picture shows the curves

/// Totals of a run, the last line.
struct Totals {
  std::uint64_t queries = 0;
  std::uint64_t hits = 0;
  std::uint64_t mismatches = 0;
  std::uint64_t contacts = 0;
  std::uint64_t crossing = 0;  ///< queries whose objects cross, if that was asked for
  CollisionStats stats;
  std::uint64_t left_out = 0;            ///< faces that could not be used
  std::chrono::duration<double> time{};  ///< of the queries alone, without files

  void add(const CollisionResult& result, bool differs) {
    add(result);
    crossing += result.relation == Relation::crossing;
    mismatches += differs;
  }
  /// A result of any kind.
  template <class Result>
  void add(const Result& result) {
    ++queries;
    hits += result.hit;
    contacts += result.contacts.size();
    stats += result.stats;
  }
};

std::string to_line(const Totals& t, const CollideOptions& options) {
  const auto mean = [&t](std::uint64_t count) {
    return t.queries == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(t.queries);
  };
  std::string line = fmt::format("queries={} hits={}", t.queries, t.hits);
  if (!options.expect.empty()) line += fmt::format(" mismatches={}", t.mismatches);
  line += fmt::format(" contacts={} open={} steps_mean={:.1f} box_tests_mean={:.1f} pairs_mean={:.1f}", t.contacts,
                      t.stats.open, mean(t.stats.steps), mean(t.stats.box_tests), mean(t.stats.pairs));
  if (options.lenient) line += fmt::format(" left_out={}", t.left_out);
  if (options.device == "cpu") return line;
  return line + fmt::format(" fallbacks={} swaps={} swap_clocks={} clocks_mean={:.1f}", t.stats.fallbacks,
                            t.stats.swaps, t.stats.swap_clocks, mean(t.stats.clocks));
}

std::string counted(std::uint64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// The same for people. \param with_time times differ from run to run
std::string to_sentence(const Totals& t, const CollideOptions& options, bool with_time) {
  std::string line = counted(t.queries, "query", "queries") + ", " + counted(t.contacts, "contact", "contacts");
  if (!options.expect.empty()) {
    line += fmt::format(", {} differ{} from column {}", t.mismatches, t.mismatches == 1 ? "s" : "", options.expect);
  }
  if (t.left_out > 0) line += ", " + counted(t.left_out, "face", "faces") + " left out";
  if (t.stats.clocks > 0) line += ", " + counted(t.stats.clocks, "clock", "clocks");
  if (t.stats.swaps > 0) line += ", " + counted(t.stats.swaps, "swap", "swaps");
  if (t.stats.fallbacks > 0) line += ", " + counted(t.stats.fallbacks, "query", "queries") + " left to the CPU";
  if (with_time) {
    const double seconds = t.time.count();
    line += seconds < 1 ? fmt::format(", {:.3g} ms", 1000 * seconds) : fmt::format(", {:.3g} s", seconds);
  }
  return line;
}

/// stdout stays machine-readable: the summary of CSV and JSON lines goes to stderr.
int report(const Totals& totals, const CollideOptions& options, const Streams& streams) {
  if (options.format == Format::table) {
    streams.out << to_sentence(totals, options, streams.person) << '\n';
  } else {
    streams.err << to_line(totals, options) << '\n';
  }
  if (totals.mismatches > 0) return exit_mismatch;
  if (options.exit_code && totals.hits > 0) return exit_contact;
  return totals.left_out > 0 ? exit_left_out : exit_ok;
}

std::unique_ptr<Device> open_named_device(const CollideOptions& options) {
  const auto needs_sim = [&options](bool is_set, const char* option, const char* what) {
    if (!is_set || options.device == "sim") return;
    throw UsageError(std::string(option) + ": device " + options.device + " has no " + what +
                     "; add --device sim, or leave " + option + " out");
  };
  needs_sim(!options.trace.empty(), "--trace", "waveform");
  needs_sim(options.slots != 0, "--slots", "slots");
  needs_sim(options.chips != 1, "--chips", "chips");
  if (options.device == "sim" && options.hardware != nullptr) {
    ChipOptions chip;
    chip.trace_path = options.trace;
    chip.slots = static_cast<unsigned>(options.slots);
    chip.chips = static_cast<unsigned>(options.chips);
    return options.hardware->open_chip(chip);
  }
  try {
    return open_device(options.device);
  } catch (const std::invalid_argument& error) {
    const bool is_missing = options.hardware == nullptr && is_hardware_device(options.device);
    throw UsageError(is_missing ? "--device " + options.device + ": " + without_hardware
                                : std::string("--device: ") + error.what());
  }
}

/// How many contacts a query finds.
/// \param request a CollisionRequest or a CloudRequest
template <class Request>
void set_contacts(const CollideOptions& options, Request& request) {
  using Contacts = CollisionRequest::Contacts;
  request.contacts = options.contacts.value_or(options.poses_file.empty() ? Contacts::all : Contacts::first);
  if (request.contacts == Contacts::first && options.max_contacts != 0) {
    throw UsageError("--most: each query stops at its first contact; add --contacts all, or leave --most out");
  }
  if (options.max_contacts != 0) request.max_contacts = options.max_contacts;
}

CollisionRequest request_of(const CollideOptions& options) {
  CollisionRequest request;
  set_contacts(options, request);
  const bool all = request.contacts == CollisionRequest::Contacts::all;
  if (options.only_crossing) request.least = Relation::crossing;
  if (!options.within.empty()) {
    const std::optional<double> distance = read_decimal(options.within);
    if (!distance || !(*distance >= 0 && *distance <= std::numeric_limits<double>::max())) {
      throw UsageError("--within: '" + options.within + "' is not a distance; give a number that is at least 0");
    }
    if (options.relation || options.only_crossing) {
      throw UsageError("--within: faces at a distance neither touch nor cross; leave out --relation and --counts");
    }
    request.within = *distance;
  }
  request.relation = options.relation || (all && options.poses_file.empty() && options.within.empty());
  return request;
}

/// Faces of a mesh whose number in the file is in the set.
template <class Take>
void for_each_face_of(const Mesh& mesh, const std::set<std::uint32_t>& in_file, const Take& take) {
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const std::uint32_t number = mesh.number_in_file(static_cast<std::uint32_t>(i));
    if (in_file.count(number) != 0) take(i);
  }
}

bool crosses(const Contact& contact) { return contact.relation == Relation::crossing; }

/// Faces of each object that are in contact with the other one.
struct FacesHit {
  void add(const Contact& contact) {
    a.insert(contact.face_a);
    b.insert(contact.face_b);
  }
  std::set<std::uint32_t> a;
  std::set<std::uint32_t> b;
};

/// Of a contact or of two objects, in a row of a table.
std::string to_word(const std::optional<Relation>& relation) {
  if (!relation) return "";
  return *relation == Relation::apart ? "apart" : *relation == Relation::touching ? "touching" : "crossing";
}

/// The file of the proofs, a certificate for each query.
class ProofFile {
 public:
  explicit ProofFile(const CollideOptions& options) : options_(options), file_(options.certificate) {}
  /// Reads the trees, if there are any.
  void prepare(const Object& a, const Object& b) {
    if (!options_.tree_a.empty())
      trees_.emplace(read_tree(options_.tree_a, a.mesh()), read_tree(options_.tree_b, b.mesh()));
  }
  void add(const Object& a, const Object& b, const Pose& pose, const CollisionRequest& request,
           const CollisionResult& result) {
    const Pose pose_a = Pose::Identity();
    const CitedTrees trees = trees_ ? CitedTrees{&trees_->first, &trees_->second} : CitedTrees{};
    write_certificate(certify({&a, &pose_a, &b, &pose}, request, result, trees), file_.stream());
  }
  void commit() { file_.commit(); }

 private:
  const CollideOptions& options_;
  sim::OutputFile file_;
  std::optional<std::pair<CertificateTree, CertificateTree>> trees_;
};

/// The answer in words.
std::string to_words(const CollisionResult& result, const CollisionRequest& request, const std::string& within) {
  if (!result.hit && !within.empty()) return "apart by more than " + within;
  if (!result.hit) return result.relation == Relation::touching ? "touch: no faces cross" : "apart";
  const char* touch = std::any_of(result.contacts.begin(), result.contacts.end(), crosses) ? "cross" : "touch";
  const std::string verb = within.empty() ? touch : "within " + within;
  if (request.contacts == CollisionRequest::Contacts::first) {
    return fmt::format("{}: face {} of A {} face {} of B", verb, result.contacts[0].face_a,
                       within.empty() ? "meets" : "and", result.contacts[0].face_b);
  }
  FacesHit hit;
  for (const Contact& contact : result.contacts) hit.add(contact);
  const bool more = result.contacts.size() == request.max_contacts;
  if (!within.empty()) {
    return fmt::format("{}: {}{} face{} of A and {} of B", verb, more ? "at least " : "", hit.a.size(),
                       hit.a.size() == 1 ? "" : "s", hit.b.size());
  }
  return fmt::format("{}: {}{} face{} of A meet{} {} of B", verb, more ? "at least " : "", hit.a.size(),
                     hit.a.size() == 1 ? "" : "s", hit.a.size() == 1 ? "s" : "", hit.b.size());
}

/// The answer in words for a terminal: red, yellow or green.
std::string coloured(const std::string& answer) {
  const char* const colour = answer.rfind("cross", 0) == 0 ? "31" : answer.rfind("apart", 0) == 0 ? "32" : "33";
  return fmt::format("\x1b[1;{}m{}\x1b[0m", colour, answer);
}

/// Adds the time that a function takes to `time`.
template <class Function>
auto timed(std::chrono::duration<double>& time, const Function& function) {
  const auto start = std::chrono::steady_clock::now();
  auto result = function();
  time += std::chrono::steady_clock::now() - start;
  return result;
}

/// A row for each contact, made as it is written; a table shows the first ones only. \param what the contacts are
/// called
template <class Contacts, class MakeRow>
void write_rows(const std::vector<std::string>& names, const Contacts& contacts, const MakeRow& make_row,
                const char* what, Format format, std::ostream& out) {
  if (contacts.empty() && format == Format::table) return;
  const auto writer = make_row_writer(format, out, names);
  const std::size_t shown = format == Format::table ? std::min(contacts.size(), contacts_shown) : contacts.size();
  for (std::size_t i = 0; i < shown; ++i) writer->write(make_row(contacts[i]));
  writer->flush();
  if (shown < contacts.size()) {
    out << fmt::format("... and {} more {}; --format csv lists all\n", contacts.size() - shown, what);
  }
}

/// \param relation with a column for it
void write_contacts(const std::vector<Contact>& contacts, bool relation, Format format, std::ostream& out) {
  std::vector<std::string> names = mesh_pair_names();
  if (relation) names.emplace_back("relation");
  const auto row = [relation](const Contact& contact) {
    std::vector<Cell> cells = {std::uint64_t{contact.face_a}, std::uint64_t{contact.face_b}};
    if (relation) cells.emplace_back(to_word(contact.relation));
    return cells;
  };
  write_rows(names, contacts, row, "pairs of faces", format, out);
}

/// In JSON lines an answer without contacts is a line, too.
void write_no_contact(const CollisionResult& result, const CollisionRequest& request, std::ostream& out) {
  std::vector<std::string> names = {"hit"};
  std::vector<Cell> cells = {std::uint64_t{0}};
  if (request.tells_relation()) {
    names.emplace_back("relation");
    cells.emplace_back(to_word(result.relation));
  }
  const auto writer = make_row_writer(Format::jsonl, out, names);
  writer->write(cells);
  writer->flush();
}

int answer_one(const CollideOptions& options, Device& device, const Streams& streams) {
  std::optional<HitPicture> picture;
  if (!options.ply.empty()) picture.emplace(options.ply);
  std::optional<HtmlView> view;
  if (!options.html.empty()) view.emplace(options.html);
  std::optional<ProofFile> proofs;
  if (!options.certificate.empty()) proofs.emplace(options);
  const Pose pose = parse_pose_options(options.pose, options.pose_matrix);
  const CollisionRequest request = request_of(options);
  try {
    check_query(Pose::Identity(), pose, request);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  MeshReader reader(streams, options.lenient, options.single);
  const Object a = reader.read_object(options.file_a);
  const Object b = reader.read_object(options.file_b);
  if (proofs) proofs->prepare(a, b);
  Totals totals;
  const CollisionResult result =
      timed(totals.time, [&] { return collide(device, a, Pose::Identity(), b, pose, request); });
  if (proofs) {
    proofs->add(a, b, pose, request, result);
    proofs->commit();
  }
  if (options.format == Format::table) {
    const std::string answer = to_words(result, request, options.within);
    streams.out << (streams.colour ? coloured(answer) : answer) << '\n';
  }
  if (options.format != Format::table || request.contacts == CollisionRequest::Contacts::all) {
    write_contacts(result.contacts, request.tells_relation(), options.format, streams.out);
  }
  if (options.format == Format::jsonl && !result.hit) write_no_contact(result, request, streams.out);
  std::vector<IntersectionCurve> curves;
  if (picture || view) {
    const Pose here = Pose::Identity();
    if (result.contacts.size() <= curves_from) {
      curves = intersection_curves({&a, &here, &b, &pose}, result.contacts);
    } else {
      streams.err << fmt::format("{} pairs of faces: the picture shows no curves of more than {}\n",
                                 result.contacts.size(), curves_from);
    }
  }
  if (picture) {
    // Without relations every contact counts as one that crosses.
    std::array<FacesHit, 2> hit;
    for (const Contact& contact : result.contacts)
      hit[crosses(contact) || !request.tells_relation() ? 1 : 0].add(contact);
    for (const bool cross : {false, true}) {
      for_each_face_of(a.mesh(), hit[cross].a, [&](std::size_t face) { picture->add_hit_a(face, cross); });
      for_each_face_of(b.mesh(), hit[cross].b, [&](std::size_t face) { picture->add_hit_b(face, cross); });
    }
    for (const IntersectionCurve& curve : curves) picture->add_curve(curve.points, curve.closed);
    picture->write(a.mesh(), transformed(b.mesh(), pose));
  }
  if (view) {
    view->write(a.mesh(), transformed(b.mesh(), pose), to_words(result, request, options.within), result.contacts,
                curves);
  }
  totals.add(result, false);
  totals.left_out = reader.faces_left_out();
  return report(totals, options, streams);
}

/// Says that shells of a mesh overlap. \returns whether the answer is in doubt for it
bool note_shells(const CollideOptions& options, const char* name, const std::string& file,
                 const std::optional<Contact>& overlap, const Streams& streams) {
  if (!overlap) return false;
  const bool odd = options.inside == InsideRule::odd;
  streams.err
      << file << ": faces " << overlap->face_a << " and " << overlap->face_b << " of " << name
      << (overlap->relation == Relation::crossing ? " cross" : " lie on each other")
      << ": its shells overlap, are there twice or have a wall in common. Space that two of them share counts as "
      << (odd ? "outside; --inside nonzero counts it as inside\n" : "inside\n");
  return odd;
}

/// How the two solids lie to each other, in a line.
int answer_solids(const CollideOptions& options, Device& device, const Streams& streams) {
  const Pose pose = parse_pose_options(options.pose, options.pose_matrix);
  MeshReader reader(streams, options.lenient, options.single);
  const Object a = reader.read_object(options.file_a);
  const Object b = reader.read_object(options.file_b);
  SolidResult relation;
  try {
    relation = solids(device, a, Pose::Identity(), b, pose, {options.inside});
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  if (options.format == Format::table) {
    streams.out << name_of(relation) << '\n';
  } else {
    const auto writer = make_row_writer(options.format, streams.out, {"solids"});
    writer->write({std::string(name_of(relation))});
    writer->flush();
  }
  const bool in_doubt = note_shells(options, "A", options.file_a, relation.overlap_a, streams) |
                        note_shells(options, "B", options.file_b, relation.overlap_b, streams);
  if (options.exit_code && relation != SolidRelation::disjoint) return exit_contact;
  return reader.faces_left_out() > 0 || in_doubt ? exit_left_out : exit_ok;
}

PointCloud load_cloud(const CollideOptions& options, const Streams& streams) {
  const std::optional<double> radius = options.radius.empty() ? 0 : read_decimal(options.radius);
  if (!radius || !(*radius >= 0 && *radius <= std::numeric_limits<double>::max())) {
    throw UsageError("--radius: '" + options.radius + "' is not a radius; give a number that is at least 0");
  }
  std::size_t left_out = 0;
  LoadPointsOptions load;
  load.points_left_out = &left_out;
  load.single_precision = options.single;
  std::vector<Vec3d> points;
  try {
    points = options.file_a == "-" ? parse_points(read_all(streams.in), "-", load) : load_points(options.file_a, load);
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
  if (left_out > 0) {
    streams.err << fmt::format("cchip: {}: {} without finite coordinates left out; the others are numbered from 0\n",
                               options.file_a, counted(left_out, "point", "points"));
  }
  try {
    return PointCloud(points, *radius);
  } catch (const std::invalid_argument& error) {
    throw UsageError(options.file_a + ": " + error.what());
  }
}

/// The answer about a point cloud in words.
std::string to_words(const CloudResult& result, const CloudRequest& request) {
  if (!result.hit) return "apart";
  if (request.contacts == CollisionRequest::Contacts::first) {
    return fmt::format("touch: point {} of A meets face {} of B", result.contacts[0].point, result.contacts[0].face);
  }
  std::set<std::uint32_t> points;
  std::set<std::uint32_t> faces;
  for (const CloudContact& contact : result.contacts) {
    points.insert(contact.point);
    faces.insert(contact.face);
  }
  return fmt::format(
      "touch: {}{} of A meet{} {} of B", result.contacts.size() == request.max_contacts ? "at least " : "",
      counted(points.size(), "point", "points"), points.size() == 1 ? "s" : "", counted(faces.size(), "face", "faces"));
}

/// Which points of A meet which faces of B.
int answer_points(const CollideOptions& options, const Streams& streams) {
  if (options.device != "cpu") {
    throw UsageError("--points: device " + options.device + " knows faces only; leave --device out");
  }
  const Pose pose = parse_pose_options(options.pose, options.pose_matrix);
  CloudRequest request;
  set_contacts(options, request);
  const PointCloud cloud = load_cloud(options, streams);
  MeshReader reader(streams, options.lenient, options.single);
  const Object b = reader.read_object(options.file_b);
  Totals totals;
  CloudResult result;
  try {
    result = timed(totals.time, [&] { return collide(cloud, Pose::Identity(), b, pose, request); });
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  const bool table = options.format == Format::table;
  if (table) {
    const std::string answer = to_words(result, request);
    streams.out << (streams.colour ? coloured(answer) : answer) << '\n';
  }
  if (!table || request.contacts == CollisionRequest::Contacts::all) {
    const auto row = [](const CloudContact& contact) {
      return std::vector<Cell>{std::uint64_t{contact.point}, std::uint64_t{contact.face}};
    };
    write_rows({"point", "face"}, result.contacts, row, "contacts", options.format, streams.out);
  }
  if (options.format == Format::jsonl && !result.hit) write_no_contact({}, {}, streams.out);
  totals.add(result);
  totals.left_out = reader.faces_left_out();
  return report(totals, options, streams);
}

/// Answers the poses of a file, a batch at a time, and writes a row for each.
class PosesRunner {
 public:
  PosesRunner(const CollideOptions& options, Device& device, const Streams& streams)
      : options_(options), device_(device), streams_(streams), request_(request_of(options)) {
    if (!options.certificate.empty()) proofs_.emplace(options);
  }

  Totals run() {
    if (options_.poses_file == "-") return run(streams_.in);
    std::ifstream in(options_.poses_file, std::ios::binary);
    if (!in || std::filesystem::is_directory(options_.poses_file)) {
      throw UsageError(fmt::format("{}: the file cannot be read ({}); check its name and permissions",
                                   options_.poses_file, in ? "is a directory" : std::strerror(errno)));
    }
    return run(in);
  }

 private:
  Totals run(std::istream& in) {
    CsvReader reader(in, options_.poses_file);
    CsvRow row;
    if (!reader.next(row)) {
      throw row_error(options_.poses_file, 1,
                      "the file is empty; write a first row with the column names r00 to r22, tx, ty, tz");
    }
    const PoseColumns columns(row, options_.poses_file, options_.expect);
    MeshReader meshes(streams_, options_.lenient, options_.single);
    const Object a = meshes.read_object(options_.file_a);
    const Object b = meshes.read_object(options_.file_b);
    totals_.left_out = meshes.faces_left_out();
    if (proofs_) proofs_->prepare(a, b);
    writer_ = make_row_writer(options_.format, streams_.out, names_behind(columns.passed_names(), names()));
    Progress progress(streams_.err, streams_.progress, "poses");
    std::error_code no_size;  // of a pipe
    const auto size = std::filesystem::file_size(options_.poses_file, no_size);
    while (reader.next(row)) {
      add(row, columns);
      if (rows_.size() < batch) continue;
      progress.clear();
      answer(a, b);
      progress.update(totals_.queries,
                      no_size ? -1.0 : static_cast<double>(reader.bytes_read()) / static_cast<double>(size));
    }
    progress.clear();
    answer(a, b);
    if (proofs_) proofs_->commit();
    if (options_.format == Format::table) {
      if (!options_.within.empty()) {
        streams_.out << fmt::format("within {} in {} of {} poses\n", options_.within, totals_.hits, totals_.queries);
      } else if (options_.only_crossing) {
        streams_.out << fmt::format("cross in {} of {} poses\n", totals_.hits, totals_.queries);
      } else {
        streams_.out << fmt::format("touch in {} of {} poses", totals_.hits, totals_.queries)
                     << (request_.tells_relation() ? fmt::format(", cross in {} of these\n", totals_.crossing) : "\n");
      }
    }
    return totals_;
  }

  bool table_of_differences() const { return options_.format == Format::table && !options_.expect.empty(); }

  std::vector<std::string> names() const {
    std::vector<std::string> names = {"hit", "contacts", "steps", "box_tests", "pairs", "open"};
    if (request_.tells_relation()) names.emplace_back("relation");
    if (table_of_differences()) names.insert(names.begin(), {"row", "expected"});
    return names;
  }

  void add(const CsvRow& row, const PoseColumns& columns) {
    rows_.push_back(columns.parse(row));
    lines_.push_back(row.line);
    poses_.push_back({Pose::Identity(), rows_.back().pose});
    try {
      check_query(poses_.back().a, poses_.back().b, request_);
    } catch (const std::invalid_argument& error) {
      throw row_error(options_.poses_file, row.line, error.what());
    }
  }

  void answer(const Object& a, const Object& b) {
    const std::vector<CollisionResult> results =
        timed(totals_.time, [&] { return collide(device_, a, b, poses_, request_); });
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (proofs_) proofs_->add(a, b, poses_[i].b, request_, results[i]);
      write(i, results[i]);
    }
    writer_->flush();
    rows_.clear();
    lines_.clear();
    poses_.clear();
  }

  void write(std::size_t i, const CollisionResult& result) {
    const PoseColumns::Row& row = rows_[i];
    const bool all = request_.contacts == CollisionRequest::Contacts::all;
    const std::uint64_t answer = all ? result.contacts.size() : std::uint64_t{result.hit};
    const bool differs = row.expected && *row.expected != answer;
    totals_.add(result, differs);
    if (table_of_differences() && !differs) return;
    if (differs && !table_of_differences()) {
      streams_.err << fmt::format("cchip: {}:{}: expected {} {}, got {}\n", options_.poses_file, lines_[i],
                                  all ? "contacts" : "hit", *row.expected, answer);
    }
    std::vector<Cell> cells(row.passed.begin(), row.passed.end());
    if (table_of_differences()) {
      cells.emplace_back(lines_[i]);
      cells.emplace_back(*row.expected);
    }
    const CollisionStats& counts = result.stats;
    for (const std::uint64_t number : {std::uint64_t{result.hit}, std::uint64_t{result.contacts.size()}, counts.steps,
                                       counts.box_tests, counts.pairs, counts.open}) {
      cells.emplace_back(number);
    }
    if (request_.tells_relation()) cells.emplace_back(to_word(result.relation));
    writer_->write(cells);
  }

  const CollideOptions& options_;
  Device& device_;
  const Streams& streams_;
  CollisionRequest request_;
  std::optional<ProofFile> proofs_;
  std::unique_ptr<RowWriter> writer_;
  std::vector<PoseColumns::Row> rows_;
  std::vector<std::uint64_t> lines_;
  std::vector<PosePair> poses_;
  Totals totals_;
};

}  // namespace

int run_collide(const CollideOptions& options, const Streams& streams) {
  sim::check_outputs({{"A", options.file_a}, {"B", options.file_b}, {"--poses", options.poses_file}},
                     {{"--ply", options.ply},
                      {"--html", options.html},
                      {"--certificate", options.certificate},
                      {"--trace", options.trace}});
  check_picture_name(options.ply);
  check_view_name(options.html);
  check_standard_input({options.file_a, options.file_b, options.poses_file});
  if (options.poses_file.empty() && !options.expect.empty()) {
    throw UsageError("--expect: there is no file of poses; name one with --poses");
  }
  const auto device = open_named_device(options);
  if (options.points) return answer_points(options, streams);
  if (options.solids) return answer_solids(options, *device, streams);
  if (options.poses_file.empty()) return answer_one(options, *device, streams);
  return report(PosesRunner(options, *device, streams).run(), options, streams);
}

}  // namespace cchip::app
