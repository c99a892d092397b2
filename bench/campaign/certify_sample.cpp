// SPDX-License-Identifier: Apache-2.0
#include "certify_sample.hpp"

#include <cchip/certify.hpp>
#include <cchip/check.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/internal/grid/grid_oracle.hpp>
#include <stdexcept>

#include "grid_mesh.hpp"

namespace cchip::campaign {
namespace {

bool holds(const GridPair& pair) {
  const Object a(mesh_of({pair.a}));
  const Object b(mesh_of({pair.b}));
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
