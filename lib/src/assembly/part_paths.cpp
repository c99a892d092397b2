// SPDX-License-Identifier: Apache-2.0
#include "part_paths.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cchip/internal/geometry/quarter_turns.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "kinematics.hpp"

namespace cchip::assembly {
namespace {

using JointKind = AssemblyJoint::Kind;

/// Covers the rounding of sums and products of bounds.
constexpr double rounded_up = 1 + 0x1p-40;
/// Covers what a rotation and a product of poses, both rounded, move a point at distance 1: some 2^-50.
constexpr double pose_error = 0x1p-45;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void check_rows(std::size_t rows, std::size_t columns, const std::vector<std::string>& names) {
  if (rows == 0) refuse("the path has no row; give one at least");
  if (columns == 0) refuse("the path moves nothing; name a joint or a part");
  if (std::set<std::string>(names.begin(), names.end()).size() != names.size()) {
    refuse("the path names a joint or part twice; name each once");
  }
}

/// The row before a time, but not the last if there are two, and the rest.
std::pair<std::size_t, double> row_and_rest(double time, std::size_t rows) {
  const auto row = std::min(static_cast<std::size_t>(time), rows < 2 ? 0 : rows - 2);
  return {row, time - static_cast<double>(row)};
}

/// Vertices that faces use; those of no face are of no part.
std::vector<Vec3d> points_of(const Object& object, const Pose& pose) {
  std::vector<Vec3d> points;
  std::vector<bool> seen(object.mesh().vertices.size(), false);
  for (const Mesh::Face& face : object.mesh().faces) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(face.kind); ++i) {
      if (seen[face.vertex[i]]) continue;
      seen[face.vertex[i]] = true;
      points.push_back(pose * object.mesh().vertices[face.vertex[i]]);
    }
  }
  return points;
}

/// A bound of the numbers that are added when vertices are posed, also if they cancel.
double reach_of(const Object& object, const Pose& pose) {
  double greatest = 0;
  for (const Vec3d& v : object.mesh().vertices) greatest = std::max(greatest, v.norm());
  return pose.linear().norm() * greatest + pose.translation().norm();
}

/// Joints that move.
class RobotPaths : public PartPaths {
 public:
  RobotPaths(const Assembly& assembly, const AssemblyMotion& motion) : assembly_(assembly) {
    check_rows(motion.values.size(), motion.joints.size(), motion.joints);
    for (std::size_t row = 0; row < motion.values.size(); ++row) {
      if (motion.values[row].size() != motion.joints.size()) {
        refuse("row " + std::to_string(row) +
               " of the path has another number of values than joints; give one for each");
      }
      std::map<std::string, double> named;
      for (std::size_t i = 0; i < motion.joints.size(); ++i) named[motion.joints[i]] = motion.values[row][i];
      try {
        values_.push_back(joint_values(assembly, named));
      } catch (const std::invalid_argument& error) {
        refuse("row " + std::to_string(row) + " of the path: " + error.what());
      }
    }
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
      double most = 0;
      for (const std::vector<double>& row : values_) most = std::max(most, std::abs(row[i]));
      most_.push_back(most);
    }
    carrier_.resize(assembly.links.size());
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) carrier_[assembly.joints[i].child] = i;
    link_of_.resize(assembly.parts.size());
    for (std::size_t i = 0; i < assembly.links.size(); ++i) {
      if (assembly.links[i].part) link_of_[*assembly.links[i].part] = i;
    }
  }

  std::size_t rows() const override { return values_.size(); }

  std::pair<Pose, Pose> poses(std::size_t a, std::size_t b, double time) const override {
    const auto [row, rest] = row_and_rest(time, rows());
    std::vector<double> at = values_[row];
    for (std::size_t i = 0; rest > 0 && i < at.size(); ++i) {
      const double next = values_[row + 1][i];
      at[i] = rest == 1 ? next : at[i] + rest * (next - at[i]);
    }
    const std::vector<Pose> links = link_poses(assembly_, at);
    return {links[link_of_[a]] * place(a), links[link_of_[b]] * place(b)};
  }

  PairPath path_of(std::size_t a, std::size_t b) const override {
    std::vector<std::size_t> up_a = chain(link_of_[a]);
    std::vector<std::size_t> up_b = chain(link_of_[b]);
    PairPath path;
    path.rounding = rounding(a, up_a) + rounding(b, up_b);
    while (!up_a.empty() && !up_b.empty() && up_a.back() == up_b.back()) {  // what moves both
      up_a.pop_back();
      up_b.pop_back();
    }
    path.speed.assign(rows() - 1, 0);
    add_speeds(a, up_a, path.speed);
    add_speeds(b, up_b, path.speed);
    return path;
  }

  std::vector<std::string> notes() const override {
    for (std::size_t row = 0; row < rows(); ++row) {
      std::vector<std::string> notes = followers_beyond_limits(assembly_, values_[row]);
      for (std::string& note : notes) note = "row " + std::to_string(row) + " of the path: " + note;
      if (!notes.empty()) return notes;
    }
    return {};
  }

 private:
  const Pose& place(std::size_t part) const { return assembly_.links[link_of_[part]].place; }

  /// Joints from a link to the root.
  std::vector<std::size_t> chain(std::size_t link) const {
    std::vector<std::size_t> joints;
    while (carrier_[link]) {
      joints.push_back(*carrier_[link]);
      link = assembly_.joints[*carrier_[link]].parent;
    }
    return joints;
  }

  double rounding(std::size_t part, const std::vector<std::size_t>& joints) const {
    double reach = reach_of(assembly_.parts[part].object, place(part));
    double errors = 1;
    for (const std::size_t i : joints) {
      const AssemblyJoint& joint = assembly_.joints[i];
      reach += joint.origin.translation().norm() + (joint.kind == JointKind::prismatic ? most_[i] : 0);
      errors += 1 + most_[i];
    }
    return pose_error * reach * errors;
  }

  /// Points of the part are held in a ball, which grows from joint to joint: that is where they may be.
  void add_speeds(std::size_t part, const std::vector<std::size_t>& joints, std::vector<double>& speeds) const {
    std::vector<Vec3d> points = points_of(assembly_.parts[part].object, place(part));
    bool rigid = true;  // `points` hold, not the ball
    Vec3d centre = Vec3d::Zero();
    double radius = 0;
    for (const std::size_t i : joints) {
      const AssemblyJoint& joint = assembly_.joints[i];
      const Vec3d& axis = joint.axis;
      const bool slides = joint.kind == JointKind::prismatic;
      const bool turns = joint.kind == JointKind::revolute || joint.kind == JointKind::continuous;
      double arm = slides ? 1 : 0;  // how far a point moves at most when the joint moves by 1
      if (rigid && (slides || turns)) {
        centre = Vec3d::Zero();
        for (const Vec3d& p : points) centre += p / static_cast<double>(points.size());
        if (turns) centre = centre.dot(axis) * axis;
        for (const Vec3d& p : points) {
          radius = std::max(radius, (p - centre).norm());
          if (turns) arm = std::max(arm, axis.cross(p).norm());
        }
        rigid = false;
      } else if (turns) {
        const double off_axis = axis.cross(centre).norm();
        radius += off_axis;
        arm = radius;
        centre = centre.dot(axis) * axis;
      }
      if (slides) radius += most_[i];
      for (std::size_t row = 0; arm > 0 && row < speeds.size(); ++row) {
        speeds[row] += arm * std::abs(values_[row + 1][i] - values_[row][i]) * rounded_up;
      }
      if (rigid) {
        for (Vec3d& p : points) p = joint.origin * p;
      } else {
        centre = joint.origin * centre;
      }
    }
  }

  const Assembly& assembly_;
  std::vector<std::vector<double>> values_;  ///< for each row one for each joint
  std::vector<double> most_;                 ///< for each joint the greatest absolute value
  std::vector<std::optional<std::size_t>> carrier_;
  std::vector<std::size_t> link_of_;
};

/// Parts that move by themselves.
class FreePaths : public PartPaths {
 public:
  FreePaths(const Assembly& assembly, const AssemblyMotion& motion)
      : assembly_(assembly), rows_(motion.moves.size()), column_(assembly.parts.size()) {
    check_rows(rows_, motion.parts.size(), motion.parts);
    for (std::size_t i = 0; i < motion.parts.size(); ++i) {
      const auto found = std::find_if(assembly.parts.begin(), assembly.parts.end(),
                                      [&](const AssemblyPart& part) { return part.name == motion.parts[i]; });
      if (found == assembly.parts.end()) {
        refuse("the path moves '" + motion.parts[i] + "', and there is no such part; correct the name");
      }
      column_[static_cast<std::size_t>(found - assembly.parts.begin())] = i;
    }
    columns_.resize(motion.parts.size());
    for (std::size_t row = 0; row < rows_; ++row) {
      if (motion.moves[row].size() != motion.parts.size()) {
        refuse("row " + std::to_string(row) + " of the path has another number of moves than parts; give one for each");
      }
      for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i].push_back(step_of(motion.moves[row][i], row));
    }
    for (std::vector<Step>& column : columns_) {
      for (std::size_t row = 0; row + 1 < rows_; ++row) {
        const Eigen::AngleAxisd turn(Eigen::Matrix3d(column[row].rotation.transpose() * column[row + 1].rotation));
        column[row].angle = turn.angle();
        column[row].axis = turn.axis();
      }
    }
  }

  std::size_t rows() const override { return rows_; }

  std::pair<Pose, Pose> poses(std::size_t a, std::size_t b, double time) const override {
    return {pose(a, time), pose(b, time)};
  }

  PairPath path_of(std::size_t a, std::size_t b) const override {
    PairPath path;
    path.speed.assign(rows_ - 1, 0);
    path.rounding = add_speeds(a, path.speed) + add_speeds(b, path.speed);
    for (std::size_t row = 0; row < path.speed.size(); ++row) {
      if (move_together(a, b, row) && move_together(a, b, row + 1)) path.speed[row] = 0;
    }
    return path;
  }

 private:
  struct Step {
    Eigen::Matrix3d rotation;
    Vec3d translation;
    double angle = 0;  ///< to the next row, about `axis` before the rotation
    Vec3d axis = Vec3d::UnitX();
  };

  static Step step_of(const RigidPose& move, std::size_t row) {
    const Eigen::Matrix3d rotation = move.linear();
    const Eigen::Matrix3d clean = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
    constexpr double written = 1e-9;  // rounded texts
    if (!move.matrix().allFinite() || !((clean - rotation).cwiseAbs().maxCoeff() <= written)) {
      refuse("row " + std::to_string(row) + " of the path: a move is no rotation and translation; write one");
    }
    return {snapped(clean), move.translation()};
  }

  bool move_together(std::size_t a, std::size_t b, std::size_t row) const {
    if (!column_[a] || !column_[b]) return false;
    const Step& x = columns_[*column_[a]][row];
    const Step& y = columns_[*column_[b]][row];
    return x.rotation == y.rotation && x.translation == y.translation;
  }

  Pose pose(std::size_t part, double time) const {
    if (!column_[part]) return assembly_.parts[part].pose;
    const std::vector<Step>& column = columns_[*column_[part]];
    const auto [row, rest] = row_and_rest(time, rows_);
    const Step& from = column[rest == 1 ? row + 1 : row];
    Pose move = Pose::Identity();
    move.linear() = from.rotation;
    move.translation() = from.translation;
    if (rest > 0 && rest < 1) {
      move.linear() = from.rotation * Eigen::AngleAxisd(rest * from.angle, from.axis).toRotationMatrix();
      move.translation() += rest * (column[row + 1].translation - from.translation);
    }
    return move * assembly_.parts[part].pose;
  }

  /// \returns the rounding
  double add_speeds(std::size_t part, std::vector<double>& speeds) const {
    const std::vector<Vec3d> points = points_of(assembly_.parts[part].object, assembly_.parts[part].pose);
    const double reach = reach_of(assembly_.parts[part].object, assembly_.parts[part].pose);
    if (!column_[part]) return pose_error * reach;
    const std::vector<Step>& column = columns_[*column_[part]];
    double farthest = 0;
    for (const Step& step : column) farthest = std::max(farthest, step.translation.norm());
    for (std::size_t row = 0; row < speeds.size(); ++row) {
      double arm = 0;
      const bool turns = column[row].rotation != column[row + 1].rotation;
      for (std::size_t i = 0; turns && i < points.size(); ++i) {
        arm = std::max(arm, column[row].axis.cross(points[i]).norm());
      }
      const double way = (column[row + 1].translation - column[row].translation).norm();
      speeds[row] += (way + (turns ? arm * column[row].angle : 0)) * rounded_up;
    }
    constexpr double of_turns = 8;  // an angle out of a rounded matrix
    return of_turns * pose_error * (reach + farthest);
  }

  const Assembly& assembly_;
  std::size_t rows_;
  std::vector<std::optional<std::size_t>> column_;  ///< for each part
  std::vector<std::vector<Step>> columns_;
};

}  // namespace

std::unique_ptr<PartPaths> part_paths(const Assembly& assembly, const AssemblyMotion& motion) {
  if (!assembly.links.empty()) {
    if (!motion.parts.empty()) refuse("the assembly is a robot, whose parts do not move by themselves; name joints");
    return std::make_unique<RobotPaths>(assembly, motion);
  }
  if (!motion.joints.empty()) refuse("the assembly is no robot, so it has no joints; name parts");
  return std::make_unique<FreePaths>(assembly, motion);
}

}  // namespace cchip::assembly
