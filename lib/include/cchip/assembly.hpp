// SPDX-License-Identifier: Apache-2.0
/// \file
/// Is an assembly as it should be: do only those parts meet that may, and are others far enough apart?
/// docs/cpp/clash.md
///
/// Verdicts are exact for the doubles of meshes and poses, in real arithmetic. Link collisionchip::assembly.
#ifndef CCHIP_ASSEMBLY_HPP
#define CCHIP_ASSEMBLY_HPP

#include <array>
#include <cchip/collide.hpp>
#include <cchip/object.hpp>
#include <cchip/pose.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cchip {

/// A placed object. A mesh that is placed twice is two parts with copies of one Object.
struct AssemblyPart {
  std::string name;  ///< no two parts of an assembly have the same
  Object object;
  Pose pose = Pose::Identity();  ///< from the coordinates of the mesh to those of the assembly, the unit included
  std::vector<std::string> groups = {};
  std::string file = {};  ///< where the mesh is from; for messages
};

/// What the parts of some pairs may do, or must.
struct AssemblyRule {
  enum class Kind {
    nothing,    ///< they must not touch
    touching,   ///< they may touch; they must share no volume
    overlap,    ///< they may overlap if a translation of at most `limit` along a normal of a face in contact parts them
    anything,   ///< they may do what they like, for a reason
    clearance,  ///< they must be at least `limit` apart
    inside,     ///< the first must be inside the second
    same        ///< they must be the same volume in the same place
  };
  /// Two names of parts, or two groups, or both empty: all pairs. With Kind::inside the order counts.
  std::vector<std::string> parts = {};
  std::vector<std::string> groups = {};
  Kind kind = Kind::nothing;
  double limit = 0;         ///< in units of the assembly
  std::string reason = {};  ///< for people; Kind::anything must have one
  std::string place = {};   ///< "file:line", for messages
  bool optional =
      false;  ///< not reported if it never counts, as those of an SRDF, which lists what may not meet at all
};
/// The name of the enumerator, such as "touching".
const char* name_of(AssemblyRule::Kind kind);

/// A body of a robot, a `link` of URDF.
struct AssemblyLink {
  std::string name;
  std::optional<std::size_t> part = std::nullopt;  ///< the part that it carries; none: it has no shape
  Pose place = Pose::Identity();                   ///< from the coordinates of the part's mesh to those of the link
};

/// What joins a link to the one that carries it.
struct AssemblyJoint {
  enum class Kind { fixed, revolute, continuous, prismatic, planar, floating };
  std::string name;
  Kind kind = Kind::fixed;
  std::size_t parent = 0;          ///< numbers of links
  std::size_t child = 0;           ///< in the joint's coordinates; not carried by any other joint
  Pose origin = Pose::Identity();  ///< from the coordinates of the joint to those of the parent
  Vec3d axis = Vec3d(1, 0, 0);     ///< of length 1 but for rounding, in the joint's coordinates
  double lower = 0;                ///< of revolute and prismatic joints, in radians or units of the assembly
  double upper = 0;
  std::optional<std::size_t> leader =
      std::nullopt;  ///< the joint it follows, which follows none: value = multiplier leader + offset
  double multiplier = 1;
  double offset = 0;
  double value = 0;  ///< how far it is moved
};
/// The name of the enumerator, such as "revolute".
const char* name_of(AssemblyJoint::Kind kind);

/// Of the rules for a pair one counts: one that names both parts before one of two groups, that before one for all
/// pairs; of several that are equally special the last. A pair without any must not touch, and is at least `clearance`
/// apart.
struct Assembly {
  std::vector<AssemblyPart> parts;
  std::vector<AssemblyRule> rules;
  double clearance = 0;
  std::string unit;                        ///< um, mm, cm, m, in or ft; empty: not known
  std::size_t faces_left_out = 0;          ///< with AssemblyLoadOptions::lenient
  std::vector<std::string> notes;          ///< of the files: what was left out, a line each
  std::vector<AssemblyLink> links = {};    ///< of a robot, the root first; empty: it is none
  std::vector<AssemblyJoint> joints = {};  ///< of a robot, each behind the one that carries its parent
  /// Pairs a < b of parts that are not looked at unless a rule names both and wants more than Kind::anything.
  std::vector<std::pair<std::size_t, std::size_t>> left_out = {};
};

struct AssemblyLoadOptions {
  std::string unit;      ///< of the assembly, in place of what the file says: its numbers are taken to be in this unit
  std::string rules;     ///< a TOML file whose rules come behind those of the assembly; empty: none
  bool lenient = false;  ///< as LoadOptions::lenient
  /// As LoadOptions::most_unpacked_bytes; of glTF and 3MF the numbers of all meshes count.
  std::uint64_t most_unpacked_bytes = std::uint64_t{1} << 32;
  // Of URDF:
  std::map<std::string, double> joints =
      {};  ///< values by name, radians or metres; others are as near 0 as they may be
  std::string packages =
      {};                 ///< a folder of packages, for package://; empty, and if it is not there: those above the file
  std::string srdf = {};  ///< a file whose disable_collisions become rules Kind::anything; empty: none
  bool neighbours = false;  ///< pairs of links that a joint joins are not left out
};

/// Reads an assembly: a TOML file by the schema of docs/cpp/clash.md; a folder, in which each mesh file is a part named
/// as the file, in the coordinates of the assembly; an OBJ, in which each `o` is a part; a glTF or GLB, in which each
/// node with triangles of the chosen scene is one, named by the path of nodes, in metres; a 3MF, in which each mesh
/// that its build places is one, in its unit; or a URDF, in which each link with collision shapes is one, in metres. A
/// name that is there already gets a number: "bolt", "bolt#2". Each mesh is read and built once.
/// \throws std::runtime_error one line: file, line if it has one, what is wrong, what to do. Fewer than two parts and a
///         part without a face are errors, too.
Assembly load_assembly(const std::string& path, const AssemblyLoadOptions& options = {});

/// Moves the joints of a robot, and its parts with them. A joint that is not named keeps its value; one that follows
/// another moves with it.
/// \returns notes: joints that follow others beyond their own limits
/// \throws std::invalid_argument no such joint; it follows another; it is planar or floating; a value is not finite or
///         beyond its limits. Nothing is moved then.
std::vector<std::string> move_joints(Assembly& assembly, const std::map<std::string, double>& values);

/// The rules of a TOML file that has no parts.
/// \throws std::runtime_error as load_assembly()
std::vector<AssemblyRule> load_rules(const std::string& path);

/// How two parts lie to each other.
enum class PairVerdict {
  apart,
  too_near,  ///< apart, but less than the clearance
  touching,  ///< they share a point, and no volume
  overlap,   ///< they share volume; of surfaces that are open: they cross
  a_in_b,    ///< all of A is in B
  b_in_a,
  duplicate  ///< the same volume, or the same open mesh, in the same place
};
/// The name of the enumerator, such as "too_near".
const char* name_of(PairVerdict verdict);

/// A translation of B that parts it from A.
struct PartingWay {
  Vec3d direction = Vec3d::Zero();  ///< in the world, of length 1 but for rounding
  double depth = 0;                 ///< how far at most, in units of the assembly
};

struct AssemblyPair {
  std::size_t a = 0;  ///< numbers of parts, a < b
  std::size_t b = 0;
  PairVerdict verdict = PairVerdict::apart;
  std::optional<std::size_t> rule = std::nullopt;  ///< the number of the rule that counts; none: the assembly's default
  bool is_violation = false;
  /// False if the parts are not closed, or their shells overlap, so that they may clash although nothing shows it;
  /// `note` says why.
  bool is_judged = true;
  /// Of parts that overlap: the least of the ways that were tried, or the first that the rule accepts. With a rule that
  /// accepts an overlap, none if no normal of a face in contact gives one.
  std::optional<PartingWay> way = std::nullopt;
  /// Of parts that are too near: bounds of their distance and nearest points, as in DistanceResult.
  double distance_lower = 0;
  double distance_upper = 0;
  std::array<Vec3d, 2> nearest = {Vec3d::Zero(), Vec3d::Zero()};
  std::string note = {};  ///< what else one must know, such as that a mesh is open; empty: nothing
};

struct AssemblyReport {
  std::size_t judged = 0;  ///< pairs that were looked at: close by, or with a rule that wants something
  /// Those of them that are not apart, are violations or could not be judged; ascending.
  std::vector<AssemblyPair> pairs;
  std::size_t violations = 0;
  std::size_t accepted = 0;  ///< pairs that are not apart and that a rule accepts
  std::size_t not_judged = 0;
  /// Numbers of rules that never counted: those that allow something if no pair does it, others if they are about no
  /// pair.
  std::vector<std::size_t> unused_rules;
  std::vector<std::string> notes;          ///< about parts: open meshes, sizes that differ 1,000 times
  std::array<double, 3> size = {0, 0, 0};  ///< of the box around all parts, in units of the assembly
};

struct AssemblyCheckOptions {
  unsigned threads = 0;  ///< 0: as many as there are cores; the report does not depend on it
  /// Normals of faces in contact that are tried for a pair of which a rule accepts an overlap, those of most contacts
  /// first. Of others, where the depth decides nothing, it is that of a way on which all of B gets past all of A.
  std::size_t most_normals = 100;
};

/// Looks at all pairs whose boxes overlap, that may be nearer than their clearance, or of which a rule wants something.
/// Closed meshes are solids, as solids() takes them, by the rule InsideRule::odd; where shells of a mesh overlap and
/// nothing is found, by the rule InsideRule::nonzero as well. Open meshes are surfaces. Each pair is asked about once;
/// a pair that overlaps takes up to 2 most_normals times clear_along() besides.
/// \throws std::invalid_argument a name is there twice; a rule or the clearance makes no sense; as solids()
AssemblyReport check(const Assembly& assembly, const AssemblyCheckOptions& options = {});

/// The verdict in words, with names, numbers and unit: "lid overlaps box: ...".
std::string sentence(const Assembly& assembly, const AssemblyPair& pair);
/// Why a rule never counted.
std::string why_unused(const Assembly& assembly, std::size_t rule);

/// A TOML file with a rule for each pair of the report that meets or is too near, so that it is accepted as it is and
/// another one is not. load_rules() reads it.
std::string accepting_rules(const Assembly& assembly, const AssemblyReport& report);

}  // namespace cchip

#endif
