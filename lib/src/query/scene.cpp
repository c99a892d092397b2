// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/scene.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "exact/float_mode.hpp"
#include "exact/ieee.hpp"
#include "judge/box_pairs.hpp"
#include "search/line_reach.hpp"

namespace cchip {
namespace {

/// Bound on the rounding of a box, in units of the magnitudes that are added up for one of its coordinates; 14.4 u are
/// needed. Twice that for rounding modes that are not to nearest.
constexpr double box_limit = 32 * 0x1p-53;
/// Sizes from here on might overflow.
constexpr double most_size = 0x1p1000;

void check_object(const Object& object) {
  if (object.id() != nullptr) return;
  throw std::invalid_argument("scene: the object was moved from; use the one that it was moved to");
}

// A point of the object is c + y, c the centre of its ball and y within what the tree says. A coordinate of it in the
// world is row . c + t + row . y, and row . y is at most the reach along the row. With u = 2^-53 and size the sum of
// the magnitudes that are added up for any point, row . c + t is off by 4u size, the reach by 7.95u size, their sum by
// two more roundings of at most 1.13 size: 14.4u size.
WorldBox world_box(const Object& object, const Pose& pose) {
  const bvh::SupportTree& tree = object.tree();
  const Vec3d& c = tree.centre();
  WorldBox box = {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const std::array<double, 3> row = {pose(i, 0), pose(i, 1), pose(i, 2)};
    const double t = pose(i, 3);
    const double size = (std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2])) * tree.extent() + std::abs(t);
    if (!(size < most_size)) {
      box.least[axis] = -std::numeric_limits<double>::infinity();
      box.greatest[axis] = std::numeric_limits<double>::infinity();
      continue;
    }
    const double centre = row[0] * c[0] + row[1] * c[1] + row[2] * c[2] + t;
    // The second term is for what underflows, in the reach before it is multiplied by the object's unit.
    const double slack = box_limit * size + 0x1p-1060 * (1 + tree.extent());
    box.least[axis] = centre - (reach_along(tree, {-row[0], -row[1], -row[2]}) + slack);
    box.greatest[axis] = centre + (reach_along(tree, row) + slack);
  }
  return box;
}

}  // namespace

Scene::Boxes::Boxes() : held(std::make_unique<BoxPairs>()) {}
Scene::Boxes::Boxes(const Boxes& other) : held(other.held ? std::make_unique<BoxPairs>(*other.held) : nullptr) {}
Scene::Boxes::Boxes(Boxes&& other) noexcept = default;
Scene::Boxes& Scene::Boxes::operator=(Boxes other) noexcept {
  held.swap(other.held);
  return *this;
}
Scene::Boxes::~Boxes() = default;

Scene::Id Scene::add(Object object, const Pose& pose, const CollisionGroups& groups) {
  check_float_mode();
  check_object(object);
  check_pose(pose, "the object");
  if (entries_.size() == std::numeric_limits<std::uint32_t>::max()) {
    throw std::length_error("scene: it holds at most 2^32 - 1 objects; use several scenes");
  }
  if (!boxes_.held) boxes_ = Boxes();  // the scene was moved from
  const WorldBox box = world_box(object, pose);
  entries_.push_back({std::move(object), pose});
  try {
    labels_.push_back({next_, groups});
    places_.emplace(next_, entries_.size() - 1);
    boxes_.held->add(box);
  } catch (...) {
    places_.erase(next_);
    entries_.pop_back();
    labels_.resize(entries_.size());
    throw;
  }
  return next_++;
}

void Scene::set_pose(Id id, const Pose& pose) {
  const std::size_t at = place(id);
  Entry& moved = entries_[at];
  check_float_mode();
  check_pose(pose, ("object " + std::to_string(id)).c_str());
  boxes_.held->move(at, world_box(moved.object, pose));
  moved.pose = pose;
}

void Scene::set_groups(Id id, const CollisionGroups& groups) { labels_[place(id)].groups = groups; }

void Scene::remove(Id id) {
  const std::size_t at = place(id);
  for (auto pair = ignored_.begin(); pair != ignored_.end();) {
    pair = pair->first == id || pair->second == id ? ignored_.erase(pair) : std::next(pair);
  }
  const Object gone = std::move(entries_[at].object);  // and what it holds is released
  labels_[at].id = 0;
  places_.erase(id);
  boxes_.held->remove(at);
  if (2 * places_.size() >= entries_.size()) return;
  std::size_t count = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (labels_[i].id == 0) continue;
    if (count != i) entries_[count] = std::move(entries_[i]);
    labels_[count] = labels_[i];
    places_.find(labels_[i].id)->second = count++;
  }
  entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(count), entries_.end());
  labels_.resize(count);
  boxes_.held->renumber();
}

std::vector<Scene::Id> Scene::ids() const {
  std::vector<Id> all;
  all.reserve(size());
  for (const Label& x : labels_) {
    if (x.id != 0) all.push_back(x.id);
  }
  return all;
}

void Scene::set_ignored(Id a, Id b, bool ignored) {
  place(a);
  place(b);
  if (a == b) {
    throw std::invalid_argument("scene: object " + std::to_string(a) +
                                " is never tested against itself; give the ids of two objects");
  }
  const auto pair = std::minmax(a, b);
  if (ignored) {
    ignored_.insert(pair);
  } else {
    ignored_.erase(pair);
  }
}

std::size_t Scene::place(Id id) const {
  const auto found = places_.find(id);
  if (found != places_.end()) return found->second;
  throw std::invalid_argument("scene: no object has the id " + std::to_string(id) + ": " +
                              (id != 0 && id < next_ ? "it was removed" : "add() has not returned it"));
}

const WorldBox& Scene::box(Id id) const { return boxes_.held->box(place(id)); }

bool Scene::is_wanted(const Label& x, const Label& y) const {
  if ((x.groups.groups & y.groups.mask) == 0 || (y.groups.groups & x.groups.mask) == 0) return false;
  if (x.id == 0 || y.id == 0) return true;  // one is not in the scene
  const auto pair = std::minmax(x.id, y.id);
  if (!ignored_.empty() && ignored_.count(pair) != 0) return false;
  return !filter_ || filter_(pair.first, pair.second);
}

std::vector<Scene::Candidate> Scene::find_candidates(double within) const {
  if (entries_.empty()) return {};
  const double half = within > 0 ? std::nextafter(within / 2, std::numeric_limits<double>::infinity()) : 0;
  std::vector<Candidate> found = boxes_.held->pairs(half);
  const auto unwanted = [this](const Candidate& pair) { return !is_wanted(labels_[pair.first], labels_[pair.second]); };
  found.erase(std::remove_if(found.begin(), found.end(), unwanted), found.end());
  return found;
}

std::vector<std::uint32_t> Scene::near(const Label& one, const WorldBox& box, double within) const {
  const WorldBox around = grown(box, within);
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    const Label& x = labels_[i];
    if (x.id != 0 && x.id != one.id && overlap(boxes_.held->box(i), around) && is_wanted(x, one)) found.push_back(i);
  }
  return found;
}

std::vector<std::pair<Scene::Id, Scene::Id>> Scene::candidates() const {
  std::vector<std::pair<Id, Id>> pairs;
  const std::vector<Candidate> found = find_candidates(0);
  pairs.reserve(found.size());
  for (const auto& [a, b] : found) pairs.emplace_back(labels_[a].id, labels_[b].id);
  return pairs;
}

void Scene::for_each_contact(Device& device, const PairSink& take, const CollisionRequest& request) const {
  check_query(Pose::Identity(), Pose::Identity(), request);  // whether or not there are pairs
  const std::vector<Candidate> pairs = find_candidates(request.within);
  device.collide(
      pairs.size(),
      [this, &pairs](std::size_t i) {
        const Entry& a = entries_[pairs[i].first];
        const Entry& b = entries_[pairs[i].second];
        return CollisionQuery{&a.object, &a.pose, &b.object, &b.pose};
      },
      request,
      [this, &pairs, &take](std::size_t i, const CollisionResult& result) {
        return !result.hit || take({labels_[pairs[i].first].id, labels_[pairs[i].second].id, result});
      });
}

struct Scene::Near {
  const Object* object;
  const Pose* pose;
  std::uint64_t of;
  std::vector<std::uint32_t> others;
};

std::vector<Scene::Near> Scene::near(const Target& target, double within) const {
  std::vector<Near> all;
  const auto add = [&](const Object& object, const Pose& pose, std::uint64_t of, const Label& label,
                       const WorldBox& box) {
    std::vector<std::uint32_t> others = near(label, box, within);
    if (!others.empty()) all.push_back({&object, &pose, of, std::move(others)});
  };
  if (target.scene_ == this) {
    throw std::invalid_argument(
        "scene: the target is the scene itself; leave it out, which asks for the pairs of the scene");
  }
  if (target.scene_ != nullptr) {
    const Scene& other = *target.scene_;
    for (std::size_t i = 0; i < other.entries_.size(); ++i) {
      const Label& label = other.labels_[i];
      const Entry& entry = other.entries_[i];
      if (label.id != 0) add(entry.object, entry.pose, label.id, {0, label.groups}, other.boxes_.held->box(i));
    }
  } else if (target.object_ != nullptr) {
    check_float_mode();
    check_object(*target.object_);
    for (std::size_t i = 0; i < target.count_; ++i) {
      const Pose& pose = target.poses_[i];
      check_pose(pose, target.count_ == 1 ? "the object" : ("the object: number " + std::to_string(i)).c_str());
      add(*target.object_, pose, i, {0, target.groups_}, world_box(*target.object_, pose));
    }
  } else {
    const std::size_t at = place(target.id_);
    add(entries_[at].object, entries_[at].pose, 0, labels_[at], box(target.id_));
  }
  return all;
}

void Scene::for_each_contact(Device& device, const Target& target, const HitSink& take,
                             const CollisionRequest& request) const {
  check_query(Pose::Identity(), Pose::Identity(), request);  // whether or not there are others
  const std::vector<Near> all = near(target, request.within);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> queries;  // numbers in `all` and in entries_
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    for (const std::uint32_t other : all[i].others) queries.emplace_back(i, other);
  }
  device.collide(
      queries.size(),
      [&](std::size_t i) {
        const Near& a = all[queries[i].first];
        const Entry& b = entries_[queries[i].second];
        return CollisionQuery{a.object, a.pose, &b.object, &b.pose};
      },
      request,
      [&](std::size_t i, const CollisionResult& result) {
        return !result.hit || take({labels_[queries[i].second].id, result, all[queries[i].first].of});
      });
}

namespace {

/// Everything that a call of for_each_contact() finds, in the order of `less`.
template <class Found, class Less, class Call>
std::vector<Found> gather(const Less& less, const Call& call) {
  std::vector<Found> all;
  call([&all](const Found& found) {
    all.push_back(found);
    return true;
  });
  std::sort(all.begin(), all.end(), less);
  return all;
}

/// The first that it finds.
template <class Found, class Call>
std::optional<Found> first(const Call& call) {
  std::optional<Found> one;
  call([&one](const Found& found) {
    one = found;
    return false;
  });
  return one;
}

bool pair_less(const Scene::Pair& x, const Scene::Pair& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
bool hit_less(const Scene::Hit& x, const Scene::Hit& y) { return x.id != y.id ? x.id < y.id : x.of < y.of; }

}  // namespace

std::vector<Scene::Pair> Scene::contacts(Device& device, const CollisionRequest& request) const {
  return gather<Pair>(pair_less, [&](const PairSink& take) { for_each_contact(device, take, request); });
}

std::vector<Scene::Hit> Scene::contacts(Device& device, const Target& target, const CollisionRequest& request) const {
  return gather<Hit>(hit_less, [&](const HitSink& take) { for_each_contact(device, target, take, request); });
}

std::optional<Scene::Pair> Scene::find_contact(Device& device, const CollisionRequest& request) const {
  return first<Pair>([&](const PairSink& take) { for_each_contact(device, take, request); });
}

std::optional<Scene::Hit> Scene::find_contact(Device& device, const Target& target,
                                              const CollisionRequest& request) const {
  return first<Hit>([&](const HitSink& take) { for_each_contact(device, target, take, request); });
}

}  // namespace cchip
