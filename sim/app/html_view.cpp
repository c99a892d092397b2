// SPDX-License-Identifier: Apache-2.0
#include "html_view.hpp"

#include <fmt/format.h>

#include <cchip/stimulus/usage_error.hpp>
#include <filesystem>
#include <stdexcept>

namespace cchip::app {
namespace {

PageScripts read_scripts() {
  try {
    return read_page_scripts();
  } catch (const std::runtime_error& error) {
    throw UsageError(std::string("--html: ") + error.what());
  }
}

}  // namespace

void check_view_name(const std::string& path) {
  const std::string end = std::filesystem::path(path).extension().string();
  if (end.empty() || end == ".html" || end == ".htm") return;
  throw UsageError(fmt::format("--html {}: the view is an HTML file; give a name that ends with .html", path));
}

HtmlView::HtmlView(const std::string& path) : scripts_(read_scripts()), file_(path) {}

void HtmlView::write(const Mesh& a, const Mesh& b, const std::string& answer, const std::vector<Contact>& contacts,
                     const std::vector<IntersectionCurve>& curves) {
  std::vector<PageContact> rows;
  rows.reserve(contacts.size());
  for (const Contact& contact : contacts) rows.push_back({contact.face_a, contact.face_b, contact.relation});
  std::vector<PageCurve> lines;
  lines.reserve(curves.size());
  for (const IntersectionCurve& curve : curves) lines.push_back({curve.points, curve.closed});
  file_.stream() << html_page(a, b, answer, rows, scripts_, lines);
  file_.commit();
}

}  // namespace cchip::app
