// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "placed_meshes.hpp"
#include "three_mf_model.hpp"
#include "zip_folder.hpp"

namespace cchip::assembly {
namespace {

constexpr std::size_t most_levels = 1000;

class ThreeMfReader {
 public:
  ThreeMfReader(const std::string& path, std::uint64_t most_bytes)
      : path_(path), allowance_(most_bytes), archive_(path) {}

  PlacedMeshes read() {
    root_ = model_path();
    const ThreeMfModel& main = model(root_);
    result_.unit = main.unit();
    const std::vector<pugi::xml_node> items = main.children(main.child(main.root(), "build"), "item");
    for (std::size_t i = 0; i < items.size(); ++i) add_item(main, items[i], "item " + std::to_string(i + 1));
    if (supports_ > 0) {
      result_.notes.push_back(std::to_string(supports_) + " placed " + (supports_ == 1 ? "object" : "objects") +
                              " of type support left out");
    }
    if (result_.parts.empty()) {
      refuse("its build holds no triangle, so nothing can be said about it; save it with its objects in the build");
    }
    return std::move(result_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }

  /// A path in the archive as it is in there.
  std::string inside(const std::string& written) const {
    const std::string name = written.substr(written.compare(0, 1, "/") == 0 ? 1 : 0);
    const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
    if (name.empty() || path.has_root_path() || *path.begin() == "..") {
      refuse("names '" + one_line(written) + "', which is not in the archive; save the file anew");
    }
    return path.generic_string();
  }

  /// Of the main model, which _rels/.rels names.
  std::string model_path() {
    constexpr std::string_view type = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
    const std::optional<std::string> relations = archive_.read("_rels/.rels", allowance_);
    if (!relations) return "3D/3dmodel.model";
    pugi::xml_document document;
    if (!document.load_buffer(relations->data(), relations->size())) {
      refuse("_rels/.rels: its XML is wrong; save the file anew");
    }
    for (const pugi::xml_node relation : document.document_element().children()) {
      if (relation.attribute("Type").value() == type) return inside(relation.attribute("Target").value());
    }
    return "3D/3dmodel.model";
  }

  const ThreeMfModel& model(const std::string& name) {
    const auto found = models_.find(name);
    if (found != models_.end()) return *found->second;
    const std::optional<std::string> content = archive_.read(name, allowance_);
    if (!content) refuse("holds no '" + one_line(name) + "', so it is no 3MF, or not a whole one; save it anew");
    auto made = std::make_unique<ThreeMfModel>(path_ + ": " + one_line(name), *content);
    if (!result_.unit.empty() && made->unit() != result_.unit) {
      made->refuse("its unit is " + made->unit() + ", that of the main model " + result_.unit +
                   ", which is not read; save the file in one unit");
    }
    return *models_.emplace(name, std::move(made)).first->second;
  }

  /// What an item or a component leads to.
  struct Placed {
    std::string model;  ///< its path in the archive
    std::string id;
    std::string names;  ///< of the objects above it, each with a slash
    Pose pose;
    std::string who;  ///< for messages
    std::size_t level = 0;
  };

  std::string model_of(const ThreeMfModel& from, pugi::xml_node reference, const std::string& here) const {
    const std::string other = from.path_of(reference);
    return other.empty() ? here : inside(other);
  }

  void add_item(const ThreeMfModel& main, pugi::xml_node item, const std::string& who) {
    const std::string id = item.attribute("objectid").value();
    const std::string name = model_of(main, item, root_);
    const ThreeMfModel& from = model(name);
    if (std::string_view(from.object(id, who).attribute("type").value()) == "other") {
      from.refuse(who + ": object " + one_line(id) +
                  " is of type other, which must not be in a build; remove the item");
    }
    part_number_ = one_line(item.attribute("partnumber").value());
    place({name, id, "", main.transform(item, who), who});
  }

  void place(const Placed& placed) {
    const ThreeMfModel& from = model(placed.model);
    const pugi::xml_node object = from.object(placed.id, placed.who);
    if (placed.level > most_levels) {
      from.refuse("object " + one_line(placed.id) + " is a component of itself, or more than " +
                  std::to_string(most_levels) + " levels deep; save the file anew");
    }
    const std::string name = placed.names + name_of(object, placed);
    if (!allowance_.spend(1, bytes_of_part + name.size())) {
      from.refuse(placed.who + ": places more than the file may ask for; split the file, or raise most_unpacked_bytes");
    }
    if (const pugi::xml_node mesh = from.child(object, "mesh")) {
      add_mesh(from, object, mesh, placed, name);
    } else if (const pugi::xml_node components = from.child(object, "components")) {
      for (const pugi::xml_node component : from.children(components, "component")) {
        const std::string who = "object " + one_line(placed.id) + ": component";
        place({model_of(from, component, placed.model), component.attribute("objectid").value(), name + "/",
               placed.pose * from.transform(component, who), who, placed.level + 1});
      }
    } else {
      refuse_content(from, object);
    }
  }

  std::string name_of(pugi::xml_node object, const Placed& placed) const {
    const std::string name = one_line(object.attribute("name").value());
    if (!name.empty()) return name;
    return placed.level == 0 && !part_number_.empty() ? part_number_ : "object" + one_line(placed.id);
  }

  [[noreturn]] static void refuse_content(const ThreeMfModel& from, pugi::xml_node object) {
    std::string names;
    for (const pugi::xml_node part : object.children()) {
      names += (names.empty() ? "" : ", ") + one_line(part.name());
    }
    from.refuse("object " + one_line(object.attribute("id").value()) + ": has neither a mesh nor components" +
                (names.empty() ? "" : ", but " + names + ", which is not read") + "; save it as triangles");
  }

  void add_mesh(const ThreeMfModel& from, pugi::xml_node object, pugi::xml_node mesh, const Placed& placed,
                const std::string& name) {
    const std::string type = object.attribute("type").value();
    const std::string who = "object " + one_line(placed.id);
    if (type == "support") {
      ++supports_;
      return;
    }
    for (const std::string known : {"", "model", "solidsupport", "surface", "other"}) {
      if (type == known) return add_part(from, mesh, placed, name, who);
    }
    from.refuse(who + ": type '" + one_line(type) +
                "' is none of 3MF; write model, solidsupport, support, surface or other");
  }

  void add_part(const ThreeMfModel& from, pugi::xml_node mesh, const Placed& placed, const std::string& name,
                const std::string& who) {
    const auto [number, is_new] = meshes_.emplace(std::pair(placed.model, placed.id), result_.meshes.size());
    if (is_new) {
      result_.meshes.push_back(from.mesh(mesh, who, allowance_));
      if (result_.meshes.back().faces.empty()) result_.notes.push_back(who + " has no triangle, so it is no part");
    }
    if (result_.meshes[number->second].faces.empty()) return;
    const std::string wrong = wrong_with(placed.pose);
    if (!wrong.empty()) from.refuse(placed.who + ": " + wrong);
    result_.parts.push_back({name, number->second, placed.pose});
  }

  std::string path_;
  Allowance allowance_;
  ZipFolder archive_;
  std::string root_;
  std::map<std::string, std::unique_ptr<ThreeMfModel>> models_;        ///< by their paths in the archive
  std::map<std::pair<std::string, std::string>, std::size_t> meshes_;  ///< by model and id
  std::string part_number_;                                            ///< of the item that is read
  std::size_t supports_ = 0;
  PlacedMeshes result_;
};

}  // namespace

PlacedMeshes read_3mf(const std::string& path, std::uint64_t most_bytes) {
  return ThreeMfReader(path, most_bytes).read();
}

}  // namespace cchip::assembly
