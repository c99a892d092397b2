// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cchip/html_page.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "viewer.hpp"

namespace cchip {
namespace {

std::string read_script(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!text.empty()) return text;
  throw std::runtime_error("the library three.js is missing (" + path.string() +
                           "); install Debian's package libjs-three, or name the folder of three.js 0.111 in "
                           "CCHIP_THREE");
}

/// A text as JavaScript in a page: "</script>" in it would end the script. Browsers replace bytes that are not UTF-8.
std::string quoted(const std::string& text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string safe = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || c == '"' || c == '\\' || c == '<') {
      safe += "\\u00";
      safe += digits[code / 16];
      safe += digits[code % 16];
    } else {
      safe += c;
    }
  }
  return safe + '"';
}

/// A text as HTML.
std::string escaped(const std::string& text) {
  std::string html;
  for (const char c : text) {
    if (c == '&' || c == '<') {
      html += c == '&' ? "&amp;" : "&lt;";
    } else {
      html += c;
    }
  }
  return html;
}

/// Numbers with commas, in brackets.
class List {
 public:
  explicit List(std::ostream& out) : out_(out) { out_ << '['; }
  /// An item of another one.
  List(std::ostream& out, List& outer) : out_(out) {
    out_ << (outer.first_ ? "[" : ",[");
    outer.first_ = false;
  }
  template <class Item>
  void add(const Item& item) {
    out_ << (first_ ? "" : ",") << item;
    first_ = false;
  }
  void end() { out_ << ']'; }

 private:
  std::ostream& out_;
  bool first_ = true;
};

std::size_t corners(const Mesh::Face& face) { return face.kind == Kind::quad ? 4 : 3; }

/// Sides of the file's faces: those inside a polygon that was cut belong to two of its triangles.
void write_edges(const Mesh& mesh, std::ostream& out) {
  List edges(out);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Mesh::Face& face = mesh.faces[i];
    for (std::size_t k = 0; k < corners(face); ++k) {
      const std::uint32_t from = face.vertex[k];
      const std::uint32_t to = face.vertex[(k + 1) % corners(face)];
      ++sides[{std::min(from, to), std::max(from, to)}];
    }
    const auto number = [&mesh](std::size_t n) { return mesh.number_in_file(static_cast<std::uint32_t>(n)); };
    if (i + 1 < mesh.faces.size() && number(i + 1) == number(i)) continue;
    for (const auto& [side, count] : sides) {
      if (count % 2 == 0) continue;
      edges.add(side.first);
      edges.add(side.second);
    }
    sides.clear();
  }
  edges.end();
}

/// \param centre subtracted from all points, so that single precision is enough to draw them
void write_mesh(const Mesh& mesh, const Vec3d& centre, std::ostream& out) {
  out << "{\"name\":" << quoted(mesh.name) << ",\"vertices\":";
  List vertices(out);
  for (const Vec3d& vertex : mesh.vertices) {
    for (Eigen::Index i = 0; i < 3; ++i) vertices.add(vertex[i] - centre[i]);
  }
  vertices.end();
  out << ",\"triangles\":";
  List triangles(out);
  for (const Mesh::Face& face : mesh.faces) {
    for (std::size_t k = 2; k < corners(face); ++k) {
      for (const std::size_t corner : {std::size_t{0}, k - 1, k}) triangles.add(face.vertex[corner]);
    }
  }
  triangles.end();
  out << ",\"faces\":";
  List faces(out);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    for (std::size_t k = 2; k < corners(mesh.faces[i]); ++k) {
      faces.add(mesh.number_in_file(static_cast<std::uint32_t>(i)));
    }
  }
  faces.end();
  out << ",\"edges\":";
  write_edges(mesh, out);
  out << '}';
}

/// Middle of the box around the faces of all.
Vec3d centre_of(const std::vector<const Mesh*>& meshes) {
  Eigen::AlignedBox3d box;
  for (const Mesh* mesh : meshes) {
    for (const Mesh::Face& face : mesh->faces) {
      for (std::size_t k = 0; k < corners(face); ++k) box.extend(mesh->vertices[face.vertex[k]]);
    }
  }
  return box.center();
}

/// The ends of all segments: x, y, z, x, y, z.
void write_segments(const std::vector<PageCurve>& curves, const Vec3d& centre, std::ostream& out) {
  List list(out);
  for (const PageCurve& curve : curves) {
    const std::size_t n = curve.points.size();
    for (std::size_t i = 0; i + (curve.closed ? 0 : 1) < n; ++i) {
      const Vec3d& from = curve.points[i];
      const Vec3d& to = curve.points[(i + 1) % n];
      if (!from.allFinite() || !to.allFinite()) continue;
      for (const Vec3d& end : {from, to}) {
        for (Eigen::Index k = 0; k < 3; ++k) list.add(end[k] - centre[k]);
      }
    }
  }
  list.end();
}

void write_contacts(const std::vector<PageContact>& contacts, std::ostream& out) {
  List list(out);
  for (const PageContact& contact : contacts) {
    const int relation = !contact.relation ? 0 : *contact.relation == Relation::crossing ? 2 : 1;
    List row(out, list);
    row.add(contact.face_a);
    row.add(contact.face_b);
    row.add(relation);
    row.end();
  }
  list.end();
}

void write_data(const Mesh& a, const Mesh& b, const std::string& answer, const std::vector<PageContact>& contacts,
                const std::vector<PageCurve>& curves, std::ostream& out) {
  const Vec3d centre = centre_of({&a, &b});
  out << "{\"answer\":" << quoted(answer) << ",\"meshes\":[";
  write_mesh(a, centre, out);
  out << ',';
  write_mesh(b, centre, out);
  out << "],\"contacts\":";
  write_contacts(contacts, out);
  out << ",\"curves\":";
  write_segments(curves, centre, out);
  out << '}';
}

void write_data(const std::vector<Mesh>& parts, const std::string& summary, const std::vector<PagePair>& pairs,
                std::ostream& out) {
  std::map<std::size_t, std::size_t> place;  // in the page
  std::vector<const Mesh*> shown;
  for (const PagePair& pair : pairs) {
    for (const std::size_t part : {pair.a, pair.b}) {
      if (place.emplace(part, shown.size()).second) shown.push_back(&parts[part]);
    }
  }
  const Vec3d centre = centre_of(shown);
  out << "{\"summary\":" << quoted(summary) << ",\"parts\":[";
  const char* comma = "";
  for (const Mesh* mesh : shown) {
    out << comma;
    write_mesh(*mesh, centre, out);
    comma = ",\n";
  }
  out << "],\"pairs\":[";
  comma = "";
  for (const PagePair& pair : pairs) {
    out << comma << "{\"a\":" << place[pair.a] << ",\"b\":" << place[pair.b] << ",\"kind\":" << quoted(pair.kind)
        << ",\"text\":" << quoted(pair.text) << ",\"contacts\":";
    write_contacts(pair.contacts, out);
    out << ",\"curves\":";
    write_segments(pair.curves, centre, out);
    out << '}';
    comma = ",\n";
  }
  out << "]}";
}

/// Puts parts in place of @NAME@; another @ is a letter.
template <class Write>
void fill(std::string_view page, std::ostream& out, const Write& write) {
  while (!page.empty()) {
    const std::size_t mark = page.find('@');
    out << page.substr(0, mark);
    page.remove_prefix(std::min(mark, page.size()));
    const std::size_t end = page.find('@', 1);
    const std::string_view name = end == std::string_view::npos ? "" : page.substr(0, end + 1);
    if (!name.empty() && write(name)) {
      page.remove_prefix(name.size());
    } else {
      out << page.substr(0, 1);
      page.remove_prefix(std::min<std::size_t>(1, page.size()));
    }
  }
}

std::ostringstream page_stream() {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(9);
  return out;
}

/// The viewer's scripts in their places. \param rest writes what belongs in the other places
template <class Write>
std::string viewer_with(const PageScripts& scripts, const Write& rest) {
  std::ostringstream out = page_stream();
  fill(mesh_io::viewer_page, out, [&](std::string_view name) {
    if (name == "@THREE@") {
      out << scripts.three;
    } else if (name == "@CONTROLS@") {
      out << scripts.controls;
    } else {
      return rest(name, out);
    }
    return true;
  });
  return out.str();
}

}  // namespace

PageScripts read_page_scripts(const std::string& folder) {
  const char* const chosen = std::getenv("CCHIP_THREE");
  const std::filesystem::path path = chosen != nullptr ? chosen : folder;
  return {read_script(path / "three.min.js"), read_script(path / "examples/js/controls/OrbitControls.js")};
}

std::string html_page(const Mesh& a, const Mesh& b, const std::string& answer, const std::vector<PageContact>& contacts,
                      const PageScripts& scripts, const std::vector<PageCurve>& curves) {
  return viewer_with(scripts, [&](std::string_view name, std::ostream& out) {
    if (name == "@TITLE@") {
      out << escaped(answer);
    } else if (name == "@DATA@") {
      write_data(a, b, answer, contacts, curves, out);
    } else {
      return false;
    }
    return true;
  });
}

std::string pairs_page(const std::vector<Mesh>& parts, const std::string& title, const std::string& summary,
                       const std::vector<PagePair>& pairs, const PageScripts& scripts) {
  std::ostringstream out = page_stream();
  fill(mesh_io::pairs_page, out, [&](std::string_view name) {
    if (name == "@TITLE@") {
      out << escaped(title);
    } else if (name == "@DATA@") {
      write_data(parts, summary, pairs, out);
    } else if (name == "@VIEWER@") {
      out << quoted(viewer_with(scripts, [](std::string_view, std::ostream&) { return false; }));
    } else {
      return false;
    }
    return true;
  });
  return out.str();
}

}  // namespace cchip
