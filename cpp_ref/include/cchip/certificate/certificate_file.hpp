// SPDX-License-Identifier: Apache-2.0
/// \file
/// Certificates as lines of JSON (docs/cpp/certificates.md).
#ifndef CCHIP_CERTIFICATE_CERTIFICATE_FILE_HPP
#define CCHIP_CERTIFICATE_CERTIFICATE_FILE_HPP

#include <cchip/certificate/certificate.hpp>
#include <iosfwd>

namespace cchip {

/// The claim in the first line, then a line for each cell.
void write_certificate(const Certificate& certificate, std::ostream& out);

/// Reads what write_certificate() writes, to the end of the stream. Memory is proportional to the size of the file.
/// \throws std::runtime_error no such lines, or another version; one line with the number of the line. Also if the
///         library was built without nlohmann-json
Certificate read_certificate(std::istream& in);

}  // namespace cchip

#endif
