// SPDX-License-Identifier: Apache-2.0
#include "distance.hpp"

#include <fmt/format.h>

#include <cchip/along.hpp>
#include <cchip/distance.hpp>
#include <cchip/internal/geometry/decimal.hpp>
#include <cchip/program/usage_error.hpp>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "mesh_source.hpp"
#include "pose.hpp"

namespace cchip::app {
namespace {

/// The value of an option in a range whose upper end may belong to it or not.
double parse_range(const std::string& option, const std::string& text, bool below_1) {
  const std::optional<double> number = read_decimal(text);
  if (number && std::isfinite(*number) && *number >= 0 && !(below_1 && *number >= 1)) return *number;
  throw UsageError(fmt::format("{}: got '{}'; write a number that is at least 0{}", option, text,
                               below_1 ? " and less than 1" : ""));
}

DistanceRequest request_of(const DistanceOptions& options) {
  DistanceRequest request;
  if (!options.relative_error.empty()) {
    request.rel_error = parse_range("--relative-error", options.relative_error, true);
  }
  if (!options.stop_above.empty()) request.stop_above = parse_range("--stop-above", options.stop_above, false);
  return request;
}

/// Both objects in their places, and what is asked about them.
struct Scene {
  Object a;
  Object b;
  Pose pose_b;
};

/// One row in the format of the command; a table has the answer in words above it.
void write_answer(const std::string& answer, const std::vector<std::string>& names, const std::vector<Cell>& cells,
                  Format format, const Streams& streams) {
  if (format == Format::table) streams.out << answer << '\n';
  // In a table a row without faces has nothing to add.
  if (format == Format::table && std::holds_alternative<std::monostate>(cells.back())) return;
  const auto writer = make_row_writer(format, streams.out, names);
  writer->write(cells);
  writer->flush();
}

/// \param picture gets both meshes with the line between the nearest points, if it is not null
void write_distance(const Scene& scene, const DistanceRequest& request, Format format, const Streams& streams,
                    HitPicture* picture) {
  const DistanceResult result = distance(scene.a, Pose::Identity(), scene.b, scene.pose_b, request);
  const bool stopped = std::isinf(result.upper) && result.lower == request.stop_above;
  const std::string answer = result.upper == 0          ? "distance 0: they touch or cross"
                             : std::isinf(result.upper) ? fmt::format("distance above {}", result.lower)
                             : result.lower == result.upper
                                 ? fmt::format("distance {}", result.lower)
                                 : fmt::format("distance from {} to {}", result.lower, result.upper);
  std::vector<Cell> cells = {result.lower, result.upper};
  if (stopped) {
    cells.resize(10);
  } else {
    const auto add = [&cells](std::uint32_t face, const Vec3d& point) {
      cells.emplace_back(std::uint64_t{face});
      for (const double x : point) cells.emplace_back(x);
    };
    add(result.face_a, result.point_a);
    add(result.face_b, result.point_b);
  }
  if (picture != nullptr) {
    if (!stopped) picture->add_curve({result.point_a, result.point_b}, false);
    picture->write(scene.a.mesh(), transformed(scene.b.mesh(), scene.pose_b));
  }
  write_answer(answer, {"lower", "upper", "face_a", "ax", "ay", "az", "face_b", "bx", "by", "bz"}, cells, format,
               streams);
}

/// Objects that touch are asked when they are clear, others when they meet.
void write_along(const Scene& scene, const Vec3d& direction, Format format, const Streams& streams) {
  AlongResult result = first_contact(scene.a, Pose::Identity(), scene.b, scene.pose_b, direction);
  const bool touch_now = result.touches && result.upper == 0;
  if (touch_now) result = clear_along(scene.a, Pose::Identity(), scene.b, scene.pose_b, direction);
  const std::string word = touch_now ? "clear" : result.touches ? "touch" : "never";
  const std::string answer =
      word == "never" ? "they never touch in this direction"
                      : fmt::format("{} after {} times the direction", word, result.factor) +
                            (result.lower == result.upper
                                 ? ""
                                 : fmt::format(", rounded: it is from {} to {}", result.lower, result.upper));
  std::vector<Cell> cells = {word, Cell(), Cell(), Cell(), Cell(), Cell()};
  if (result.touches) {
    cells = {
        word, result.factor, result.lower, result.upper, std::uint64_t{result.face_a}, std::uint64_t{result.face_b}};
  }
  write_answer(answer, {"answer", "factor", "lower", "upper", "face_a", "face_b"}, cells, format, streams);
}

}  // namespace

int run_distance(const DistanceOptions& options, const Streams& streams) {
  check_standard_input({options.file_a, options.file_b});
  check_picture_name(options.ply);
  std::optional<HitPicture> picture;
  if (!options.ply.empty()) picture.emplace(options.ply);
  const DistanceRequest request = request_of(options);
  std::optional<Vec3d> direction;
  if (!options.along.empty()) direction = parse_direction(options.along);
  const Pose pose = parse_pose_options(options.pose, options.pose_matrix);
  MeshReader reader(streams, options.lenient, options.single);
  const Scene scene = {reader.read_object(options.file_a), reader.read_object(options.file_b), pose};
  try {
    if (direction) {
      write_along(scene, *direction, options.format, streams);
    } else {
      write_distance(scene, request, options.format, streams, picture ? &*picture : nullptr);
    }
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return reader.faces_left_out() > 0 ? exit_left_out : exit_ok;
}

}  // namespace cchip::app
