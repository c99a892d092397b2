// SPDX-License-Identifier: Apache-2.0
#include "robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cchip/mesh_file.hpp>
#include <map>
#include <sstream>
#include <stdexcept>

#ifdef CCHIP_HAS_TINYXML2
#include <tinyxml2.h>
#endif

namespace cchip::testing {
namespace {

constexpr double pi = 3.14159265358979323846;

void append(Mesh& mesh, const Mesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (Mesh::Face face : part.faces) {
    for (std::uint32_t& vertex : face.vertex) vertex += first;
    mesh.faces.push_back(face);
  }
}

}  // namespace

Mesh make_box(const Vec3d& size) {
  Mesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        0.5 * size.cwiseProduct(Vec3d((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1)));
  }
  constexpr std::uint32_t sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& side : sides) {
    mesh.faces.push_back({Kind::tri, {side[0], side[1], side[2], 0}});
    mesh.faces.push_back({Kind::tri, {side[0], side[2], side[3], 0}});
  }
  return mesh;
}

bool Robot::adjacent(std::size_t link_a, std::size_t link_b) const {
  const std::size_t a = links_.at(link_a).body;
  const std::size_t b = links_.at(link_b).body;
  return a == b || std::any_of(joints_.begin(), joints_.end(), [&](const Joint& joint) {
           const std::size_t parent = links_[joint.parent].body;
           const std::size_t child = links_[joint.child].body;
           return (parent == a && child == b) || (parent == b && child == a);
         });
}

std::vector<Pose> Robot::poses(const std::vector<double>& values) const {
  std::vector<RigidPose> placed(links_.size(), RigidPose::Identity());
  for (const Joint& joint : joints_) {
    RigidPose pose = placed[joint.parent] * joint.origin;
    if (!joint.fixed) {
      const double value = joint.factor * values.at(joint.axis) + joint.offset;
      if (joint.turns) {
        pose = pose * Eigen::AngleAxisd(value, joint.direction);
      } else {
        pose = pose * Eigen::Translation3d(value * joint.direction);
      }
    }
    placed[joint.child] = pose;
  }
  return {placed.begin(), placed.end()};
}

#ifdef CCHIP_HAS_TINYXML2

namespace {

using tinyxml2::XMLElement;

/// Reads elements of one file; its messages say where.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file.string()) {}

  [[noreturn]] void fail(const XMLElement& place, const std::string& what) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", file_, place.GetLineNum(), what));
  }
  const XMLElement& child(const XMLElement& element, const char* name) const {
    const XMLElement* found = element.FirstChildElement(name);
    if (found == nullptr) fail(element, fmt::format("<{}> without <{}>; correct the URDF", element.Name(), name));
    return *found;
  }
  std::string text(const XMLElement& element, const char* name) const {
    const char* found = element.Attribute(name);
    if (found == nullptr)
      fail(element, fmt::format("<{}> without attribute {}; correct the URDF", element.Name(), name));
    return found;
  }
  /// `otherwise` if the attribute is not there.
  double number(const XMLElement& element, const char* name, double otherwise) const {
    double value = otherwise;
    const tinyxml2::XMLError error = element.QueryDoubleAttribute(name, &value);
    if (error != tinyxml2::XML_SUCCESS && error != tinyxml2::XML_NO_ATTRIBUTE) {
      fail(element, fmt::format("attribute {} is no number; correct the URDF", name));
    }
    return value;
  }
  Vec3d vector(const XMLElement& element, const char* name, const Vec3d& otherwise) const {
    const char* found = element.Attribute(name);
    if (found == nullptr) return otherwise;
    std::istringstream words(found);
    words.imbue(std::locale::classic());
    Vec3d value;
    if (!(words >> value[0] >> value[1] >> value[2]) || !(words >> std::ws).eof()) {
      fail(element, fmt::format("attribute {} is not three numbers; correct the URDF", name));
    }
    return value;
  }
  /// That of the child <origin>, if there is one.
  RigidPose origin(const XMLElement& element) const {
    const XMLElement* found = element.FirstChildElement("origin");
    if (found == nullptr) return RigidPose::Identity();
    return make_pose(vector(*found, "xyz", Vec3d::Zero()), vector(*found, "rpy", Vec3d::Zero()) * (180 / pi));
  }
  Mesh collision_mesh(const XMLElement& link, const std::filesystem::path& package) const {
    Mesh result;
    result.name = text(link, "name");
    for (const XMLElement* x = link.FirstChildElement("collision"); x != nullptr;
         x = x->NextSiblingElement("collision")) {
      const XMLElement& geometry = child(*x, "geometry");
      const XMLElement* shape = geometry.FirstChildElement();
      const std::string kind = shape == nullptr ? "nothing" : shape->Name();
      Mesh part;
      Vec3d scale = Vec3d::Ones();
      if (kind == "box") {
        part = make_box(vector(*shape, "size", Vec3d::Ones()));
      } else if (kind == "mesh") {
        part = load_mesh(path(*shape, text(*shape, "filename"), package));
        scale = vector(*shape, "scale", Vec3d::Ones());
      } else {
        fail(geometry, fmt::format("collision geometry is {}; choose a robot with boxes and meshes only", kind));
      }
      append(result, transformed(part, Pose(origin(*x)) * Eigen::Scaling(scale)));
    }
    return result;
  }

 private:
  std::string path(const XMLElement& place, const std::string& name, const std::filesystem::path& package) const {
    constexpr std::string_view scheme = "package://";
    std::filesystem::path result = std::filesystem::path(file_).parent_path() / name;
    if (name.rfind(scheme, 0) == 0) {
      const std::size_t slash = name.find('/', scheme.size());
      if (slash == std::string::npos) fail(place, fmt::format("no file in '{}'; correct the URDF", name));
      result = package / name.substr(slash + 1);
    }
    if (!std::filesystem::is_regular_file(result)) {
      fail(place, fmt::format("no mesh {}; install the robots again: scripts/run robots", result.string()));
    }
    return result.string();
  }

  std::string file_;
};

}  // namespace

Robot::Robot(const std::filesystem::path& urdf, const std::filesystem::path& package) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(urdf.c_str()) == tinyxml2::XML_ERROR_FILE_NOT_FOUND) {
    throw std::runtime_error(urdf.string() + ": no such file; install the robots: scripts/run robots");
  }
  if (document.Error()) {
    throw std::runtime_error(fmt::format("{}:{}: {}; install the robots again: scripts/run robots", urdf.string(),
                                         document.ErrorLineNum(), document.ErrorName()));
  }
  const Reader read(urdf);
  const XMLElement* root = document.FirstChildElement("robot");
  if (root == nullptr) throw std::runtime_error(urdf.string() + ": no <robot>; give a URDF");

  std::map<std::string, std::size_t> number;
  for (const XMLElement* x = root->FirstChildElement("link"); x != nullptr; x = x->NextSiblingElement("link")) {
    const std::string name = read.text(*x, "name");
    if (!number.try_emplace(name, links_.size()).second) read.fail(*x, fmt::format("second link '{}'", name));
    links_.push_back({name, read.collision_mesh(*x, package), links_.size()});
  }
  const auto link = [&](const XMLElement& joint, const char* which) {
    const XMLElement& element = read.child(joint, which);
    const auto found = number.find(read.text(element, "link"));
    if (found == number.end()) read.fail(element, "no link of this name; correct the URDF");
    return found->second;
  };
  std::map<std::string, std::size_t> axis_of;
  std::vector<std::pair<std::size_t, const XMLElement*>> mimics;
  for (const XMLElement* x = root->FirstChildElement("joint"); x != nullptr; x = x->NextSiblingElement("joint")) {
    Joint joint;
    joint.parent = link(*x, "parent");
    joint.child = link(*x, "child");
    joint.origin = read.origin(*x);
    const std::string type = read.text(*x, "type");
    joint.fixed = type == "fixed";
    joint.turns = type == "revolute" || type == "continuous";
    if (!joint.fixed && !joint.turns && type != "prismatic") {
      read.fail(*x, fmt::format("joint of type {}; choose a robot of fixed, revolute and prismatic ones", type));
    }
    if (!joint.fixed) {
      const XMLElement* axis = x->FirstChildElement("axis");
      if (axis != nullptr) joint.direction = read.vector(*axis, "xyz", Vec3d::UnitX());
      if (!(joint.direction.norm() > 0)) read.fail(*x, "the axis of the joint has no direction; correct the URDF");
      joint.direction.normalize();
      if (const XMLElement* mimic = x->FirstChildElement("mimic")) {
        joint.factor = read.number(*mimic, "multiplier", 1);
        joint.offset = read.number(*mimic, "offset", 0);
        mimics.emplace_back(joints_.size(), mimic);
      } else {
        const XMLElement* limit = x->FirstChildElement("limit");
        Axis free = {read.text(*x, "name"), -pi, pi};
        if (type != "continuous" && limit == nullptr) read.fail(*x, "joint without <limit>; correct the URDF");
        if (type != "continuous") {
          free.lower = read.number(*limit, "lower", 0);
          free.upper = read.number(*limit, "upper", 0);
        }
        if (!(free.lower <= free.upper)) read.fail(*x, "lower limit above the upper one; correct the URDF");
        joint.axis = axes_.size();
        axis_of[free.joint] = joint.axis;
        axes_.push_back(free);
      }
    }
    joints_.push_back(joint);
  }
  for (const auto& [joint, mimic] : mimics) {
    const auto found = axis_of.find(read.text(*mimic, "joint"));
    if (found == axis_of.end()) read.fail(*mimic, "no joint with limits of this name; correct the URDF");
    joints_[joint].axis = found->second;
  }

  // From the root on, a joint once its parent is placed.
  std::vector<bool> is_child(links_.size());
  for (const Joint& joint : joints_) {
    if (is_child[joint.child]) read.fail(*root, fmt::format("two joints move link '{}'", links_[joint.child].name));
    is_child[joint.child] = true;
  }
  std::vector<bool> placed(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i) placed[i] = !is_child[i];
  if (std::count(placed.begin(), placed.end(), true) != 1) {
    read.fail(*root, "the links are not one tree; correct the URDF");
  }
  std::vector<Joint> sorted;
  while (sorted.size() < joints_.size()) {
    const std::size_t before = sorted.size();
    for (const Joint& joint : joints_) {
      if (!placed[joint.parent] || placed[joint.child]) continue;
      placed[joint.child] = true;
      if (joint.fixed) links_[joint.child].body = links_[joint.parent].body;
      sorted.push_back(joint);
    }
    if (sorted.size() == before) read.fail(*root, "the links are not one tree; correct the URDF");
  }
  joints_ = std::move(sorted);
}

#else

Robot::Robot(const std::filesystem::path& urdf, const std::filesystem::path& /*package*/) {
  throw std::runtime_error(urdf.string() +
                           ": cannot be read, this program was built without Debian's libtinyxml2-dev; install it with "
                           "scripts/bootstrap --dev, then run scripts/run bench-robot");
}

#endif

}  // namespace cchip::testing
