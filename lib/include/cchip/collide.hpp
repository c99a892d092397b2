// SPDX-License-Identifier: Apache-2.0
/// \file
/// Do two objects touch or cross, and where?
///
/// The answer is exact: for closed faces with the double coordinates of the meshes, and both poses as given, in real
/// arithmetic without rounding. Touching counts, unless the request asks for crossings. Objects are surfaces, not
/// volumes: one wholly inside another does not touch it. A quad is the hull of its four vertices. There is no depth;
/// distance.hpp is about distances, along.hpp about ways along a direction, intersection.hpp about the points that
/// faces share.
#ifndef CCHIP_COLLIDE_HPP
#define CCHIP_COLLIDE_HPP

#include <algorithm>
#include <atomic>
#include <cchip/object.hpp>
#include <cchip/pose.hpp>
#include <cchip/relation.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace cchip {

struct Certificate;  // <cchip/certificate.hpp>

/// Which contacts a caller wants.
struct CollisionRequest {
  enum class Contacts {
    first,  ///< whether there is one; the device may name any
    all     ///< every pair of faces in contact
  };
  Contacts contacts = Contacts::first;
  /// With Contacts::all: the search ends when it meets one contact more than this many. At least 1.
  std::size_t max_contacts = std::numeric_limits<std::size_t>::max();
  /// The least that two faces must do to be a contact. Relation::touching: share a point. Relation::crossing: cross;
  /// flush and grazing faces are then no contacts. Faces are judged pair by pair, so solids that overlap can do
  /// without: two bars of one section, one pushed into the other, have no faces that cross (docs/cpp/touching.md).
  /// Relation::apart is refused.
  Relation least = Relation::touching;
  /// Tell touching from crossing: fills CollisionResult::relation and Contact::relation, which `least` does in any case
  /// if it is Relation::crossing. With Contacts::first the search continues after a contact that only touches, until
  /// one crosses or none is left.
  bool relation = false;
  /// Prove the answer: fills CollisionResult::certificate (docs/cpp/certificates.md). Takes far longer than the answer.
  bool certificate = false;
  /// Pairs of faces whose distance is at most this are contacts, in units of the world; exactly. With 0, those that
  /// share a point. With more, touching and crossing are not told apart: leave `relation` and `least` as they are.
  double within = 0;

  bool tells_relation() const { return relation || least == Relation::crossing; }
};

/// A face of A and a face of B in contact, by their numbers in the files (Mesh::file_face). A polygon that was cut into
/// triangles is one face here.
struct Contact {
  std::uint32_t face_a = 0;
  std::uint32_t face_b = 0;
  /// Touching or crossing; of a polygon that was cut, crossing if one of its triangles crosses. Empty if the request
  /// does not tell them apart.
  std::optional<Relation> relation = std::nullopt;
  friend bool operator==(const Contact& x, const Contact& y) { return same_faces(x, y) && x.relation == y.relation; }
  friend bool operator!=(const Contact& x, const Contact& y) { return !(x == y); }
  /// Equal but for the relation, which one of them may tell and the other not.
  friend bool same_faces(const Contact& x, const Contact& y) { return x.face_a == y.face_a && x.face_b == y.face_b; }
  /// By the faces alone.
  friend bool operator<(const Contact& x, const Contact& y) { return x.key() < y.key(); }

 private:
  std::uint64_t key() const { return std::uint64_t{face_a} << 32U | face_b; }  // one comparison, for long sorts
};

/// The same faces in the same order, whatever is known of their relations.
inline bool same_faces(const std::vector<Contact>& x, const std::vector<Contact>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const Contact& p, const Contact& q) { return same_faces(p, q); });
}

/// What a query cost.
struct CollisionStats {
  std::uint64_t steps = 0;      ///< pairs of tree nodes that were expanded
  std::uint64_t box_tests = 0;  ///< pairs of bounding volumes that were compared
  std::uint64_t pairs = 0;      ///< pairs of primitives that were tested
  /// Those of them for which faster arithmetic could not tell whether they meet, or whether they cross, so that exact
  /// arithmetic did.
  std::uint64_t open = 0;
  std::uint64_t clocks = 0;  ///< clocks of the device; 0 for devices without a clock
  /// 1: the CPU answered instead of the device (driver/chip_host.hpp says when); the other numbers are those of both.
  std::uint64_t fallbacks = 0;
  std::uint64_t swaps = 0;        ///< exchanges of the device's modules since the result before it
  std::uint64_t swap_clocks = 0;  ///< their clocks
  CollisionStats& operator+=(const CollisionStats& x) {
    using C = CollisionStats;
    for (const auto count :
         {&C::steps, &C::box_tests, &C::pairs, &C::open, &C::clocks, &C::fallbacks, &C::swaps, &C::swap_clocks}) {
      this->*count += x.*count;
    }
    return *this;
  }
};

struct CollisionResult {
  bool hit = false;  ///< there is a contact
  /// Of the two objects. Empty if the request does not tell touching from crossing, or if there are more contacts than
  /// CollisionRequest::max_contacts and the search ended before a pair crossed.
  std::optional<Relation> relation;
  /// In ascending order, without duplicates. With Contacts::first at most one.
  std::vector<Contact> contacts;
  CollisionStats stats;
  /// The answer with its proof, if the request asks for it and the device is one of this library; see
  /// <cchip/certificate.hpp>.
  std::shared_ptr<const Certificate> certificate;
};

/// Poses of the two objects of one query.
struct PosePair {
  Pose a = Pose::Identity();
  Pose b = Pose::Identity();
};

/// A face of A and a face of B, by their numbers in the files, that touch in all likelihood: those of a contact of the
/// same objects a moment before. The CPU device tests them first; if they touch, a request for the first contact is
/// answered with them, several times faster than by a search. A hint that is wrong costs one test of two faces, and no
/// hint changes whether there is a contact. Other devices, and requests for all contacts, ignore it.
struct CollisionHint {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t face_a = none;
  std::uint32_t face_b = none;
  CollisionHint() = default;
  CollisionHint(const Contact& contact) : face_a(contact.face_a), face_b(contact.face_b) {}  // NOLINT: it is one
  /// From the last result about these objects, with its first contact if it has one.
  CollisionHint(const CollisionResult& last) {  // NOLINT: it is one
    if (!last.contacts.empty()) *this = last.contacts.front();
  }
};

/// Two placed objects. Refers to objects and poses of the caller, which must stay as they are during the call.
struct CollisionQuery {
  const Object* a = nullptr;
  const Pose* pose_a = nullptr;
  const Object* b = nullptr;
  const Pose* pose_b = nullptr;
  CollisionHint hint = {};
};

/// Answers queries. A device takes one call at a time, from any thread, and none from the functions that a call was
/// given: open a device for each thread, and another one for queries that depend on results. Objects may be shared
/// between devices.
class Device {
 public:
  /// \throws std::runtime_error the calling thread flushes small numbers to zero; so do calls of collide()
  Device();
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual const char* name() const = 0;
  /// Replaces what is in `result`, whose memory is used again.
  /// \throws std::invalid_argument check_query() refuses the query: a null pointer, an object that was moved from, an
  ///         entry of a pose that is not finite or beyond 2^500 in magnitude
  /// \throws std::logic_error the device is in use
  /// \throws std::runtime_error as certify(), if the request is for a certificate and the answer is wrong
  void collide(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result);

  using QuerySource = std::function<CollisionQuery(std::size_t)>;
  /// A function that takes the number of a query and its result. One that returns bool says whether the batch
  /// continues; after one that returns anything else, or nothing, it does.
  class ResultSink {
   public:
    template <class Function, class = std::enable_if_t<
                                  !std::is_same_v<std::decay_t<Function>, ResultSink> &&
                                  std::is_invocable_v<std::decay_t<Function>&, std::size_t, const CollisionResult&>>>
    ResultSink(Function&& function) {  // NOLINT: functions convert
      if constexpr (std::is_same_v<std::invoke_result_t<std::decay_t<Function>&, std::size_t, const CollisionResult&>,
                                   bool>) {
        asks_ = std::forward<Function>(function);
      } else {
        goes_on_ = std::forward<Function>(function);
      }
    }
    /// \returns whether the batch continues
    bool operator()(std::size_t number, const CollisionResult& result) const {
      if (!goes_on_) return asks_(number, result);
      goes_on_(number, result);
      return true;
    }

   private:
    // One of them is set. A std::function that the caller has becomes one of these without memory from the heap.
    std::function<bool(std::size_t, const CollisionResult&)> asks_;
    std::function<void(std::size_t, const CollisionResult&)> goes_on_;
  };
  /// Answers `count` queries, those that `query` gives for 0..count - 1. It may be asked for a query more than once and
  /// by several threads at a time. `take` is called with the number of a query and its result, one call at a time, in
  /// any order. A device may use all cores. Once `take` has returned false it is not called again: queries that are in
  /// flight are dropped, and the call returns.
  /// Exceptions of `query` and `take` end the batch and reach the caller, who may use the device again.
  /// \throws std::invalid_argument as above; results of other queries may have come before, none comes after
  /// \throws std::logic_error as above
  void collide(std::size_t count, const QuerySource& query, const CollisionRequest& request, const ResultSink& take);

 private:
  class Use;

  /// \pre check_query() accepts the query
  virtual void answer(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) = 0;
  /// Does one after the other unless it is overridden. An exception of `query`, which refuses what check_query() does
  /// not accept, or of `take` must end the batch and reach the caller; the result of `take` says nothing here.
  virtual void answer_all(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                          const ResultSink& take);

  std::atomic<bool> in_use_ = false;
};

/// One query.
inline CollisionResult collide(Device& device, const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                               const CollisionRequest& request = {}, const CollisionHint& hint = {}) {
  CollisionResult result;
  device.collide({&a, &pose_a, &b, &pose_b, hint}, request, result);
  return result;
}

/// The same objects in many poses; each result as it is ready, until `take` returns false.
void collide(Device& device, const Object& a, const Object& b, const std::vector<PosePair>& poses,
             const CollisionRequest& request, const Device::ResultSink& take);
/// The same; results in the order of the poses.
std::vector<CollisionResult> collide(Device& device, const Object& a, const Object& b,
                                     const std::vector<PosePair>& poses, const CollisionRequest& request = {});
/// Any queries, such as one object against each of a scene; results in their order. The device gets those about the
/// same two objects one behind the other, as their trees are in the caches then.
std::vector<CollisionResult> collide(Device& device, const std::vector<CollisionQuery>& queries,
                                     const CollisionRequest& request = {});

/// What self_contacts() makes of two faces that have a vertex in common, by its position.
enum class Neighbours {
  tested,   ///< a contact if they share more than that vertex, or more than the edge between two of them
  left_out  ///< no contact
};

/// Pairs of faces of one object that share a point, without the one vertex or the one edge that neighbours have in
/// common: so faces that coincide, fold onto each other over an edge or pierce each other at a vertex are contacts, and
/// a closed mesh without faults has none. Ascending, face_a < face_b, none twice, each with its relation; faces that
/// were cut count as one. For a check of a mesh or of a deformed body; descends the object's tree against itself.
/// \param max_contacts the search ends when it meets one more than this many
/// \throws std::invalid_argument the object was moved from, or max_contacts is 0
/// \throws std::runtime_error the calling thread flushes small numbers to zero
std::vector<Contact> self_contacts(const Object& object,
                                   std::size_t max_contacts = std::numeric_limits<std::size_t>::max(),
                                   Neighbours neighbours = Neighbours::tested);

/// The first two faces of an object, in ascending order, that cross each other or share an area, if there are any: of
/// shells that overlap, were written twice or have a wall in common. There solids() depends on its rule for the inside
/// (docs/cpp/solids.md). The first call takes as long as self_contacts(); copies of the object share its result.
/// \throws as self_contacts()
std::optional<Contact> shell_overlap(const Object& object);

}  // namespace cchip

#endif
