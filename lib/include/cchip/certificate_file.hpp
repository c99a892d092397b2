// SPDX-License-Identifier: Apache-2.0
/// \file
/// Certificates and their trees as lines of JSON (docs/cpp/certificates.md).
#ifndef CCHIP_CERTIFICATE_FILE_HPP
#define CCHIP_CERTIFICATE_FILE_HPP

#include <cchip/certificate_tree.hpp>
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>

namespace cchip {

/// The claim in the first line, then a line for each cell. More of them may follow in the same stream.
void write_certificate(const Certificate& certificate, std::ostream& out);

/// Reads one after another from a stream that holds any number of them. Memory is proportional to the largest.
class CertificateReader {
 public:
  explicit CertificateReader(std::istream& in) : in_(in) {}
  /// \returns nothing at the end of the stream
  /// \throws std::runtime_error as read_certificate(); nothing can be read after that
  std::optional<Certificate> next();

 private:
  std::istream& in_;
  std::string line_;        ///< the last one that was read
  std::size_t number_ = 0;  ///< of it, from 1; 0: nothing was read yet
  bool ended_ = false;
};

/// Reads one certificate, to the end of the stream. Memory is proportional to the size of the file.
/// \throws std::runtime_error no such lines, or another version; one line with the number of the line. Also if the
///         library was built without nlohmann-json
Certificate read_certificate(std::istream& in);

/// One line: the order of the faces and the hash of the mesh.
void write_certificate_tree(const CertificateTree& tree, std::ostream& out);

/// Reads and checks it. Keeps a reference to the mesh.
/// \throws std::runtime_error no such line, of another mesh, or an order that does not hold each face once. Also if the
///         library was built without nlohmann-json
CertificateTree read_certificate_tree(const Mesh& mesh, std::istream& in);

}  // namespace cchip

#endif
