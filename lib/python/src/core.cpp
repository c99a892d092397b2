// SPDX-License-Identifier: Apache-2.0
// Python module collisionchip._core: arrays to C++ and back. What the answers mean is decided in the library.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <atomic>
#include <cchip/cchip.hpp>
#include <cchip/certificate_file.hpp>
#include <cchip/driver/model_device.hpp>
#include <cchip/html_page.hpp>
#include <cchip/internal/judge/brute_force.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "assembly.hpp"
#include "convert.hpp"

namespace nb = nanobind;
using namespace nb::literals;

/// What may be an object that is not in a scene: anything but a number, which is the id of one that is.
struct Outside {
  nb::handle value;
};
template <>
struct nanobind::detail::type_caster<Outside> {
  NB_TYPE_CASTER(Outside, const_name("Object"))
  bool from_python(handle source, std::uint8_t /*flags*/, cleanup_list* /*list*/) noexcept {
    if (PyIndex_Check(source.ptr()) != 0) {
      PyObject* const number = PyNumber_Index(source.ptr());
      if (number != nullptr) {
        Py_DECREF(number);
        return false;
      }
      PyErr_Clear();  // an array, which may have no number
    }
    value.value = source;
    return true;
  }
};

namespace {

using cchip::CollisionRequest;
using cchip::CollisionResult;
using cchip::Device;
using cchip::Scene;

using namespace collisionchip_python;

template <auto query>
cchip::AlongResult along(nb::handle object_a, nb::handle pose_a, nb::handle object_b, nb::handle pose_b,
                         nb::handle direction) {
  const Object a = to_object(object_a, "a");
  const Object b = to_object(object_b, "b");
  const Pose place_a = one_pose(pose_a, "pose_a");
  const Pose place_b = one_pose(pose_b, "pose_b");
  const Vec3d d = one_direction(direction);
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  return query(a, place_a, b, place_b, d);
}

Object load(nb::handle path, bool quads, bool lenient) {
  return read_file(path, [&](const std::string& name) {
    cchip::LoadOptions options;
    options.kinds = quads ? cchip::FaceKinds::triangles_and_quads : cchip::FaceKinds::triangles;
    options.lenient = lenient;
    return Object(cchip::load_mesh(name, options));
  });
}

// Parts of an object, also for pickle.

using Doubles = nb::ndarray<nb::numpy, const double, nb::shape<-1, 3>>;

Doubles vertices_of(const Object& x) {
  static_assert(sizeof(cchip::Vec3d) == 3 * sizeof(double), "vertices are rows of an array");
  const std::vector<cchip::Vec3d>& vertices = x.mesh().vertices;
  return {vertices.front().data(), {vertices.size(), 3}};
}

/// Three columns, or four if there are quads: a triangle has its last vertex twice then.
nb::object faces_of(const Object& x) {
  const std::vector<cchip::Mesh::Face>& faces = x.mesh().faces;
  const auto is_quad = [](const cchip::Mesh::Face& face) { return face.kind == cchip::Kind::quad; };
  const std::size_t columns = std::any_of(faces.begin(), faces.end(), is_quad) ? 4 : 3;
  std::vector<std::uint32_t> rows;
  rows.reserve(columns * faces.size());
  for (const cchip::Mesh::Face& face : faces) {
    rows.insert(rows.end(), face.vertex.begin(), face.vertex.begin() + 3);
    if (columns == 4) rows.push_back(face.vertex[is_quad(face) ? 3 : 2]);
  }
  return nb::cast(owned<std::uint32_t>(std::move(rows), {faces.size(), columns}));
}

nb::object numbers_of(const Object& x) {
  std::vector<std::uint32_t> numbers(x.mesh().faces.size());
  for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = x.mesh().number_in_file(i);
  const std::size_t n = numbers.size();
  return nb::cast(owned<std::uint32_t>(std::move(numbers), {n}));
}

nb::tuple notes_of(const Object& x) {
  nb::list notes;
  for (const std::string& note : x.mesh().notes) notes.append(to_text(note));
  return nb::tuple(notes);
}

template <class T>
nb::bytes to_bytes(const std::vector<T>& values) {
  return nb::bytes(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
}
template <class T>
std::vector<T> from_bytes(const nb::bytes& bytes) {
  if (bytes.size() % sizeof(T) != 0) throw std::invalid_argument("Object: this is not what pickle made of an Object");
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.c_str(), bytes.size());
  return values;
}

/// Version, name, vertices, faces (kind and four numbers each), numbers in the file, polygons that were cut.
using State = std::tuple<int, nb::bytes, nb::bytes, nb::bytes, nb::bytes, std::size_t>;
constexpr int state_version = 1;

State state_of(const Object& x) {
  const cchip::Mesh& mesh = x.mesh();
  std::vector<std::uint32_t> faces;
  faces.reserve(5 * mesh.faces.size());
  for (const cchip::Mesh::Face& face : mesh.faces) {
    faces.push_back(static_cast<std::uint32_t>(face.kind));
    faces.insert(faces.end(), face.vertex.begin(), face.vertex.end());
  }
  return {state_version,
          nb::bytes(mesh.name.data(), mesh.name.size()),
          to_bytes(mesh.vertices),
          to_bytes(faces),
          to_bytes(mesh.file_face),
          mesh.polygons_cut};
}

void set_state(Object& self, const State& state) {
  const auto& [version, name, vertices, faces, numbers, polygons_cut] = state;
  if (version != state_version) {
    throw std::invalid_argument("Object: pickled as version " + std::to_string(version) + ", version " +
                                std::to_string(state_version) + " is known; pickle it with this version");
  }
  cchip::Mesh mesh;
  mesh.name = std::string(name.c_str(), name.size());
  mesh.vertices = from_bytes<cchip::Vec3d>(vertices);
  const std::vector<std::uint32_t> words = from_bytes<std::uint32_t>(faces);
  for (std::size_t i = 0; i + 5 <= words.size(); i += 5) {
    cchip::Mesh::Face& face = mesh.faces.emplace_back();
    face.kind = static_cast<cchip::Kind>(words[i]);
    std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, 4, face.vertex.begin());
  }
  mesh.file_face = from_bytes<std::uint32_t>(numbers);
  mesh.polygons_cut = polygons_cut;
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  new (&self) Object(std::move(mesh));
}

/// \throws std::invalid_argument other than what pickle made
void check_state(const nb::tuple& state, std::size_t size, const char* name) {
  if (state.size() == size && nb::isinstance<nb::int_>(state[0]) && nb::cast<int>(state[0]) == state_version) return;
  throw std::invalid_argument(std::string(name) + ": this was pickled by another version; pickle it with this version");
}

nb::bytes pose_bytes(const Pose& pose) {
  const Eigen::Matrix<double, 3, 4> matrix = pose.affine();
  return to_bytes(std::vector<double>(matrix.data(), matrix.data() + matrix.size()));
}
Pose pose_from(const nb::bytes& bytes) {
  const std::vector<double> numbers = from_bytes<double>(bytes);
  if (numbers.size() != 12) throw std::invalid_argument("this is not what pickle made of a pose");
  Pose pose;
  pose.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4>>(numbers.data());
  return pose;
}

constexpr std::array<std::uint64_t cchip::CollisionStats::*, 8> stats_fields = {
    &cchip::CollisionStats::steps, &cchip::CollisionStats::box_tests,  &cchip::CollisionStats::pairs,
    &cchip::CollisionStats::open,  &cchip::CollisionStats::clocks,     &cchip::CollisionStats::fallbacks,
    &cchip::CollisionStats::swaps, &cchip::CollisionStats::swap_clocks};
nb::bytes stats_bytes(const cchip::CollisionStats& stats) {
  std::vector<std::uint64_t> numbers;
  for (const auto field : stats_fields) numbers.push_back(stats.*field);
  return to_bytes(numbers);
}
cchip::CollisionStats stats_from(const nb::bytes& bytes) {
  const std::vector<std::uint64_t> numbers = from_bytes<std::uint64_t>(bytes);
  if (numbers.size() != stats_fields.size()) throw std::invalid_argument("this is not what pickle made of statistics");
  cchip::CollisionStats stats;
  for (std::size_t i = 0; i < numbers.size(); ++i) stats.*stats_fields[i] = numbers[i];
  return stats;
}

// Requests and results.

CollisionRequest to_request(const std::string& contacts, bool relation, const std::string& least,
                            std::optional<std::size_t> max_contacts, bool certificate, double within) {
  CollisionRequest request;
  if (contacts == "all") {
    request.contacts = CollisionRequest::Contacts::all;
  } else if (contacts != "first") {
    throw std::invalid_argument("contacts is '" + contacts + "'; give 'first' or 'all'");
  }
  if (least == "crossing") {
    request.least = cchip::Relation::crossing;
  } else if (least != "touching") {
    throw std::invalid_argument("least is '" + least + "'; give 'touching' or 'crossing'");
  }
  request.relation = relation;
  request.certificate = certificate;
  request.within = within;
  if (max_contacts) request.max_contacts = *max_contacts;
  if (request.max_contacts == 0) throw std::invalid_argument("max_contacts is 0: ask for at least one contact");
  return request;
}

const char* name_of(cchip::Relation relation) {
  if (relation == cchip::Relation::apart) return "apart";
  return relation == cchip::Relation::touching ? "touching" : "crossing";
}

/// The objects of a query in their poses.
struct Places {
  Object a;
  Pose pose_a;
  Object b;
  Pose pose_b;
};

/// An answer with its proof, and what it was asked about.
struct Proof {
  std::shared_ptr<const cchip::Certificate> certificate;
  Places places;
};

struct Result {
  Result(const CollisionResult& x, Places asked)
      : hit(x.hit), stats(x.stats), certificate(x.certificate), places(std::move(asked)) {
    if (x.relation) relation = name_of(*x.relation);
    for (const cchip::Contact& contact : x.contacts) {
      faces.insert(faces.end(), {contact.face_a, contact.face_b});
      if (contact.relation) crossing.push_back(*contact.relation == cchip::Relation::crossing ? 1 : 0);
    }
    tells_crossing = x.relation.has_value() || (!x.contacts.empty() && x.contacts[0].relation.has_value());
  }
  bool hit;
  std::optional<std::string> relation;
  std::vector<std::uint32_t> faces;
  std::vector<std::uint8_t> crossing;
  bool tells_crossing;
  cchip::CollisionStats stats;
  std::shared_ptr<const cchip::Certificate> certificate;  ///< null: not asked for
  Places places;
};

/// A query of the result's objects, for the time of a call.
cchip::CollisionQuery query_of(const Places& x) { return {&x.a, &x.pose_a, &x.b, &x.pose_b}; }

cchip::Contact contact_of(const Result& x, std::size_t number) {
  if (number >= x.faces.size() / 2) throw std::out_of_range("the result has no such contact");
  return {x.faces[2 * number], x.faces[2 * number + 1], std::nullopt};
}

std::vector<cchip::Contact> contacts_of(const Result& x) {
  std::vector<cchip::Contact> contacts;
  for (std::size_t i = 0; i < x.faces.size() / 2; ++i) contacts.push_back(contact_of(x, i));
  return contacts;
}

nb::object to_rows(const std::vector<cchip::Vec3d>& points) {
  std::vector<double> rows;
  rows.reserve(3 * points.size());
  for (const cchip::Vec3d& p : points) rows.insert(rows.end(), p.data(), p.data() + 3);
  return nb::cast(owned<double>(std::move(rows), {points.size(), 3}));
}

nb::dict to_dict(const cchip::CollisionStats& stats) {
  nb::dict d;
  d["steps"] = stats.steps;
  d["box_tests"] = stats.box_tests;
  d["pairs"] = stats.pairs;
  d["open"] = stats.open;
  d["clocks"] = stats.clocks;
  d["fallbacks"] = stats.fallbacks;
  d["swaps"] = stats.swaps;
  d["swap_clocks"] = stats.swap_clocks;
  return d;
}

const char* name_of(cchip::Intersection::Kind kind) {
  switch (kind) {
    case cchip::Intersection::Kind::point:
      return "point";
    case cchip::Intersection::Kind::segment:
      return "segment";
    case cchip::Intersection::Kind::polygon:
      return "polygon";
    default:
      return "polyhedron";
  }
}

cchip::SolidRequest to_solid_request(const std::string& inside) {
  if (inside == "odd") return {cchip::InsideRule::odd};
  if (inside == "nonzero") return {cchip::InsideRule::nonzero};
  throw std::invalid_argument("inside is '" + inside + "'; give 'odd' or 'nonzero'");
}

/// Warns that an answer about solids rests on a rule that its caller may not have meant.
/// \param object how the caller calls it
/// \throws nb::python_error if the user has made such warnings errors
void warn_of_overlap(const std::string& object, const std::optional<cchip::Contact>& overlap,
                     const cchip::SolidRequest& request) {
  if (!overlap || request.inside != cchip::InsideRule::odd) return;
  const bool cross = overlap->relation == cchip::Relation::crossing;
  const nb::object text =
      to_text("solids: faces " + std::to_string(overlap->face_a) + " and " + std::to_string(overlap->face_b) + " of " +
              object + (cross ? " cross" : " lie on each other") +
              ": its shells overlap, are there twice or have a wall in common, and space that two "
              "of them share counts as outside; inside='nonzero' counts it as inside");
  if (PyErr_WarnFormat(PyExc_UserWarning, 1, "%U", text.ptr()) != 0) throw nb::python_error();
}

/// "A", with the file if it came from one.
std::string call_it(const char* name, const Object& object) {
  const std::string& file = object.mesh().name;
  return file.empty() ? name : name + (" (" + file + ")");
}

const char* solids_of_two(nb::handle object_a, nb::handle pose_a, nb::handle object_b, nb::handle pose_b,
                          const std::string& inside) {
  const Object a = to_object(object_a, "a");
  const Object b = to_object(object_b, "b");
  const Pose place_a = one_pose(pose_a, "pose_a");
  const Pose place_b = one_pose(pose_b, "pose_b");
  const cchip::SolidRequest request = to_solid_request(inside);
  cchip::SolidResult result;
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    result = cchip::solids(a, place_a, b, place_b, request);
  }
  warn_of_overlap(call_it("A", a), result.overlap_a, request);
  if (a.id() != b.id()) warn_of_overlap(call_it("B", b), result.overlap_b, request);
  return cchip::name_of(result.relation);
}

/// Its ends and a face, or None.
nb::object to_tuple(const std::optional<cchip::OpenEdge>& edge) {
  if (!edge) return nb::none();
  const auto point = [](const Vec3d& x) { return nb::make_tuple(x[0], x[1], x[2]); };
  return nb::make_tuple(point(edge->from), point(edge->to), edge->face);
}

nb::list intersections_of(const Result& x) {
  std::vector<std::vector<cchip::Intersection>> found;
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    found = cchip::intersections(query_of(x.places), contacts_of(x));
  }
  nb::list all;
  for (const auto& parts : found) {
    nb::list one;
    for (const cchip::Intersection& part : parts) one.append(nb::make_tuple(name_of(part.kind), to_rows(part.points)));
    all.append(one);
  }
  return all;
}

nb::list curves_of(const Result& x) {
  std::vector<cchip::IntersectionCurve> found;
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    found = cchip::intersection_curves(query_of(x.places), contacts_of(x));
  }
  nb::list all;
  for (const cchip::IntersectionCurve& curve : found) {
    all.append(nb::make_tuple(to_rows(curve.points), curve.closed));
  }
  return all;
}

nb::object normals_of(const Result& x) {
  std::vector<double> rows;
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    for (const cchip::Contact& contact : contacts_of(x)) {
      for (const cchip::Vec3d& n : {cchip::face_normal(x.places.a, x.places.pose_a, contact.face_a),
                                    cchip::face_normal(x.places.b, x.places.pose_b, contact.face_b)}) {
        rows.insert(rows.end(), n.data(), n.data() + 3);
      }
    }
  }
  return nb::cast(owned<double>(std::move(rows), {x.faces.size() / 2, 2, 3}));
}

/// The middle of the first part that the faces of a contact share, rounded.
nb::object point_of(const Result& x, std::size_t number) {
  const GradualUnderflow mode;
  const std::vector<cchip::Intersection> parts = cchip::intersections(query_of(x.places), contact_of(x, number));
  std::vector<double> middle(3, parts.empty() ? std::numeric_limits<double>::quiet_NaN() : 0.0);
  if (!parts.empty()) {
    const std::vector<cchip::Vec3d>& points = parts[0].points;
    for (const cchip::Vec3d& p : points) {
      for (std::size_t k = 0; k < 3; ++k) {
        middle[k] += p[static_cast<Eigen::Index>(k)] / static_cast<double>(points.size());
      }
    }
  }
  return nb::cast(owned<double>(std::move(middle), {3}));
}

/// Of A's face.
nb::object normal_of(const Result& x, std::size_t number) {
  const GradualUnderflow mode;
  const cchip::Vec3d normal = cchip::face_normal(x.places.a, x.places.pose_a, contact_of(x, number).face_a);
  return nb::cast(owned<double>(std::vector<double>(normal.begin(), normal.end()), {3}));
}

std::string text_of(const Proof& x) {
  std::ostringstream out;
  cchip::write_certificate(*x.certificate, out);
  return out.str();
}

/// The certificate's lines, or None; the objects and their poses.
nb::tuple proof_state(const Proof& x) {
  return nb::make_tuple(state_version, x.certificate ? nb::object(nb::str(text_of(x).c_str())) : nb::none(), x.places.a,
                        pose_bytes(x.places.pose_a), x.places.b, pose_bytes(x.places.pose_b));
}
Proof proof_from(const nb::tuple& state) {
  check_state(state, 6, "Certificate");
  std::shared_ptr<const cchip::Certificate> certificate;
  if (!nb::object(state[1]).is_none()) {
    std::istringstream lines(nb::cast<std::string>(state[1]));
    certificate = std::make_shared<const cchip::Certificate>(cchip::read_certificate(lines));
  }
  return {std::move(certificate),
          {nb::cast<Object>(state[2]), pose_from(nb::cast<nb::bytes>(state[3])), nb::cast<Object>(state[4]),
           pose_from(nb::cast<nb::bytes>(state[5]))}};
}

nb::tuple result_state(const Result& x) {
  return nb::make_tuple(state_version, x.hit, x.relation, to_bytes(x.faces), to_bytes(x.crossing), x.tells_crossing,
                        stats_bytes(x.stats), proof_state({x.certificate, x.places}));
}
void set_result_state(Result& self, const nb::tuple& state) {
  check_state(state, 8, "Result");
  Proof proof = proof_from(nb::cast<nb::tuple>(state[7]));
  Result made(CollisionResult{}, std::move(proof.places));
  made.hit = nb::cast<bool>(state[1]);
  made.relation = nb::cast<std::optional<std::string>>(state[2]);
  made.faces = from_bytes<std::uint32_t>(nb::cast<nb::bytes>(state[3]));
  made.crossing = from_bytes<std::uint8_t>(nb::cast<nb::bytes>(state[4]));
  made.tells_crossing = nb::cast<bool>(state[5]);
  made.stats = stats_from(nb::cast<nb::bytes>(state[6]));
  made.certificate = std::move(proof.certificate);
  new (&self) Result(std::move(made));
}

nb::tuple distance_state(const cchip::DistanceResult& x) {
  std::vector<double> numbers = {x.lower, x.upper};
  for (const Vec3d& point : {x.point_a, x.point_b}) numbers.insert(numbers.end(), point.data(), point.data() + 3);
  return nb::make_tuple(state_version, to_bytes(numbers), x.face_a, x.face_b, stats_bytes(x.stats));
}
void set_distance_state(cchip::DistanceResult& self, const nb::tuple& state) {
  check_state(state, 5, "Distance");
  const std::vector<double> numbers = from_bytes<double>(nb::cast<nb::bytes>(state[1]));
  if (numbers.size() != 8) throw std::invalid_argument("Distance: this is not what pickle made of a Distance");
  new (&self) cchip::DistanceResult{numbers[0],
                                    numbers[1],
                                    Vec3d(numbers[2], numbers[3], numbers[4]),
                                    Vec3d(numbers[5], numbers[6], numbers[7]),
                                    nb::cast<std::uint32_t>(state[2]),
                                    nb::cast<std::uint32_t>(state[3]),
                                    stats_from(nb::cast<nb::bytes>(state[4]))};
}

nb::tuple along_state(const cchip::AlongResult& x) {
  return nb::make_tuple(state_version, x.touches, x.factor, x.lower, x.upper, x.face_a, x.face_b);
}
void set_along_state(cchip::AlongResult& self, const nb::tuple& state) {
  check_state(state, 7, "Along");
  cchip::AlongResult made;
  made.touches = nb::cast<bool>(state[1]);
  made.factor = nb::cast<double>(state[2]);
  made.lower = nb::cast<double>(state[3]);
  made.upper = nb::cast<double>(state[4]);
  made.face_a = nb::cast<std::uint32_t>(state[5]);
  made.face_b = nb::cast<std::uint32_t>(state[6]);
  new (&self) cchip::AlongResult(made);
}

/// pickle, and copies, which are the same: it never changes.
template <class Type, class Get, class Set>
void def_state(nb::class_<Type>& type, const Get& get, const Set& set) {
  type.def("__getstate__", get)
      .def("__setstate__", set)
      .def("__copy__", [](nb::handle self) { return nb::borrow(self); })
      .def(
          "__deepcopy__", [](nb::handle self, nb::handle) { return nb::borrow(self); }, "memo"_a);
}

/// A mesh as check.py takes it.
nb::tuple mesh_for_check(const Object& x) {
  const cchip::Mesh& mesh = x.mesh();
  nb::list vertices, faces, numbers;
  for (const cchip::Vec3d& v : mesh.vertices) vertices.append(nb::make_tuple(v[0], v[1], v[2]));
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    const cchip::Mesh::Face& face = mesh.faces[i];
    nb::list corners;
    for (std::size_t k = 0; k < static_cast<std::size_t>(face.kind); ++k) corners.append(face.vertex[k]);
    faces.append(corners);
    numbers.append(mesh.number_in_file(i));
  }
  return nb::make_tuple(vertices, faces, numbers);
}

/// By the checker in Python, which shares no code with the answer.
nb::object check_proof(const Proof& x) {
  nb::list poses;
  for (const Pose* pose : {&x.places.pose_a, &x.places.pose_b}) {
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 4; ++column) poses.append((*pose)(row, column));
    }
  }
  const nb::object lines = nb::cast(text_of(x)).attr("splitlines")();
  return nb::module_::import_("collisionchip.check")
      .attr("check")(nb::make_tuple(mesh_for_check(x.places.a), mesh_for_check(x.places.b)), poses, lines);
}

/// What the result looks like, see cchip::html_page(); UTF-8, but for names of files.
nb::bytes page_of(const Result& x) {
  std::vector<cchip::PageContact> contacts;
  for (std::size_t i = 0; i < x.faces.size() / 2; ++i) {
    std::optional<cchip::Relation> relation;
    if (x.tells_crossing) relation = x.crossing[i] != 0 ? cchip::Relation::crossing : cchip::Relation::touching;
    contacts.push_back({x.faces[2 * i], x.faces[2 * i + 1], relation});
  }
  std::string answer = x.relation ? *x.relation : x.hit ? "touch" : "apart";
  if (x.hit) answer += ": " + std::to_string(contacts.size()) + (contacts.size() == 1 ? " contact" : " contacts");
  std::string folder;
  const char* const mine = std::getenv("CCHIP_THREE");
  if (mine == nullptr)
    folder = nb::cast<std::string>(nb::module_::import_("collisionchip.view").attr("three_folder")());
  std::string page;
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    const cchip::PageScripts scripts = cchip::read_page_scripts(folder);
    cchip::Mesh a = cchip::transformed(x.places.a.mesh(), x.places.pose_a);
    cchip::Mesh b = cchip::transformed(x.places.b.mesh(), x.places.pose_b);
    if (a.name.empty()) a.name = "A";
    if (b.name.empty()) b.name = "B";
    std::vector<cchip::PageCurve> curves;
    for (cchip::IntersectionCurve& curve : cchip::intersection_curves(query_of(x.places), contacts_of(x))) {
      curves.push_back({std::move(curve.points), curve.closed});
    }
    page = cchip::html_page(a, b, answer, contacts, scripts, curves);
  }
  return nb::bytes(page.data(), page.size());
}

/// The device that was given, or else one with all cores, which the process has once; if it is in use, one of a single
/// thread that the calling thread has. Use it with the GIL released.
class DeviceUse {
 public:
  explicit DeviceUse(Device* device) : device_(device) {
    if (device_ != nullptr) return;
    static std::atomic<bool> in_use = false;
    if (!in_use.exchange(true)) {
      in_use_ = &in_use;
      try {
        static Device* const all_cores = cchip::open_cpu_device().release();  // for good: its threads may wait
        device_ = all_cores;
      } catch (...) {
        in_use = false;
        throw;
      }
    } else {
      thread_local const std::unique_ptr<Device> own = cchip::open_cpu_device({1, {}});
      device_ = own.get();
    }
  }
  ~DeviceUse() {
    if (in_use_ != nullptr) *in_use_ = false;
  }
  DeviceUse(const DeviceUse&) = delete;
  DeviceUse& operator=(const DeviceUse&) = delete;
  Device& operator*() const { return *device_; }

 private:
  Device* device_;
  std::atomic<bool>* in_use_ = nullptr;
};

Result collide(nb::handle object_a, nb::handle pose_a, nb::handle object_b, nb::handle pose_b,
               const std::string& contacts, bool relation, const std::string& least,
               std::optional<std::size_t> max_contacts, Device* device, bool certificate, double within,
               const Result* last) {
  const Object a = to_object(object_a, "a");
  const Object b = to_object(object_b, "b");
  const Pose place_a = one_pose(pose_a, "pose_a");
  const Pose place_b = one_pose(pose_b, "pose_b");
  const CollisionRequest request = to_request(contacts, relation, least, max_contacts, certificate, within);
  cchip::CollisionHint hint;
  if (last != nullptr && !last->faces.empty()) hint = cchip::Contact{last->faces[0], last->faces[1]};
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  return Result(device != nullptr ? cchip::collide(*device, a, place_a, b, place_b, request, hint)
                                  : cchip::collide(a, place_a, b, place_b, request, hint),
                {a, place_a, b, place_b});
}

// Point clouds.

std::vector<Vec3d> to_points(const Array<double>& array) {
  if (array.ndim() == 1 && array.shape(0) == 0) return {};  // an empty list
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw std::invalid_argument("points have the shape " + shape_of(array) + "; give (n, 3)");
  }
  std::vector<Vec3d> points(array.shape(0));
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = Eigen::Map<const Vec3d>(array.data() + 3 * i);
  return points;
}

/// A cloud, and the numbers that its points have for the caller; null: those of the array.
struct PyCloud {
  cchip::PointCloud points;
  std::shared_ptr<const std::vector<std::uint32_t>> numbers;
};
struct CloudResult : cchip::CloudResult {};

void init_cloud(PyCloud* self, nb::handle points, nb::handle radius, nb::handle numbers) {
  const std::vector<Vec3d> centres = to_points(to_array<double>(points, "float64", "points"));
  const auto radii = to_array<double>(radius, "float64", "radius");
  if (radii.ndim() > 1) {
    throw std::invalid_argument("radius has the shape " + shape_of(radii) + "; give a number, or (n,) for n points");
  }
  const std::vector<double> values(radii.data(), radii.data() + radii.size());
  const bool for_all = radii.ndim() == 0;
  PyCloud made = {{{}, 0.0}, nullptr};
  if (!numbers.is_none()) {
    const auto array = to_array<double>(numbers, "float64", "numbers");
    if (array.ndim() != 1 || array.shape(0) != centres.size()) {
      throw std::invalid_argument("numbers have the shape " + shape_of(array) + "; give (" +
                                  std::to_string(centres.size()) + ",), one for each point");
    }
    auto list = std::make_shared<std::vector<std::uint32_t>>(centres.size());
    for (std::size_t i = 0; i < list->size(); ++i) {
      const double number = array.data()[i];
      if (!(number >= 0 && number <= std::numeric_limits<std::uint32_t>::max() && number == std::floor(number))) {
        throw std::invalid_argument("numbers[" + std::to_string(i) + "] is " + nb::repr(nb::float_(number)).c_str() +
                                    "; give integers from 0 to 2^32 - 1");
      }
      (*list)[i] = static_cast<std::uint32_t>(number);
    }
    made.numbers = std::move(list);
  }
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    made.points = for_all ? cchip::PointCloud(centres, values[0]) : cchip::PointCloud(centres, values);
  }
  new (self) PyCloud(std::move(made));
}

nb::object load_points(nb::handle path, bool leave_out_nan, bool numbers) {
  std::vector<std::uint32_t> in_file;
  const nb::object rows = to_rows(read_file(path, [&](const std::string& name) {
    cchip::LoadPointsOptions options;
    options.leave_out_nan = leave_out_nan;
    options.numbers = &in_file;
    return cchip::load_points(name, options);
  }));
  if (!numbers) return rows;
  const std::size_t n = in_file.size();
  return nb::make_tuple(rows, owned<std::uint32_t>(std::move(in_file), {n}));
}

PyCloud load_cloud(nb::handle path, double radius) {
  return read_file(path, [&](const std::string& name) {
    auto numbers = std::make_shared<std::vector<std::uint32_t>>();
    cchip::LoadPointsOptions options;
    options.numbers = numbers.get();
    cchip::PointCloud points(cchip::load_points(name, options), radius);
    return PyCloud{std::move(points), std::move(numbers)};
  });
}

nb::tuple cloud_state(const PyCloud& x) {
  std::vector<double> rows;
  for (const Vec3d& p : x.points.points()) rows.insert(rows.end(), p.data(), p.data() + 3);
  return nb::make_tuple(state_version, to_bytes(rows), to_bytes(x.points.radii()),
                        x.numbers ? nb::object(to_bytes(*x.numbers)) : nb::none());
}
void set_cloud_state(PyCloud& self, const nb::tuple& state) {
  check_state(state, 4, "PointCloud");
  const std::vector<double> rows = from_bytes<double>(nb::cast<nb::bytes>(state[1]));
  std::vector<Vec3d> points(rows.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = Eigen::Map<const Vec3d>(rows.data() + 3 * i);
  std::shared_ptr<const std::vector<std::uint32_t>> numbers;
  if (!nb::object(state[3]).is_none()) {
    numbers =
        std::make_shared<const std::vector<std::uint32_t>>(from_bytes<std::uint32_t>(nb::cast<nb::bytes>(state[3])));
    if (numbers->size() != points.size())
      throw std::invalid_argument("PointCloud: this is not what pickle made of one");
  }
  const GradualUnderflow mode;
  cchip::PointCloud made(points, from_bytes<double>(nb::cast<nb::bytes>(state[2])));
  new (&self) PyCloud{std::move(made), std::move(numbers)};
}

nb::tuple cloud_result_state(const CloudResult& x) {
  std::vector<std::uint32_t> rows;
  for (const cchip::CloudContact& contact : x.contacts) rows.insert(rows.end(), {contact.point, contact.face});
  return nb::make_tuple(state_version, x.hit, to_bytes(rows), stats_bytes(x.stats));
}
void set_cloud_result_state(CloudResult& self, const nb::tuple& state) {
  check_state(state, 4, "CloudResult");
  CloudResult made;
  made.hit = nb::cast<bool>(state[1]);
  const std::vector<std::uint32_t> rows = from_bytes<std::uint32_t>(nb::cast<nb::bytes>(state[2]));
  for (std::size_t i = 0; i + 2 <= rows.size(); i += 2) made.contacts.push_back({rows[i], rows[i + 1]});
  made.stats = stats_from(nb::cast<nb::bytes>(state[3]));
  new (&self) CloudResult(std::move(made));
}

CloudResult collide_cloud(const PyCloud& cloud, nb::handle pose_cloud, nb::handle mesh, nb::handle pose_object,
                          const std::string& contacts, std::optional<std::size_t> max_contacts) {
  const Object object = to_object(mesh, "object");
  const Pose place_cloud = one_pose(pose_cloud, "pose_cloud");
  const Pose place_object = one_pose(pose_object, "pose_object");
  // checks the words, as for two objects
  const CollisionRequest words = to_request(contacts, false, "touching", max_contacts, false, 0);
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  CloudResult result = {
      cchip::collide(cloud.points, place_cloud, object, place_object, {words.contacts, words.max_contacts})};
  if (cloud.numbers) {
    for (cchip::CloudContact& contact : result.contacts) contact.point = (*cloud.numbers)[contact.point];
    std::sort(result.contacts.begin(), result.contacts.end());
  }
  return result;
}

/// \param objects any iterable of pairs of an Object and its pose
std::optional<std::size_t> first_met(const PyCloud& cloud, nb::handle pose_cloud, nb::handle objects) {
  const Pose place_cloud = one_pose(pose_cloud, "pose_cloud");
  if (!nb::hasattr(objects, "__iter__")) {
    throw nb::type_error("objects cannot be iterated over; give a list of tuples of an Object and its pose");
  }
  const nb::list list(nb::borrow(objects));
  std::vector<Object> kept;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string name = "objects[" + std::to_string(i) + "]";
    const nb::handle pair = list[i];
    if (PySequence_Check(pair.ptr()) == 0 || PySequence_Size(pair.ptr()) != 2) {
      PyErr_Clear();
      throw std::invalid_argument(name + " is no tuple of an Object and its pose");
    }
    kept.push_back(to_object(nb::object(pair[0]), (name + "[0]").c_str()));
    poses.push_back(one_pose(nb::object(pair[1]), name.c_str()));
  }
  std::vector<cchip::PlacedObject> placed;
  for (std::size_t i = 0; i < kept.size(); ++i) placed.push_back({&kept[i], poses[i]});
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  const std::size_t found = cchip::first_met(cloud.points, place_cloud, placed);
  return found < placed.size() ? std::optional(found) : std::nullopt;
}

/// Calls `each` for the result of every pose, with the GIL released.
template <class Each>
void collide_each(const Object& a, const Poses& poses_a, const Object& b, const Poses& poses_b, std::size_t count,
                  const CollisionRequest& request, Device* device, const Each& each) {
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  (*DeviceUse(device))
      .collide(
          count,
          [&](std::size_t i) {
            return cchip::CollisionQuery{&a, &poses_a[i], &b, &poses_b[i]};
          },
          request, each);
}

constexpr std::uint8_t unknown = 3;

/// An array of words, empty where the search ended too early.
nb::object to_words(std::vector<std::uint8_t>&& relations) {
  using cchip::Relation;
  const auto word = [](Relation relation) { return name_of(relation); };
  static_assert(static_cast<int>(Relation::apart) == 0 && static_cast<int>(Relation::touching) == 1 &&
                static_cast<int>(Relation::crossing) == 2);
  const nb::object words = nb::module_::import_("numpy").attr("array")(
      nb::make_tuple(word(Relation::apart), word(Relation::touching), word(Relation::crossing), ""));
  const std::size_t n = relations.size();
  return words[nb::cast(owned<std::uint8_t>(std::move(relations), {n}))];
}

nb::object collide_many(nb::handle object_a, nb::handle poses_a, nb::handle object_b, nb::handle poses_b, bool contacts,
                        bool relation, const std::string& least, std::optional<std::size_t> max_contacts,
                        Device* device, bool certificate, double within) {
  const Object a = to_object(object_a, "a");
  const Object b = to_object(object_b, "b");
  const Poses places_a(poses_a, "poses_a", true);
  const Poses places_b(poses_b, "poses_b", true);
  if (places_a.many() && places_b.many() && places_a.size() != places_b.size()) {
    throw std::invalid_argument("poses_a are " + std::to_string(places_a.size()) + ", poses_b " +
                                std::to_string(places_b.size()) + "; give as many of both, or one pose for all");
  }
  const std::size_t count = places_a.many() ? places_a.size() : places_b.size();
  if (count > std::numeric_limits<std::uint32_t>::max()) throw std::invalid_argument("more than 2^32 - 1 poses");
  const CollisionRequest request =
      to_request(contacts ? "all" : "first", relation, least, max_contacts, certificate, within);
  std::vector<std::uint8_t> hits(count);
  std::vector<std::uint8_t> relations(relation ? count : 0);
  std::vector<std::vector<cchip::Contact>> found(contacts ? count : 0);
  std::vector<std::shared_ptr<const cchip::Certificate>> proofs(certificate ? count : 0);
  collide_each(a, places_a, b, places_b, count, request, device, [&](std::size_t i, const CollisionResult& result) {
    hits[i] = result.hit ? 1 : 0;
    if (contacts) found[i] = result.contacts;
    if (relation) relations[i] = result.relation ? static_cast<std::uint8_t>(*result.relation) : unknown;
    if (certificate) proofs[i] = result.certificate;
  });
  nb::list answer;
  answer.append(to_bools(std::move(hits)));
  const nb::object words = relation ? to_words(std::move(relations)) : nb::none();
  if (contacts) {
    std::vector<std::uint32_t> rows;
    std::vector<std::uint8_t> crossing;
    for (std::size_t i = 0; i < count; ++i) {
      for (const cchip::Contact& contact : found[i]) {
        if (relation) crossing.push_back(contact.relation == cchip::Relation::crossing ? 1 : 0);
        rows.insert(rows.end(), {static_cast<std::uint32_t>(i), contact.face_a, contact.face_b});
      }
    }
    const std::size_t n = rows.size() / 3;
    answer.append(owned<std::uint32_t>(std::move(rows), {n, 3}));
    if (relation) {
      answer.append(words);
      answer.append(to_bools(std::move(crossing)));
    }
  } else if (relation) {
    answer.append(words);
  }
  if (certificate) {
    nb::list list;
    for (std::size_t i = 0; i < count; ++i) {
      if (proofs[i]) {
        list.append(Proof{proofs[i], {a, places_a[i], b, places_b[i]}});
      } else {
        list.append(nb::none());
      }
    }
    answer.append(list);
  }
  if (nb::len(answer) == 1) return answer[0];
  return nb::tuple(answer);
}

/// By asking about every pair of faces in integers of any size: for tests.
Result exact(nb::handle object_a, nb::handle pose_a, nb::handle object_b, nb::handle pose_b) {
  const Object a = to_object(object_a, "a");
  const Object b = to_object(object_b, "b");
  const Pose place_a = one_pose(pose_a, "pose_a");
  const Pose place_b = one_pose(pose_b, "pose_b");
  CollisionResult result;
  result.contacts = cchip::brute_force_contacts(a.mesh(), place_a, b.mesh(), place_b);
  result.hit = !result.contacts.empty();
  result.relation = cchip::Relation::apart;
  for (const cchip::Contact& contact : result.contacts) {
    result.relation = std::max(*result.relation, contact.relation.value_or(cchip::Relation::touching));
  }
  return Result(result, {a, place_a, b, place_b});
}

// Scenes.

/// Changes of a scene hold the GIL; queries release it, and count themselves first. So a change during a query is seen.
class PyScene {
 public:
  using Id = Scene::Id;

  const Scene& scene() const { return scene_; }
  Scene& change() {
    if (queries_ != 0) throw std::runtime_error("the scene is in use: a query is running, in this thread or another");
    return scene_;
  }

  Id add(const Object& object, const Pose& pose, const cchip::CollisionGroups& groups) {
    const Id id = change().add(object, pose, groups);
    next_ = id + 1;
    return id;
  }
  void remove(Id id) {
    change().remove(id);
    for (auto pair = ignored_.begin(); pair != ignored_.end();) {
      pair = pair->first == id || pair->second == id ? ignored_.erase(pair) : std::next(pair);
    }
  }
  void set_ignored(Id a, Id b, bool ignored) {
    change().set_ignored(a, b, ignored);
    if (ignored) {
      ignored_.insert(std::minmax(a, b));
    } else {
      ignored_.erase(std::minmax(a, b));
    }
  }
  const std::set<std::pair<Id, Id>>& ignored() const { return ignored_; }
  Id next() const { return next_; }
  /// With the same ids, and a filter of its own.
  void copy_to(PyScene& other) const {
    other.scene_ = scene_;
    other.ignored_ = ignored_;
    other.next_ = next_;
    other.set_filter(filter_);
  }

  void set_filter(nb::object filter) {
    Scene& scene = change();
    if (filter.is_none()) {
      scene.set_filter({});
    } else {
      if (!PyCallable_Check(filter.ptr())) throw nb::type_error("the filter must be callable, or None");
      scene.set_filter([this](Id a, Id b) {
        const nb::gil_scoped_acquire acquire;
        return nb::cast<bool>(nb::module_::import_("builtins").attr("bool")(filter_(a, b)));
      });
    }
    filter_ = std::move(filter);
  }
  const nb::object& filter() const { return filter_; }
  void clear() { filter_.reset(); }

  /// Runs a query of this scene and another one, which may be the same, with the GIL released.
  template <class Query>
  auto ask_with(PyScene& other, const Query& query) {
    const Count count(other.queries_);
    return ask([&](const Scene& scene) { return query(scene, static_cast<const Scene&>(other.scene_)); });
  }
  /// Runs a query with the GIL released.
  template <class Query>
  auto ask(const Query& query) {
    const Count count(queries_);
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    return query(static_cast<const Scene&>(scene_));
  }

 private:
  struct Count {
    explicit Count(int& n) : count(n) { ++count; }
    ~Count() { --count; }
    Count(const Count&) = delete;
    Count& operator=(const Count&) = delete;
    int& count;
  };
  Scene scene_;
  std::set<std::pair<Id, Id>> ignored_;  ///< the lower id first
  Id next_ = 1;
  nb::object filter_ = nb::none();
  int queries_ = 0;
};

int traverse_scene(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<PyScene>(self)->filter().ptr());
  return 0;
}
int clear_scene(PyObject* self) {
  if (nb::inst_ready(self)) nb::inst_ptr<PyScene>(self)->clear();
  return 0;
}
PyType_Slot scene_slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse_scene)},
                             {Py_tp_clear, reinterpret_cast<void*>(clear_scene)},
                             {0, nullptr}};

/// An object and its pose: one of the scene, or one outside.
struct Asked {
  Object object;
  Pose pose;
};
Asked asked_for(const Scene& scene, Scene::Id id) { return {scene.object(id), scene.pose(id)}; }

Result placed(const CollisionResult& x, const Asked& a, const Asked& b) {
  return {x, {a.object, a.pose, b.object, b.pose}};
}

nb::object to_tuple(const Scene& scene, const Scene::Pair& x) {
  return nb::make_tuple(x.a, x.b, placed(x.result, asked_for(scene, x.a), asked_for(scene, x.b)));
}
nb::object to_tuple(const Scene& scene, const Asked& a, const Scene::Hit& x) {
  return nb::make_tuple(x.id, placed(x.result, a, asked_for(scene, x.id)));
}
/// \param found a list or an optional one; \param args of to_tuple() before it
template <class Found, class... Args>
nb::object to_python(const std::vector<Found>& found, const Args&... args) {
  nb::list list;
  for (const Found& x : found) list.append(to_tuple(args..., x));
  return list;
}
template <class Found, class... Args>
nb::object to_python(const std::optional<Found>& found, const Args&... args) {
  return found ? to_tuple(args..., *found) : nb::none();
}

constexpr std::uint64_t all_groups = ~std::uint64_t{0};

nb::list solids_of(PyScene& self, Device* device, const std::string& inside) {
  const cchip::SolidRequest request = to_solid_request(inside);
  const std::vector<cchip::SolidPair> found =
      self.ask([&](const Scene& s) { return cchip::solids(*DeviceUse(device), s, request); });
  nb::list pairs;
  std::map<Scene::Id, std::optional<cchip::Contact>> overlaps;  // each object once
  for (const cchip::SolidPair& pair : found) {
    overlaps.emplace(pair.a, pair.overlap_a);
    overlaps.emplace(pair.b, pair.overlap_b);
    if (pair.relation == cchip::SolidRelation::disjoint) continue;
    pairs.append(nb::make_tuple(pair.a, pair.b, cchip::name_of(pair.relation)));
  }
  for (const auto& [id, overlap] : overlaps) warn_of_overlap("object " + std::to_string(id), overlap, request);
  return pairs;
}

/// Ids of pairs in contact, ascending, without their results: of this scene, or of another one and this one.
/// \param first at most one pair, any of them
nb::object pairs_of(PyScene& self, PyScene* other, bool first, Device* device) {
  using Ids = std::pair<Scene::Id, Scene::Id>;
  std::vector<Ids> found;
  self.ask_with(other != nullptr ? *other : self, [&](const Scene& mine, const Scene& theirs) {
    if (other == nullptr) {
      mine.for_each_contact(*DeviceUse(device), [&](const Scene::Pair& x) {
        found.emplace_back(x.a, x.b);
        return !first;
      });
    } else {
      mine.for_each_contact(*DeviceUse(device), Scene::Target(theirs), [&](const Scene::Hit& x) {
        found.emplace_back(x.of, x.id);
        return !first;
      });
    }
    std::sort(found.begin(), found.end());
    return 0;
  });
  std::vector<Scene::Id> ids;
  ids.reserve(2 * found.size());
  for (const auto& [a, b] : found) ids.insert(ids.end(), {a, b});
  return nb::cast(owned<Scene::Id>(std::move(ids), {found.size(), 2}));
}

/// The two nearest objects of a scene, or of two. Boxes bound the distance of a pair from below; pairs are asked in
/// ascending order of the bounds, until a bound is not less than the least distance so far.
class NearestPair {
 public:
  struct Item {
    Scene::Id id;
    const Object* object;
    const Pose* pose;
    cchip::WorldBox box;
    bool second;  ///< of the second set
  };
  /// \param two_sets a pair has an object of each
  NearestPair(std::vector<Item> items, bool two_sets, const std::set<std::pair<Scene::Id, Scene::Id>>& left_out)
      : items_(std::move(items)), two_sets_(two_sets), left_out_(left_out) {
    choose_axis();
    std::sort(items_.begin(), items_.end(),
              [this](const Item& x, const Item& y) { return x.box.least[axis_] < y.box.least[axis_]; });
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < items_.size(); ++i) {  // the one with the least bound for each object
      Pair least;
      sweep(
          i, [&] { return least.bound; }, [&](const Pair& pair) { least = pair; });
      if (least.a != least.b) pairs.push_back(least);
    }
    ask(pairs);
    for (std::size_t i = 0; i < items_.size() && found_; ++i) {
      sweep(
          i, [&] { return found_->upper; }, [&](const Pair& pair) { pairs.push_back(pair); });
      if (pairs.size() > most_pairs) ask(pairs);
    }
    ask(pairs);
  }
  const std::optional<cchip::DistanceResult>& found() const { return found_; }
  const Item& a() const { return items_[nearest_.a]; }
  const Item& b() const { return items_[nearest_.b]; }

 private:
  static constexpr std::size_t most_pairs = std::size_t{1} << 20U;
  struct Pair {
    double bound = std::numeric_limits<double>::infinity();
    std::size_t a = 0;
    std::size_t b = 0;
    bool operator<(const Pair& x) const { return bound < x.bound; }
  };

  /// That along which the objects are spread out most.
  void choose_axis() {
    double widest = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      double least = std::numeric_limits<double>::infinity();
      double greatest = -least;
      for (const Item& item : items_) {
        least = std::min(least, item.box.least[k]);
        greatest = std::max(greatest, item.box.least[k]);
      }
      if (!(greatest - least > widest)) continue;
      widest = greatest - least;
      axis_ = k;
    }
  }
  /// At most the exact gap between the boxes along an axis.
  static double gap(const cchip::WorldBox& x, const cchip::WorldBox& y, std::size_t axis) {
    const double wide = std::max(y.least[axis] - x.greatest[axis], x.least[axis] - y.greatest[axis]);
    return wide > 0 ? wide * (1 - 0x1p-48) : 0;  // also if it is nan
  }
  /// Hands on pairs of item i and one behind it whose bound is less than limit(), but for the first one of all.
  template <class Limit, class Take>
  void sweep(std::size_t i, const Limit& limit, const Take& take) {
    const Item& x = items_[i];
    for (std::size_t j = i + 1; j < items_.size(); ++j) {
      const Item& y = items_[j];
      const double along = gap(x.box, y.box, axis_);
      if (along >= limit()) return;
      if (two_sets_ && x.second == y.second) continue;
      Pair pair;
      pair.bound = std::hypot(gap(x.box, y.box, 0), gap(x.box, y.box, 1), gap(x.box, y.box, 2)) * (1 - 0x1p-48);
      if (pair.bound >= limit()) continue;
      if (!left_out_.empty() && left_out_.count(std::minmax(x.id, y.id)) != 0) continue;
      pair.a = i;
      pair.b = j;
      const bool turned = two_sets_ ? x.second : y.id < x.id;
      if (turned) std::swap(pair.a, pair.b);
      take(pair);
    }
  }
  void ask(std::vector<Pair>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    for (const Pair& pair : pairs) {
      const double least = found_ ? found_->upper : std::numeric_limits<double>::infinity();
      if (found_ && pair.bound >= least) break;
      const Item& x = items_[pair.a];
      const Item& y = items_[pair.b];
      const cchip::DistanceResult result = cchip::distance(*x.object, *x.pose, *y.object, *y.pose, {0, least});
      if (found_ && !(result.upper < least)) continue;
      found_ = result;
      nearest_ = pair;
    }
    pairs.clear();
  }

  std::vector<Item> items_;
  bool two_sets_;
  const std::set<std::pair<Scene::Id, Scene::Id>>& left_out_;
  std::size_t axis_ = 0;
  std::optional<cchip::DistanceResult> found_;
  Pair nearest_;
};

/// Ids and distance of the nearest two objects: of this scene, of it and another one, or of one object and the others.
nb::object nearest_of(PyScene& self, PyScene* other, Scene::Id id) {
  std::vector<NearestPair::Item> items;
  const auto add = [&](const PyScene& from, bool second) {
    const Scene& scene = from.scene();
    for (const Scene::Id x : scene.ids()) {
      items.push_back({x, &scene.object(x), &scene.pose(x), scene.box(x), second != (id != 0 && x != id)});
    }
  };
  add(self, false);
  if (other != nullptr) add(*other, true);
  const std::set<std::pair<Scene::Id, Scene::Id>> none;
  const NearestPair nearest = self.ask_with(other != nullptr ? *other : self, [&](const Scene&, const Scene&) {
    return NearestPair(std::move(items), other != nullptr || id != 0, other != nullptr ? none : self.ignored());
  });
  if (!nearest.found()) return nb::none();
  return nb::make_tuple(nearest.a().id, nearest.b().id, *nearest.found());
}

/// What pickle keeps of a scene: objects, each once; of each entry id, number of its object, pose, groups and mask;
/// ignored pairs, the next id, the filter.
nb::tuple scene_state(const PyScene& x) {
  const Scene& scene = x.scene();
  std::map<const void*, std::size_t> numbers;
  nb::list objects, entries, ignored;
  for (const Scene::Id id : scene.ids()) {
    const auto [place, is_new] = numbers.try_emplace(scene.object(id).id(), numbers.size());
    if (is_new) objects.append(Object(scene.object(id)));
    const cchip::CollisionGroups& groups = scene.groups(id);
    entries.append(nb::make_tuple(id, place->second, pose_bytes(scene.pose(id)), groups.groups, groups.mask));
  }
  for (const auto& [a, b] : x.ignored()) ignored.append(nb::make_tuple(a, b));
  return nb::make_tuple(state_version, objects, entries, ignored, x.next(), x.filter());
}

void set_scene_state(PyScene& self, const nb::tuple& state) {
  check_state(state, 6, "Scene");
  std::vector<Object> objects;
  for (const nb::handle x : nb::cast<nb::list>(state[1])) objects.push_back(nb::cast<Object>(x));
  new (&self) PyScene;
  const GradualUnderflow mode;
  std::optional<Object> blank;  // stands for an object that was removed, so that ids stay what they were
  const auto skip_to = [&](Scene::Id id) {
    while (self.next() < id) {
      if (!blank) {
        cchip::Mesh triangle;
        triangle.vertices = {Vec3d::Zero(), Vec3d::UnitX(), Vec3d::UnitY()};
        triangle.faces.push_back({static_cast<cchip::Kind>(3), {0, 1, 2, 0}});
        blank = Object(std::move(triangle));
      }
      self.remove(self.add(*blank, Pose::Identity(), {}));
    }
  };
  for (const nb::handle x : nb::cast<nb::list>(state[2])) {
    const auto [id, number, pose, groups, mask] =
        nb::cast<std::tuple<Scene::Id, std::size_t, nb::bytes, std::uint64_t, std::uint64_t>>(x);
    skip_to(id);
    self.add(objects.at(number), pose_from(pose), {groups, mask});
  }
  skip_to(nb::cast<Scene::Id>(state[4]));
  for (const nb::handle x : nb::cast<nb::list>(state[3])) {
    const auto [a, b] = nb::cast<std::pair<Scene::Id, Scene::Id>>(x);
    self.set_ignored(a, b, true);
  }
  self.set_filter(nb::object(state[5]));
}

/// contacts() and find_contact() of a scene: all pairs, those of one object, those of an object outside.
template <class Call>
void def_queries(nb::class_<PyScene>& type, const char* name, const Call& call, const std::string& found,
                 const std::string& doc) {
  const std::string keywords =
      ", *, contacts: str = 'first', relation: bool = False, least: str = 'touching', "
      "max_contacts: int | None = None, device: Device | None = None, certificate: bool = False, within: float = 0";
  const auto sig = [&](const std::string& what, const std::string& pair) {
    std::string result = found;
    result.replace(result.find('@'), 1, pair);
    return "def " + std::string(name) + "(self" + what + keywords + ") -> " + result;
  };
  type.def(
      name,
      [call](PyScene& self, const std::string& contacts, bool relation, const std::string& least,
             std::optional<std::size_t> max_contacts, Device* device, bool certificate, double within) {
        const CollisionRequest request = to_request(contacts, relation, least, max_contacts, certificate, within);
        const auto answers = self.ask([&](const Scene& s) { return call(s, *DeviceUse(device), request); });
        return to_python(answers, self.scene());
      },
      nb::kw_only(), "contacts"_a = "first", "relation"_a = false, "least"_a = "touching",
      "max_contacts"_a = nb::none(), "device"_a = nb::none(), "certificate"_a = false, "within"_a = 0.0,
      nb::sig(sig("", "tuple[int, int, Result]").c_str()), doc.c_str());
  type.def(
      name,
      [call](PyScene& self, Scene::Id id, const std::string& contacts, bool relation, const std::string& least,
             std::optional<std::size_t> max_contacts, Device* device, bool certificate, double within) {
        const CollisionRequest request = to_request(contacts, relation, least, max_contacts, certificate, within);
        const auto answers = self.ask([&](const Scene& s) { return call(s, *DeviceUse(device), id, request); });
        return to_python(answers, self.scene(), asked_for(self.scene(), id));
      },
      "id"_a, nb::kw_only(), "contacts"_a = "first", "relation"_a = false, "least"_a = "touching",
      "max_contacts"_a = nb::none(), "device"_a = nb::none(), "certificate"_a = false, "within"_a = 0.0,
      nb::sig(sig(", id: int", "tuple[int, Result]").c_str()),
      "The same for one object of the scene, which is A in the results; tuples (id, result).");
  type.def(
      name,
      [call](PyScene& self, Outside mesh, nb::handle pose, std::uint64_t groups, std::uint64_t mask,
             const std::string& contacts, bool relation, const std::string& least,
             std::optional<std::size_t> max_contacts, Device* device, bool certificate, double within) {
        const CollisionRequest request = to_request(contacts, relation, least, max_contacts, certificate, within);
        const Object object = to_object(mesh.value, "object");
        const Pose place = one_pose(pose, "pose");
        const cchip::CollisionGroups bits = {groups, mask};
        const auto answers = self.ask(
            [&](const Scene& s) { return call(s, *DeviceUse(device), Scene::Target(object, place, bits), request); });
        return to_python(answers, self.scene(), Asked{object, place});
      },
      "object"_a.none(), "pose"_a = nb::none(), "groups"_a = 1, "mask"_a = all_groups, nb::kw_only(),
      "contacts"_a = "first", "relation"_a = false, "least"_a = "touching", "max_contacts"_a = nb::none(),
      "device"_a = nb::none(), "certificate"_a = false, "within"_a = 0.0,
      nb::sig(sig(", object: Object, pose: numpy.typing.ArrayLike | None = None, groups: int = 1, mask: int = "
                  "0xffffffffffffffff",
                  "tuple[int, Result]")
                  .c_str()),
      "The same for an object that is not in the scene, which is A in the results; tuples (id, result). The filter is "
      "not asked.");
}

}  // namespace

NB_MODULE(_core, m) {
  cchip::add_model_device();
  m.doc() = "Exact collision detection for triangle and quad meshes; import collisionchip instead.";
  m.attr("version") = CCHIP_VERSION;  // stubs leave out __version__

  nb::class_<Object>(m, "Object", nb::is_weak_referenceable(),
                     R"(A mesh made ready for collision tests; immutable, any number of threads may use it.

An object is the surface of the mesh, not the volume inside: one wholly inside another does not touch it.)")
      .def(
          "__init__",
          [](Object* self, nb::handle vertices, nb::handle faces) {
            new (self) Object(faces.is_none() ? to_object(vertices, "mesh") : object_of(vertices, faces));
          },
          "vertices"_a.none(), "faces"_a = nb::none(),
          nb::sig("def __init__(self, vertices: typing.Any, faces: numpy.typing.ArrayLike | None = None) -> None"),
          R"(From arrays, which are copied. Takes O(m log m) time.

vertices: (n, 3) float64, x, y and z of each in any length unit.
faces: (m, 3) for triangles or (m, 4) for quads, integers of any kind: numbers of vertices from 0. A quad is the hull
of its four vertices; one with a dent or a spike is cut into triangles, which are one face.

Without faces, vertices is a mesh of trimesh, PyVista or Open3D, or anything else with `vertices` and `faces`. Queries and
scenes take such a mesh, too, and make an Object of it at each call.

Raises ValueError: another shape, faces that are not integers, a number beyond the vertices, no faces or more than
2^24 - 2, a vertex of a face that is not finite or beyond 2^1000, a masked array, complex numbers, a first column that
counts corners. Raises TypeError: no mesh; the message has the remedy.)")
      .def_static(
          "load", &load, "path"_a, "quads"_a = false, nb::kw_only(), "lenient"_a = false,
          nb::sig("def load(path: str | bytes | os.PathLike[str] | os.PathLike[bytes], quads: bool = False, *, "
                  "lenient: bool = False) -> Object"),
          R"(From a file: OBJ, OFF, PLY or STL. Polygons are cut into triangles, with quads=True all but quads without a dent;
contacts have the numbers of the file's faces all the same.

lenient: faces that cannot be used are left out and not an error: with vertices that are not there or not finite, or
with sides that cross. `notes` names them. The other faces keep their numbers.

Raises OSError: the file cannot be opened; FileNotFoundError, IsADirectoryError. Raises ValueError: it is no mesh; the message has file, line and reason.)")
      .def(
          "moved",
          [](const Object& x, nb::handle vertices) {
            const auto points = to_array<double>(vertices, "float64", "vertices");
            if (points.ndim() != 2 || points.shape(1) != 3) {
              throw std::invalid_argument("vertices have shape " + shape_of(points) + "; give (n, 3)");
            }
            std::vector<cchip::Vec3d> moved(points.shape(0));
            for (std::size_t i = 0; i < moved.size(); ++i)
              moved[i] = Eigen::Map<const cchip::Vec3d>(points.data() + 3 * i);
            const nb::gil_scoped_release release;
            const GradualUnderflow mode;
            return x.moved(std::move(moved));
          },
          "vertices"_a, nb::sig("def moved(self, vertices: numpy.typing.ArrayLike) -> Object"),
          R"(The object with the same faces and other vertices, in a third of the time of a new one; this one stays as it is.

vertices: (vertex_count, 3) float64, in the order of this object's.

Raises ValueError: another shape, a vertex that is not finite or beyond 2^1000.)")
      .def_prop_ro(
          "is_closed",
          [](const Object& x) {
            const nb::gil_scoped_release release;
            return x.is_closed();
          },
          "An even number of faces use each edge, so the mesh bounds a solid; vertices by their coordinates.")
      .def_prop_ro(
          "twisted_edge",
          [](const Object& x) {
            std::optional<cchip::OpenEdge> edge;
            {
              const nb::gil_scoped_release release;
              edge = x.twisted_edge();
            }
            return to_tuple(edge);
          },
          nb::sig(
              "def twisted_edge(self) -> tuple[tuple[float, float, float], tuple[float, float, float], int] | None"),
          "The first edge that faces run along more often one way than the other: its ends and a face that uses it. "
          "None if the sides of all faces are consistent, as solids(inside='nonzero') needs.")
      .def_prop_ro(
          "shell_overlap",
          [](const Object& x) -> std::optional<std::pair<std::uint32_t, std::uint32_t>> {
            const nb::gil_scoped_release release;
            const GradualUnderflow mode;
            const std::optional<cchip::Contact> overlap = cchip::shell_overlap(x);
            if (!overlap) return std::nullopt;
            return std::pair(overlap->face_a, overlap->face_b);
          },
          nb::sig("def shell_overlap(self) -> tuple[int, int] | None"),
          "The first two faces that cross or share an area, where shells overlap, are there twice or have a wall in "
          "common; None if there are none. There solids() depends on its rule for the inside. The first use takes as "
          "long as self_contacts().")
      .def(
          "self_contacts",
          [](const Object& x, std::optional<std::size_t> max_contacts, bool relation, bool neighbours) -> nb::object {
            std::vector<std::uint32_t> faces;
            std::vector<std::uint8_t> crossing;
            {
              const nb::gil_scoped_release release;
              const GradualUnderflow mode;
              const std::size_t most = max_contacts.value_or(std::numeric_limits<std::size_t>::max());
              for (const auto& contact : cchip::self_contacts(
                       x, most, neighbours ? cchip::Neighbours::tested : cchip::Neighbours::left_out)) {
                faces.insert(faces.end(), {contact.face_a, contact.face_b});
                crossing.push_back(contact.relation == cchip::Relation::crossing ? 1 : 0);
              }
            }
            const std::size_t count = crossing.size();
            const nb::object pairs = nb::cast(owned<std::uint32_t>(std::move(faces), {count, 2}));
            if (!relation) return pairs;
            return nb::make_tuple(pairs, to_bools(std::move(crossing)));
          },
          nb::kw_only(), "max_contacts"_a = nb::none(), "relation"_a = false, "neighbours"_a = true,
          nb::sig(
              "def self_contacts(self, *, max_contacts: int | None = None, relation: bool = False, neighbours: bool = "
              "True) -> typing.Any"),
          R"((k, 2) uint32: pairs of this object's faces that share a point, ascending, none twice.

Neighbours have a vertex or an edge in common. They are a pair if they share more than that: faces that coincide, fold
onto each other or pierce each other at a vertex. A closed mesh without faults has none.

max_contacts: the search ends when it meets one more than this many.
relation: return a tuple of the pairs and (k,) bool, whether they cross.
neighbours: False leaves out all pairs with a common vertex.)")
      .def_prop_ro(
          "name", [](const Object& x) { return to_text(x.mesh().name); }, nb::sig("def name(self) -> str"),
          "Path of the file; empty for arrays.")
      .def_prop_ro("notes", &notes_of, nb::sig("def notes(self) -> tuple[str, ...]"),
                   "What load() left out of the file, a line each: with lenient=True the first hundred faces that "
                   "cannot be used "
                   "and their number. Empty for arrays; pickle does not keep it.")
      .def_prop_ro("vertices", &vertices_of, nb::rv_policy::reference_internal,
                   "(n, 3) float64, read-only: all vertices, those that no face uses, too.")
      .def_prop_ro(
          "faces", &faces_of,
          "(m, 3) uint32, or (m, 4) if there are quads: numbers of vertices, after polygons were cut. Among quads "
          "a triangle has its last vertex twice.")
      .def_prop_ro(
          "face_numbers", &numbers_of,
          "(m,) uint32: for each of `faces` the number of the file's or the array's face that it is or was cut "
          "from, as in contacts.")
      .def("__getstate__", &state_of)
      .def("__setstate__", &set_state)
      .def("__copy__", [](nb::handle self) { return nb::borrow(self); })
      .def(
          "__deepcopy__", [](nb::handle self, nb::handle) { return nb::borrow(self); }, "memo"_a,
          "Itself: an object never changes.")
      .def_prop_ro(
          "vertex_count", [](const Object& x) { return x.mesh().vertices.size(); }, "Number of vertices.")
      .def_prop_ro(
          "face_count", [](const Object& x) { return x.mesh().faces.size(); },
          "Number of faces, after polygons were cut.")
      .def("__repr__", [](const Object& x) {
        const std::string& name = x.mesh().name;
        return to_text("<collisionchip.Object" + (name.empty() ? name : " " + name) + ": " +
                       std::to_string(x.mesh().vertices.size()) + " vertices, " +
                       std::to_string(x.mesh().faces.size()) + " faces>");
      });

  nb::class_<Proof> proof(m, "Certificate", nb::is_weak_referenceable(),
                          R"(An answer with its proof, which a short program can check (docs/cpp/certificates.md).)");
  def_state(proof, &proof_state, [](Proof& self, const nb::tuple& state) { new (&self) Proof(proof_from(state)); });
  proof
      .def_prop_ro(
          "lines", [](const Proof& x) { return nb::object(nb::cast(text_of(x)).attr("splitlines")()); },
          nb::sig("def lines(self) -> list[str]"), "Lines of JSON: the claim, then a line for each step of the proof.")
      .def(
          "save",
          [](const Proof& x, nb::handle path) {
            const nb::object file =
                nb::module_::import_("io").attr("open")(path, "w", "encoding"_a = "utf-8", "newline"_a = "");
            const nb::object close = file.attr("close");
            try {
              file.attr("write")(text_of(x));
            } catch (...) {
              close();
              throw;
            }
            close();
          },
          "path"_a, nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
          "Writes the lines into a file, for `cchip check` and `python -m collisionchip.check`. Raises OSError: the "
          "file "
          "cannot be written.")
      .def(
          "check", &check_proof, nb::sig("def check(self) -> dict[str, typing.Any]"),
          R"(Checks the proof by collisionchip.check, which is in Python and exact and shares no code with the answer. Slow for large meshes.

Returns the claim, as the first of the lines has it. Raises collisionchip.check.Refused: it does not hold.)")
      .def("__repr__", [](const Proof& x) {
        return "<collisionchip.Certificate: " + std::to_string(x.certificate->contacts.size()) + " contacts, " +
               std::to_string(x.certificate->cells.size()) + " cells>";
      });

  nb::class_<Result> result(m, "Result", nb::is_weak_referenceable(),
                            "The answer to a query. True in a condition if there is a contact.");
  def_state(result, &result_state, &set_result_state);
  result.def_ro("hit", &Result::hit, "bool: there is a contact.")
      .def_ro("relation", &Result::relation,
              "'apart', 'touching' or 'crossing'; None if it was not asked for, or if max_contacts ended the search "
              "before a pair crossed.")
      .def_prop_ro(
          "contacts",
          [](const Result& x) {
            return nb::ndarray<nb::numpy, const std::uint32_t, nb::shape<-1, 2>>(x.faces.data(),
                                                                                 {x.faces.size() / 2, 2});
          },
          nb::rv_policy::reference_internal,
          "(k, 2) uint32, read-only: a face of A and a face of B in each row, ascending, none twice.")
      .def_prop_ro(
          "crossing",
          [](const Result& x) {
            return x.tells_crossing ? to_bools(std::vector<std::uint8_t>(x.crossing)) : nb::none();
          },
          nb::sig("def crossing(self) -> numpy.typing.NDArray[numpy.bool_] | None"),
          "(k,) bool, whether the faces of each contact cross; None if it was not asked for.")
      .def_prop_ro(
          "stats", [](const Result& x) { return to_dict(x.stats); }, nb::sig("def stats(self) -> dict[str, int]"),
          "What the query cost (docs/cpp/collide.md).")
      .def_prop_ro(
          "certificate",
          [](const Result& x) -> std::optional<Proof> {
            if (!x.certificate) return std::nullopt;
            return Proof{x.certificate, x.places};
          },
          nb::sig("def certificate(self) -> Certificate | None"),
          "The answer with its proof; None if it was not asked for.")
      .def("intersections", &intersections_of,
           nb::sig("def intersections(self) -> list[list[tuple[str, numpy.typing.NDArray[numpy.float64]]]]"),
           R"(What the faces of each contact share, exactly; each coordinate is the float64 nearest to the exact one.

Returns a list for each contact, with a tuple of kind and points, (k, 3) float64. Kinds: 'point'; 'segment'; 'polygon', its
corners once around; 'polyhedron', of two quads that are not flat. Of faces that were cut into triangles there is a tuple
for each pair of triangles that share a point, of others one; none of faces that are apart, see within.)")
      .def("curves", &curves_of, nb::sig("def curves(self) -> list[tuple[numpy.typing.NDArray[numpy.float64], bool]]"),
           R"(The segments of intersections(), chained where their ends are the same exact point.

Returns a tuple of points, (k, 3) float64, and whether the last is joined to the first, for each curve. Ask collide() with
contacts='all'.)")
      .def(
          "normals", &normals_of, nb::sig("def normals(self) -> numpy.typing.NDArray[numpy.float64]"),
          R"(Unit normals of the two faces of each contact in their poses, (k, 2, 3) float64; zero for a face without an area.

They go by the order of a face's vertices; a pose that mirrors turns them about.)")
      .def("_point", &point_of, "number"_a, nb::sig("def _point(self, number: int) -> typing.Any"), "For ContactData.")
      .def("_normal", &normal_of, "number"_a, nb::sig("def _normal(self, number: int) -> typing.Any"),
           "For ContactData.")
      .def(
          "show",
          [](const Result& x, nb::object path) {
            return nb::module_::import_("collisionchip.view").attr("show")(page_of(x), path);
          },
          "path"_a = nb::none(),
          nb::sig("def show(self, path: str | os.PathLike[str] | None = None) -> collisionchip.view.View"),
          R"(Shows both objects and the contacts that the result has: opens a page in the browser, or in a notebook returns it to
the cell. For all contacts and which of them cross, ask collide() with contacts='all', relation=True.

path: write the page into this file instead, HTML.

Raises RuntimeError: three.js, which draws, is neither in the package nor on this computer. Raises OSError: the file
cannot be written.)")
      .def("__bool__", [](const Result& x) { return x.hit; })
      .def("__repr__", [](const Result& x) {
        return "<collisionchip.Result: " + std::string(x.hit ? "hit" : "no hit") +
               (x.relation ? ", " + *x.relation : std::string()) + ", " + std::to_string(x.faces.size() / 2) +
               " contacts>";
      });

  nb::class_<Device>(m, "Device", nb::is_weak_referenceable(), R"(Answers queries; open_device() makes one.

It takes one call at a time, from any thread: a device in use raises RuntimeError. Open one for each thread.)")
      .def_prop_ro("name", &Device::name, "Its name, such as 'cpu'.");
  m.def(
      "open_device",
      [](const std::string& name, unsigned threads, const std::string& target) {
        const GradualUnderflow mode;
        if (name == "cpu") return cchip::open_cpu_device({threads, target});
        if (threads != 0 || !target.empty())
          throw std::invalid_argument("only the device 'cpu' has threads and target");
        return cchip::open_device(name);
      },
      "name"_a = "cpu", nb::kw_only(), "threads"_a = 0, "target"_a = "",
      nb::sig("def open_device(name: str = 'cpu', *, threads: int = 0, target: str = '') -> Device"),
      R"(Opens a device, one of device_names().

threads: of a batch on the CPU; 0 means as many as there are cores.
target: one of cpu_targets(), instruction sets of the CPU; by default the best. Which contact contacts="first" names, and stats, may differ
between them; all else is equal.

Raises ValueError: no device or target of this name.)");
  m.def("device_names", &cchip::device_names, "Names that open_device() takes, 'cpu' first.");
  m.def("cpu_targets", &cchip::cpu_targets, "Instruction sets that open_device('cpu', target=...) takes, best first.");

  nb::class_<PyCloud> cloud(m, "PointCloud", nb::is_weak_referenceable(),
                            R"(Points with a radius each, made ready for queries; immutable.

A point meets a face if it is at most its radius away from it. Faces are surfaces: a sphere inside an object meets none.)");
  def_state(cloud, &cloud_state, &set_cloud_state);
  cloud
      .def("__init__", &init_cloud, "points"_a, "radius"_a = 0.0, "numbers"_a = nb::none(),
           nb::sig("def __init__(self, points: numpy.typing.ArrayLike, radius: numpy.typing.ArrayLike = 0, numbers: "
                   "numpy.typing.ArrayLike | None = None) -> None"),
           R"(From arrays, which are copied. Takes O(n log n) time.

points: (n, 3), x, y and z of each; n may be 0.
radius: of all points, or (n,), one for each, in units of the world: poses move the points and leave it as it is.
numbers: (n,), what contacts call the points, such as their numbers in a file; by default 0, 1, 2, ...

Raises ValueError: another shape; a coordinate that is not finite or beyond 2^1000 (leave out the NaN of sensors, as load_points()
does); a radius that is negative, not finite or beyond 2^1000; a masked array, complex numbers.)")
      .def_static(
          "load", &load_cloud, "path"_a, "radius"_a = 0.0,
          nb::sig(
              "def load(path: str | bytes | os.PathLike[str] | os.PathLike[bytes], radius: float = 0) -> PointCloud"),
          R"(Points of a file that load_points() reads, without those that are not finite; contacts have the numbers of the file's
points, from 0, all the same.

radius: of all points. Raises as load_points(), and ValueError as PointCloud().)")
      .def("__len__", [](const PyCloud& x) { return x.points.size(); })
      .def("__repr__", [](const PyCloud& x) {
        const std::size_t n = x.points.size();
        return "<collisionchip.PointCloud: " + std::to_string(n) + (n == 1 ? " point>" : " points>");
      });
  m.def(
      "load_points", &load_points, "path"_a, nb::kw_only(), "leave_out_nan"_a = true, "numbers"_a = false,
      nb::sig(
          "def load_points(path: str | bytes | os.PathLike[str] | os.PathLike[bytes], *, leave_out_nan: bool = True, "
          "numbers: bool = False) -> typing.Any"),
      R"(Points of a file, (n, 3) float64: PLY (with or without faces), XYZ, PCD (ascii and binary), also packed with gzip.

leave_out_nan: points with a coordinate that is not finite are left out, so the rows of those behind them are other than in
the file; with False they are an error.
numbers: return a tuple of the points and (n,) uint32, the number in the file of each, from 0; for PointCloud(numbers=).

Raises OSError: the file cannot be opened. Raises ValueError: it holds no points; the message has file, line and reason.)");
  nb::class_<CloudResult> cloud_result(
      m, "CloudResult", nb::is_weak_referenceable(),
      "What collide() says about a PointCloud; in a condition it is true if there is a contact.");
  def_state(cloud_result, &cloud_result_state, &set_cloud_result_state);
  cloud_result.def_ro("hit", &CloudResult::hit, "Whether there is a contact.")
      .def_prop_ro(
          "contacts",
          [](const CloudResult& x) {
            std::vector<std::uint32_t> rows;
            rows.reserve(2 * x.contacts.size());
            for (const cchip::CloudContact& contact : x.contacts) {
              rows.insert(rows.end(), {contact.point, contact.face});
            }
            return nb::cast(owned<std::uint32_t>(std::move(rows), {x.contacts.size(), 2}));
          },
          "(k, 2) uint32: number of a point and of a face in each row, ascending, none twice.")
      .def_prop_ro(
          "stats", [](const CloudResult& x) { return to_dict(x.stats); }, nb::sig("def stats(self) -> dict[str, int]"),
          "What the query cost (docs/cpp/points.md).")
      .def("__bool__", [](const CloudResult& x) { return x.hit; })
      .def("__repr__", [](const CloudResult& x) {
        return "<collisionchip.CloudResult: " + std::string(x.hit ? "hit" : "no hit") + ", " +
               std::to_string(x.contacts.size()) + " contacts>";
      });
  m.def(
      "collide", &collide_cloud, "cloud"_a, "pose_cloud"_a.none(), "object"_a.none(), "pose_object"_a.none(),
      "contacts"_a = "first", "max_contacts"_a = nb::none(),
      nb::sig(
          "def collide(cloud: PointCloud, pose_cloud: numpy.typing.ArrayLike | None, object: Object, pose_object: "
          "numpy.typing.ArrayLike | None, contacts: str = 'first', max_contacts: int | None = None) -> CloudResult"),
      R"(Which points of a cloud meet which faces of an object? Exact for the float64 numbers of points, radii, mesh and poses.

Poses and contacts as for two objects. Raises ValueError as for two objects.)");
  m.def("collide", &collide, "a"_a.none(), "pose_a"_a.none(), "b"_a.none(), "pose_b"_a.none(), "contacts"_a = "first",
        "relation"_a = false, "least"_a = "touching", "max_contacts"_a = nb::none(), "device"_a = nb::none(),
        "certificate"_a = false, "within"_a = 0.0, "hint"_a = nb::none(),
        nb::sig("def collide(a: Object, pose_a: numpy.typing.ArrayLike | None, b: Object, pose_b: "
                "numpy.typing.ArrayLike | None, contacts: str = 'first', relation: bool = False, least: str = "
                "'touching', max_contacts: int | None = None, device: Device | None = None, certificate: bool = False, "
                "within: float = 0, hint: Result | None = None) -> "
                "Result"),
        R"(Do two placed objects touch, and where? Exact for the float64 numbers of meshes and poses.

pose_a, pose_b: (4, 4) or (3, 4), converted to float64; None is the identity. Any affine map is allowed: a vertex v lies
at pose[:3, :3] @ v + pose[:3, 3]. The last row of a (4, 4) pose must be 0 0 0 1.
contacts: 'first', whether there is one, any of them is returned; or 'all' of them, at most max_contacts.
relation: tell touching from crossing; fills Result.relation and Result.crossing.
least: what faces must do at least to be a contact: 'touching', share a point; or 'crossing', cross.
device: by default one thread of the CPU, one for each calling thread.
certificate: prove the answer; fills Result.certificate. Takes far longer than the answer.
within: faces at most so far apart, in units of the world, are contacts; exactly. Leave relation and least then.
hint: the Result of the query before, about the same objects a moment earlier: the CPU tests the faces of its first
contact first, and is done if they touch. It never changes whether there is a contact.

Raises ValueError: a pose of another shape or with an entry that is not finite or beyond 2^500, an unknown word,
max_contacts of 0. Raises RuntimeError: the device is in use; or, with certificate=True, the answer is wrong.)");
  m.def("first_met", &first_met, "cloud"_a, "pose_cloud"_a.none(), "objects"_a.none(),
        nb::sig("def first_met(cloud: PointCloud, pose_cloud: numpy.typing.ArrayLike | None, objects: "
                "typing.Iterable[tuple[Object, numpy.typing.ArrayLike | None]]) -> int | None"),
        R"(Does a point of the cloud meet any of several placed objects, such as the links of a robot?

objects: an iterable of tuples of an Object and its pose. Returns the number of the first one that is met, or None.

Raises ValueError: as collide(); an entry that is no such tuple.)");
  m.def(
      "collide_many", &collide_many, "a"_a.none(), "poses_a"_a.none(), "b"_a.none(), "poses_b"_a.none(),
      "contacts"_a = false, "relation"_a = false, "least"_a = "touching", "max_contacts"_a = nb::none(),
      "device"_a = nb::none(), "certificate"_a = false, "within"_a = 0.0,
      nb::sig("def collide_many(a: Object, poses_a: numpy.typing.ArrayLike | None, b: Object, poses_b: "
              "numpy.typing.ArrayLike | None, contacts: bool = False, relation: bool = False, least: str = "
              "'touching', max_contacts: int | "
              "None = None, device: Device | None = None, certificate: bool = False, within: float = 0) -> typing.Any"),
      R"(The same two objects in n pairs of poses, on all cores, with the GIL released.

poses_a, poses_b: (n, 4, 4) or (n, 3, 4), as collide() takes them; or one pose, (4, 4), (3, 4) or None, for all.
contacts: return all contacts as well, at most max_contacts a query.
relation: tell touching from crossing, as collide().
least: as collide().
device: by default the CPU with all cores, one for the process; while another thread uses it, one core.
certificate: prove each answer, as collide().
within: as collide().

Returns hits, (n,) bool. With contacts=True a tuple of hits and contacts, (k, 3) uint32, in each row the number of the
query, a face of A and a face of B, ascending. With relation=True the tuple continues with relations, (n,) str, as
Result.relation with '' for None; with both there follows crossing, (k,) bool, as Result.crossing.
With certificate=True the tuple ends with a list of certificates, one for each query.

Raises as collide(), and ValueError if there are not as many poses of A as of B. Ctrl-C takes effect after the call.)");
  nb::class_<cchip::DistanceResult> far(m, "Distance", nb::is_weak_referenceable(),
                                        "Bounds of a distance, proved, and the nearest points; distance() makes it.");
  def_state(far, &distance_state, &set_distance_state);
  far.def_ro("lower", &cchip::DistanceResult::lower, "The distance is at least this.")
      .def_ro("upper", &cchip::DistanceResult::upper,
              "The distance is at most this; inf if it is above stop_above, which is lower then.")
      .def_prop_ro(
          "points",
          [](const cchip::DistanceResult& x) {
            std::vector<double> rows(x.point_a.data(), x.point_a.data() + 3);
            rows.insert(rows.end(), x.point_b.data(), x.point_b.data() + 3);
            return nb::cast(owned<double>(std::move(rows), {2, 3}));
          },
          "Nearest points of A and of B in the world, rounded, (2, 3) float64; nan if upper is inf.")
      .def_prop_ro(
          "faces",
          [](const cchip::DistanceResult& x) {
            return nb::cast(owned<std::uint32_t>(std::vector<std::uint32_t>{x.face_a, x.face_b}, {2}));
          },
          "The faces on which they lie, (2,) uint32.")
      .def("__repr__", [](const cchip::DistanceResult& x) {
        return "<collisionchip.Distance: " + std::string(nb::repr(nb::float_(x.lower)).c_str()) + " to " +
               nb::repr(nb::float_(x.upper)).c_str() + ">";
      });
  m.def(
      "distance",
      [](nb::handle object_a, nb::handle pose_a, nb::handle object_b, nb::handle pose_b, double rel_error,
         double stop_above) {
        const Object a = to_object(object_a, "a");
        const Object b = to_object(object_b, "b");
        const Pose place_a = one_pose(pose_a, "pose_a");
        const Pose place_b = one_pose(pose_b, "pose_b");
        const nb::gil_scoped_release release;
        const GradualUnderflow mode;
        cchip::DistanceResult result = cchip::distance(a, place_a, b, place_b, {rel_error, stop_above});
        if (std::isinf(result.upper)) {
          result.point_a.setConstant(std::numeric_limits<double>::quiet_NaN());
          result.point_b = result.point_a;
        }
        return result;
      },
      "a"_a.none(), "pose_a"_a.none(), "b"_a.none(), "pose_b"_a.none(), nb::kw_only(), "rel_error"_a = 0.0,
      "stop_above"_a = std::numeric_limits<double>::infinity(),
      nb::sig("def distance(a: Object, pose_a: numpy.typing.ArrayLike | None, b: Object, pose_b: "
              "numpy.typing.ArrayLike | None, *, rel_error: float = 0, stop_above: float = float('inf')) -> Distance"),
      R"(How far are two placed objects apart? 0 if they touch or cross; surfaces, so also inside each other.

rel_error: upper - lower <= rel_error * upper is good enough; with 0 both are the distance, or the two doubles beside it.
stop_above: of a distance above this nothing more is asked.

Raises ValueError: a pose as in collide(); rel_error that is not in [0, 1), a stop_above that is negative or nan.)");
  m.def(
      "distances",
      [](nb::handle mesh, nb::handle pose, nb::handle points, bool is_signed, unsigned threads) {
        const Object object = to_object(mesh, "object");
        const Pose place = one_pose(pose, "pose");
        const std::vector<Vec3d> at = to_points(to_array<double>(points, "float64", "points"));
        std::vector<double> found(at.size()), nearest(3 * at.size());
        std::vector<std::uint32_t> faces(at.size());
        {
          const nb::gil_scoped_release release;
          const GradualUnderflow mode;
          const std::vector<cchip::DistanceResult> results = cchip::distances(object, place, at, {}, threads);
          std::vector<cchip::PointPlace> places(at.size(), cchip::PointPlace::outside);
          if (is_signed) places = cchip::inside(object, place, at, {}, threads);
          for (std::size_t i = 0; i < results.size(); ++i) {
            found[i] = places[i] == cchip::PointPlace::inside ? -results[i].upper : results[i].upper;
            faces[i] = results[i].face_a;
            for (std::size_t k = 0; k < 3; ++k) nearest[3 * i + k] = results[i].point_a[static_cast<Eigen::Index>(k)];
          }
        }
        const std::size_t n = found.size();
        return nb::make_tuple(owned<double>(std::move(found), {n}), owned<double>(std::move(nearest), {n, 3}),
                              owned<std::uint32_t>(std::move(faces), {n}));
      },
      "object"_a.none(), "pose"_a.none(), "points"_a, nb::kw_only(), "signed"_a = false, "threads"_a = 1,
      nb::sig("def distances(object: Object, pose: numpy.typing.ArrayLike | None, points: numpy.typing.ArrayLike, *, "
              "signed: bool = False, threads: int = 1) -> tuple[numpy.typing.NDArray[numpy.float64], "
              "numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.uint32]]"),
      R"(How far are points, (n, 3), from the surface of a placed object?

Returns their distances, (n,), each the exact number or the double above it; the nearest points of the surface, (n, 3),
rounded; the faces that these lie on, (n,).

signed: distances of points inside are negative; the surface has to be closed. threads: 0 for all cores.
Raises ValueError: a point that is not finite; with signed as inside().)");
  nb::class_<cchip::AlongResult> way(m, "Along", nb::is_weak_referenceable(),
                                     "A factor of a direction; clear_along() and first_contact() make it.");
  def_state(way, &along_state, &set_along_state);
  way.def_ro(
         "touches", &cchip::AlongResult::touches,
         "The objects touch there. If False they are apart as they are (clear_along) or never touch (first_contact).")
      .def_ro("factor", &cchip::AlongResult::factor, "The double nearest to the exact number.")
      .def_ro("lower", &cchip::AlongResult::lower, "The greatest double that is at most the exact number.")
      .def_ro("upper", &cchip::AlongResult::upper, "The least double that is at least the exact number.")
      .def_prop_ro(
          "faces",
          [](const cchip::AlongResult& x) {
            return nb::cast(owned<std::uint32_t>(std::vector<std::uint32_t>{x.face_a, x.face_b}, {2}));
          },
          "Faces of A and of B that touch there and decide, (2,) uint32; meaningless unless touches.")
      .def("__repr__", [](const cchip::AlongResult& x) {
        return "<collisionchip.Along: " + std::string(nb::repr(nb::float_(x.factor)).c_str()) +
               (x.touches ? ", touches>" : ">");
      });
  m.def("clear_along", &along<cchip::clear_along>, "a"_a.none(), "pose_a"_a.none(), "b"_a.none(), "pose_b"_a.none(),
        "direction"_a,
        nb::sig("def clear_along(a: Object, pose_a: numpy.typing.ArrayLike | None, b: Object, pose_b: "
                "numpy.typing.ArrayLike | None, direction: numpy.typing.ArrayLike) -> Along"),
        R"(How far must B move along a direction until it is clear of A? Exactly.

direction: (3,), in the world, not zero.

Returns the least factor such that B, moved by any slightly greater multiple of the direction, is apart from A; 0 if they
are apart as they are, then touches is False.

Raises ValueError: a pose as in collide(); a direction that is zero, not finite or of another shape.)");
  m.def("first_contact", &along<cchip::first_contact>, "a"_a.none(), "pose_a"_a.none(), "b"_a.none(), "pose_b"_a.none(),
        "direction"_a,
        nb::sig("def first_contact(a: Object, pose_a: numpy.typing.ArrayLike | None, b: Object, pose_b: "
                "numpy.typing.ArrayLike | None, direction: numpy.typing.ArrayLike) -> Along"),
        R"(How far may B move along a direction until it touches A? Exactly.

direction: (3,), in the world, not zero.

Returns the least factor for which B, moved by that multiple of the direction, touches A; 0 if they touch as they are,
inf if they never touch, then touches is False.

Raises as clear_along().)");
  m.def(
      "inside",
      [](nb::handle mesh, nb::handle pose, nb::handle points, const std::string& inside, unsigned threads) {
        const Object object = to_object(mesh, "object");
        const Pose place = one_pose(pose, "pose");
        const std::vector<Vec3d> at = to_points(to_array<double>(points, "float64", "points"));
        std::vector<std::int8_t> places(at.size());
        {
          const cchip::SolidRequest request = to_solid_request(inside);
          const nb::gil_scoped_release release;
          const GradualUnderflow mode;
          const std::vector<cchip::PointPlace> found = cchip::inside(object, place, at, request, threads);
          for (std::size_t i = 0; i < found.size(); ++i) {
            places[i] = static_cast<std::int8_t>(static_cast<int>(found[i]) - 1);
          }
        }
        const std::size_t n = places.size();
        return owned<std::int8_t>(std::move(places), {n});
      },
      "object"_a.none(), "pose"_a.none(), "points"_a, nb::kw_only(), "inside"_a = "odd", "threads"_a = 1,
      nb::sig("def inside(object: Object, pose: numpy.typing.ArrayLike | None, points: numpy.typing.ArrayLike, *, "
              "inside: str = 'odd', threads: int = 1) -> numpy.typing.NDArray[numpy.int8]"),
      R"(Where points, (n, 3), are to a placed solid: (n,) int8, 1 inside, 0 on the surface, -1 outside. Exactly.

inside: the rule of solids(). threads: 0 for all cores.
Raises ValueError: the surface is open; its faces are not all the same way round, with inside='nonzero'; the pose
flattens space; a point that is not finite.)");
  m.def("solids", &solids_of_two, "a"_a.none(), "pose_a"_a.none(), "b"_a.none(), "pose_b"_a.none(), nb::kw_only(),
        "inside"_a = "odd",
        nb::sig("def solids(a: Object, pose_a: numpy.typing.ArrayLike | None, b: Object, pose_b: "
                "numpy.typing.ArrayLike | None, *, inside: str = 'odd') -> str"),
        R"(How do two closed meshes lie to each other as solids? Exactly.

"disjoint"; "touching": surfaces share a point, no volume; "overlapping"; "a_in_b" and "b_in_a", surfaces may touch; "equal".

inside: 'odd', what a surface encloses an odd number of times; 'nonzero', what it winds around, so that space two shells share is
inside. They differ where shells of a mesh overlap or are there twice (Object.shell_overlap): with 'odd' a UserWarning says so.

Raises ValueError: a pose as in collide(), or one that flattens space; a mesh that is not closed (Object.is_closed), or, with
'nonzero', with faces that are not all the same way round (Object.twisted_edge).)");
  m.def(
      "_to_object", [](nb::handle mesh, const std::string& name) { return to_object(mesh, name.c_str()); },
      "mesh"_a.none(), "name"_a, nb::sig("def _to_object(mesh: typing.Any, name: str) -> Object"),
      "For CollisionManager: the Object itself, or one made of a mesh; the name is for messages.");
  m.def(
      "_rotation",
      [](double x, double y, double z) {
        const Rows<double> rows = cchip::make_pose(Eigen::Vector3d::Zero(), {x, y, z}).linear();
        return owned<double>(std::vector<double>(rows.data(), rows.data() + rows.size()), {3, 3});
      },
      "x"_a, "y"_a, "z"_a, nb::sig("def _rotation(x: float, y: float, z: float) -> typing.Any"),
      "For make_pose(): of degrees about the fixed axes x, then y, then z.");
  m.def("_exact", &exact, "a"_a.none(), "pose_a"_a.none(), "b"_a.none(), "pose_b"_a.none(),
        nb::sig("def _exact(a: Object, pose_a: typing.Any, b: Object, pose_b: typing.Any) -> Result"),
        "For tests: all contacts by asking about every pair of faces in integers of any size. Slow.");

  nb::class_<PyScene> scene(m, "Scene", nb::type_slots(scene_slots), nb::is_weak_referenceable(),
                            R"(Placed objects, and which of them touch.

Objects have ids: 1, 2, 3, ... in the order of add(), none given twice. Queries may run in several threads at a time,
each with its own device; a change meanwhile raises RuntimeError. Methods that take an id raise ValueError if no object
has it.)");
  scene.def(nb::init<>(), "An empty scene.")
      .def(
          "add",
          [](PyScene& self, nb::handle mesh, nb::handle pose, std::uint64_t groups, std::uint64_t mask) {
            const Object object = to_object(mesh, "object");
            const Pose place = one_pose(pose, "pose");
            const GradualUnderflow mode;
            return self.add(object, place, {groups, mask});
          },
          "object"_a.none(), "pose"_a = nb::none(), "groups"_a = 1, "mask"_a = all_groups,
          nb::sig(
              "def add(self, object: Object, pose: numpy.typing.ArrayLike | None = None, groups: int = 1, mask: int "
              "= 0xffffffffffffffff) -> int"),
          R"(Adds an object in a pose, as collide() takes it, and returns its id.

groups, mask: 64 bits each. Two objects are tested if the mask of each has a group of the other.)")
      .def(
          "set_pose",
          [](PyScene& self, Scene::Id id, nb::handle pose) {
            const Pose place = one_pose(pose, "pose");
            const GradualUnderflow mode;
            self.change().set_pose(id, place);
          },
          "id"_a, "pose"_a.none(), nb::sig("def set_pose(self, id: int, pose: numpy.typing.ArrayLike | None) -> None"),
          "Moves an object to a pose, as collide() takes it.")
      .def(
          "remove", [](PyScene& self, Scene::Id id) { self.remove(id); }, "id"_a, "Takes an object out.")
      .def(
          "set_groups",
          [](PyScene& self, Scene::Id id, std::uint64_t groups, std::uint64_t mask) {
            self.change().set_groups(id, {groups, mask});
          },
          "id"_a, "groups"_a = 1, "mask"_a = all_groups,
          nb::sig("def set_groups(self, id: int, groups: int = 1, mask: int = 0xffffffffffffffff) -> None"),
          "Changes the groups of an object and the groups that it is tested against, 64 bits each.")
      .def(
          "groups",
          [](const PyScene& self, Scene::Id id) {
            const cchip::CollisionGroups& x = self.scene().groups(id);
            return nb::make_tuple(x.groups, x.mask);
          },
          "id"_a, nb::sig("def groups(self, id: int) -> tuple[int, int]"), "Groups and mask of an object.")
      .def(
          "set_ignored", [](PyScene& self, Scene::Id a, Scene::Id b, bool ignored) { self.set_ignored(a, b, ignored); },
          "a"_a, "b"_a, "ignored"_a = true,
          "Leaves a pair out, such as two links that a joint connects; or takes it in again.")
      .def("set_filter", &PyScene::set_filter, "filter"_a.none(),
           nb::sig("def set_filter(self, filter: typing.Callable[[int, int], bool] | None) -> None"),
           "A function of two ids, the lower one first: is this pair to be tested? It is asked last, and only about "
           "pairs whose boxes overlap. None lets all through. It must not change the scene.")
      .def(
          "ids", [](const PyScene& self) { return self.scene().ids(); }, "All ids, ascending.")
      .def(
          "object", [](const PyScene& self, Scene::Id id) { return Object(self.scene().object(id)); }, "id"_a,
          "The object with this id.")
      .def(
          "pose",
          [](const PyScene& self, Scene::Id id) {
            const Rows<double> rows = self.scene().pose(id).matrix();
            return owned<double>(std::vector<double>(rows.data(), rows.data() + rows.size()), {4, 4});
          },
          "id"_a, "The pose of an object, (4, 4) float64.")
      .def("solids", &solids_of, nb::kw_only(), "device"_a = nb::none(), "inside"_a = "odd",
           nb::sig(
               "def solids(self, *, device: Device | None = None, inside: str = 'odd') -> list[tuple[int, int, str]]"),
           R"(All pairs that are not disjoint as solids, tuples (id of A, id of B, word of solids()), ascending.

Raises and warns as solids() for pairs of candidates(): both must be closed.)")
      .def("_pairs", &pairs_of, "other"_a = nb::none(), "first"_a = false, "device"_a = nb::none(),
           nb::sig("def _pairs(self, other: Scene | None = None, first: bool = False, device: Device | None = None) -> "
                   "typing.Any"),
           "For CollisionManager: (k, 2) uint64, ids of pairs in contact; of `other` and this scene if it is given.")
      .def("_nearest", &nearest_of, "other"_a = nb::none(), "id"_a = 0,
           nb::sig("def _nearest(self, other: Scene | None = None, id: int = 0) -> tuple[int, int, Distance] | None"),
           "For CollisionManager: the nearest pair; of this scene and `other` or of the object with this id, if given.")
      .def("__getstate__", &scene_state)
      .def("__setstate__", &set_scene_state)
      .def("__copy__",
           [](const PyScene& self) {
             auto copy = std::make_unique<PyScene>();
             self.copy_to(*copy);
             return copy;
           })
      .def(
          "__deepcopy__",
          [](const PyScene& self, nb::handle) {
            auto copy = std::make_unique<PyScene>();
            self.copy_to(*copy);
            return copy;
          },
          "memo"_a, "A scene of its own, with the same ids, objects and filter.")
      .def("__len__", [](const PyScene& self) { return self.scene().size(); })
      .def("__contains__", [](const PyScene& self, Scene::Id id) { return self.scene().contains(id); })
      .def(
          "candidates",
          [](PyScene& self) {
            std::vector<Scene::Id> ids;
            for (const auto& [a, b] : self.ask([](const Scene& s) { return s.candidates(); })) {
              ids.insert(ids.end(), {a, b});
            }
            const std::size_t n = ids.size() / 2;
            return owned<Scene::Id>(std::move(ids), {n, 2});
          },
          "(k, 2) uint64: ids of the pairs whose boxes overlap and that groups, ignored pairs and filter let through.");
  const auto contacts = [](const Scene& s, auto&&... what) { return s.contacts(what...); };
  const auto find_contact = [](const Scene& s, auto&&... what) { return s.find_contact(what...); };
  def_queries(scene, "contacts", contacts, "list[@]",
              R"(All pairs in contact, tuples (id of A, id of B, result), ascending.

The other parameters are those of collide(); the device is by default the CPU with all cores. Raises as collide() and as
the filter.)");
  def_queries(scene, "find_contact", find_contact, "@ | None",
              "One of the tuples that contacts() would return, any of them, or None if there is no contact.");
  collisionchip_python::def_assembly(m);
}
