// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/assembly.hpp>
#include <cchip/mesh_file.hpp>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "mesh_io/file_content.hpp"
#include "mesh_io/other_formats.hpp"
#include "obj_parts.hpp"
#include "placed_meshes.hpp"
#include "robot.hpp"
#include "source.hpp"

namespace cchip {
namespace {

namespace fs = std::filesystem;
using assembly::AssemblySource;
using assembly::PartSource;

bool is_mesh_name(const std::string& name) {
  constexpr std::array<std::string_view, 4> ends = {".obj", ".off", ".ply", ".stl"};
  return std::find(ends.begin(), ends.end(), mesh_io::extension_of(mesh_io::name_inside(name))) != ends.end();
}

/// glTF, GLB and 3MF, which say what is placed where.
bool is_placed_meshes(const std::string& name) {
  constexpr std::array<std::string_view, 3> ends = {".gltf", ".glb", ".3mf"};
  return std::find(ends.begin(), ends.end(), mesh_io::extension_of(name)) != ends.end();
}

/// A path that is relative to the folder of a file.
std::string beside(const std::string& file, const std::string& path) {
  return (fs::path(file).parent_path() / path).string();
}

class Loader {
 public:
  explicit Loader(const AssemblyLoadOptions& options) : options_(options) {
    if (options.unit.empty() || assembly::millimetres(options.unit) > 0) return;
    throw std::runtime_error("unit '" + options.unit + "': there is no such unit; give " + assembly::units);
  }

  Assembly load(const std::string& path) {
    assembly_.unit = options_.unit;
    std::error_code error;
    if (fs::is_directory(path, error)) {
      load_folder(path);
    } else if (is_placed_meshes(path)) {
      load_placed(path);
    } else if (mesh_io::extension_of(path) == ".urdf") {
      load_urdf(path);
    } else if (mesh_io::extension_of(path) == ".toml") {
      load_toml(path);
    } else if (mesh_io::extension_of(mesh_io::name_inside(path)) == ".obj") {
      load_obj(path);
    } else {
      refuse(path,
             "is no assembly; give a TOML file, a folder of mesh files, a glTF, GLB or 3MF, a URDF, "
             "or an OBJ with a part for each 'o'");
    }
    if (assembly_.links.empty()) refuse_robot_options(path);
    if (assembly_.parts.size() < 2) {
      refuse(path, "holds one part, which cannot clash; give an assembly of at least two");
    }
    if (!options_.rules.empty()) add_rules(load_rules(options_.rules));
    return std::move(assembly_);
  }

 private:
  [[noreturn]] static void refuse(const std::string& path, const std::string& what) {
    throw std::runtime_error(path + ": " + what);
  }

  void refuse_robot_options(const std::string& path) const {
    if (options_.joints.empty() && options_.srdf.empty() && options_.packages.empty() && !options_.neighbours) return;
    refuse(path, "is no robot, so it has no joints, packages, SRDF or neighbours; leave these options out");
  }

  void add_rules(std::vector<AssemblyRule> rules) {
    std::move(rules.begin(), rules.end(), std::back_inserter(assembly_.rules));
  }

  LoadOptions mesh_options(std::size_t& left_out) const {
    LoadOptions options;
    options.lenient = options_.lenient;
    options.faces_left_out = &left_out;
    options.most_unpacked_bytes = options_.most_unpacked_bytes;
    return options;
  }

  static Object build(Mesh mesh, const std::string& path) {
    try {
      return Object(std::move(mesh));
    } catch (const std::invalid_argument& error) {
      refuse(path, error.what());
    }
  }

  /// The object of a mesh file; one that was read before is taken again.
  const Object& object_of(const std::string& path) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(path, error);
    const std::string key = error ? path : whole.string();
    const auto found = objects_.find(key);
    if (found != objects_.end()) return found->second;
    std::size_t left_out = 0;
    Mesh mesh = load_mesh(path, mesh_options(left_out));
    assembly_.faces_left_out += left_out;
    for (const std::string& note : mesh.notes) assembly_.notes.push_back(path + ": " + note);
    return objects_.emplace(key, build(std::move(mesh), path)).first->second;
  }

  void add_part(std::string name, const Object& object, const Pose& pose, std::vector<std::string> groups,
                const std::string& file) {
    std::string unique = name;
    for (std::size_t i = 2; !names_.insert(unique).second; ++i) unique = name + "#" + std::to_string(i);
    assembly_.parts.push_back({unique, object, pose, std::move(groups), file});
  }

  void load_folder(const std::string& path) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
      std::error_code error;
      if (entry.is_regular_file(error) && is_mesh_name(entry.path().filename().string())) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    if (files.empty()) refuse(path, "the folder holds no mesh file (OBJ, OFF, PLY, STL); give another one");
    for (const fs::path& file : files) {
      add_part(file.filename().string(), object_of(file.string()), Pose::Identity(), {}, file.string());
    }
  }

  void load_obj(const std::string& path) {
    std::size_t left_out = 0;
    const auto parts = assembly::load_obj_parts(path, mesh_options(left_out), assembly_.notes);
    assembly_.faces_left_out += left_out;
    for (const assembly::ObjPart& part : parts) {
      const std::string name = part.name.empty() ? fs::path(path).stem().string() : part.name;
      add_part(name, build(part.mesh, path), Pose::Identity(), {}, path);
    }
  }

  void load_placed(const std::string& path) {
    const bool is_3mf = mesh_io::extension_of(path) == ".3mf";
    assembly::PlacedMeshes placed = is_3mf ? assembly::read_3mf(path, options_.most_unpacked_bytes)
                                           : assembly::read_gltf(path, options_.most_unpacked_bytes);
    if (assembly_.unit.empty()) assembly_.unit = placed.unit;
    for (const std::string& note : placed.notes) assembly_.notes.push_back(path + ": " + note);
    std::map<std::size_t, Object> built;  // each is used at least once
    for (const auto& part : placed.parts) {
      auto found = built.find(part.mesh);
      if (found == built.end()) {
        found =
            built.emplace(part.mesh, build(std::move(placed.meshes[part.mesh]), path + ": part '" + part.name + "'"))
                .first;
      }
      add_part(part.name, found->second, part.pose, {}, path);
    }
  }

  void load_urdf(const std::string& path) {
    const assembly::Robot robot = assembly::read_urdf(path, options_);
    if (assembly_.unit.empty()) assembly_.unit = "m";
    for (const std::string& note : robot.notes) assembly_.notes.push_back(path + ": " + note);
    std::size_t without_shape = 0;
    for (const assembly::RobotLink& link : robot.links) {
      assembly_.links.push_back({link.name, std::nullopt, Pose::Identity()});
      if (link.shapes.empty()) {
        ++without_shape;
      } else {
        add_link_part(path, link);
      }
    }
    if (without_shape > 0) {
      assembly_.notes.push_back(path + ": " + std::to_string(without_shape) + " of " +
                                std::to_string(robot.links.size()) + " links have no collision, so they are no parts");
    }
    assembly_.joints = robot.joints;
    leave_neighbours_out();
    if (!options_.srdf.empty()) add_disabled(assembly::read_srdf(options_.srdf, robot.links, assembly_.notes));
    try {
      for (const std::string& note : move_joints(assembly_, options_.joints)) {
        assembly_.notes.push_back(path + ": " + note);
      }
    } catch (const std::invalid_argument& error) {
      refuse(path, error.what());
    }
  }

  /// A link of one shape is the mesh of that, and places it.
  void add_link_part(const std::string& path, const assembly::RobotLink& link) {
    const std::string who = path + ": link '" + link.name + "'";
    std::vector<Object> objects;
    for (const assembly::RobotShape& shape : link.shapes) {
      try {
        objects.push_back(shape.file.empty() ? build(shape.mesh, who) : object_of(shape.file));
      } catch (const std::runtime_error& error) {
        if (shape.file.empty()) throw;
        refuse(who, error.what());
      }
    }
    AssemblyLink& made = assembly_.links.back();
    made.part = assembly_.parts.size();
    if (objects.size() == 1) {
      made.place = link.shapes[0].place;
      add_part(link.name, objects[0], made.place, {}, link.shapes[0].file.empty() ? path : link.shapes[0].file);
      return;
    }
    std::vector<const Mesh*> meshes;
    std::vector<Pose> places;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      meshes.push_back(&objects[i].mesh());
      places.push_back(link.shapes[i].place);
    }
    add_part(link.name, build(assembly::joined(meshes, places), who), Pose::Identity(), {}, path);
  }

  void leave_neighbours_out() {
    if (options_.neighbours) return;
    for (const AssemblyJoint& joint : assembly_.joints) {
      const std::optional<std::size_t> parent = assembly_.links[joint.parent].part;
      const std::optional<std::size_t> child = assembly_.links[joint.child].part;
      if (parent && child) assembly_.left_out.push_back(std::minmax(*parent, *child));
    }
    std::sort(assembly_.left_out.begin(), assembly_.left_out.end());
  }

  /// Rules of an SRDF about pairs that are looked at.
  void add_disabled(std::vector<AssemblyRule> rules) {
    const auto part_of = [this](const std::string& name) {
      return std::find_if(assembly_.links.begin(), assembly_.links.end(),
                          [&name](const AssemblyLink& link) { return link.name == name; })
          ->part;
    };
    for (AssemblyRule& rule : rules) {
      const std::optional<std::size_t> a = part_of(rule.parts[0]);
      const std::optional<std::size_t> b = part_of(rule.parts[1]);
      if (!a || !b) continue;
      const std::pair<std::size_t, std::size_t> pair = std::minmax(*a, *b);
      if (!std::binary_search(assembly_.left_out.begin(), assembly_.left_out.end(), pair)) {
        assembly_.rules.push_back(std::move(rule));
      }
    }
  }

  void load_toml(const std::string& path) {
    const AssemblySource source = assembly::read_toml(path, true);
    if (assembly_.unit.empty()) assembly_.unit = source.unit;
    assembly_.clearance = source.clearance;
    for (const PartSource& part : source.parts) {
      const Object& object = part_object(path, part);
      const std::string name = part.name.empty() ? fs::path(part.file).stem().string() : part.name;
      add_part(name, object, placed(part), part.groups, beside(path, part.file));
    }
    add_rules(source.rules);
    for (const std::string& file : source.rules_files) add_rules(load_rules(beside(path, file)));
  }

  const Object& part_object(const std::string& path, const PartSource& part) {
    if (is_placed_meshes(part.file)) {
      throw std::runtime_error(part.place + ": " + part.file +
                               " is an assembly of its own, no mesh; give it as ASSEMBLY, or save its parts as PLY");
    }
    try {
      return object_of(beside(path, part.file));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(part.place + ": " + error.what());
    }
  }

  /// The pose with the unit of the file worked in.
  Pose placed(const PartSource& part) const {
    if (part.unit.empty() || part.unit == assembly_.unit) return part.pose;
    if (assembly_.unit.empty()) {
      throw std::runtime_error(part.place + ": key 'unit' says " + part.unit +
                               ", but the assembly has no unit to convert to; add unit = \"mm\" or another at the top");
    }
    Pose pose = part.pose;
    pose.linear() *= assembly::millimetres(part.unit) / assembly::millimetres(assembly_.unit);
    return pose;
  }

  const AssemblyLoadOptions& options_;
  Assembly assembly_;
  std::map<std::string, Object> objects_;  ///< by the path of their file
  std::set<std::string> names_;
};

}  // namespace

Assembly load_assembly(const std::string& path, const AssemblyLoadOptions& options) {
  return Loader(options).load(path);
}

std::vector<AssemblyRule> load_rules(const std::string& path) { return assembly::read_toml(path, false).rules; }

}  // namespace cchip
