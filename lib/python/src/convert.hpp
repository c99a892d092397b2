// SPDX-License-Identifier: Apache-2.0
/// \file
/// Arrays, poses, meshes and paths between Python and C++, for the files of this module.
#ifndef COLLISIONCHIP_PYTHON_CONVERT_HPP
#define COLLISIONCHIP_PYTHON_CONVERT_HPP

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <Eigen/Core>
#include <cchip/cchip.hpp>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace collisionchip_python {

namespace nb = nanobind;
using namespace nb::literals;
using cchip::GradualUnderflow;
using cchip::Object;
using cchip::Pose;
using cchip::Vec3d;

// Arrays from Python.

template <class Scalar>
using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
template <class Scalar>
using Array = nb::ndarray<const Scalar, nb::c_contig, nb::device::cpu>;

inline std::string shape_of(const Array<double>& x) {
  std::string text = "(";
  for (std::size_t i = 0; i < x.ndim(); ++i) text += (i != 0 ? ", " : "") + std::to_string(x.shape(i));
  return text + (x.ndim() == 1 ? ",)" : ")");
}

/// What numpy makes of it, if nothing is lost by that.
/// \param name of the argument, for the message
inline nb::object plain_array(nb::handle x, const char* name) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  if (nb::isinstance(x, numpy.attr("ma").attr("MaskedArray"))) {
    throw std::invalid_argument(std::string(name) + " is a masked array; fill it first, as with numpy.ma.filled()");
  }
  nb::object array = numpy.attr("asarray")(x);
  if (nb::cast<std::string>(array.attr("dtype").attr("kind")) == "c") {
    throw std::invalid_argument(std::string(name) + " has complex numbers; give real ones");
  }
  return array;
}

/// As it is if it is a contiguous array of this type already, or else what numpy makes of it.
template <class Scalar>
Array<Scalar> to_array(nb::handle x, const char* type, const char* name) {
  static const nb::handle array_type = nb::object(nb::module_::import_("numpy").attr("ndarray")).release();  // for good
  Array<Scalar> array;
  if (!x.type().is(array_type) || !nb::try_cast(x, array, false)) {
    array = nb::cast<Array<Scalar>>(
        nb::module_::import_("numpy").attr("array")(plain_array(x, name), type, "order"_a = "C"));
  }
  return array;
}

inline Pose to_pose(const double* rows, std::size_t count, const std::string& name) {
  for (std::size_t i = 0; i < 4 * count; ++i) {
    if (std::isfinite(rows[i])) continue;
    throw std::invalid_argument(name + ": row " + std::to_string(i / 4) + ", column " + std::to_string(i % 4) +
                                " is not finite; give numbers");
  }
  if (count == 4 && (rows[12] != 0 || rows[13] != 0 || rows[14] != 0 || rows[15] != 1)) {
    throw std::invalid_argument("" + name + ": the last row of a 4 x 4 pose must be 0 0 0 1");
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
    const auto array = to_array<double>(x, "float64", name);
    const std::size_t n = array.ndim();
    if (many_allowed && n == 1 && array.shape(0) == 0) {  // an empty list
      many_ = true;
      return;
    }
    many_ = n == 3;
    if (!(n == 2 || (many_ && many_allowed)) || array.shape(n - 1) != 4 ||
        (array.shape(n - 2) != 3 && array.shape(n - 2) != 4)) {
      throw std::invalid_argument(std::string(name) + " has the shape " + shape_of(array) + "; give (4, 4) or (3, 4)" +
                                  (many_allowed ? ", or (n, 4, 4) or (n, 3, 4)" : ""));
    }
    const std::size_t rows = array.shape(n - 2);
    const std::size_t count = many_ ? array.shape(0) : 1;
    poses_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      poses_.push_back(to_pose(array.data() + 4 * rows * i, rows,
                               many_ ? name + ("[" + std::to_string(i) + "]") : std::string(name)));
    }
  }
  bool many() const { return many_; }
  std::size_t size() const { return poses_.size(); }
  const Pose& operator[](std::size_t i) const { return poses_[many_ ? i : 0]; }

 private:
  std::vector<Pose> poses_;
  bool many_ = false;
};

inline Object to_object(nb::handle x, const char* name);

inline Pose one_pose(nb::handle x, const char* name) { return Poses(x, name, false)[0]; }

/// A direction of three numbers.
inline Vec3d one_direction(nb::handle x) {
  const auto array = to_array<double>(x, "float64", "direction");
  if (array.ndim() != 1 || array.shape(0) != 3) {
    throw std::invalid_argument("direction has the shape " + shape_of(array) + "; give three numbers, (3,)");
  }
  return {array.data()[0], array.data()[1], array.data()[2]};
}

// Arrays to Python.

/// An array that owns a copy of the rows.
template <class Scalar>
nb::ndarray<nb::numpy, Scalar> owned(std::vector<Scalar>&& data, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<Scalar>(std::move(data));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<Scalar>*>(p); });
  return nb::ndarray<nb::numpy, Scalar>(kept->data(), shape, owner);
}

inline nb::object to_bools(std::vector<std::uint8_t>&& values) {  // std::vector<bool> has no data()
  const std::size_t n = values.size();
  return nb::cast(owned<std::uint8_t>(std::move(values), {n})).attr("view")("bool");
}

// Objects.

/// Faces as VTK and PyVista keep them, with the number of corners before those of each face, are not taken for faces.
inline void refuse_counts(const Array<std::int64_t>& faces) {
  const std::size_t width = faces.ndim() == 2 ? faces.shape(1) : 0;
  for (const std::size_t corners : {std::size_t{3}, std::size_t{4}}) {
    if (faces.ndim() == 1 ? faces.size() % (corners + 1) != 0 : width != corners + 1) continue;
    const auto count = static_cast<std::int64_t>(corners);
    bool all = true;
    for (std::size_t i = 0; i < faces.size() && all; i += corners + 1) all = faces.data()[i] == count;
    if (!all) continue;
    const std::string number = std::to_string(corners);
    if (faces.ndim() == 1) {
      throw std::invalid_argument("faces have one dimension, and a " + number +
                                  " before the corners of each face, a count as in PyVista and VTK; give "
                                  "faces.reshape(-1, " +
                                  std::to_string(corners + 1) + ")[:, 1:]");
    }
    throw std::invalid_argument(
        "faces: column 0 is " + number +
        " in all rows, a count of corners as in PyVista and VTK; give faces[:, 1:], or PyVista's regular_faces" +
        (corners == 3 ? "; if they are quads that all begin at vertex 3, numpy.roll(faces, 1, axis=1)" : ""));
  }
}

inline cchip::Mesh mesh_of(nb::handle vertices, nb::handle faces) {
  const auto points = to_array<double>(vertices, "float64", "vertices");
  const nb::object numbers = plain_array(faces, "faces");
  if (nb::cast<std::size_t>(numbers.attr("size")) == 0) {
    throw std::invalid_argument("there are no faces; give at least one, a row of three or four vertex numbers");
  }
  const std::string kind = nb::cast<std::string>(numbers.attr("dtype").attr("kind"));
  if (kind != "i" && kind != "u") {
    throw std::invalid_argument("faces are " + nb::cast<std::string>(numbers.attr("dtype").attr("name")) +
                                "; give integers, the numbers of vertices from 0");
  }
  if (kind == "u") {  // which int64 may not hold
    const auto greatest = nb::cast<std::uint64_t>(nb::int_(nb::object(numbers.attr("max")())));
    if (greatest > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
      throw std::invalid_argument("faces: vertex index " + std::to_string(greatest) + " is out of range (there are " +
                                  std::to_string(points.ndim() > 0 ? points.shape(0) : 0) + " vertices, from 0)");
    }
  }
  const auto indices = to_array<std::int64_t>(numbers, "int64", "faces");
  refuse_counts(indices);
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

inline Object object_of(nb::handle vertices, nb::handle faces) {
  cchip::Mesh mesh = mesh_of(vertices, faces);
  const nb::gil_scoped_release release;
  const GradualUnderflow mode;
  return Object(std::move(mesh));
}

/// An Object as it is, or one made of a mesh of another package.
/// \param name of the argument, for the message
inline Object to_object(nb::handle x, const char* name) {
  if (nb::isinstance<Object>(x)) return *nb::inst_ptr<Object>(x);
  const nb::object arrays = nb::module_::import_("collisionchip._meshes").attr("arrays_of")(x, name);
  return object_of(arrays[0], arrays[1]);
}

/// A path as the system has it, any bytes.
inline nb::object to_text(const std::string& bytes) {
  return nb::steal(PyUnicode_DecodeFSDefaultAndSize(bytes.data(), static_cast<Py_ssize_t>(bytes.size())));
}

[[noreturn]] inline void raise_os_error(int number, nb::handle path) {
  errno = number;
  PyErr_SetFromErrnoWithFilenameObject(PyExc_OSError, path.ptr());
  throw nb::python_error();
}

/// What `read` makes of a file, whose name it is given. The GIL is released meanwhile.
template <class Read>
auto read_file(nb::handle path, const Read& read) {
  PyObject* converted = nullptr;
  if (PyUnicode_FSConverter(path.ptr(), &converted) == 0) throw nb::python_error();
  const nb::bytes bytes = nb::steal<nb::bytes>(converted);
  const std::string name(bytes.c_str(), bytes.size());
  const nb::module_ os = nb::module_::import_("os");  // knows what the errors of each system mean
  const nb::object kind = os.attr("stat")(path).attr("st_mode");
  if (nb::cast<bool>(nb::module_::import_("stat").attr("S_ISDIR")(kind))) raise_os_error(EISDIR, path);
  if (!nb::cast<bool>(os.attr("access")(path, os.attr("R_OK")))) raise_os_error(EACCES, path);
  std::string wrong;
  {
    const nb::gil_scoped_release release;
    const GradualUnderflow mode;
    try {
      return read(name);
    } catch (const std::runtime_error& error) {
      wrong = error.what();
    } catch (const std::invalid_argument& error) {
      wrong = error.what();
    }
  }
  PyErr_SetObject(PyExc_ValueError, to_text(wrong).ptr());
  throw nb::python_error();
}

}  // namespace collisionchip_python

#endif
