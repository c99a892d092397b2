// SPDX-License-Identifier: Apache-2.0
#include "motion.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cchip/program/csv_reader.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "pose.hpp"

namespace cchip::app {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const std::string& file, std::uint64_t line, const std::string& what) {
  throw UsageError(fmt::format("{}:{}: {}", file, line, what));
}

void read_joints(CsvReader& csv, const CsvRow& header, AssemblyMotion& motion) {
  for (const std::string& field : header.fields) motion.joints.emplace_back(trimmed_field(field));
  CsvRow row;
  while (csv.next(row)) {
    if (row.fields.size() != header.fields.size()) {
      refuse(csv.name(), row.line,
             fmt::format("the row has {} fields, but the header names {} joints; write one field per joint",
                         row.fields.size(), header.fields.size()));
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < row.fields.size(); ++i) {
      try {
        values.push_back(parse_coordinate(row.fields[i]));
      } catch (const std::invalid_argument& error) {
        refuse(csv.name(), row.line, fmt::format("column {}: {}", motion.joints[i], error.what()));
      }
    }
    motion.values.push_back(values);
  }
}

void read_parts(CsvReader& csv, const CsvRow& header, AssemblyMotion& motion) {
  const PoseColumns columns(header, csv.name(), "");
  const std::vector<std::string>& names = columns.passed_names();
  const auto part = std::find_if(names.begin(), names.end(), [](const auto& n) { return trimmed_field(n) == "part"; });
  if (part == names.end()) {
    throw missing_column(csv.name(), header, "part", "the first row must name part and the columns of a pose");
  }
  std::map<std::string, std::size_t> column;
  std::vector<std::size_t> count;
  CsvRow row;
  while (csv.next(row)) {
    const PoseColumns::Row pose = columns.parse(row);
    const std::string name(trimmed_field(pose.passed[static_cast<std::size_t>(part - names.begin())]));
    const auto [place, is_new] = column.emplace(name, column.size());
    if (is_new) {
      motion.parts.push_back(name);
      count.push_back(0);
    }
    const Eigen::Matrix3d linear = pose.pose.linear();
    constexpr double written = 1e-9;
    if (!((linear * linear.transpose()).isIdentity(written)) || linear.determinant() < 0) {
      refuse(csv.name(), row.line, "the pose is no rotation and translation; write one");
    }
    const std::size_t at = count[place->second]++;
    if (at == motion.moves.size()) motion.moves.emplace_back();
    motion.moves[at].resize(std::max(motion.moves[at].size(), place->second + 1), RigidPose::Identity());
    motion.moves[at][place->second] = RigidPose(pose.pose.matrix());
  }
  for (std::size_t i = 0; i < count.size(); ++i) {
    if (count[i] == motion.moves.size()) continue;
    throw UsageError(fmt::format("{}: part '{}' has {} rows, another {}; write as many for each", csv.name(),
                                 motion.parts[i], count[i], motion.moves.size()));
  }
}

std::string number(double x) { return fmt::format("{:.9g}", x); }

std::string length(const Assembly& assembly, double x) {
  return number(x) + (assembly.unit.empty() ? "" : " " + assembly.unit);
}

std::string names(const Assembly& assembly, const MotionPair& pair) {
  return assembly.parts[pair.a].name + " and " + assembly.parts[pair.b].name;
}

std::string violation_text(const Assembly& assembly, const MotionPair& pair) {
  return fmt::format("at time {}: {}", number(*pair.time), sentence(assembly, pair.violation));
}

std::string unproved_text(const Assembly& assembly, const MotionPair& pair) {
  std::string text = names(assembly, pair);
  constexpr std::size_t most = 3;
  for (std::size_t i = 0; i < std::min(most, pair.unproved.size()); ++i) {
    text += fmt::format("{} from time {} to {}", i == 0 ? "" : ",", number(pair.unproved[i][0]),
                        number(pair.unproved[i][1]));
  }
  if (pair.unproved.size() > most) text += fmt::format(", and {} times more", pair.unproved.size() - most);
  return text;
}

const MotionPair* nearest(const MotionReport& report) {
  const MotionPair* found = nullptr;
  for (const MotionPair& pair : report.pairs) {
    if (!pair.time && (found == nullptr || pair.clearance_lower < found->clearance_lower)) found = &pair;
  }
  return found != nullptr && std::isfinite(found->clearance_lower) ? found : nullptr;
}

}  // namespace

AssemblyMotion read_motion(const std::string& path, const Assembly& assembly) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UsageError(path + ": cannot be read; name a CSV file");
  CsvReader csv(in, path);
  CsvRow header;
  if (!csv.next(header)) throw UsageError(path + ": is empty; write a row of names, then a row for each configuration");
  AssemblyMotion motion;
  if (assembly.joints.empty()) {
    read_parts(csv, header, motion);
  } else {
    read_joints(csv, header, motion);
  }
  return motion;
}

std::string left_out_line(const Assembly& assembly) {
  const std::size_t count = assembly.left_out.size();
  if (count == 0) return "";
  return fmt::format("left out: {} {} of links that a joint joins; --neighbours looks at them\n", count,
                     count == 1 ? "pair" : "pairs");
}

void write_table(const Assembly& assembly, const MotionReport& report, std::ostream& out) {
  for (const MotionPair& pair : report.pairs) {
    if (pair.time) out << "violation: " << violation_text(assembly, pair) << '\n';
  }
  for (const MotionPair& pair : report.pairs) {
    if (!pair.unproved.empty()) out << "unproved: " << unproved_text(assembly, pair) << '\n';
  }
  if (const MotionPair* pair = nearest(report)) {
    out << "nearest: " << names(assembly, *pair) << " are never less than " << length(assembly, pair->clearance_lower)
        << " apart" << (pair->unproved.empty() ? "" : " where proved") << "; found "
        << length(assembly, pair->clearance_upper) << '\n';
  }
  out << left_out_line(assembly);
}

std::string json_text(const Assembly& assembly, const MotionReport& report) {
  const auto finite = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  Json pairs = Json::array();
  for (const MotionPair& pair : report.pairs) {
    Json object = {{"a", assembly.parts[pair.a].name},
                   {"b", assembly.parts[pair.b].name},
                   {"time", nullptr},
                   {"verdict", nullptr},
                   {"text", nullptr},
                   {"clearance", nullptr},
                   {"unproved", pair.unproved}};
    if (pair.time) {
      object["time"] = *pair.time;
      object["verdict"] = name_of(pair.violation.verdict);
      object["text"] = violation_text(assembly, pair);
    } else {
      object["clearance"] = {finite(pair.clearance_lower), finite(pair.clearance_upper)};
    }
    pairs.push_back(std::move(object));
  }
  Json left_out = Json::array();
  for (const auto& [a, b] : assembly.left_out) {
    left_out.push_back(Json::array({assembly.parts[a].name, assembly.parts[b].name}));
  }
  const Json object = {{"unit", assembly.unit.empty() ? Json() : Json(assembly.unit)},
                       {"violations", report.violations},
                       {"unproved", report.unproved},
                       {"looks", report.looks},
                       {"pairs", pairs},
                       {"left_out", left_out},
                       {"notes", report.notes}};
  return object.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string junit_text(const Assembly& assembly, const MotionReport& report, const std::string& path) {
  const std::string name = xml_text(std::filesystem::path(path).filename().string());
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += fmt::format("<testsuite name=\"cchip clash {}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\">\n",
                      name, report.pairs.size() + 1, report.violations, report.unproved);
  text += fmt::format("  <testcase classname=\"{}\" name=\"path\"><system-out>{}</system-out></testcase>\n", name,
                      summary(assembly, report));
  for (const MotionPair& pair : report.pairs) {
    text += fmt::format("  <testcase classname=\"{}\" name=\"{} / {}\">", name, xml_text(assembly.parts[pair.a].name),
                        xml_text(assembly.parts[pair.b].name));
    if (pair.time) {
      text += fmt::format("<failure type=\"{}\" message=\"{}\"/>", name_of(pair.violation.verdict),
                          xml_text(violation_text(assembly, pair)));
    } else if (!pair.unproved.empty()) {
      text += fmt::format("<skipped message=\"unproved: {}\"/>", xml_text(unproved_text(assembly, pair)));
    }
    text += "</testcase>\n";
  }
  return text + "</testsuite>\n";
}

std::string summary(const Assembly& assembly, const MotionReport& report) {
  return fmt::format("parts={} pairs={} violations={} unproved={} looks={}", assembly.parts.size(), report.pairs.size(),
                     report.violations, report.unproved, report.looks);
}

}  // namespace cchip::app
