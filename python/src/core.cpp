// SPDX-License-Identifier: Apache-2.0
// Python module collisionchip._core: arrays to C++ and back. What the answers mean is decided in the library.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <Eigen/Core>
#include <cchip/cchip.hpp>
#include <cchip/reference/brute_force.hpp>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using cchip::CollisionRequest;
using cchip::CollisionResult;
using cchip::Device;
using cchip::Object;
using cchip::Pose;
using cchip::Scene;

// Arrays from Python.

template <class Scalar>
using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
template <class Scalar>
using Array = nb::ndarray<const Scalar, nb::c_contig, nb::device::cpu>;

std::string shape_of(const Array<double>& x) {
  std::string text = "(";
  for (std::size_t i = 0; i < x.ndim(); ++i) text += (i != 0 ? ", " : "") + std::to_string(x.shape(i));
  return text + (x.ndim() == 1 ? ",)" : ")");
}

/// As it is if it is a contiguous array of this type already, or else what numpy makes of it.
template <class Scalar>
Array<Scalar> to_array(nb::handle x, const char* type) {
  Array<Scalar> array;
  if (!nb::try_cast(x, array, false)) {
    array = nb::cast<Array<Scalar>>(nb::module_::import_("numpy").attr("array")(x, type, "order"_a = "C"));
  }
  return array;
}

Pose to_pose(const double* rows, std::size_t count) {
  if (count == 4 && (rows[12] != 0 || rows[13] != 0 || rows[14] != 0 || rows[15] != 1)) {
    throw std::invalid_argument("the last row of a 4 x 4 pose must be 0 0 0 1");
  }
  Pose pose;
  pose.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(rows);
  return pose;
}

/// One pose, or an array of them: (4, 4), (3, 4), (n, 4, 4) or (n, 3, 4).
class Poses {
 public:
  Poses(nb::handle x, const char* name, bool many_allowed) {
    if (x.is_none()) {
      poses_.push_back(Pose::Identity());
      return;
    }
    const auto array = to_array<double>(x, "float64");
    const std::size_t n = array.ndim();
    many_ = n == 3;
    if (!(n == 2 || (many_ && many_allowed)) || array.shape(n - 1) != 4 ||
        (array.shape(n - 2) != 3 && array.shape(n - 2) != 4)) {
      throw std::invalid_argument(std::string(name) + " has the shape " + shape_of(array) + "; give (4, 4) or (3, 4)" +
                                  (many_allowed ? ", or (n, 4, 4) or (n, 3, 4)" : ""));
    }
    const std::size_t rows = array.shape(n - 2);
    const std::size_t count = many_ ? array.shape(0) : 1;
    poses_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) poses_.push_back(to_pose(array.data() + 4 * rows * i, rows));
  }
  bool many() const { return many_; }
  std::size_t size() const { return poses_.size(); }
  const Pose& operator[](std::size_t i) const { return poses_[many_ ? i : 0]; }

 private:
  std::vector<Pose> poses_;
  bool many_ = false;
};

Pose one_pose(nb::handle x, const char* name) { return Poses(x, name, false)[0]; }

// Arrays to Python.

/// An array that owns a copy of the rows.
template <class Scalar>
nb::ndarray<nb::numpy, Scalar> owned(std::vector<Scalar>&& data, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<Scalar>(std::move(data));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<Scalar>*>(p); });
  return nb::ndarray<nb::numpy, Scalar>(kept->data(), shape, owner);
}

nb::object to_bools(std::vector<std::uint8_t>&& values) {  // std::vector<bool> has no data()
  const std::size_t n = values.size();
  return nb::cast(owned<std::uint8_t>(std::move(values), {n})).attr("view")("bool");
}

// Objects.

cchip::Mesh mesh_of(nb::handle vertices, nb::handle faces) {
  const auto points = to_array<double>(vertices, "float64");
  const nb::object numbers = nb::module_::import_("numpy").attr("asarray")(faces);
  const std::string kind = nb::cast<std::string>(numbers.attr("dtype").attr("kind"));
  if (kind != "i" && kind != "u") {
    throw std::invalid_argument("faces are " + nb::cast<std::string>(numbers.attr("dtype").attr("name")) +
                                "; give integers, the numbers of vertices from 0");
  }
  const auto indices = to_array<std::int64_t>(numbers, "int64");
  const auto matrix = [](const auto& x, const char* name) {
    using Scalar = std::remove_const_t<std::remove_pointer_t<decltype(x.data())>>;
    if (x.ndim() != 2) {
      throw std::invalid_argument(std::string(name) + " have " + std::to_string(x.ndim()) +
                                  " dimensions; give two, a row for each");
    }
    return Eigen::Map<const Rows<Scalar>>(x.data(), static_cast<Eigen::Index>(x.shape(0)),
                                          static_cast<Eigen::Index>(x.shape(1)));
  };
  return cchip::make_mesh(matrix(points, "vertices"), cchip::FaceMatrix(matrix(indices, "faces")));
}

Object load(nb::handle path, bool quads) {
  const std::string name = nb::cast<std::string>(nb::module_::import_("os").attr("fspath")(path));
  if (std::FILE* file = std::fopen(name.c_str(), "rb")) {
    std::fclose(file);
  } else {
    PyErr_SetFromErrnoWithFilename(PyExc_OSError, name.c_str());
    throw nb::python_error();
  }
  const nb::gil_scoped_release release;
  try {
    return Object(cchip::load_mesh(name, quads ? cchip::FaceKinds::triangles_and_quads : cchip::FaceKinds::triangles));
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());
  }
}

// Requests and results.

CollisionRequest to_request(const std::string& contacts, bool relation, const std::string& counts,
                            std::optional<std::size_t> max_contacts) {
  CollisionRequest request;
  if (contacts == "all") {
    request.contacts = CollisionRequest::Contacts::all;
  } else if (contacts != "first") {
    throw std::invalid_argument("contacts is '" + contacts + "'; give 'first' or 'all'");
  }
  if (counts == "crossing") {
    request.counts = CollisionRequest::Counts::crossing;
  } else if (counts != "touching") {
    throw std::invalid_argument("counts is '" + counts + "'; give 'touching' or 'crossing'");
  }
  request.relation = relation;
  if (max_contacts) request.max_contacts = *max_contacts;
  return request;
}

const char* name_of(cchip::Relation relation) {
  if (relation == cchip::Relation::apart) return "apart";
  return relation == cchip::Relation::touching ? "touching" : "crossing";
}

struct Result {
  explicit Result(const CollisionResult& x) : hit(x.hit), counts(x.counts) {
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
  cchip::CollisionCounts counts;
};

/// The device that was given, or one of the calling thread's own that uses all cores for batches.
Device& device_or_own(Device* device) {
  if (device != nullptr) return *device;
  thread_local const std::unique_ptr<Device> own = cchip::open_cpu_device();
  return *own;
}

Result collide(const Object& a, nb::handle pose_a, const Object& b, nb::handle pose_b, const std::string& contacts,
               bool relation, const std::string& counts, std::optional<std::size_t> max_contacts, Device* device) {
  const Pose place_a = one_pose(pose_a, "pose_a");
  const Pose place_b = one_pose(pose_b, "pose_b");
  const CollisionRequest request = to_request(contacts, relation, counts, max_contacts);
  const nb::gil_scoped_release release;
  return Result(device != nullptr ? cchip::collide(*device, a, place_a, b, place_b, request)
                                  : cchip::collide(a, place_a, b, place_b, request));
}

/// Calls `each` for the result of every pose, with the GIL released.
template <class Each>
void collide_each(const Object& a, const Poses& poses_a, const Object& b, const Poses& poses_b, std::size_t count,
                  const CollisionRequest& request, Device* device, const Each& each) {
  const nb::gil_scoped_release release;
  device_or_own(device).collide(
      count,
      [&](std::size_t i) {
        return cchip::CollisionQuery{&a, &poses_a[i], &b, &poses_b[i]};
      },
      request, each);
}

nb::object collide_many(const Object& a, nb::handle poses_a, const Object& b, nb::handle poses_b, bool contacts,
                        const std::string& counts, std::optional<std::size_t> max_contacts, Device* device) {
  const Poses places_a(poses_a, "poses_a", true);
  const Poses places_b(poses_b, "poses_b", true);
  if (places_a.many() && places_b.many() && places_a.size() != places_b.size()) {
    throw std::invalid_argument("poses_a are " + std::to_string(places_a.size()) + ", poses_b " +
                                std::to_string(places_b.size()) + "; give as many of both, or one pose for all");
  }
  const std::size_t count = places_a.many() ? places_a.size() : places_b.size();
  if (count > std::numeric_limits<std::uint32_t>::max()) throw std::invalid_argument("more than 2^32 - 1 poses");
  const CollisionRequest request = to_request(contacts ? "all" : "first", false, counts, max_contacts);
  std::vector<std::uint8_t> hits(count);
  std::vector<std::vector<cchip::Contact>> found(contacts ? count : 0);
  collide_each(a, places_a, b, places_b, count, request, device, [&](std::size_t i, const CollisionResult& result) {
    hits[i] = result.hit ? 1 : 0;
    if (contacts) found[i] = result.contacts;
  });
  if (!contacts) return to_bools(std::move(hits));
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i < count; ++i) {
    for (const cchip::Contact& contact : found[i]) {
      rows.insert(rows.end(), {static_cast<std::uint32_t>(i), contact.face_a, contact.face_b});
    }
  }
  const std::size_t n = rows.size() / 3;
  return nb::make_tuple(to_bools(std::move(hits)), owned<std::uint32_t>(std::move(rows), {n, 3}));
}

/// By asking about every pair of faces in integers of any size: for tests.
Result exact(const Object& a, nb::handle pose_a, const Object& b, nb::handle pose_b) {
  CollisionResult result;
  result.contacts =
      cchip::brute_force_contacts(a.mesh(), one_pose(pose_a, "pose_a"), b.mesh(), one_pose(pose_b, "pose_b"));
  result.hit = !result.contacts.empty();
  result.relation = cchip::Relation::apart;
  for (const cchip::Contact& contact : result.contacts) {
    result.relation = std::max(*result.relation, contact.relation.value_or(cchip::Relation::touching));
  }
  return Result(result);
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

  /// Runs a query with the GIL released.
  template <class Query>
  auto ask(const Query& query) {
    const Count count(queries_);
    const nb::gil_scoped_release release;
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

nb::object to_tuple(const Scene::Pair& x) { return nb::make_tuple(x.a, x.b, Result(x.result)); }
nb::object to_tuple(const Scene::Hit& x) { return nb::make_tuple(x.id, Result(x.result)); }
template <class Found>
nb::object to_object(const std::vector<Found>& found) {
  nb::list list;
  for (const Found& x : found) list.append(to_tuple(x));
  return list;
}
template <class Found>
nb::object to_object(const std::optional<Found>& found) {
  return found ? to_tuple(*found) : nb::none();
}

constexpr std::uint64_t all_groups = ~std::uint64_t{0};

/// touching() and find_touching() of a scene: all pairs, those of one object, those of an object outside.
template <class Call>
void def_queries(nb::class_<PyScene>& type, const char* name, const Call& call, const std::string& found,
                 const std::string& doc) {
  const std::string keywords =
      ", *, contacts: str = 'first', relation: bool = False, counts: str = 'touching', "
      "max_contacts: int | None = None, device: Device | None = None";
  const auto sig = [&](const std::string& what, const std::string& pair) {
    std::string result = found;
    result.replace(result.find('@'), 1, pair);
    return "def " + std::string(name) + "(self" + what + keywords + ") -> " + result;
  };
  type.def(
      name,
      [call](PyScene& self, const std::string& contacts, bool relation, const std::string& counts,
             std::optional<std::size_t> max_contacts, Device* device) {
        const CollisionRequest request = to_request(contacts, relation, counts, max_contacts);
        return to_object(self.ask([&](const Scene& s) { return call(s, device_or_own(device), request); }));
      },
      nb::kw_only(), "contacts"_a = "first", "relation"_a = false, "counts"_a = "touching",
      "max_contacts"_a = nb::none(), "device"_a = nb::none(), nb::sig(sig("", "tuple[int, int, Result]").c_str()),
      doc.c_str());
  type.def(
      name,
      [call](PyScene& self, Scene::Id id, const std::string& contacts, bool relation, const std::string& counts,
             std::optional<std::size_t> max_contacts, Device* device) {
        const CollisionRequest request = to_request(contacts, relation, counts, max_contacts);
        return to_object(self.ask([&](const Scene& s) { return call(s, device_or_own(device), id, request); }));
      },
      "id"_a, nb::kw_only(), "contacts"_a = "first", "relation"_a = false, "counts"_a = "touching",
      "max_contacts"_a = nb::none(), "device"_a = nb::none(), nb::sig(sig(", id: int", "tuple[int, Result]").c_str()),
      "The same for one object of the scene, which is A in the results; tuples (id, result).");
  type.def(
      name,
      [call](PyScene& self, const Object& object, nb::handle pose, std::uint64_t groups, std::uint64_t mask,
             const std::string& contacts, bool relation, const std::string& counts,
             std::optional<std::size_t> max_contacts, Device* device) {
        const CollisionRequest request = to_request(contacts, relation, counts, max_contacts);
        const Pose place = one_pose(pose, "pose");
        const cchip::CollisionGroups bits = {groups, mask};
        return to_object(
            self.ask([&](const Scene& s) { return call(s, device_or_own(device), object, place, request, bits); }));
      },
      "object"_a, "pose"_a = nb::none(), "groups"_a = 1, "mask"_a = all_groups, nb::kw_only(), "contacts"_a = "first",
      "relation"_a = false, "counts"_a = "touching", "max_contacts"_a = nb::none(), "device"_a = nb::none(),
      nb::sig(sig(", object: Object, pose: numpy.typing.ArrayLike | None = None, groups: int = 1, mask: int = "
                  "0xffffffffffffffff",
                  "tuple[int, Result]")
                  .c_str()),
      "The same for an object that is not in the scene, which is A in the results; tuples (id, result). The filter is "
      "not asked.");
}

}  // namespace

NB_MODULE(_core, m) {
  m.doc() = "Exact collision detection for triangle and quad meshes; import collisionchip instead.";
  m.attr("version") = CCHIP_VERSION;  // stubs leave out __version__

  nb::class_<Object>(m, "Object", R"(A mesh made ready for collision tests; immutable, any number of threads may use it.

An object is the surface of the mesh, not the volume inside: one wholly inside another does not touch it.)")
      .def(
          "__init__",
          [](Object* self, nb::handle vertices, nb::handle faces) {
            cchip::Mesh mesh = mesh_of(vertices, faces);
            const nb::gil_scoped_release release;
            new (self) Object(std::move(mesh));
          },
          "vertices"_a, "faces"_a,
          nb::sig("def __init__(self, vertices: numpy.typing.ArrayLike, faces: numpy.typing.ArrayLike) -> None"),
          R"(From arrays, which are copied. Takes O(m log m) time.

vertices: (n, 3) float64, x, y and z of each in any length unit.
faces: (m, 3) for triangles or (m, 4) for quads, integers of any kind: numbers of vertices from 0. A quad is the hull
of its four vertices; one with a dent or a spike is cut into triangles, which are one face.

Raises ValueError: another shape, faces that are not integers, a number beyond the vertices, no faces or more than
2^24 - 2, a vertex that is not finite or beyond 2^1000.)")
      .def_static(
          "load", &load, "path"_a, "quads"_a = false,
          nb::sig("def load(path: str | os.PathLike[str], quads: bool = False) -> Object"),
          R"(From a file: OBJ, OFF, PLY or STL. Polygons are cut into triangles, with quads=True all but quads without a dent;
contacts have the numbers of the file's faces all the same.

Raises OSError: the file cannot be opened. Raises ValueError: it is no mesh; the message has file, line and reason.)")
      .def(
          "moved",
          [](const Object& x, nb::handle vertices) {
            const auto points = to_array<double>(vertices, "float64");
            if (points.ndim() != 2 || points.shape(1) != 3) {
              throw std::invalid_argument("vertices have shape " + shape_of(points) + "; give (n, 3)");
            }
            std::vector<cchip::Vec3d> moved(points.shape(0));
            for (std::size_t i = 0; i < moved.size(); ++i)
              moved[i] = Eigen::Map<const cchip::Vec3d>(points.data() + 3 * i);
            const nb::gil_scoped_release release;
            return x.moved(std::move(moved));
          },
          "vertices"_a, nb::sig("def moved(self, vertices: numpy.typing.ArrayLike) -> Object"),
          R"(The object with the same faces and other vertices, in a third of the time of a new one; this one stays as it is.

vertices: (vertex_count, 3) float64, in the order of this object's.

Raises ValueError: another shape, a vertex that is not finite or beyond 2^1000.)")
      .def(
          "self_contacts",
          [](const Object& x, std::optional<std::size_t> max_contacts) {
            std::vector<std::uint32_t> faces;
            {
              const nb::gil_scoped_release release;
              const std::size_t most = max_contacts.value_or(std::numeric_limits<std::size_t>::max());
              for (const auto& contact : cchip::self_contacts(x, most)) {
                faces.insert(faces.end(), {contact.face_a, contact.face_b});
              }
            }
            const std::size_t count = faces.size() / 2;
            return owned<std::uint32_t>(std::move(faces), {count, 2});
          },
          nb::kw_only(), "max_contacts"_a = nb::none(),
          nb::sig("def self_contacts(self, *, max_contacts: int | None = None) -> numpy.typing.NDArray[numpy.uint32]"),
          R"((k, 2) uint32: pairs of this object's faces that share a point and no vertex, ascending, none twice.)")
      .def_prop_ro(
          "name", [](const Object& x) { return x.mesh().name; }, "Path of the file; empty for arrays.")
      .def_prop_ro(
          "vertex_count", [](const Object& x) { return x.mesh().vertices.size(); }, "Number of vertices.")
      .def_prop_ro(
          "face_count", [](const Object& x) { return x.mesh().faces.size(); },
          "Number of faces, after polygons were cut.")
      .def("__repr__", [](const Object& x) {
        const std::string& name = x.mesh().name;
        return "<collisionchip.Object" + (name.empty() ? name : " " + name) + ": " +
               std::to_string(x.mesh().vertices.size()) + " vertices, " + std::to_string(x.mesh().faces.size()) +
               " faces>";
      });

  nb::class_<Result>(m, "Result", "The answer to a query. True in a condition if there is a contact.")
      .def_ro("hit", &Result::hit, "bool: there is a contact that counts.")
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
          "counts",
          [](const Result& x) {
            nb::dict d;
            d["steps"] = x.counts.steps;
            d["box_tests"] = x.counts.box_tests;
            d["pairs"] = x.counts.pairs;
            d["open"] = x.counts.open;
            d["clocks"] = x.counts.clocks;
            d["fallbacks"] = x.counts.fallbacks;
            return d;
          },
          nb::sig("def counts(self) -> dict[str, int]"), "What the query cost (docs/cpp/collide.md).")
      .def("__bool__", [](const Result& x) { return x.hit; })
      .def("__repr__", [](const Result& x) {
        return "<collisionchip.Result: " + std::string(x.hit ? "hit" : "no hit") +
               (x.relation ? ", " + *x.relation : std::string()) + ", " + std::to_string(x.faces.size() / 2) +
               " contacts>";
      });

  nb::class_<Device>(m, "Device", R"(Answers queries; open_device() makes one.

It takes one call at a time, from any thread: a device in use raises RuntimeError. Open one for each thread.)")
      .def_prop_ro("name", &Device::name, "Its name, such as 'cpu'.");
  m.def(
      "open_device",
      [](const std::string& name, unsigned threads, const std::string& target) {
        if (name == "cpu") return cchip::open_cpu_device({threads, target});
        if (threads != 0 || !target.empty())
          throw std::invalid_argument("only the device 'cpu' has threads and target");
        return cchip::open_device(name);
      },
      "name"_a = "cpu", nb::kw_only(), "threads"_a = 0, "target"_a = "",
      nb::sig("def open_device(name: str = 'cpu', *, threads: int = 0, target: str = '') -> Device"),
      R"(Opens a device, one of device_names().

threads: of a batch on the CPU; 0 means as many as there are cores.
target: one of cpu_targets(), instruction sets of the CPU; by default the best. Answers are the same on all of them.

Raises ValueError: no device or target of this name.)");
  m.def("device_names", &cchip::device_names, "Names that open_device() takes, 'cpu' first.");
  m.def("cpu_targets", &cchip::cpu_targets, "Instruction sets that open_device('cpu', target=...) takes, best first.");

  m.def("collide", &collide, "a"_a, "pose_a"_a.none(), "b"_a, "pose_b"_a.none(), "contacts"_a = "first",
        "relation"_a = false, "counts"_a = "touching", "max_contacts"_a = nb::none(), "device"_a = nb::none(),
        nb::sig("def collide(a: Object, pose_a: numpy.typing.ArrayLike | None, b: Object, pose_b: "
                "numpy.typing.ArrayLike | None, contacts: str = 'first', relation: bool = False, counts: str = "
                "'touching', max_contacts: int | None = None, device: Device | None = None) -> Result"),
        R"(Do two placed objects touch, and where? Exact for the float64 numbers of meshes and poses.

pose_a, pose_b: (4, 4) or (3, 4), converted to float64; None is the identity. Any affine map is allowed: a vertex v lies
at pose[:3, :3] @ v + pose[:3, 3]. The last row of a (4, 4) pose must be 0 0 0 1.
contacts: 'first', whether there is one, any of them is returned; or 'all' of them, at most max_contacts.
relation: tell touching from crossing; fills Result.relation and Result.crossing.
counts: what counts as a contact: 'touching', faces that share a point; or 'crossing', only faces that cross.
device: by default one thread of the CPU, one for each calling thread.

Raises ValueError: a pose of another shape or with an entry that is not finite or beyond 2^500, an unknown word,
max_contacts of 0. Raises RuntimeError: the device is in use, or the thread flushes small numbers to zero.)");
  m.def("collide_many", &collide_many, "a"_a, "poses_a"_a.none(), "b"_a, "poses_b"_a.none(), "contacts"_a = false,
        "counts"_a = "touching", "max_contacts"_a = nb::none(), "device"_a = nb::none(),
        nb::sig("def collide_many(a: Object, poses_a: numpy.typing.ArrayLike | None, b: Object, poses_b: "
                "numpy.typing.ArrayLike | None, contacts: bool = False, counts: str = 'touching', max_contacts: int | "
                "None = None, device: Device | None = None) -> typing.Any"),
        R"(The same two objects in n pairs of poses, on all cores, with the GIL released.

poses_a, poses_b: (n, 4, 4) or (n, 3, 4), as collide() takes them; or one pose, (4, 4), (3, 4) or None, for all.
contacts: return all contacts as well, at most max_contacts a query.
counts: as collide().
device: by default the CPU with all cores, one for each calling thread.

Returns hits, (n,) bool; with contacts=True a tuple of hits and contacts, (k, 3) uint32, in each row the number of the
query, a face of A and a face of B, ascending.

Raises as collide(), and ValueError if there are not as many poses of A as of B. Ctrl-C takes effect after the call.)");
  m.def("_exact", &exact, "a"_a, "pose_a"_a.none(), "b"_a, "pose_b"_a.none(),
        nb::sig("def _exact(a: Object, pose_a: typing.Any, b: Object, pose_b: typing.Any) -> Result"),
        "For tests: all contacts by asking about every pair of faces in integers of any size. Slow.");

  nb::class_<PyScene> scene(m, "Scene", nb::type_slots(scene_slots), R"(Placed objects, and which of them touch.

Objects have ids: 1, 2, 3, ... in the order of add(), none given twice. Queries may run in several threads at a time,
each with its own device; a change meanwhile raises RuntimeError. Methods that take an id raise ValueError if no object
has it.)");
  scene.def(nb::init<>(), "An empty scene.")
      .def(
          "add",
          [](PyScene& self, const Object& object, nb::handle pose, std::uint64_t groups, std::uint64_t mask) {
            const Pose place = one_pose(pose, "pose");
            return self.change().add(object, place, {groups, mask});
          },
          "object"_a, "pose"_a = nb::none(), "groups"_a = 1, "mask"_a = all_groups,
          nb::sig(
              "def add(self, object: Object, pose: numpy.typing.ArrayLike | None = None, groups: int = 1, mask: int "
              "= 0xffffffffffffffff) -> int"),
          R"(Adds an object in a pose, as collide() takes it, and returns its id.

groups, mask: 64 bits each. Two objects are tested if the mask of each has a group of the other.)")
      .def(
          "set_pose",
          [](PyScene& self, Scene::Id id, nb::handle pose) {
            const Pose place = one_pose(pose, "pose");
            self.change().set_pose(id, place);
          },
          "id"_a, "pose"_a.none(), nb::sig("def set_pose(self, id: int, pose: numpy.typing.ArrayLike | None) -> None"),
          "Moves an object to a pose, as collide() takes it.")
      .def(
          "remove", [](PyScene& self, Scene::Id id) { self.change().remove(id); }, "id"_a, "Takes an object out.")
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
          "set_ignored",
          [](PyScene& self, Scene::Id a, Scene::Id b, bool ignored) { self.change().set_ignored(a, b, ignored); },
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
  def_queries(
      scene, "touching", [](const Scene& s, auto&... what) { return s.touching(what...); }, "list[@]",
      R"(All pairs in contact, tuples (id of A, id of B, result), ascending.

The other parameters are those of collide(); the device is by default the CPU with all cores. Raises as collide() and as
the filter.)");
  def_queries(
      scene, "find_touching", [](const Scene& s, auto&... what) { return s.find_touching(what...); }, "@ | None",
      "One of the tuples that touching() would return, any of them, or None if nothing touches.");
}
