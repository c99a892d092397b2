// SPDX-License-Identifier: Apache-2.0
// Any bytes as a file of certificates of two boxes. What is accepted must be true.
#include <algorithm>
#include <array>
#include <cchip/certificate_file.hpp>
#include <cchip/check.hpp>
#include <cchip/internal/judge/brute_force.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "require.hpp"

using namespace cchip;

namespace {

/// The box from 0 to 1 of docs/cpp/certificates.md.
Mesh box() {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1U, i >> 1U & 1U, i >> 2U);
  for (const auto& face : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                           {4, 5, 7, 6},
                           {0, 1, 5, 4},
                           {2, 6, 7, 3},
                           {0, 4, 6, 2},
                           {1, 3, 7, 5}}) {
    mesh.faces.push_back({Kind::quad, face});
  }
  return mesh;
}

std::string written(const Certificate& certificate) {
  std::ostringstream out;
  write_certificate(certificate, out);
  return out.str();
}

/// B is the same box, moved along x: crossing, flush, apart.
struct Scene {
  Pose pose = Pose::Identity();
  std::vector<Contact> contacts;
  Relation relation = Relation::apart;
};

bool is_true(const Certificate& c, const Scene& scene) {
  std::vector<Contact> truth;
  for (const Contact& contact : scene.contacts) {
    if (*contact.relation >= c.least) truth.push_back(contact);
  }
  if (c.relation && *c.relation != scene.relation) return false;
  if (c.all ? c.contacts.size() != truth.size() : c.contacts.size() != 1) return false;
  return std::all_of(c.contacts.begin(), c.contacts.end(), [&](const Certificate::Contact& x) {
    return std::any_of(truth.begin(), truth.end(), [&](const Contact& y) {
      return x.face_a == y.face_a && x.face_b == y.face_b && (!x.relation || x.relation == y.relation);
    });
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Mesh mesh = box();
  static const std::array<Scene, 3> scenes = [] {
    std::array<Scene, 3> result;
    double x = 0.5;
    for (Scene& scene : result) {
      scene.pose.translation() = Vec3d(x, 0.25, 0.125);
      scene.contacts = brute_force_contacts(mesh, Pose::Identity(), mesh, scene.pose);
      for (const Contact& contact : scene.contacts) scene.relation = std::max(scene.relation, *contact.relation);
      x += 0.5;
    }
    return result;
  }();
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    CertificateReader reader(in);
    while (const std::optional<Certificate> certificate = reader.next()) {
      std::istringstream again(written(*certificate));
      require(written(read_certificate(again)) == written(*certificate), "what is written is read again");
      for (const Scene& scene : scenes) {
        const CertificateVerdict verdict = check_certificate(mesh, Pose::Identity(), mesh, scene.pose, *certificate);
        require(!verdict.accepted || is_true(*certificate, scene), "what is accepted is true");
        require(verdict.accepted == verdict.reason.empty(), "a refusal has a reason");
        require(verdict.cell <= certificate->cells.size(), "a refusal names a cell or the claim");
      }
    }
  } catch (const std::runtime_error& error) {
    require_one_line(error);
  }
  return 0;
}
