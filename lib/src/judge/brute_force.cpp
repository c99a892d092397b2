// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/internal/exact/oracle.hpp>
#include <cchip/internal/judge/brute_force.hpp>

namespace cchip {

std::vector<Contact> brute_force_contacts(const Mesh& a, const Pose& pose_a, const Mesh& b, const Pose& pose_b) {
  const auto in_file = [](const Mesh& mesh, std::size_t face) {
    return mesh.file_face.empty() ? static_cast<std::uint32_t>(face) : mesh.file_face[face];
  };
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    for (std::size_t k = 0; k < b.faces.size(); ++k) {
      const Relation relation = exact_relation(a.primitive(i), pose_a, b.primitive(k), pose_b);
      if (relation != Relation::apart) contacts.push_back({in_file(a, i), in_file(b, k), relation});
    }
  }
  // Of those that name the same faces the one that crosses stays.
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& x, const Contact& y) { return same_faces(x, y) ? x.relation > y.relation : x < y; });
  contacts.erase(std::unique(contacts.begin(), contacts.end(),
                             [](const Contact& x, const Contact& y) { return same_faces(x, y); }),
                 contacts.end());
  return contacts;
}

}  // namespace cchip
