// SPDX-License-Identifier: Apache-2.0
#include "other_formats.hpp"

#include <algorithm>
#include <array>
#include <cchip/internal/geometry/decimal.hpp>
#include <cctype>
#include <filesystem>
#include <vector>

#include "polygon_soup.hpp"
#include "text.hpp"

namespace cchip::mesh_io {
namespace {

using namespace std::string_view_literals;

// scripts/run test-ply runs the commands in Python, Gmsh and MeshLab, tests/system/test_file_messages.cpp those of
// assimp. In a remedy % stands for the name of the file.
constexpr std::string_view by_gmsh = "mesh it first, for example with `gmsh -2 % -o part.stl` or with FreeCAD";
constexpr std::string_view by_ifcopenshell =
    "write each building element as a mesh of its own with IfcOpenShell, which gives vertices and faces in metres";
constexpr std::string_view by_trimesh =
    "`cchip clash` judges the parts of .glb, .gltf and .3mf files; for one mesh convert it with trimesh, which keeps "
    "numbers, axes and the places of the parts: `python3 -c \"import trimesh; "
    "trimesh.load_mesh('%').export('part.obj', digits=17)\"`";
constexpr std::string_view by_meshlab =
    "convert it to PLY with MeshLab, which keeps axes and units: File, Import Mesh, then File, Export Mesh As "
    "(Debian's "
    "assimp turns, scales or refuses some of them)";
constexpr std::string_view by_assimp =
    "convert it with `assimp export % part.obj`, which rounds to single precision and may turn axes and change the "
    "unit: compare the size";
constexpr std::string_view by_pyvista =
    "convert it with PyVista: `python3 -c \"import pyvista; "
    "pyvista.read('%').extract_surface().triangulate().save('part.obj')\"`";
constexpr std::string_view by_meshio = "convert it with `meshio convert % part.obj`, which keeps all digits";
constexpr std::string_view by_blender =
    "open it in Blender and export PLY, whose axes it does not turn as it does those of OBJ; it rounds to single "
    "precision";
constexpr std::string_view by_laspy =
    "write its points as text: `python3 -c \"import laspy, numpy; numpy.savetxt('scan.xyz', laspy.read('%').xyz, "
    "fmt='%.17g')\"`, and give --points";
constexpr std::string_view by_laspy_and_lazrs =
    "write its points as text, with Python's laspy and lazrs: `python3 -c \"import laspy, numpy; "
    "numpy.savetxt('scan.xyz', laspy.read('%').xyz, fmt='%.17g')\"`, and give --points";
constexpr std::string_view by_cloudcompare =
    "write its points as text (ASC) with CloudCompare, which rounds them to single precision, and give --points";

struct OtherFormat {
  std::string_view name;
  std::string_view ends;   ///< of names, each with a blank behind it
  std::string_view begin;  ///< of the file; empty: only the name tells
  std::string_view remedy;
};

constexpr std::array<OtherFormat, 23> formats = {{
    {"IFC", ".ifc .ifczip .ifcxml ", {}, by_ifcopenshell},
    {"STEP (surfaces of CAD, not a mesh)", ".step .stp ", "ISO-10303-21", by_gmsh},
    {"IGES (surfaces of CAD, not a mesh)", ".iges .igs ", {}, by_gmsh},
    {"BREP (surfaces of CAD, not a mesh)", ".brep ", "DBRep_DrawableShape", by_gmsh},
    {"3MF", ".3mf ", {}, by_trimesh},
    {"glTF", ".glb .gltf ", "glTF", by_trimesh},
    {"COLLADA", ".dae ", {}, by_meshlab},
    {"3DS", ".3ds ", {}, by_meshlab},
    {"VRML", ".wrl .vrml ", "#VRML", by_meshlab},
    {"FBX", ".fbx ", "Kaydara FBX Binary", by_assimp},
    {"AMF", ".amf ", {}, by_assimp},
    {"X3D", ".x3d ", {}, by_assimp},
    {"DirectX", ".x ", "xof 0", by_assimp},
    {"Blender", ".blend ", "BLENDER-", by_blender},
    {"Blender", ".blend ", "BLENDER_", by_blender},
    {"VTK", ".vtk .vtp .vtu .vtm ", "# vtk DataFile", by_pyvista},
    {"VTK", ".vtp .vtu .vtm ", "<VTKFile", by_pyvista},
    {"Gmsh", ".msh ", "$MeshFormat", by_meshio},
    {"USD", ".usd .usda .usdc .usdz ", "#usda", by_blender},
    {"USD", ".usdc ", "PXR-USDC", by_blender},
    {"LAS", ".las ", "LASF", by_laspy},
    {"LAZ", ".laz ", {}, by_laspy_and_lazrs},
    {"E57", ".e57 ", "ASTM-E57", by_cloudcompare},
}};

/// "is IFC, which is not read; ..."
std::string sentence(const OtherFormat& format, const std::string& name) {
  const std::string file = std::filesystem::path(name).filename().string();
  std::string text = "is " + std::string(format.name) + ", which is not read; ";
  for (std::size_t i = 0; i < format.remedy.size(); ++i) {
    const bool here = format.remedy[i] == '%' && format.remedy.substr(i, 2) != "%.";
    text += here ? file : std::string(1, format.remedy[i]);
  }
  return text;
}

const OtherFormat* named_by(const std::string& name) {
  const std::string end = extension_of(name) + " ";
  if (end == " ") return nullptr;
  for (const OtherFormat& format : formats) {
    const auto at = format.ends.find(end);
    if (at != std::string_view::npos && (at == 0 || format.ends[at - 1] == ' ')) return &format;
  }
  return nullptr;
}

bool begins_with(std::string_view text, std::string_view begin) {
  return text.size() >= begin.size() && std::equal(begin.begin(), begin.end(), text.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
         });
}

bool is_html(std::string_view file) {
  const std::string_view text = file.substr(std::min(file.find_first_not_of(" \t\r\n"), file.size()));
  return begins_with(text, "<!doctype html") || begins_with(text, "<html");
}

/// Three numbers or more in the first line that is no comment.
bool looks_like_points(std::string_view file) {
  Lines lines(file.substr(0, std::size_t{1} << 12), {true, false});
  if (!lines.next() || lines.words().size() < 3) return false;
  return std::all_of(lines.words().begin(), lines.words().begin() + 3,
                     [](std::string_view word) { return read_decimal(word).has_value(); });
}

}  // namespace

std::string extension_of(const std::string& name) {
  std::string end = std::filesystem::path(name).extension().string();
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  return end;
}

std::string not_read_by_content(std::string_view file, const std::string& name) {
  if (begins_with(file, "version https://git-lfs.github.com/spec/")) {
    return "is a Git LFS pointer, not the file itself; run `git lfs pull` in its repository";
  }
  if (is_html(file)) return "is a web page (HTML), not a mesh; download the file behind it";
  if (begins_with(file, "ISO-10303-21")) {  // the header names the schema
    const bool ifc = file.substr(0, 4096).find("('IFC") != std::string_view::npos;
    return sentence(formats[ifc ? 0 : 1], name);
  }
  for (const OtherFormat& format : formats) {
    if (!format.begin.empty() && file.substr(0, format.begin.size()) == format.begin) return sentence(format, name);
  }
  return {};
}

std::string not_read_by_name(const std::string& name) {
  const OtherFormat* format = named_by(name);
  return format == nullptr ? "" : sentence(*format, name);
}

std::string no_points_by_name(const std::string& name) {
  if (extension_of(name) == ".stl") return "is STL, a mesh; name the file of points first and the mesh behind it";
  const OtherFormat* format = named_by(name);
  return format != nullptr ? sentence(*format, name) : "";
}

std::string points_not_mesh(std::string_view file, const std::string& name) {
  constexpr std::array<std::string_view, 7> ends = {".pcd", ".xyz", ".pts", ".ptx", ".asc", ".csv", ".xyzrgb"};
  const bool by_name = std::find(ends.begin(), ends.end(), extension_of(name)) != ends.end();
  const bool by_content = file.substr(0, 6) == "# .PCD" || looks_like_points(file);
  return by_name || by_content ? "holds points, no faces; " + std::string(points_come_first) : "";
}

}  // namespace cchip::mesh_io
