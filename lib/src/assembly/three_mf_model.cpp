// SPDX-License-Identifier: Apache-2.0
#include "three_mf_model.hpp"

#include <algorithm>
#include <array>
#include <cchip/internal/geometry/decimal.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace cchip::assembly {
namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr const char* production = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
constexpr const char* materials = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const auto end = std::min(text.find_first_of(blanks), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

std::string_view local_name(std::string_view name) { return name.substr(name.find(':') + 1); }

}  // namespace

ThreeMfModel::ThreeMfModel(const std::string& place, const std::string& content) : place_(place) {
  const pugi::xml_parse_result result = document_.load_buffer(content.data(), content.size());
  if (!result) {
    refuse("its XML is wrong at byte " + std::to_string(result.offset) + ": " + result.description() +
           "; save the file anew");
  }
  root_ = document_.document_element();
  const std::string name = root_.name();
  if (local_name(name) != "model") refuse("holds no <model>; save the file anew");
  core_ = name.substr(0, name.size() - std::string_view("model").size());
  const std::string prefix = prefix_for(production);
  if (!prefix.empty()) path_key_ = prefix + ":path";
  read_unit();
  check_extensions();
  for (const pugi::xml_node object : children(child(root_, "resources"), "object")) {
    const std::string id(trimmed(object.attribute("id").value()));
    if (id.empty()) refuse("an object has no 'id'; save the file anew");
    if (!objects_.emplace(id, object).second) refuse("object " + one_line(id) + " is there twice; save the file anew");
  }
}

void ThreeMfModel::refuse(const std::string& what) const { throw std::runtime_error(place_ + ": " + what); }

std::string ThreeMfModel::prefix_for(const std::string& name_space) const {
  for (const pugi::xml_attribute attribute : root_.attributes()) {
    const std::string name = attribute.name();
    if (name.compare(0, 6, "xmlns:") == 0 && name_space == attribute.value()) return name.substr(6);
  }
  return "";
}

void ThreeMfModel::read_unit() {
  constexpr std::array<std::pair<std::string_view, const char*>, 6> known = {
      {{"micron", "um"}, {"millimeter", "mm"}, {"centimeter", "cm"}, {"inch", "in"}, {"foot", "ft"}, {"meter", "m"}}};
  const pugi::xml_attribute attribute = root_.attribute("unit");
  const std::string_view written = attribute ? trimmed(attribute.value()) : "millimeter";
  for (const auto& [name, unit] : known) {
    if (written == name) unit_ = unit;
  }
  if (!unit_.empty()) return;
  refuse("unit '" + one_line(std::string(written)) +
         "' is none of 3MF; write micron, millimeter, centimeter, inch, foot or meter");
}

void ThreeMfModel::check_extensions() const {
  for (const std::string& prefix : words_of(root_.attribute("requiredextensions").value())) {
    const std::string name_space = root_.attribute(("xmlns:" + prefix).c_str()).value();
    if (name_space == production || name_space == materials) continue;
    refuse("needs the extension " + one_line(name_space.empty() ? prefix : name_space) +
           ", which is not read; save it without");
  }
}

pugi::xml_node ThreeMfModel::object(const std::string& id, const std::string& who) const {
  const auto found = objects_.find(std::string(trimmed(id)));
  if (found == objects_.end()) {
    refuse(who + ": names object '" + one_line(id) + "', which is not there; save the file anew");
  }
  return found->second;
}

pugi::xml_node ThreeMfModel::child(pugi::xml_node parent, const char* name) const {
  return parent.child((core_ + name).c_str());
}

std::vector<pugi::xml_node> ThreeMfModel::children(pugi::xml_node parent, const char* name) const {
  std::vector<pugi::xml_node> all;
  const std::string whole = core_ + name;  // the range keeps a pointer to it
  for (const pugi::xml_node found : parent.children(whole.c_str())) all.push_back(found);
  return all;
}

std::string ThreeMfModel::path_of(pugi::xml_node reference) const {
  return path_key_.empty() ? "" : reference.attribute(path_key_.c_str()).value();
}

Pose ThreeMfModel::transform(pugi::xml_node reference, const std::string& who) const {
  Pose pose = Pose::Identity();
  const pugi::xml_attribute attribute = reference.attribute("transform");
  if (!attribute) return pose;
  const std::vector<std::string> words = words_of(attribute.value());
  if (words.size() != 12) {
    refuse(who + ": 'transform' must be 12 numbers, and has " + std::to_string(words.size()) + "; correct it");
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::optional<double> value = read_decimal(words[i]);
    if (!value || !std::isfinite(*value)) {
      refuse(who + ": 'transform' has '" + one_line(words[i]) + "', which is no finite number; correct it");
    }
    pose.matrix()(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(i / 3)) = *value;  // row vectors there
  }
  return pose;
}

double ThreeMfModel::number(pugi::xml_node from, const char* key, const std::string& who) const {
  const std::string_view text = trimmed(from.attribute(key).value());
  const std::optional<double> value = text.empty() ? std::nullopt : read_decimal(text);
  if (value && std::isfinite(*value)) return *value;
  refuse(who + ": '" + key + "' is '" + one_line(std::string(text)) + "', which is no finite number; correct it");
}

std::uint32_t ThreeMfModel::vertex(pugi::xml_node from, const char* key, std::size_t count,
                                   const std::string& who) const {
  const double value = number(from, key, who);
  if (value >= 0 && value < static_cast<double>(count) && value == std::floor(value)) {
    return static_cast<std::uint32_t>(value);
  }
  refuse(who + ": '" + key + "' is " + one_line(from.attribute(key).value()) + ", and there are " +
         std::to_string(count) + " vertices; save the file anew");
}

Mesh ThreeMfModel::mesh(pugi::xml_node mesh, const std::string& who, Allowance& allowance) const {
  for (const pugi::xml_node part : mesh.children()) {
    if (local_name(part.name()) == "beamlattice") {
      refuse(who + ": has a beam lattice, which is not read; save it as triangles");
    }
  }
  Mesh made;
  made.name = place_;
  const auto room_for = [&](std::size_t bytes) {
    if (!allowance.spend(1, bytes)) {
      refuse(who + ": takes more memory than the file may ask for; split the file, or raise most_unpacked_bytes");
    }
  };
  for (const pugi::xml_node point : children(child(mesh, "vertices"), "vertex")) {
    const std::string here = who + ": vertex " + std::to_string(made.vertices.size());
    room_for(sizeof(Vec3d));
    made.vertices.emplace_back(number(point, "x", here), number(point, "y", here), number(point, "z", here));
  }
  if (made.vertices.size() > UINT32_MAX) refuse(who + ": has too many vertices; split the file");
  for (const pugi::xml_node triangle : children(child(mesh, "triangles"), "triangle")) {
    const std::string here = who + ": triangle " + std::to_string(made.faces.size());
    room_for(sizeof(Mesh::Face));
    Mesh::Face face;
    constexpr std::array<const char*, 3> keys = {"v1", "v2", "v3"};
    for (std::size_t i = 0; i < 3; ++i) face.vertex[i] = vertex(triangle, keys[i], made.vertices.size(), here);
    made.faces.push_back(face);
  }
  return made;
}

}  // namespace cchip::assembly
