// SPDX-License-Identifier: Apache-2.0
// Prints the table of docs/cpp/touching.md: the cases, answered by the CPU device and by FCL. With --far that of
// docs/cpp/touching_stays.md: the same parts at the origin and far away from it, by every library that the build found;
// --far-cases prints these cases for Python's libraries.
#include <algorithm>
#include <cchip/device.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "other_libraries.hpp"
#include "touching_cases.hpp"

using namespace cchip;
using namespace cchip::testing;

namespace {

/// The table of docs/cpp/touching_stays.md: each library's yes or no where it is right, and where it is wrong.
int far_table() {
  const std::vector<NamedLibrary> libraries = open_libraries();
  const auto device = open_device("cpu");
  std::cout << "| parts | place | by | state | right | ours |";
  for (const auto& [name, library] : libraries) std::cout << ' ' << name << " |";
  std::cout << "\n|---|---|---|---|---|---|";
  for (std::size_t i = 0; i < libraries.size(); ++i) std::cout << "---|";
  std::cout << '\n';
  std::vector<std::size_t> wrong(libraries.size() + 1);
  std::size_t cases = 0;
  const auto cell = [&wrong](std::size_t column, bool hit, bool right) {
    wrong[column] += hit != right ? 1 : 0;
    std::cout << ' ' << (hit == right ? "" : "**") << (hit ? "yes" : "no") << (hit == right ? "" : "**") << " |";
  };
  for (const FarCase& c : far_cases()) {
    ++cases;
    std::cout << "| " << c.part << " | " << c.place << " | " << c.how << " | " << c.state << " | "
              << (c.meets ? "yes" : "no") << " |";
    cell(0, collide(*device, Object(c.a), c.pose, Object(c.b), c.pose).hit, c.meets);
    for (std::size_t i = 0; i < libraries.size(); ++i) {
      const PeerLibrary& library = libraries[i].library;
      cell(i + 1, library.mesh(c.a).hit(c.pose, library.mesh(c.b), c.pose), c.meets);
    }
    std::cout << '\n';
  }
  std::cout << "cases=" << cases << " ours_wrong=" << wrong[0];
  for (std::size_t i = 0; i < libraries.size(); ++i) {
    std::string key = libraries[i].name;
    std::replace(key.begin(), key.end(), ' ', '_');
    std::cout << ' ' << key << "_wrong=" << wrong[i + 1];
  }
  std::cout << '\n';
  return wrong[0] == 0 ? 0 : 1;
}

/// The same cases for bench/peers/touching_python.py, one a line: whether they meet, the rows of the pose, and of each
/// mesh the number of vertices, the vertices, and the triangles. Numbers as the doubles that they are.
void print_far_cases() {
  std::cout << std::hexfloat;
  const auto print_mesh = [](const Mesh& mesh) {
    std::cout << ' ' << std::dec << mesh.vertices.size() << std::hexfloat;
    for (const Vec3d& v : mesh.vertices) std::cout << ' ' << v.x() << ' ' << v.y() << ' ' << v.z();
    std::size_t triangles = 0;
    for (const Mesh::Face& face : mesh.faces) triangles += face.kind == Kind::quad ? 2 : 1;
    std::cout << ' ' << triangles;
    for (const Mesh::Face& face : mesh.faces) {
      const auto& v = face.vertex;
      std::cout << ' ' << v[0] << ' ' << v[1] << ' ' << v[2];
      if (face.kind == Kind::quad) std::cout << ' ' << v[0] << ' ' << v[2] << ' ' << v[3];
    }
  };
  for (const FarCase& c : far_cases()) {
    std::cout << (c.meets ? 1 : 0);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) std::cout << ' ' << c.pose(row, column);
    }
    print_mesh(c.a);
    print_mesh(c.b);
    std::cout << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--far-cases") {
    print_far_cases();
    return 0;
  }
  if (argc > 1 && std::string(argv[1]) == "--far") return far_table();
  const PeerLibrary fcl = PeerLibrary::fcl_debian();
  const auto device = open_device("cpu");
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  request.relation = true;
  const std::string description = fcl.description();
  std::cout << "| case | relation | pairs of faces that cross | that touch | FCL "
            << description.substr(0, description.find(',')) << " |\n|---|---|---|---|---|\n";
  for (const TouchingCase& c : touching_cases()) {
    const CollisionResult result = collide(*device, Object(c.a), c.pose_a, Object(c.b), c.pose_b, request);
    const auto crosses = [](const Contact& contact) { return contact.relation == Relation::crossing; };
    const auto crossing = std::count_if(result.contacts.begin(), result.contacts.end(), crosses);
    const char* relation = crossing > 0 ? "crossing" : result.hit ? "touching" : "apart";
    std::cout << "| " << c.name << " | " << relation << " | " << crossing << " | "
              << static_cast<std::ptrdiff_t>(result.contacts.size()) - crossing << " | "
              << (fcl.mesh(c.a).hit(c.pose_a, fcl.mesh(c.b), c.pose_b) ? "hit" : "no hit") << " |\n";
  }
}
