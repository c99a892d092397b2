// SPDX-License-Identifier: Apache-2.0
#include "receipt_file.hpp"

#include <algorithm>
#include <cchip/certificate.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <stdexcept>

#include "json_table.hpp"
#include "mesh_trees.hpp"

namespace cchip::assembly {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* version_key = "collisionchip_receipts";

std::string hash_text(std::uint64_t hash) {
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[i] = "0123456789abcdef"[hash >> (60 - 4 * i) & 15U];
  return text;
}

std::uint64_t read_hash(const JsonTable& table, const char* key) {
  const std::string text = table.text(key);
  if (text.size() != 16 || text.find_first_not_of("0123456789abcdef") != std::string::npos) {
    table.refuse(std::string("'") + key + "' is no hash of 16 hexadecimal digits; write the receipts again");
  }
  return std::stoull(text, nullptr, 16);
}

std::optional<Vec3d> read_vector(const JsonTable& table, const char* key) {
  if (!table.has(key)) return std::nullopt;
  const std::vector<double> numbers = table.numbers(key, 3);
  return Vec3d(numbers[0], numbers[1], numbers[2]);
}

struct Box {
  Vec3d least;
  Vec3d greatest;
};

Box wide_box_of(const AssemblyPart& part) {
  Box box = {Vec3d::Constant(std::numeric_limits<double>::infinity()),
             Vec3d::Constant(-std::numeric_limits<double>::infinity())};
  double greatest_term = part.pose.translation().cwiseAbs().maxCoeff();
  const double greatest_entry = part.pose.linear().cwiseAbs().maxCoeff();
  for (const Mesh::Face& face : part.object.mesh().faces) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(face.kind); ++i) {
      const Vec3d& vertex = part.object.mesh().vertices[face.vertex[i]];
      const Vec3d at = part.pose * vertex;
      box.least = box.least.cwiseMin(at);
      box.greatest = box.greatest.cwiseMax(at);
      greatest_term = std::max(greatest_term, greatest_entry * vertex.cwiseAbs().maxCoeff());
    }
  }
  // Three products and sums of at most four such terms: each is off by less than 16 times their last bit.
  const Vec3d margin = Vec3d::Constant(0x1p-48 * greatest_term + std::numeric_limits<double>::min());
  return {box.least - margin, box.greatest + margin};
}

bool are_boxes_apart(const Box& a, const Box& b, double by) {
  const double gap = (b.least - a.greatest).cwiseMax(a.least - b.greatest).maxCoeff();
  return gap * (1 - 0x1p-50) > by;
}

}  // namespace

std::string tree_file_name(std::uint64_t hash) { return "tree-" + hash_text(hash) + ".jsonl"; }

Receipt receipt_of(const AssemblyPart& a, const AssemblyPart& b) {
  return {a.name, b.name, hash_mesh(a.object.mesh()), hash_mesh(b.object.mesh()), hash_poses(a.pose, b.pose)};
}

void write_receipt_index(const std::string& folder, const std::vector<Receipt>& receipts) {
  const auto vector = [](const Vec3d& v) { return Json::array({v[0], v[1], v[2]}); };
  Json list = Json::array();
  for (const Receipt& receipt : receipts) {
    Json entry = {{"a", receipt.a},
                  {"b", receipt.b},
                  {"mesh_a", hash_text(receipt.mesh_a)},
                  {"mesh_b", hash_text(receipt.mesh_b)},
                  {"poses", hash_text(receipt.poses)}};
    if (!receipt.file.empty()) entry["file"] = receipt.file;
    if (receipt.translation) entry["translation"] = vector(*receipt.translation);
    if (receipt.common_point) entry["common_point"] = vector(*receipt.common_point);
    list.push_back(std::move(entry));
  }
  const std::string path = folder + "/" + receipt_index;
  std::ofstream file(path, std::ios::binary);
  file << Json{{version_key, 1}, {"receipts", list}}.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written; check the disk and the rights of the folder");
}

std::vector<Receipt> read_receipt_index(const std::string& folder) {
  const std::string path = folder + "/" + receipt_index;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read; give a folder that --receipts has written");
  try {
    const nlohmann::json json = nlohmann::json::parse(file);
    const JsonTable table(path, json, "");
    if (table.whole(version_key, 0) != 1) {
      table.refuse(std::string("'") + version_key +
                   "' is not 1; give a folder that --receipts of this version has written");
    }
    std::vector<Receipt> receipts;
    for (const JsonTable& entry : table.tables("receipts", "receipt")) {
      Receipt receipt;
      receipt.a = entry.text("a");
      receipt.b = entry.text("b");
      receipt.mesh_a = read_hash(entry, "mesh_a");
      receipt.mesh_b = read_hash(entry, "mesh_b");
      receipt.poses = read_hash(entry, "poses");
      receipt.file = entry.text("file");
      receipt.translation = read_vector(entry, "translation");
      receipt.common_point = read_vector(entry, "common_point");
      if (receipt.file.find_first_of("/\\") != std::string::npos) {
        entry.refuse("'file' names another folder; receipts are in the folder of " + std::string(receipt_index));
      }
      receipts.push_back(std::move(receipt));
    }
    return receipts;
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(path + ": is no JSON (" + error.what() + "); write the receipts again");
  }
}

PairsToProve pairs_to_prove(const Assembly& assembly, const RuleBook& rules) {
  const std::size_t count = assembly.parts.size();
  std::vector<Box> boxes;
  boxes.reserve(count);
  for (const AssemblyPart& part : assembly.parts) boxes.push_back(wide_box_of(part));
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&boxes](std::size_t x, std::size_t y) { return boxes[x].least[0] < boxes[y].least[0]; });
  const std::vector<double> clearances = rules.clearances();
  const double most = clearances.empty() ? 0 : clearances.back();
  std::size_t free = 0;
  const auto may_do_anything = [&](std::size_t a, std::size_t b) {
    const std::optional<std::size_t> rule = rules.rule_of(a, b);
    return rules.is_left_out(a, b) || (rule && assembly.rules[*rule].kind == AssemblyRule::Kind::anything);
  };
  std::set<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) {
      const auto [a, b] = std::minmax(order[i], order[k]);
      if (boxes[order[k]].least[0] - boxes[order[i]].greatest[0] > 2 * most) break;
      if (are_boxes_apart(boxes[a], boxes[b], rules.clearance_of(a, b))) continue;
      if (may_do_anything(a, b)) {
        ++free;
      } else {
        found.emplace(a, b);
      }
    }
  }
  for (std::size_t rule = 0; rule < assembly.rules.size(); ++rule) {
    const AssemblyRule::Kind kind = assembly.rules[rule].kind;
    if (kind != AssemblyRule::Kind::inside && kind != AssemblyRule::Kind::same) continue;
    rules.for_each_pair(rule, [&](std::size_t a, std::size_t b) {
      if (rules.rule_of(a, b) == rule && !rules.is_left_out(a, b)) found.emplace(a, b);
      return true;
    });
  }
  PairsToProve result;
  result.pairs.assign(found.begin(), found.end());
  result.by_boxes = count * (count - std::min<std::size_t>(count, 1)) / 2 - found.size() - free;
  return result;
}

}  // namespace cchip::assembly
