// SPDX-License-Identifier: Apache-2.0
#include "certify_sample.hpp"

#include <cchip/certificate/certify.hpp>
#include <cchip/certificate/check.hpp>
#include <cchip/cpu/cpu_device.hpp>
#include <cchip/internal/exact/oracle.hpp>
#include <stdexcept>

namespace cchip::campaign {
namespace {

Mesh mesh_of(const GridPrimitive& primitive) {
  Mesh mesh;
  Mesh::Face face;
  face.kind = primitive.kind;
  for (std::size_t k = 0; k < static_cast<std::size_t>(primitive.kind); ++k) {
    face.vertex[k] = static_cast<std::uint32_t>(k);
    mesh.vertices.emplace_back(primitive.v[k].cast<double>());
  }
  mesh.faces.push_back(face);
  return mesh;
}

bool holds(const GridPair& pair) {
  const Object a(mesh_of(pair.a));
  const Object b(mesh_of(pair.b));
  const Pose here = Pose::Identity();
  CollisionRequest request;
  request.contacts = CollisionRequest::Contacts::all;
  request.relation = true;
  const CollisionResult answer = collide(a, here, b, here, request);
  try {
    const Certificate certificate = certify({&a, &here, &b, &here}, request, answer);
    return certificate.relation == exact_relation(pair) &&
           check_certificate(a.mesh(), here, b.mesh(), here, certificate).accepted;
  } catch (const std::runtime_error&) {  // the answer is wrong
    return false;
  }
}

}  // namespace

bool CertifySample::add(const GridPair& pair) {
  ++certified_;
  if (holds(pair)) return true;
  ++refused_;
  return false;
}

}  // namespace cchip::campaign
