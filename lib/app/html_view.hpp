// SPDX-License-Identifier: Apache-2.0
/// \file
/// One file to look at the answer of a query in a browser.
#ifndef CCHIP_APP_HTML_VIEW_HPP
#define CCHIP_APP_HTML_VIEW_HPP

#include <cchip/collide.hpp>
#include <cchip/html_page.hpp>
#include <cchip/intersection.hpp>
#include <cchip/mesh.hpp>
#include <cchip/program/output_file.hpp>
#include <string>
#include <vector>

namespace cchip::app {

/// Accepts an empty path, which stands for no view, and names without an extension, such as those of pipes.
/// \throws UsageError the name has another extension than .html or .htm
void check_view_name(const std::string& path);

/// Both meshes, to be turned, cut and clicked, with the list of their contacts. The file needs nothing beside it: it
/// holds the library three.js, which is read from the folder of Debian's package libjs-three, or from CCHIP_THREE if
/// that is set.
class HtmlView {
 public:
  /// The file appears when it is complete, see sim::OutputFile.
  /// \throws UsageError the library is missing
  /// \throws sim::OutputError the file cannot be written
  explicit HtmlView(const std::string& path);
  /// \param b in its place
  /// \param answer in words, the heading
  /// \throws sim::OutputError as above
  void write(const Mesh& a, const Mesh& b, const std::string& answer, const std::vector<Contact>& contacts,
             const std::vector<IntersectionCurve>& curves);

 private:
  PageScripts scripts_;
  sim::OutputFile file_;
};

}  // namespace cchip::app

#endif
