// SPDX-License-Identifier: Apache-2.0
/// \file
/// A model part of a 3MF: one XML file.
#ifndef CCHIP_ASSEMBLY_THREE_MF_MODEL_HPP
#define CCHIP_ASSEMBLY_THREE_MF_MODEL_HPP

#include <cchip/mesh.hpp>
#include <cchip/pose.hpp>
#include <cstddef>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "placed_meshes.hpp"

namespace cchip::assembly {

/// The XML with the prefixes that it uses, and errors that say where.
class ThreeMfModel {
 public:
  /// \param place for messages: "part.3mf: 3D/3dmodel.model"
  /// \throws std::runtime_error no XML of a model, or it needs an extension that is not read
  ThreeMfModel(const std::string& place, const std::string& content);

  [[noreturn]] void refuse(const std::string& what) const;
  /// mm, um and so on.
  const std::string& unit() const { return unit_; }
  pugi::xml_node root() const { return root_; }
  /// The object with this id; \throws std::runtime_error there is none
  pugi::xml_node object(const std::string& id, const std::string& who) const;
  /// The first child with this name of the core specification.
  pugi::xml_node child(pugi::xml_node parent, const char* name) const;
  std::vector<pugi::xml_node> children(pugi::xml_node parent, const char* name) const;
  /// Where the production extension says that an object is; empty: in this model.
  std::string path_of(pugi::xml_node reference) const;
  /// Of an item or a component.
  Pose transform(pugi::xml_node reference, const std::string& who) const;
  /// The triangles of an object's <mesh>.
  Mesh mesh(pugi::xml_node mesh, const std::string& who, Allowance& allowance) const;

 private:
  std::string prefix_for(const std::string& name_space) const;
  void read_unit();
  void check_extensions() const;
  double number(pugi::xml_node from, const char* key, const std::string& who) const;
  std::uint32_t vertex(pugi::xml_node from, const char* key, std::size_t count, const std::string& who) const;

  std::string place_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::string core_;      ///< prefix of elements of the core specification: "" or "x:"
  std::string path_key_;  ///< "p:path"; empty: the extension is not there
  std::string unit_;
  std::map<std::string, pugi::xml_node> objects_;
};

}  // namespace cchip::assembly

#endif
