// SPDX-License-Identifier: Apache-2.0
/// \file
/// Image of an object: its tree as the chip reads it from memory.
#ifndef CCHIP_INTERNAL_IMAGE_IMAGE_HPP
#define CCHIP_INTERNAL_IMAGE_IMAGE_HPP

#include <cchip/internal/image/image_line.hpp>
#include <cchip/internal/tree/tree.hpp>
#include <cchip/internal/wire/bitstream.hpp>
#include <stdexcept>
#include <vector>

namespace cchip::bvh {

/// An image is invalid. what() is one line: the line of the image, the field, what is wrong with it.
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Line 0 is the header; node i of the tree is line i + 1.
///
/// The frame: x of the mesh is (x - centre) 2^-exponent, "the unit". Exactly so: boxes and cuts hold for the vertices
/// as they are, rounded outward. Vertices in leaves are rounded to nearest: each component is off by at most half a
/// step of its leaf, by 0 where `rounded` is 0.
struct Image {
  std::vector<Line> lines;
  HeaderLine header() const { return decode_header(lines.front()); }
};

/// \param tree the tree of the mesh
/// \throws std::invalid_argument more than 2^24 lines
Image make_image(const Mesh& mesh, const Tree& tree);

/// Header and leaves of make_image(), and of the nodes what does not depend on the vertices: their children. A refit
/// engine makes an image of it (docs/modules/cchip_refit.md), whose CRC-32 is not that of the header; a chip does not
/// read it. Takes less time than refit() and make_image(): no volume of a node is computed.
/// \param topology a tree over the mesh's faces; its volumes do not matter
/// \throws std::invalid_argument as make_image()
Image make_leaves(const Mesh& mesh, const Tree& topology);

Bytes to_bytes(const Image& image);

/// Parses the image in these bytes and checks it: sizes, magic, version, CRC-32, every field of every line, the counts,
/// and that each line is reached from the root exactly once.
/// \throws ImageError
Image parse_image(const Bytes& bytes);

/// CRC-32 for the header.
std::uint32_t image_crc(const Image& image);

}  // namespace cchip::bvh

#endif
