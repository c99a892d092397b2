// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/collide/collide.hpp>
#include <cchip/collide/face_pairs.hpp>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "edges.hpp"
#include "float_mode.hpp"

namespace cchip {
namespace {

std::vector<CollisionResult> gather(Device& device, std::size_t count, const Device::QuerySource& query,
                                    const CollisionRequest& request) {
  std::vector<CollisionResult> results(count);
  device.collide(count, query, request,
                 [&results](std::size_t i, const CollisionResult& result) { results[i] = result; });
  return results;
}

Device::QuerySource in_poses(const Object& a, const Object& b, const std::vector<PosePair>& poses) {
  return [&a, &b, &poses](std::size_t i) { return CollisionQuery{&a, &poses[i].a, &b, &poses[i].b}; };
}

/// What Object::parts() looks up: none if file_face serves as it is.
std::vector<std::uint32_t> faces_by_file(const Mesh& mesh) {
  const std::vector<std::uint32_t>& number = mesh.file_face;
  if (std::is_sorted(number.begin(), number.end())) return {};
  std::vector<std::uint32_t> faces(number.size());
  std::iota(faces.begin(), faces.end(), 0U);
  std::stable_sort(faces.begin(), faces.end(),
                   [&number](std::uint32_t i, std::uint32_t k) { return number[i] < number[k]; });
  return faces;
}

/// Ends a batch whose sink has returned false.
struct Enough {};

}  // namespace

Object::Object(Mesh mesh) {
  check_float_mode();
  bvh::SupportTree tree(mesh, bvh::build_topology(mesh));
  std::vector<std::uint32_t> by_file = faces_by_file(mesh);
  data_ = std::make_shared<const Data>(
      Data{std::move(mesh), std::move(tree), std::move(by_file), std::make_shared<Edges>()});
}

void Object::refuse_moved_from() {
  throw std::invalid_argument("object: it was moved from and has no mesh; use the Object that it was moved to");
}

std::vector<std::uint32_t> Object::parts(std::uint32_t number) const {
  const std::vector<std::uint32_t>& numbers = mesh().file_face;
  std::vector<std::uint32_t> parts;
  if (numbers.empty()) {
    if (number < mesh().faces.size()) parts.push_back(number);
  } else if (data().by_file.empty()) {
    const auto [first, last] = std::equal_range(numbers.begin(), numbers.end(), number);
    for (auto i = first; i != last; ++i) parts.push_back(static_cast<std::uint32_t>(i - numbers.begin()));
  } else {
    const std::vector<std::uint32_t>& faces = data().by_file;
    auto i = std::lower_bound(faces.begin(), faces.end(), number,
                              [&numbers](std::uint32_t face, std::uint32_t wanted) { return numbers[face] < wanted; });
    for (; i != faces.end() && numbers[*i] == number; ++i) parts.push_back(*i);
  }
  return parts;
}

Object Object::moved(std::vector<Vec3d> vertices) const {
  check_float_mode();
  if (vertices.size() != this->mesh().vertices.size()) {
    throw std::invalid_argument("moved: " + std::to_string(vertices.size()) + " vertices, the object has " +
                                std::to_string(this->mesh().vertices.size()));
  }
  const Mesh& old = this->mesh();
  Mesh mesh = {old.name, std::move(vertices), old.faces, old.polygons_cut, old.file_face, old.notes};
  bvh::check_vertices(mesh);
  bvh::SupportTree tree = data().tree.moved(mesh);
  Object object;
  object.data_ =
      std::make_shared<const Data>(Data{std::move(mesh), std::move(tree), data().by_file, std::make_shared<Edges>()});
  return object;
}

Device::Device() { check_float_mode(); }

/// Keeps other calls off a device.
class Device::Use {
 public:
  explicit Use(Device& device) : device_(device) {
    if (!device_.in_use_.exchange(true, std::memory_order_acquire)) return;
    throw std::logic_error(std::string("device ") + device_.name() +
                           " is in use: open one device per thread, and do not call it from its result function");
  }
  ~Use() { device_.in_use_.store(false, std::memory_order_release); }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  Device& device_;
};

void Device::collide(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) {
  const Use use(*this);
  check_float_mode();
  check_query(query, request);
  if (result.certificate) result.certificate.reset();  // of another answer
  answer(query, request, result);
}

void Device::collide(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                     const ResultSink& take) {
  const Use use(*this);
  check_float_mode();
  // Checked where it is fetched: a pass of its own before the batch would cost as much as a pair that is far apart.
  const QuerySource checked = [&query, &request](std::size_t i) {
    const CollisionQuery asked = query(i);
    check_query(asked, request);
    return asked;
  };
  // Every device must end a batch when its sink throws, so this stops all of them alike.
  const ResultSink stop_or_go_on = [&take](std::size_t i, const CollisionResult& result) {
    if (!take(i, result)) throw Enough();
  };
  try {
    answer_all(count, checked, request, stop_or_go_on);
  } catch (const Enough&) {  // NOLINT: it is no error
  }
}

void Device::answer_all(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                        const ResultSink& take) {
  CollisionResult result;
  for (std::size_t i = 0; i < count; ++i) {
    answer(query(i), request, result);
    take(i, result);
  }
}

void collide(Device& device, const Object& a, const Object& b, const std::vector<PosePair>& poses,
             const CollisionRequest& request, const Device::ResultSink& take) {
  device.collide(poses.size(), in_poses(a, b, poses), request, take);
}

std::vector<CollisionResult> collide(Device& device, const Object& a, const Object& b,
                                     const std::vector<PosePair>& poses, const CollisionRequest& request) {
  return gather(device, poses.size(), in_poses(a, b, poses), request);
}

std::vector<CollisionResult> collide(Device& device, const std::vector<CollisionQuery>& queries,
                                     const CollisionRequest& request) {
  return gather(
      device, queries.size(), [&queries](std::size_t i) { return queries[i]; }, request);
}

}  // namespace cchip
