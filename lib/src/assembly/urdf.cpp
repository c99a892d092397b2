// SPDX-License-Identifier: Apache-2.0
#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <cchip/internal/geometry/quarter_turns.hpp>
#include <cchip/internal/geometry/rotation.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <pugixml.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "kinematics.hpp"
#include "mesh_io/file_content.hpp"
#include "placed_meshes.hpp"
#include "robot.hpp"
#include "texts.hpp"

namespace cchip::assembly {
namespace {

namespace fs = std::filesystem;
using JointKind = AssemblyJoint::Kind;

/// Collects what urdfdom complains about while it is there. urdfdom drops shapes after an error, also after one in what
/// is only seen, and still calls the model parsed.
class Complaints : public console_bridge::OutputHandler {
 public:
  Complaints() : lock_(mutex()), before_(console_bridge::getOutputHandler()), level_(console_bridge::getLogLevel()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
    console_bridge::useOutputHandler(this);
  }
  ~Complaints() override {
    console_bridge::useOutputHandler(before_);
    console_bridge::setLogLevel(level_);
  }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;
  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = one_line(text);
  }
  const std::string& first() const { return first_; }

 private:
  static std::mutex& mutex() {  // the handler is one for the program
    static std::mutex it;
    return it;
  }
  std::lock_guard<std::mutex> lock_;
  console_bridge::OutputHandler* before_;
  console_bridge::LogLevel level_;
  std::string first_;
};

Vec3d vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

/// Quarter turns are exact.
Pose pose_of(const urdf::Pose& from) {
  Pose pose = Pose::Identity();
  const urdf::Rotation& q = from.rotation;
  const auto rotation = rotation_of({q.x, q.y, q.z, q.w});
  if (rotation) pose.linear() = snapped(*rotation);
  pose.translation() = vector_of(from.position);
  return pose;
}

class UrdfReader {
 public:
  UrdfReader(const std::string& path, const AssemblyLoadOptions& options) : path_(path), options_(options) {}

  Robot read() {
    const urdf::ModelInterfaceSharedPtr model = parse();
    check_tree(*model);
    add_link(*model->getRoot());
    if (robot_.links.size() != model->links_.size()) {
      for (const auto& [name, link] : model->links_) {
        if (number_.count(name) == 0) refuse_link(name, "no chain of joints leads to it from the root; join it");
      }
    }
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) lead(robot_.joints[i], names_of_joints_[i], *model);
    set_values();
    return std::move(robot_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }
  [[noreturn]] void refuse_link(const std::string& name, const std::string& what) const {
    refuse("link '" + one_line(name) + "': " + what);
  }
  [[noreturn]] void refuse_joint(const std::string& name, const std::string& what) const {
    refuse("joint '" + one_line(name) + "': " + what);
  }

  /// Elements of xacro, not in comments, which it leaves in what it writes.
  static bool has_macros(const std::string& content) {
    if (content.find("<xacro:") == std::string::npos) return false;
    pugi::xml_document document;
    document.load_buffer(content.data(), content.size());
    return !document
                .find_node(
                    [](const pugi::xml_node& node) { return std::string_view(node.name()).substr(0, 6) == "xacro:"; })
                .empty();
  }

  urdf::ModelInterfaceSharedPtr parse() const {
    const std::string content = mesh_io::read_file(path_, "robot");
    if (has_macros(content)) {
      refuse("has xacro macros, which are not read; write the robot out with `xacro robot.xacro > robot.urdf`");
    }
    urdf::ModelInterfaceSharedPtr model;
    std::string wrong;
    {
      const Complaints complaints;
      model = urdf::parseURDF(content);
      wrong = complaints.first();
    }
    if (!wrong.empty()) refuse("urdfdom says: " + wrong + "; correct that, also if it is in a visual");
    if (!model || !model->getRoot()) refuse("is no URDF that urdfdom reads; correct it, check_urdf may say more");
    return model;
  }

  void check_tree(const urdf::ModelInterface& model) const {
    std::map<std::string, std::string> carrier;
    for (const auto& [name, joint] : model.joints_) {
      const auto [place, is_new] = carrier.emplace(joint->child_link_name, name);
      if (is_new) continue;
      refuse_link(joint->child_link_name, "joints '" + one_line(place->second) + "' and '" + one_line(name) +
                                              "' both carry it; a loop is not read, leave one of them out");
    }
  }

  void add_link(const urdf::Link& root) {
    std::vector<std::pair<const urdf::Link*, const urdf::Joint*>> open = {{&root, nullptr}};
    std::map<std::string, const urdf::Link*> links;
    while (!open.empty()) {
      const auto [link, joint] = open.back();
      open.pop_back();
      number_[link->name] = robot_.links.size();
      if (joint != nullptr) add_joint(*joint);
      robot_.links.push_back({one_line(link->name), {}});
      for (const urdf::CollisionSharedPtr& shape : link->collision_array) add_shape(*link, *shape);
      for (auto child = link->child_links.rbegin(); child != link->child_links.rend(); ++child) {
        open.emplace_back(child->get(), (*child)->parent_joint.get());
      }
    }
  }

  // Shapes.

  void add_shape(const urdf::Link& link, const urdf::Collision& from) {
    RobotShape shape;
    shape.place = pose_of(from.origin);
    if (!from.geometry) refuse_link(link.name, "a collision has no geometry; add it or remove the collision");
    const auto length = [&](double x, const char* what) {
      if (!(x > 0) || !std::isfinite(x)) {
        refuse_link(link.name,
                    std::string("the ") + what + " of a shape is " + rounded_text(x) + "; write a finite one above 0");
      }
      return x;
    };
    switch (from.geometry->type) {
      case urdf::Geometry::BOX: {
        const Vec3d size = vector_of(static_cast<const urdf::Box&>(*from.geometry).dim);
        for (const double x : size) length(x, "size");
        shape.mesh = box_mesh(size);
        break;
      }
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(*from.geometry);
        shape.mesh = cylinder_mesh(length(cylinder.radius, "radius"), length(cylinder.length, "length"));
        break;
      }
      case urdf::Geometry::SPHERE:
        shape.mesh = sphere_mesh(length(static_cast<const urdf::Sphere&>(*from.geometry).radius, "radius"));
        break;
      case urdf::Geometry::MESH: {
        const auto& mesh = static_cast<const urdf::Mesh&>(*from.geometry);
        shape.file = resolved(link, mesh.filename);
        shape.place.linear() = shape.place.linear() * vector_of(mesh.scale).asDiagonal();
        break;
      }
    }
    const std::string wrong = wrong_with(shape.place);
    if (!wrong.empty()) refuse_link(link.name, "a shape: " + wrong);
    robot_.links.back().shapes.push_back(std::move(shape));
  }

  std::string resolved(const urdf::Link& link, const std::string& name) const {
    const std::string package = "package://";
    const std::string file = "file://";
    if (name.compare(0, file.size(), file) == 0) return name.substr(file.size());
    if (name.compare(0, package.size(), package) != 0) {
      if (name.find("://") != std::string::npos) {
        refuse_link(link.name, "'" + one_line(name) + "' is not read; write a path, file:// or package://");
      }
      return (fs::path(path_).parent_path() / name).string();
    }
    const std::string rest = name.substr(package.size());
    const std::size_t slash = rest.find('/');
    if (slash == std::string::npos || slash == 0) {
      refuse_link(link.name, "'" + one_line(name) + "' names no file of a package; write package://name/file");
    }
    std::error_code error;
    std::vector<fs::path> folders;
    if (!options_.packages.empty()) folders.emplace_back(options_.packages);
    for (fs::path at = fs::absolute(path_, error).parent_path();; at = at.parent_path()) {
      folders.push_back(at);
      if (!at.has_relative_path()) break;
    }
    for (const fs::path& folder : folders) {
      const fs::path whole = fs::absolute(folder, error).lexically_normal();
      const fs::path last = whole.has_filename() ? whole.filename() : whole.parent_path().filename();
      fs::path found = folder / rest;
      if (fs::is_regular_file(found, error)) return found.string();
      found = folder / rest.substr(slash + 1);
      if (last == rest.substr(0, slash) && fs::is_regular_file(found, error)) return found.string();
    }
    refuse_link(link.name, "'" + one_line(name) +
                               "' is in no folder above the file; name the folder with the package with --packages "
                               "(AssemblyLoadOptions::packages)");
  }

  // Joints.

  JointKind kind_of(const urdf::Joint& joint) const {
    switch (joint.type) {
      case urdf::Joint::FIXED:
        return JointKind::fixed;
      case urdf::Joint::REVOLUTE:
        return JointKind::revolute;
      case urdf::Joint::CONTINUOUS:
        return JointKind::continuous;
      case urdf::Joint::PRISMATIC:
        return JointKind::prismatic;
      case urdf::Joint::PLANAR:
        return JointKind::planar;
      case urdf::Joint::FLOATING:
        return JointKind::floating;
      default:
        refuse_joint(joint.name, "has a type that is not read; write revolute, continuous, prismatic or fixed");
    }
  }

  void add_joint(const urdf::Joint& from) {
    AssemblyJoint joint;
    joint.name = one_line(from.name);
    joint.kind = kind_of(from);
    joint.parent = number_.at(from.parent_link_name);
    joint.child = number_.at(from.child_link_name);
    joint.origin = pose_of(from.parent_to_joint_origin_transform);
    const std::string wrong = wrong_with(joint.origin);
    if (!wrong.empty()) refuse_joint(from.name, wrong);
    if (has_limits(joint) || joint.kind == JointKind::continuous) set_axis(joint, vector_of(from.axis));
    if (has_limits(joint)) set_limits(joint, from);
    number_of_joint_[from.name] = robot_.joints.size();
    names_of_joints_.push_back(from.name);
    robot_.joints.push_back(joint);
  }

  void set_axis(AssemblyJoint& joint, const Vec3d& axis) {
    const double greatest = axis.cwiseAbs().maxCoeff();
    if (!(greatest > 0) || !std::isfinite(greatest)) {
      refuse_joint(joint.name, "its axis is 0; write a vector of length 1, such as 0 0 1");
    }
    joint.axis = axis / greatest;
    joint.axis /= joint.axis.norm();
    if (axis.cwiseAbs().sum() == 1 && greatest == 1) joint.axis = axis;
    constexpr double rounded = 1e-4;  // of texts with some digits
    if (std::abs(axis.norm() - 1) > rounded) {
      robot_.notes.push_back("joint '" + joint.name + "': its axis has the length " + rounded_text(axis.norm()) +
                             "; taken as of length 1");
    }
  }

  void set_limits(AssemblyJoint& joint, const urdf::Joint& from) {
    if (!from.limits)
      refuse_joint(joint.name, "has no limits; add <limit> with lower and upper, or make it continuous");
    joint.lower = from.limits->lower;
    joint.upper = from.limits->upper;
    if (!std::isfinite(joint.lower) || !std::isfinite(joint.upper) || joint.lower > joint.upper) {
      refuse_joint(joint.name, "its limits are " + rounded_text(joint.lower) + " to " + rounded_text(joint.upper) +
                                   "; write lower not above upper");
    }
    if (joint.lower == 0 && joint.upper == 0) {
      robot_.notes.push_back("joint '" + joint.name +
                             "' cannot move: its limits are 0 or not there; write lower and upper");
    }
  }

  /// Resolves mimic, also of joints that follow themselves.
  /// \param name of the joint, as written
  void lead(AssemblyJoint& joint, const std::string& name, const urdf::ModelInterface& model) const {
    const urdf::Joint* at = model.joints_.at(name).get();
    if (!at->mimic || joint.kind == JointKind::fixed) return;
    if (joint.kind == JointKind::planar || joint.kind == JointKind::floating) {
      refuse_joint(joint.name, std::string("follows another, and is ") + name_of(joint.kind) + "; remove its mimic");
    }
    std::set<const urdf::Joint*> seen;
    for (; at->mimic; at = model.joints_.at(at->mimic->joint_name).get()) {
      if (!seen.insert(at).second) refuse_joint(joint.name, "follows itself; name another joint in its mimic");
      if (model.joints_.count(at->mimic->joint_name) == 0) {
        refuse_joint(at->name,
                     "follows '" + one_line(at->mimic->joint_name) + "', and there is no such joint; name another");
      }
      joint.offset += joint.multiplier * at->mimic->offset;
      joint.multiplier *= at->mimic->multiplier;
    }
    joint.leader = number_of_joint_.at(at->name);
    const JointKind kind = robot_.joints[*joint.leader].kind;
    if (kind == JointKind::fixed || kind == JointKind::planar || kind == JointKind::floating) {
      refuse_joint(joint.name,
                   "follows '" + one_line(at->name) + "', which is " + name_of(kind) + "; name another joint");
    }
    if (!std::isfinite(joint.offset) || !std::isfinite(joint.multiplier)) {
      refuse_joint(joint.name, "its multiplier or offset is not finite; write smaller ones");
    }
  }

  void set_values() {
    for (AssemblyJoint& joint : robot_.joints) {
      if (!has_limits(joint) || joint.leader) continue;
      joint.value = joint.lower > 0 ? joint.lower : joint.upper < 0 ? joint.upper : 0;
      if (joint.value == 0 || options_.joints.count(joint.name) > 0) continue;
      robot_.notes.push_back("joint '" + joint.name + "' is at " + number_text(joint.value) +
                             ", as near 0 as its limits allow; give another value with --joints");
    }
  }

  const std::string path_;
  const AssemblyLoadOptions& options_;
  Robot robot_;
  std::map<std::string, std::size_t> number_;  ///< of links
  std::map<std::string, std::size_t> number_of_joint_;
  std::vector<std::string> names_of_joints_;
};

}  // namespace

Robot read_urdf(const std::string& path, const AssemblyLoadOptions& options) {
  return UrdfReader(path, options).read();
}

}  // namespace cchip::assembly
