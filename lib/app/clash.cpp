// SPDX-License-Identifier: Apache-2.0
#include "clash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cchip/assembly_motion.hpp>
#include <cchip/assembly_receipts.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/html_page.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/intersection.hpp>
#include <cchip/program/csv_reader.hpp>
#include <cchip/program/output_file.hpp>
#include <cchip/program/usage_error.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "html_view.hpp"
#include "motion.hpp"

namespace cchip::app {
namespace {

using Json = nlohmann::ordered_json;

std::map<std::string, double> parse_joints(std::string_view text) {
  std::map<std::string, double> values;
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), item.size() + 1));
    const std::size_t equals = item.rfind('=');
    if (equals == std::string_view::npos || equals == 0) {
      throw UsageError(fmt::format("--joints: got '{}'; write name=value, with commas between them", item));
    }
    try {
      const std::string name(trimmed_field(item.substr(0, equals)));
      if (values.emplace(name, parse_coordinate(item.substr(equals + 1))).second) continue;
      throw UsageError(fmt::format("--joints: joint '{}' is there twice; remove one of them", name));
    } catch (const std::invalid_argument& error) {
      throw UsageError(fmt::format("--joints: '{}': {}", item, error.what()));
    }
  }
  return values;
}

Assembly read_assembly(const ClashOptions& options) {
  AssemblyLoadOptions load;
  load.unit = options.unit;
  load.rules = options.rules;
  load.lenient = options.lenient;
  load.joints = parse_joints(options.joints);
  load.packages = options.packages;
  load.srdf = options.srdf;
  load.neighbours = options.neighbours;
  std::optional<double> clearance;
  if (!options.clearance.empty()) {
    clearance = read_decimal(options.clearance);
    if (!clearance || !std::isfinite(*clearance) || *clearance < 0) {
      throw UsageError(fmt::format("--clearance: got '{}'; write a length in units of the assembly that is at least 0",
                                   options.clearance));
    }
  }
  try {
    Assembly assembly = load_assembly(options.assembly, load);
    if (clearance) assembly.clearance = *clearance;
    return assembly;
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
}

AssemblyReport judge(const Assembly& assembly, const ClashOptions& options) {
  AssemblyCheckOptions check_options;
  check_options.threads = options.threads;
  try {
    return check(assembly, check_options);
  } catch (const std::invalid_argument& error) {
    throw UsageError(options.assembly + ": " + error.what());
  }
}

std::string size_text(const Assembly& assembly, const AssemblyReport& report) {
  return fmt::format("size {} x {} x {} {}", report.size[0], report.size[1], report.size[2],
                     assembly.unit.empty() ? "(no unit given)" : assembly.unit);
}

std::string summary(const Assembly& assembly, const AssemblyReport& report) {
  return fmt::format("parts={} pairs={} violations={} accepted={} unused_rules={}", assembly.parts.size(),
                     report.judged, report.violations, report.accepted, report.unused_rules.size());
}

bool has_reason(const Assembly& assembly, const AssemblyPair& pair) {
  return pair.rule && assembly.rules[*pair.rule].kind == AssemblyRule::Kind::anything;
}

void write_table(const Assembly& assembly, const AssemblyReport& report, std::ostream& out) {
  out << size_text(assembly, report) << '\n';
  for (const AssemblyPair& pair : report.pairs) {
    if (pair.is_violation) out << "violation: " << sentence(assembly, pair) << '\n';
  }
  for (const AssemblyPair& pair : report.pairs) {
    if (!pair.is_judged) out << "not judged: " << sentence(assembly, pair) << '\n';
    if (has_reason(assembly, pair)) out << "allowed: " << sentence(assembly, pair) << '\n';
  }
  out << left_out_line(assembly);
  for (const std::size_t rule : report.unused_rules) out << "unused rule: " << why_unused(assembly, rule) << '\n';
}

Json to_json(const Vec3d& p) { return Json::array({p.x(), p.y(), p.z()}); }

Json to_json(const Assembly& assembly, const AssemblyPair& pair) {
  Json object = {{"a", assembly.parts[pair.a].name},
                 {"b", assembly.parts[pair.b].name},
                 {"verdict", name_of(pair.verdict)},
                 {"violation", pair.is_violation},
                 {"judged", pair.is_judged},
                 {"rule", nullptr},
                 {"depth", nullptr},
                 {"direction", nullptr},
                 {"distance", nullptr},
                 {"nearest", nullptr},
                 {"text", sentence(assembly, pair)}};
  if (pair.rule) object["rule"] = assembly.rules[*pair.rule].place;
  if (pair.way) {
    object["depth"] = pair.way->depth;
    object["direction"] = to_json(pair.way->direction);
  }
  if (pair.verdict == PairVerdict::too_near) {
    object["distance"] = {pair.distance_lower, pair.distance_upper};
    object["nearest"] = {to_json(pair.nearest[0]), to_json(pair.nearest[1])};
  }
  return object;
}

std::string json_text(const Assembly& assembly, const AssemblyReport& report) {
  Json parts = Json::array();
  for (const AssemblyPart& part : assembly.parts) {
    parts.push_back({{"name", part.name}, {"file", part.file}, {"groups", part.groups}});
  }
  Json pairs = Json::array();
  for (const AssemblyPair& pair : report.pairs) pairs.push_back(to_json(assembly, pair));
  Json left_out = Json::array();
  for (const auto& [a, b] : assembly.left_out) {
    left_out.push_back(Json::array({assembly.parts[a].name, assembly.parts[b].name}));
  }
  Json unused = Json::array();
  for (const std::size_t rule : report.unused_rules) unused.push_back(why_unused(assembly, rule));
  const Json object = {{"unit", assembly.unit.empty() ? Json() : Json(assembly.unit)},
                       {"size", report.size},
                       {"judged", report.judged},
                       {"violations", report.violations},
                       {"accepted", report.accepted},
                       {"not_judged", report.not_judged},
                       {"faces_left_out", assembly.faces_left_out},
                       {"parts", parts},
                       {"pairs", pairs},
                       {"left_out", left_out},
                       {"unused_rules", unused},
                       {"notes", report.notes}};
  return object.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// A test case for each pair that meets or is too near, and one for the assembly, so that it is never empty.
std::string junit_text(const Assembly& assembly, const AssemblyReport& report, const std::string& path) {
  const std::string name = xml_text(std::filesystem::path(path).filename().string());
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += fmt::format("<testsuite name=\"cchip clash {}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\">\n",
                      name, report.pairs.size() + 1, report.violations, report.not_judged);
  text += fmt::format("  <testcase classname=\"{}\" name=\"assembly\"><system-out>{}</system-out></testcase>\n", name,
                      xml_text(size_text(assembly, report) + "; " + summary(assembly, report)));
  for (const AssemblyPair& pair : report.pairs) {
    text += fmt::format("  <testcase classname=\"{}\" name=\"{} / {}\">", name, xml_text(assembly.parts[pair.a].name),
                        xml_text(assembly.parts[pair.b].name));
    const std::string words = xml_text(sentence(assembly, pair));
    if (pair.is_violation) {
      text += fmt::format("<failure type=\"{}\" message=\"{}\"/>", name_of(pair.verdict), words);
    } else if (!pair.is_judged) {
      text += fmt::format("<skipped message=\"{}\"/>", words);
    } else {
      text += fmt::format("<system-out>{}</system-out>", words);
    }
    text += "</testcase>\n";
  }
  return text + "</testsuite>\n";
}

void write_file(const std::string& path, const std::string& text) {
  sim::OutputFile file(path);
  file.stream() << text;
  file.commit();
}

MotionReport judge_motion(const Assembly& assembly, const ClashOptions& options) {
  MotionOptions motion_options;
  motion_options.threads = options.threads;
  if (!options.least_step.empty()) {
    const std::optional<double> step = read_decimal(options.least_step);
    if (!step) throw UsageError(fmt::format("--least-step: got '{}'; write a number such as 1e-4", options.least_step));
    motion_options.least_step = *step;
  }
  try {
    return check_motion(assembly, read_motion(options.path, assembly), motion_options);
  } catch (const std::invalid_argument& error) {
    throw UsageError(options.path + ": " + error.what());
  }
}

std::string kind_of(const AssemblyPair& pair) {
  return pair.is_violation ? "violation" : pair.is_judged ? "accepted" : "not judged";
}

/// Contacts and curves of two parts, those of the first contacts if there are many.
void add_contacts(const AssemblyPart& a, const AssemblyPart& b, PagePair& page) {
  constexpr std::size_t most = 2000;
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  request.relation = true;
  request.max_contacts = most;
  const CollisionResult result = collide(a.object, a.pose, b.object, b.pose, request);
  for (const Contact& contact : result.contacts)
    page.contacts.push_back({contact.face_a, contact.face_b, contact.relation});
  const CollisionQuery query = {&a.object, &a.pose, &b.object, &b.pose};
  for (const IntersectionCurve& curve : intersection_curves(query, result.contacts)) {
    page.curves.push_back({curve.points, curve.closed});
  }
}

/// Violations come first. A page of more pairs than a person looks at shows the first ones.
std::string html_text(const Assembly& assembly, const AssemblyReport& report, const std::string& path) {
  constexpr std::size_t most = 500;
  std::vector<const AssemblyPair*> order;
  for (const AssemblyPair& pair : report.pairs) order.push_back(&pair);
  std::stable_sort(order.begin(), order.end(), [](const AssemblyPair* x, const AssemblyPair* y) {
    return std::pair(!x->is_violation, x->is_judged) < std::pair(!y->is_violation, y->is_judged);
  });
  std::string text = size_text(assembly, report) + "; " + summary(assembly, report);
  if (order.size() > most) {
    text += fmt::format("; the first {} of {} pairs are shown, --json has all", most, order.size());
    order.resize(most);
  }
  std::vector<Mesh> parts(assembly.parts.size());
  std::vector<PagePair> pairs;
  for (const AssemblyPair* pair : order) {
    for (const std::size_t i : {pair->a, pair->b}) {
      if (!parts[i].faces.empty()) continue;
      parts[i] = transformed(assembly.parts[i].object.mesh(), assembly.parts[i].pose);
      parts[i].name = assembly.parts[i].name;
    }
    PagePair page = {pair->a, pair->b, kind_of(*pair), sentence(assembly, *pair)};
    add_contacts(assembly.parts[pair->a], assembly.parts[pair->b], page);
    if (pair->verdict == PairVerdict::too_near) page.curves.push_back({{pair->nearest[0], pair->nearest[1]}});
    pairs.push_back(std::move(page));
  }
  try {
    return pairs_page(parts, std::filesystem::path(path).filename().string(), text, pairs, read_page_scripts());
  } catch (const std::runtime_error& error) {
    throw UsageError(std::string("--html: ") + error.what());
  }
}

void prove(const Assembly& assembly, const AssemblyReport& report, const ClashOptions& options) {
  ReceiptOptions receipts;
  receipts.threads = options.threads;
  try {
    write_receipts(assembly, report, options.receipts, receipts);
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
}

std::string json_text(const Assembly& assembly, const ReceiptReport& report) {
  Json pairs = Json::array();
  for (const CheckedReceipt& pair : report.pairs) {
    pairs.push_back({{"a", assembly.parts[pair.a].name},
                     {"b", assembly.parts[pair.b].name},
                     {"state", name_of(pair.state)},
                     {"text", pair.text}});
  }
  const Json object = {{"by_boxes", report.by_boxes}, {"pairs", pairs}};
  return object.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

int run_verify(const Assembly& assembly, const ClashOptions& options, const Streams& streams) {
  const bool json_out = options.json == "-";
  ReceiptReport report;
  try {
    report = verify_receipts(assembly, options.verify, options.threads);
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  } catch (const std::invalid_argument& error) {
    throw UsageError(options.assembly + ": " + error.what());
  }
  if (json_out) {
    streams.out << json_text(assembly, report);
  } else {
    for (const CheckedReceipt& pair : report.pairs) {
      if (pair.state != ReceiptState::proved) streams.out << name_of(pair.state) << ": " << pair.text << '\n';
    }
    streams.out << left_out_line(assembly);
    if (!options.json.empty()) write_file(options.json, json_text(assembly, report));
  }
  std::string counts = fmt::format("pairs={} by_boxes={}", report.pairs.size() + report.by_boxes, report.by_boxes);
  bool fails = false;
  for (const ReceiptState state : {ReceiptState::proved, ReceiptState::violation, ReceiptState::unproved,
                                   ReceiptState::missing, ReceiptState::stale, ReceiptState::refused}) {
    const std::size_t count = report.count(state);
    counts += fmt::format(" {}={}", name_of(state), count);
    fails = fails || (count > 0 && state != ReceiptState::proved && state != ReceiptState::unproved);
  }
  (json_out ? streams.err : streams.out) << counts << '\n';
  if (fails) return exit_violation;
  return report.count(ReceiptState::unproved) > 0 || assembly.faces_left_out > 0 ? exit_left_out : exit_ok;
}

int run_motion(const Assembly& assembly, const ClashOptions& options, const Streams& streams) {
  const bool json_out = options.json == "-";
  const MotionReport report = judge_motion(assembly, options);
  for (const std::string& note : report.notes) streams.err << "cchip: " << note << '\n';
  if (json_out) {
    streams.out << app::json_text(assembly, report);
  } else {
    app::write_table(assembly, report, streams.out);
    if (!options.json.empty()) write_file(options.json, app::json_text(assembly, report));
  }
  if (!options.junit.empty()) write_file(options.junit, app::junit_text(assembly, report, options.assembly));
  (json_out ? streams.err : streams.out) << app::summary(assembly, report) << '\n';
  if (report.violations > 0) return exit_violation;
  return report.unproved > 0 || assembly.faces_left_out > 0 ? exit_left_out : exit_ok;
}

}  // namespace

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return result;
}

int run_clash(const ClashOptions& options, const Streams& streams) {
  const bool json_out = options.json == "-";
  sim::check_outputs(
      {{"ASSEMBLY", options.assembly}, {"--rules", options.rules}, {"--srdf", options.srdf}, {"--path", options.path}},
      {{"--json", json_out ? "" : options.json},
       {"--junit", options.junit},
       {"--html", options.html},
       {"--accept", options.accept}});
  if (!options.html.empty()) check_view_name(options.html);
  for (const std::string& path :
       {json_out ? std::string() : options.json, options.junit, options.html, options.accept}) {
    if (!path.empty()) sim::check_writable(path);
  }
  const Assembly assembly = read_assembly(options);
  for (const std::string& note : assembly.notes) streams.err << "cchip: " << note << '\n';
  if (!options.path.empty()) return run_motion(assembly, options, streams);
  if (!options.verify.empty()) return run_verify(assembly, options, streams);
  const AssemblyReport report = judge(assembly, options);
  for (const std::string& note : report.notes) streams.err << "cchip: " << note << '\n';
  if (json_out) {
    streams.out << json_text(assembly, report);
  } else {
    write_table(assembly, report, streams.out);
    if (!options.json.empty()) write_file(options.json, json_text(assembly, report));
  }
  if (!options.junit.empty()) write_file(options.junit, junit_text(assembly, report, options.assembly));
  if (!options.html.empty()) write_file(options.html, html_text(assembly, report, options.assembly));
  if (!options.accept.empty()) write_file(options.accept, accepting_rules(assembly, report));
  if (!options.receipts.empty()) prove(assembly, report, options);
  (json_out ? streams.err : streams.out) << summary(assembly, report) << '\n';
  if (report.violations > 0) return exit_violation;
  return report.not_judged > 0 || assembly.faces_left_out > 0 ? exit_left_out : exit_ok;
}

}  // namespace cchip::app
