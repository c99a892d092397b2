// SPDX-License-Identifier: Apache-2.0
/// \file
/// Makes certificates (docs/cpp/certificates.md).
#ifndef CCHIP_CERTIFY_HPP
#define CCHIP_CERTIFY_HPP

#include <cchip/certificate_tree.hpp>
#include <cchip/collide.hpp>

namespace cchip {

/// Trees of both objects' meshes that a certificate cites: it is short then, quick to make and quick to check. Made and
/// checked once for a mesh. A certificate of one contact cites none.
struct CitedTrees {
  const CertificateTree* a = nullptr;
  const CertificateTree* b = nullptr;
};

/// Keeps a reference to the mesh, such as Object::mesh().
/// \throws std::invalid_argument check_faces() refuses the mesh, or it has no faces
CertificateTree make_certificate_tree(const Mesh& mesh);

/// The answer to a query with its proof, found without a device. With Contacts::first and a hit, the proof of one
/// contact; otherwise of all contacts. So is that of a relation that is touching, because it says that none crosses.
/// max_contacts is ignored. Takes far longer than collide(), see the page.
/// \throws std::invalid_argument check_query() refuses the query; a tree is missing or of another mesh
Certificate certify(const CollisionQuery& query, const CollisionRequest& request = {}, const CitedTrees& trees = {});

/// The proof of a device's answer. Of a hit that names one contact it proves that contact, which needs no search.
/// \throws std::invalid_argument as above
/// \throws std::runtime_error the answer is wrong
Certificate certify(const CollisionQuery& query, const CollisionRequest& request, const CollisionResult& answer,
                    const CitedTrees& trees = {});

/// The proof that faces are nearer than `distance`: of one pair, or of all of them, and then that all others are at
/// least so far apart. With Contacts::first and no such pair, of the latter alone.
/// \throws std::invalid_argument the distance is not above 0 or not finite; check_query() refuses the query
Certificate certify_below(const CollisionQuery& query, double distance,
                          CollisionRequest::Contacts contacts = CollisionRequest::Contacts::first,
                          const CitedTrees& trees = {});

/// The proof that no translation of B by a positive multiple of `along` leaves a face of B in contact with one of A;
/// nothing if one does. In the poses themselves they may touch. Of solids that a long translation parts it follows that
/// they share no volume.
/// \throws std::invalid_argument `along` is 0 or not finite; check_query() refuses the query
std::optional<Certificate> certify_clear_along(const CollisionQuery& query, const Vec3d& along,
                                               const CitedTrees& trees = {});

/// What devices do with a result if the request is for a certificate: fills CollisionResult::certificate.
/// \throws as certify()
void add_certificate(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& answer);

}  // namespace cchip

#endif
