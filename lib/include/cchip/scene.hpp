// SPDX-License-Identifier: Apache-2.0
/// \file
/// Many placed objects: which of them touch?
#ifndef CCHIP_SCENE_HPP
#define CCHIP_SCENE_HPP

#include <array>
#include <cchip/collide.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

namespace cchip {

/// The groups that an object belongs to and those that it collides with, a bit each. Two objects are tested if each
/// one's `mask` has a group of the other, as with Bullet's filter groups.
struct CollisionGroups {
  std::uint64_t groups = 1;
  std::uint64_t mask = ~std::uint64_t{0};
};

/// Closed, in the coordinates of the world. An axis along which no bound could be computed has infinities.
struct WorldBox {
  std::array<double, 3> least;
  std::array<double, 3> greatest;
};

class BoxPairs;

/// Objects with poses, and a broad phase over their boxes, so that a device is asked only about pairs that are close.
///
/// Answers are exact like those of collide(): boxes are rounded outwards, so no pair that touches is left out. The
/// scene keeps a copy of each Object, which is a handle: copies share one mesh, and the caller may drop his own. Copies
/// of a scene have the same ids.
///
/// Const functions may be called by several threads at a time, each with its own device; a change must not happen
/// meanwhile, and not from the functions that a call was given. A function that throws has changed nothing.
class Scene {
 public:
  /// Names an object. Ids are given in ascending order from 1 and never again after remove(); 0 is never one.
  using Id = std::uint64_t;
  /// Is this pair to be tested? It is called with ids in ascending order, and only for pairs whose boxes overlap.
  using Filter = std::function<bool(Id, Id)>;

  /// Two objects in contact, a < b. In the result `a` is object A.
  struct Pair {
    Id a = 0;
    Id b = 0;
    CollisionResult result;
  };
  /// What is held against the objects of a scene. Refers to objects, poses and scenes of the caller, which must stay as
  /// they are during the call: `scene.contacts(device, {object, pose})`.
  class Target {
   public:
    /// An object of the scene: against the others.
    Target(Id id) : id_(id) {}  // NOLINT: an id is one
    /// An object that is not in the scene. The filter, which takes ids, is not asked.
    Target(const Object& object, const Pose& pose, const CollisionGroups& groups = {})
        : object_(&object), poses_(&pose), count_(1), groups_(groups) {}
    /// The same in many poses, such as the states that a planner looks at.
    Target(const Object& object, const std::vector<Pose>& poses, const CollisionGroups& groups = {})
        : object_(&object), poses_(poses.data()), count_(poses.size()), groups_(groups) {}
    /// All objects of another scene, with their groups. Neither filter is asked, and no pair is ignored, since each
    /// scene has ids of its own.
    Target(const Scene& other) : scene_(&other) {}  // NOLINT: a scene is one

   private:
    friend class Scene;
    Id id_ = 0;  ///< unless one of the two is set
    const Object* object_ = nullptr;
    const Scene* scene_ = nullptr;
    const Pose* poses_ = nullptr;
    std::size_t count_ = 0;  ///< of the poses
    CollisionGroups groups_;
  };
  /// An object of the scene in contact with a target. In the result the target is A, this one B.
  struct Hit {
    Id id = 0;
    CollisionResult result;
    /// Of a target with many poses: which of them, from 0. Of a scene: the id of its object. Else 0.
    std::uint64_t of = 0;
  };
  /// Takes a pair in contact and returns whether to go on.
  using PairSink = std::function<bool(const Pair&)>;
  using HitSink = std::function<bool(const Hit&)>;

  /// Takes constant time.
  /// \throws std::invalid_argument the object was moved from, or an entry of the pose is not finite or beyond 2^500 in
  ///         magnitude
  /// \throws std::runtime_error the calling thread flushes small numbers to zero
  Id add(Object object, const Pose& pose = Pose::Identity(), const CollisionGroups& groups = {});
  /// Moves an object. Takes constant time.
  /// \throws std::invalid_argument no object has this id, or as add() for the pose
  /// \throws std::runtime_error as add()
  void set_pose(Id id, const Pose& pose);
  /// \throws std::invalid_argument no object has this id
  void set_groups(Id id, const CollisionGroups& groups);
  /// Takes an object out, and what set_ignored() noted about it. Takes constant time on average but for a look at all
  /// ignored pairs.
  /// \throws std::invalid_argument no object has this id
  void remove(Id id);

  std::size_t size() const { return places_.size(); }
  bool contains(Id id) const { return places_.count(id) != 0; }
  /// All ids, ascending.
  std::vector<Id> ids() const;
  /// The handle and the pose stay valid until the scene changes.
  /// \throws std::invalid_argument no object has this id
  const Object& object(Id id) const { return entry(id).object; }
  const Pose& pose(Id id) const { return entry(id).pose; }
  const CollisionGroups& groups(Id id) const { return labels_[place(id)].groups; }
  /// A box that contains the object in its pose in spite of rounding; not always the least one.
  const WorldBox& box(Id id) const;

  /// Leaves a pair out, such as two links of a robot that a joint connects; or takes it in again.
  /// \throws std::invalid_argument no object has one of the ids, or both are the same
  void set_ignored(Id a, Id b, bool ignored = true);
  /// Called for pairs that groups and ignored pairs have let through, by the thread that asks; an empty one lets all
  /// through.
  void set_filter(Filter filter) { filter_ = std::move(filter); }

  /// The pairs that a device would be asked about, ascending, the lower id first: those whose boxes overlap and that
  /// groups, ignored pairs and filter let through. The pairs of boxes are kept for the next query, which looks for
  /// those of the objects that were added or have moved since: O(c log c + n log c) for c of n objects that are spread
  /// out, plus the pairs that overlap.
  /// \throws as the filter
  std::vector<std::pair<Id, Id>> candidates() const;

  /// All pairs in contact, ascending by ids on every device and with any number of threads.
  /// \throws std::invalid_argument the request wants at most 0 contacts
  /// \throws std::logic_error the device is in use
  /// \throws std::runtime_error the calling thread flushes small numbers to zero
  /// \throws as the filter
  std::vector<Pair> contacts(Device& device, const CollisionRequest& request = {}) const;
  /// What is in contact with the target, ascending by Hit::id, then Hit::of. Looks at the boxes of all objects for each
  /// of the target's, and asks the device in one batch.
  /// \throws as above; std::invalid_argument: no object has the target's id, the target is this scene, or as add()
  std::vector<Hit> contacts(Device& device, const Target& target, const CollisionRequest& request = {}) const;

  /// Stops at a contact and returns it; none if there is none. Of several contacts any may be returned.
  /// \throws as contacts()
  std::optional<Pair> find_contact(Device& device, const CollisionRequest& request = {}) const;
  std::optional<Hit> find_contact(Device& device, const Target& target, const CollisionRequest& request = {}) const;

  /// Calls `take` for what contacts() finds until it returns false: one call at a time, in any order, by any thread. It
  /// must neither change the scene nor use the device.
  /// \throws as contacts(), and as `take`
  void for_each_contact(Device& device, const PairSink& take, const CollisionRequest& request = {}) const;
  void for_each_contact(Device& device, const Target& target, const HitSink& take,
                        const CollisionRequest& request = {}) const;

 private:
  /// What decides whether a pair is wanted: a few bytes an object, since every query reads those of all pairs.
  struct Label {
    Id id;  ///< 0 if it was removed, or is not of the scene
    CollisionGroups groups;
  };
  struct Entry {
    Object object;
    Pose pose;
  };
  /// The boxes of the entries, by their numbers. A copy is deep.
  struct Boxes {
    Boxes();
    Boxes(const Boxes& other);
    Boxes(Boxes&& other) noexcept;  ///< leaves none
    Boxes& operator=(Boxes other) noexcept;
    ~Boxes();
    std::unique_ptr<BoxPairs> held;
  };
  /// Numbers in entries_ of two objects, the lower id first.
  using Candidate = std::pair<std::uint32_t, std::uint32_t>;

  std::size_t place(Id id) const;
  const Entry& entry(Id id) const { return entries_[place(id)]; }
  bool is_wanted(const Label& x, const Label& y) const;
  std::vector<Candidate> find_candidates(double within) const;
  std::vector<std::uint32_t> near(const Label& one, const WorldBox& box, double within) const;
  /// An object of a target and, by their numbers, those of the scene whose boxes are near to it.
  struct Near;
  std::vector<Near> near(const Target& target, double within) const;

  std::vector<Entry> entries_;  ///< by ascending ids, with gaps where objects were removed
  std::vector<Label> labels_;   ///< of the entries
  Boxes boxes_;
  std::unordered_map<Id, std::size_t> places_;  ///< in entries_
  std::set<std::pair<Id, Id>> ignored_;         ///< the lower id first
  Filter filter_;
  Id next_ = 1;
};

}  // namespace cchip

#endif
