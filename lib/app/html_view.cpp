// SPDX-License-Identifier: Apache-2.0
#include "html_view.hpp"

#include <fmt/format.h>

#include <array>
#include <cchip/program/usage_error.hpp>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

namespace cchip::app {
namespace {

constexpr std::size_t rows_listed = 10000;  ///< contacts that the list of a page has in any case

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
  // The first ones, and behind them those that show a face, or show it crossing, for the first time: all faces that
  // meet something have their colour, and the page is no larger than the meshes and this list.
  std::vector<PageContact> rows;
  std::array<std::map<std::uint32_t, bool>, 2> shown;  // each face, and whether it crosses
  for (const Contact& contact : contacts) {
    const bool crosses = contact.relation == Relation::crossing;
    bool is_new = false;
    for (const auto& [of_side, face] : {std::pair{&shown[0], contact.face_a}, std::pair{&shown[1], contact.face_b}}) {
      const auto [at, first] = of_side->emplace(face, crosses);
      is_new = is_new || first || (crosses && !at->second);
      at->second = at->second || crosses;
    }
    if (rows.size() < rows_listed || is_new) rows.push_back({contact.face_a, contact.face_b, contact.relation});
  }
  const std::string heading =
      rows.size() == contacts.size()
          ? answer
          : fmt::format("{} (the list has {} of {} pairs; --format csv has all)", answer, rows.size(), contacts.size());
  std::vector<PageCurve> lines;
  lines.reserve(curves.size());
  for (const IntersectionCurve& curve : curves) lines.push_back({curve.points, curve.closed});
  file_.stream() << html_page(a, b, heading, rows, scripts_, lines);
  file_.commit();
}

}  // namespace cchip::app
