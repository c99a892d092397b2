// SPDX-License-Identifier: Apache-2.0
// Options that meet: every combination of what a request may ask for, through every way to ask, is either right or
// refused in a sentence before anything is computed.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cchip/check.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/device.hpp>
#include <cchip/internal/exact/posed_distances.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cchip/scene.hpp>
#include <string>

#include "bvh_meshes.hpp"

using namespace cchip;
using testing::make_box;

namespace {

constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// Two objects, their poses, and what is true of them.
struct Case {
  Case(const char* its_name, Mesh a, Mesh b, const Vec3d& shift)
      : name(its_name), mesh_a(std::move(a)), mesh_b(std::move(b)), object_a(mesh_a), object_b(mesh_b) {
    pose_b.translation() = shift;
  }
  /// All contacts of the request, by brute force, with their relations.
  std::vector<Contact> truth(const CollisionRequest& request) const {
    const PosedPairs pairs(pose_a, pose_b);
    const PosedDistances distances(pose_a, pose_b);
    std::vector<Contact> contacts;
    for (std::uint32_t i = 0; i < mesh_a.faces.size(); ++i) {
      for (std::uint32_t k = 0; k < mesh_b.faces.size(); ++k) {
        const Primitive p = mesh_a.primitive(i);
        const Primitive q = mesh_b.primitive(k);
        const PosedPairs::Answer met = pairs.decide(p, q, true);
        const bool hit = request.within > 0                    ? distances.within(p, q, request.within).hit
                         : request.least == Relation::crossing ? met.crosses
                                                               : met.hit;
        if (!hit) continue;
        Contact contact = {i, k, std::nullopt};
        if (request.tells_relation()) contact.relation = met.crosses ? Relation::crossing : Relation::touching;
        contacts.push_back(contact);
      }
    }
    return contacts;
  }
  const char* name;
  Mesh mesh_a;
  Mesh mesh_b;
  Object object_a;
  Object object_b;
  Pose pose_a = Pose::Identity();
  Pose pose_b = Pose::Identity();
};

enum class Call { single, batch, scene };

bool is_refused(const CollisionRequest& request) {
  return request.max_contacts == 0 || (request.within > 0 && request.tells_relation());
}

CollisionResult ask(Call call, Device& device, const Case& c, const CollisionRequest& request,
                    const CollisionHint& hint) {
  if (call == Call::single) return collide(device, c.object_a, c.pose_a, c.object_b, c.pose_b, request, hint);
  if (call == Call::batch) {
    const CollisionQuery query = {&c.object_a, &c.pose_a, &c.object_b, &c.pose_b, hint};
    return collide(device, std::vector<CollisionQuery>(3, query), request).back();
  }
  Scene scene;
  scene.add(c.object_a, c.pose_a);
  scene.add(c.object_b, c.pose_b);
  const std::vector<Scene::Pair> pairs = scene.contacts(device, request);
  return pairs.empty() ? CollisionResult() : pairs.front().result;
}

void check_answer(const Case& c, const CollisionRequest& request, const CollisionResult& result, bool in_scene) {
  const std::vector<Contact> truth = c.truth(request);
  CHECK(result.hit == !truth.empty());
  if (!result.hit) CHECK(result.contacts.empty());
  const bool first = request.contacts == CollisionRequest::Contacts::first;
  const std::size_t limit = first ? 1 : request.max_contacts;
  CHECK(result.contacts.size() == std::min(limit, truth.size()));
  for (const Contact& contact : result.contacts) {
    const auto true_one =
        std::find_if(truth.begin(), truth.end(), [&contact](const Contact& t) { return same_faces(contact, t); });
    REQUIRE(true_one != truth.end());
    CHECK(contact.relation == true_one->relation);
  }
  CHECK(std::is_sorted(result.contacts.begin(), result.contacts.end()));
  const bool asks = request.tells_relation();
  if (result.relation) {
    CHECK(asks);
    Relation greatest = Relation::apart;
    CollisionRequest all = request;
    all.least = Relation::touching;
    all.relation = true;
    for (const Contact& t : c.truth(all)) greatest = std::max(greatest, *t.relation);
    CHECK(*result.relation == greatest);
  } else if (asks && !(in_scene && !result.hit)) {
    CHECK(truth.size() > limit);  // the search ended before it knew
  }
  const bool certified = request.certificate && !(in_scene && !result.hit);
  CHECK((result.certificate != nullptr) == certified);
  if (!certified) return;
  const auto verdict = check_certificate(c.mesh_a, c.pose_a, c.mesh_b, c.pose_b, *result.certificate);
  CHECK(verdict.accepted);
}

}  // namespace

TEST_CASE("options: every combination is right or refused in a sentence", "[lib][options]") {
  const Mesh box = make_box({0, 0, 0}, {1, 1, 1});
  const std::vector<Case> cases = [&box] {
    std::vector<Case> all;
    all.emplace_back("crossing", box, make_box({0.25, 0.25, 0.5}, {0.75, 0.625, 2}), Vec3d(0, 0, 0));
    all.emplace_back("touching", box, box, Vec3d(1, 0.25, 0.5));
    all.emplace_back("near", box, box, Vec3d(1.125, 0.25, 0.5));
    all.emplace_back("apart", box, box, Vec3d(9, 0, 0));
    return all;
  }();
  std::vector<std::unique_ptr<Device>> devices;
  for (const std::string& target : cpu_targets()) devices.push_back(open_cpu_device({2, target}));
  for (const std::string& name : device_names()) {
    if (name != "cpu") devices.push_back(open_device(name));
  }
  std::size_t asked = 0;
  std::size_t refused = 0;
  // The digits of a number are the choices of a request.
  const std::vector<std::size_t> choices = {2, 2, 2, 2, 4, 2, 3, 3};
  std::size_t combinations = 1;
  for (const std::size_t of_one : choices) combinations *= of_one;
  for (const Case& c : cases) {
    CollisionRequest everything;
    everything.contacts = CollisionRequest::Contacts::all;
    everything.relation = true;
    const std::vector<Contact> touching = c.truth(everything);
    for (std::size_t number = 0; number < combinations; ++number) {
      std::size_t rest = number;
      std::vector<std::size_t> choice;
      for (const std::size_t of_one : choices) {
        choice.push_back(rest % of_one);
        rest /= of_one;
      }
      CollisionRequest request;
      request.contacts = choice[0] == 0 ? CollisionRequest::Contacts::first : CollisionRequest::Contacts::all;
      request.relation = choice[1] != 0;
      request.least = choice[2] == 0 ? Relation::touching : Relation::crossing;
      request.certificate = choice[3] != 0;
      request.max_contacts = std::array<std::size_t, 4>{no_limit, 1, 3, 0}[choice[4]];
      request.within = choice[5] == 0 ? 0 : 0.25;
      CollisionHint hint;  // none, one that is right if there is any, a wrong one
      if (choice[6] == 1 && !touching.empty()) hint = touching.back();
      if (choice[6] == 2) hint.face_a = hint.face_b = 1000000;
      const Call call = std::array<Call, 3>{Call::single, Call::batch, Call::scene}[choice[7]];
      if (call == Call::scene && choice[6] != 0) continue;  // scenes take no hints
      for (const std::unique_ptr<Device>& device : devices) {
        CAPTURE(c.name, number, device->name());
        ++asked;
        if (is_refused(request)) {
          ++refused;
          try {
            ask(call, *device, c, request, hint);
            FAIL("not refused");
          } catch (const std::invalid_argument& error) {
            const std::string text = error.what();
            CHECK(text.find('\n') == std::string::npos);
            CHECK(text.find("report") == std::string::npos);
          }
          continue;
        }
        check_answer(c, request, ask(call, *device, c, request, hint), call == Call::scene);
      }
    }
  }
  CHECK(refused > asked / 3);
  CHECK(refused < asked);
}
