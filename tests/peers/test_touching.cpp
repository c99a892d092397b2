// SPDX-License-Identifier: Apache-2.0
// Every row of the table in docs/cpp/touching.md, answered by each device and by the exact oracle, face by face.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cchip/device.hpp>
#include <cchip/driver/model_device.hpp>
#include <cchip/internal/judge/brute_force.hpp>

#include "touching_cases.hpp"

using namespace cchip;
using namespace cchip::testing;

namespace {

const TouchingCase& case_named(const std::string& name) {
  static const std::vector<TouchingCase> cases = touching_cases();
  const auto found = std::find_if(cases.begin(), cases.end(), [&](const TouchingCase& c) { return c.name == name; });
  if (found == cases.end()) FAIL("no case '" << name << "'");
  return *found;
}

/// Contacts of the other order of the objects.
std::vector<Contact> turned_round(std::vector<Contact> contacts) {
  for (Contact& contact : contacts) std::swap(contact.face_a, contact.face_b);
  std::sort(contacts.begin(), contacts.end());
  return contacts;
}

void expect(Device& device, const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b, Relation relation,
            const std::vector<Contact>& contacts) {
  CollisionRequest request;
  request.relation = true;
  const CollisionResult first = collide(device, a, pose_a, b, pose_b, request);
  CHECK(first.relation == relation);
  CHECK(first.hit == (relation != Relation::apart));
  request.contacts = CollisionRequest::Contacts::all;
  const CollisionResult all = collide(device, a, pose_a, b, pose_b, request);
  CHECK(all.relation == relation);
  CHECK(std::equal(all.contacts.begin(), all.contacts.end(), contacts.begin(), contacts.end()));
  request = {};
  request.least = Relation::crossing;
  CHECK(collide(device, a, pose_a, b, pose_b, request).hit == (relation == Relation::crossing));
}

/// Of the case that has the name of the test.
void expect(Relation relation) {
  const TouchingCase& c = case_named(Catch::getResultCapture().getCurrentTestName());
  const std::vector<Contact> contacts = brute_force_contacts(c.a, c.pose_a, c.b, c.pose_b);
  Relation greatest = Relation::apart;
  for (const Contact& contact : contacts) greatest = std::max(greatest, contact.relation.value());
  CHECK(greatest == relation);
  const Object a(c.a);
  const Object b(c.b);
  add_model_device();
  for (const char* device_name : {"cpu", "model"}) {
    INFO(device_name);
    const auto device = open_device(device_name);
    expect(*device, a, c.pose_a, b, c.pose_b, relation, contacts);
    expect(*device, b, c.pose_b, a, c.pose_a, relation, turned_round(contacts));
  }
}

}  // namespace

TEST_CASE("flush boxes", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("flush boxes, pressed in by 2^-53", "[ref][touching]") { expect(Relation::crossing); }
TEST_CASE("flush boxes, pulled off by 2^-52", "[ref][touching]") { expect(Relation::apart); }
TEST_CASE("flush boxes, poses multiplied in doubles", "[ref][touching]") { expect(Relation::apart); }
TEST_CASE("box on its edge on a face", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("vertex on a face far from the origin", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("vertex below a face far from the origin", "[ref][touching]") { expect(Relation::crossing); }
TEST_CASE("vertex above a face far from the origin", "[ref][touching]") { expect(Relation::apart); }
TEST_CASE("vertex on a face, both turned and far from the origin", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("peg in its hole", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("peg in its hole, both turned and far from the origin", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("peg in its hole, thicker by 2^-52", "[ref][touching]") { expect(Relation::crossing); }
TEST_CASE("peg in its hole, thinner by 2^-53", "[ref][touching]") { expect(Relation::apart); }
TEST_CASE("gear pair in mesh", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("gear pair, moved on by 2^-30", "[ref][touching]") { expect(Relation::crossing); }
TEST_CASE("gear pair, moved back by 2^-30", "[ref][touching]") { expect(Relation::apart); }
TEST_CASE("nested boxes", "[ref][touching]") { expect(Relation::apart); }
TEST_CASE("identical objects", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("bars of one section, pushed into each other", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("bars of one section, pushed into each other, one shrunk by 2^-30", "[ref][touching]") {
  expect(Relation::crossing);
}
TEST_CASE("cubes cut on one raster, a corner of one at the centre of the other", "[ref][touching]") {
  expect(Relation::touching);
}
TEST_CASE("sheet through the common edge of two faces", "[ref][touching]") { expect(Relation::touching); }
TEST_CASE("sheet beside the common edge of two faces", "[ref][touching]") { expect(Relation::crossing); }
TEST_CASE("sheet through the same floor as one face", "[ref][touching]") { expect(Relation::crossing); }

TEST_CASE("the same parts at the origin and far away: apart, flush and pressed in stay what they are",
          "[ref][touching]") {
  const auto device = open_device("cpu");
  std::size_t cases = 0;
  for (const FarCase& c : far_cases()) {
    CAPTURE(c.part, c.place, c.how, c.state);
    ++cases;
    const std::vector<Contact> contacts = brute_force_contacts(c.a, c.pose, c.b, c.pose);
    CHECK(contacts.empty() == !c.meets);
    CollisionRequest request;
    request.relation = true;
    const CollisionResult result = collide(*device, Object(c.a), c.pose, Object(c.b), c.pose, request);
    const bool flush = std::string(c.state) == "flush";
    CHECK(result.relation == (!c.meets ? Relation::apart : flush ? Relation::touching : Relation::crossing));
  }
  CHECK(cases == 54);
}
