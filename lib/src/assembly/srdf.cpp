// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <pugixml.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "mesh_io/file_content.hpp"
#include "placed_meshes.hpp"
#include "robot.hpp"

namespace cchip::assembly {

std::vector<AssemblyRule> read_srdf(const std::string& path, const std::vector<RobotLink>& links,
                                    std::vector<std::string>& notes) {
  const std::string content = mesh_io::read_file(path, "robot's SRDF");
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(content.data(), content.size());
  const auto place_of = [&](std::ptrdiff_t offset) {
    const auto end =
        content.begin() + std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(content.size()));
    return path + ":" + std::to_string(1 + std::count(content.begin(), end, '\n'));
  };
  if (!result) {
    throw std::runtime_error(place_of(result.offset) + ": its XML is wrong, " + result.description() + "; correct it");
  }
  const pugi::xml_node robot = document.document_element();
  if (std::string(robot.name()) != "robot") {
    throw std::runtime_error(path + ": is no SRDF, its first element is not <robot>; give another file");
  }
  std::vector<AssemblyRule> rules;
  for (const pugi::xml_node pair : robot.children("disable_collisions")) {
    AssemblyRule rule;
    rule.kind = AssemblyRule::Kind::anything;
    rule.optional = true;
    rule.place = place_of(pair.offset_debug());
    for (const char* const key : {"link1", "link2"}) {
      const std::string name = one_line(pair.attribute(key).value());
      const bool known =
          std::any_of(links.begin(), links.end(), [&name](const RobotLink& link) { return link.name == name; });
      if (known) {
        rule.parts.push_back(name);
      } else {  // one file often serves several variants of a robot
        notes.push_back(rule.place + ": " + key + " is '" + name + "', and the robot has no such link");
      }
    }
    if (rule.parts.size() < 2) continue;
    if (rule.parts[0] == rule.parts[1]) {
      throw std::runtime_error(rule.place + ": link1 and link2 are both '" + rule.parts[0] + "'; name two");
    }
    rule.reason = one_line(pair.attribute("reason").value());
    if (rule.reason.empty()) rule.reason = "disabled, without a reason";
    rules.push_back(rule);
  }
  return rules;
}

}  // namespace cchip::assembly
