// SPDX-License-Identifier: Apache-2.0
/// \file
/// Makes certificates (docs/cpp/certificates.md).
#ifndef CCHIP_CERTIFY_HPP
#define CCHIP_CERTIFY_HPP

#include <cchip/certificate.hpp>
#include <cchip/collide.hpp>

namespace cchip {

/// The answer to a query with its proof, found without a device. With Contacts::first and a hit, the proof of one
/// contact; otherwise of all contacts. So is that of a relation that is touching, because it says that none crosses.
/// max_contacts is ignored. Takes far longer than collide(), see the page.
/// \throws std::invalid_argument check_query() refuses the query
Certificate certify(const CollisionQuery& query, const CollisionRequest& request = {});

/// The proof of a device's answer. Of a hit that names one contact it proves that contact, which needs no search.
/// \throws std::invalid_argument as above
/// \throws std::runtime_error the answer is wrong
Certificate certify(const CollisionQuery& query, const CollisionRequest& request, const CollisionResult& answer);

/// What devices do with a result if the request is for a certificate: fills CollisionResult::certificate.
/// \throws as certify()
void add_certificate(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& answer);

}  // namespace cchip

#endif
