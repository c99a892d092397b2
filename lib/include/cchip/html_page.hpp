// SPDX-License-Identifier: Apache-2.0
/// \file
/// One file to look at the answer of a query in a browser.
#ifndef CCHIP_HTML_PAGE_HPP
#define CCHIP_HTML_PAGE_HPP

#include <cchip/mesh.hpp>
#include <cchip/relation.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cchip {

/// The JavaScript library three.js 0.111, which draws, and its orbit controls.
struct PageScripts {
  std::string three;
  std::string controls;
};

/// From the folder that the environment variable CCHIP_THREE names, or else from `folder`.
/// \param folder with three.min.js and examples/js/controls/OrbitControls.js; by default that of Debian's libjs-three
/// \throws std::runtime_error a file is missing or empty
PageScripts read_page_scripts(const std::string& folder = "/usr/share/javascript/three");

/// A row of the page's list, as cchip::Contact.
struct PageContact {
  std::uint32_t face_a;  ///< number in the file or array
  std::uint32_t face_b;
  std::optional<Relation> relation;
};

/// A line where the meshes meet, as cchip::IntersectionCurve.
struct PageCurve {
  std::vector<Vec3d> points;
  bool closed = false;
};

/// An HTML page with both meshes, to be turned, cut and clicked, and the list of their contacts. It needs nothing
/// beside it.
/// \param a, b in their places, in any length unit
/// \param answer in words, the heading, UTF-8
/// \param curves drawn over the faces; a point that is not finite interrupts them
std::string html_page(const Mesh& a, const Mesh& b, const std::string& answer, const std::vector<PageContact>& contacts,
                      const PageScripts& scripts, const std::vector<PageCurve>& curves = {});

/// Two parts in a page of pairs.
struct PagePair {
  std::size_t a = 0;  ///< numbers of parts
  std::size_t b = 0;
  std::string kind;  ///< a word, by which rows can be hidden, such as "violation"
  std::string text;  ///< UTF-8
  std::vector<PageContact> contacts = {};
  std::vector<PageCurve> curves = {};
};

/// An HTML page with a list of pairs, the chosen one of which is shown as html_page() shows it. It needs nothing beside
/// it.
/// \param parts in their places, in any length unit; those that no pair names are not written
/// \param title, summary UTF-8
std::string pairs_page(const std::vector<Mesh>& parts, const std::string& title, const std::string& summary,
                       const std::vector<PagePair>& pairs, const PageScripts& scripts);

}  // namespace cchip

#endif
