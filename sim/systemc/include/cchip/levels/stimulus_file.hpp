// SPDX-License-Identifier: Apache-2.0
/// \file
/// Stimulus as a file of comma-separated values.
///
/// The first row names the columns, which may be in any order, others are ignored:
///     object_pair   whole number that does not decrease; rows with the same number are one pair of objects
///     mode          exhaustive or directed
///     m00 .. m23    the matrix: row, column; multiples of 1/1024
///     kind_a, kind_b          tri or quad; a triangle before a quad; kind_a may be point, kind_b is tri then
///     a0x, a0y, a0z .. b3z    vertices, whole numbers; those of index 3 are ignored for triangles. Of a point a0 is
///     the
///                             centre, a1x the radius, and the others of a are ignored
#ifndef CCHIP_LEVELS_STIMULUS_FILE_HPP
#define CCHIP_LEVELS_STIMULUS_FILE_HPP

#include <cchip/levels/stimulus.hpp>
#include <iosfwd>
#include <string>

namespace cchip::levels {

void write_stimulus(std::ostream& out, const Stimulus& stimulus);

/// \param name of the file, for messages
/// \throws UsageError file, line, what is wrong and what to do; also if the file has no pair
Stimulus read_stimulus(std::istream& in, const std::string& name);

}  // namespace cchip::levels

#endif
