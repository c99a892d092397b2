// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/collide/collide.hpp>
#include <cchip/collide/face_pairs.hpp>
#include <cchip/exact/posed_pairs.hpp>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

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

/// Ends a batch whose sink has returned false.
struct Enough {};

}  // namespace

Object::Object(Mesh mesh) {
  check_float_mode();
  bvh::SupportTree tree(mesh, bvh::build_tree(mesh));
  data_ = std::make_shared<const Data>(Data{std::move(mesh), std::move(tree)});
}

Object::Object(Mesh mesh, const bvh::Tree& tree) {
  bvh::SupportTree support(mesh, tree);
  data_ = std::make_shared<const Data>(Data{std::move(mesh), std::move(support)});
}

Object Object::moved(std::vector<Vec3d> vertices) const {
  check_float_mode();
  if (vertices.size() != this->mesh().vertices.size()) {
    throw std::invalid_argument("moved: " + std::to_string(vertices.size()) + " vertices, the object has " +
                                std::to_string(this->mesh().vertices.size()));
  }
  Mesh mesh = this->mesh();
  mesh.vertices = std::move(vertices);
  bvh::Tree tree = data_->tree.topology();
  bvh::refit(tree, mesh);
  return {std::move(mesh), tree};
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
  answer(query, request, result);
}

void Device::collide(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                     const ResultSink& take) {
  const Use use(*this);
  check_float_mode();
  for (std::size_t i = 0; i < count; ++i) check_query(query(i), request);
  // Every device must end a batch when its sink throws, so this stops all of them alike.
  const ResultSink stop_or_go_on = [&take](std::size_t i, const CollisionResult& result) {
    if (!take(i, result)) throw Enough();
  };
  try {
    answer_all(count, query, request, stop_or_go_on);
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

std::vector<Contact> self_contacts(const Object& object, std::size_t max_contacts) {
  check_float_mode();
  if (object.id() == nullptr)
    throw std::invalid_argument("self_contacts: the Object was moved from; use the other one");
  if (max_contacts == 0) throw std::invalid_argument("self_contacts: max_contacts is 0: ask for at least one contact");
  const Mesh& mesh = object.mesh();
  // Vertices at one position have one number.
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto before = [&mesh](std::uint32_t i, std::uint32_t k) {
    const Vec3d& p = mesh.vertices[i];
    const Vec3d& q = mesh.vertices[k];
    return std::tie(p.x(), p.y(), p.z()) < std::tie(q.x(), q.y(), q.z());
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<std::uint32_t> number(order.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    number[order[i]] = number[order[i - 1]] + (before(order[i - 1], order[i]) ? 1U : 0U);
  }
  const auto are_neighbours = [&](const Mesh::Face& f, const Mesh::Face& g) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(f.kind); ++i) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(g.kind); ++k) {
        if (number[f.vertex[i]] == number[g.vertex[k]]) return true;
      }
    }
    return false;
  };
  const PosedPairs pairs(Pose::Identity(), Pose::Identity());
  std::map<Contact, Relation> found;
  try {
    sweep_box_pairs(mesh, mesh, [&](CandidatePair pair) {
      if (pair.face_a >= pair.face_b || are_neighbours(mesh.faces[pair.face_a], mesh.faces[pair.face_b])) return;
      const auto [low, high] =
          std::minmax({mesh.number_in_file(pair.face_a), mesh.number_in_file(pair.face_b)});  // by value
      if (low == high) return;                                                                // parts of one polygon
      const Primitive a = mesh.primitive(pair.face_a);
      const Primitive b = mesh.primitive(pair.face_b);
      if (!pairs.decide(a, b).hit) return;
      const Relation relation = pairs.cross(a, b) ? Relation::crossing : Relation::touching;
      Relation& known = found.emplace(Contact{low, high, {}}, relation).first->second;
      known = std::max(known, relation);
      if (found.size() == max_contacts) throw Enough();
    });
  } catch (const Enough&) {  // NOLINT: it is no error
  }
  std::vector<Contact> contacts;
  contacts.reserve(found.size());
  for (const auto& [faces, relation] : found) contacts.push_back({faces.face_a, faces.face_b, relation});
  return contacts;
}

}  // namespace cchip
