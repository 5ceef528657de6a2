// Points and triangles as arrays and files.
#include "python/point_clouds.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/reprojection/ply_file.h"
#include "python/arrays.h"
#include "python/calls.h"

namespace vantage::python {
namespace py = pybind11;

FramedCloud make_cloud(const CloudSource& source, const CloudOptions& options, Execution& execution,
                       const std::string& frame) {
  return {point_cloud(source, options, execution), frame};
}

FramedMesh make_mesh(const CloudSource& source, const CloudOptions& options, Execution& execution,
                     const std::string& frame) {
  return {triangle_mesh(source, options, execution), frame};
}

namespace {

/// Rows of `columns` values, which `owner` keeps alive.
template <typename T>
py::array_t<T> rows_over(const std::vector<T>& values, py::ssize_t columns,
                         const py::object& owner) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return py::array_t<T>({count / columns, columns}, values.data(), owner);
}

py::object confidence_over(const PointCloud& cloud, const py::object& owner) {
  if (cloud.confidence.empty()) {
    return py::none();
  }
  return py::array_t<float>(static_cast<py::ssize_t>(cloud.confidence.size()),
                            cloud.confidence.data(), owner);
}

/// The values of an N×`columns` array, or of one of N values if `columns` is 0.
template <typename T>
std::vector<T> values_of(const py::object& object, const char* name, py::ssize_t columns,
                         const char* type) {
  const py::array array = to_array(object, name);
  if (array.ndim() != (columns > 0 ? 2 : 1) || (columns > 0 && array.shape(1) != columns)) {
    throw UsageError(fmt::format("{}: the array has the shape {}, expected N{}", name,
                                 shape_text(array), columns > 0 ? "x3" : ""));
  }
  const bool is_double = std::is_same_v<T, float> && py::isinstance<py::array_t<double>>(array);
  if (!py::isinstance<py::array_t<T>>(array) && !is_double) {
    throw UsageError(fmt::format("{}: the array is of {}, expected {}", name,
                                 std::string(py::str(array.dtype())), type));
  }
  const py::array_t<T, py::array::c_style | py::array::forcecast> packed(array);
  return {packed.data(), packed.data() + packed.size()};
}

PointCloud cloud_of(const py::object& points, const py::object& colours,
                    const py::object& confidence) {
  PointCloud cloud;
  cloud.positions = values_of<float>(points, "points", 3, "float32");
  cloud.colours = values_of<std::uint8_t>(colours, "colours", 3, "uint8");
  if (!confidence.is_none()) {
    cloud.confidence = values_of<float>(confidence, "confidence", 0, "float32");
  }
  const std::size_t count = cloud.size();
  if (count == 0) {
    throw UsageError("points: the array is empty, expected at least one point");
  }
  if (cloud.colours.size() != cloud.positions.size() ||
      (!confidence.is_none() && cloud.confidence.size() != count)) {
    throw UsageError(
        fmt::format("{}: the array has {} rows, expected {}, one for each point",
                    cloud.colours.size() != cloud.positions.size() ? "colours" : "confidence",
                    cloud.colours.size() != cloud.positions.size() ? cloud.colours.size() / 3
                                                                   : cloud.confidence.size(),
                    count));
  }
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    if (!std::isfinite(cloud.positions[i])) {
      throw UsageError(fmt::format("points: row {} is not finite, expected numbers", i / 3));
    }
  }
  return cloud;
}

FramedCloud cloud_from(const py::object& points, const py::object& colours,
                       const py::object& confidence) {
  return {cloud_of(points, colours, confidence), std::string(kCameraFrame)};
}

FramedMesh mesh_from(const py::object& points, const py::object& colours,
                     const py::object& triangles, const py::object& confidence) {
  FramedMesh mesh{{cloud_of(points, colours, confidence),
                   values_of<std::int32_t>(triangles, "triangles", 3, "int32")},
                  std::string(kCameraFrame)};
  const auto count = static_cast<std::int32_t>(mesh.mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
    const std::int32_t vertex = mesh.mesh.triangles[i];
    if (vertex < 0 || vertex >= count) {
      throw UsageError(fmt::format("triangles: row {} has the point {}, expected 0 to {}", i / 3,
                                   vertex, count - 1));
    }
  }
  return mesh;
}

template <typename T>
py::array_t<T> copied(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

template <typename T>
std::vector<T> restored(const py::handle& object) {
  const auto array = object.cast<py::array_t<T>>();
  return {array.data(), array.data() + array.size()};
}

/// All of a cloud, for pickle.
py::tuple state_of(const PointCloud& cloud, const std::string& frame) {
  return py::make_tuple(copied(cloud.positions), copied(cloud.normals), copied(cloud.colours),
                        copied(cloud.confidence), frame);
}

FramedCloud cloud_of_state(const py::tuple& state) {
  return {{restored<float>(state[0]), restored<float>(state[1]), restored<std::uint8_t>(state[2]),
           restored<float>(state[3])},
          state[4].cast<std::string>()};
}

template <typename Shape>
void write_ply(const py::object& path, const Shape& shape, const std::string& frame) {
  const std::string file = path_of(path);
  if (!file.ends_with(".ply")) {
    throw UsageError(fmt::format("cannot write {}, expected a name that ends in .ply", file));
  }
  without_gil([&] { write_binary_file(file, encode_ply(shape, frame)); });
}

}  // namespace

void bind_point_clouds(py::module_& module) {
  py::class_<FramedCloud>(module, "PointCloud",
                          "Points of a disparity map. len() is their number.\n\n"
                          "PointCloud(points, colours, confidence=None) makes one of arrays, to be "
                          "written. X is to the\nright, Y down and Z ahead of the rectified left "
                          "camera; a Sequence with poses has points in\ntheir world.")
      .def(py::init(&cloud_from), py::arg("points"), py::arg("colours"),
           py::arg("confidence") = py::none())
      .def(py::pickle([](const FramedCloud& self) { return state_of(self.cloud, self.frame); },
                      [](const py::tuple& state) { return cloud_of_state(state); }))
      .def("__len__", [](const FramedCloud& self) { return self.cloud.size(); })
      .def("__repr__",
           [](const FramedCloud& self) {
             return fmt::format("<vantage.PointCloud: {} points>", self.cloud.size());
           })
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return rows_over(self.cast<const FramedCloud&>().cloud.positions, 3, self);
          },
          "float32, Nx3: X, Y, Z in metres.")
      .def_property_readonly(
          "colours",
          [](const py::object& self) {
            return rows_over(self.cast<const FramedCloud&>().cloud.colours, 3, self);
          },
          "uint8, Nx3: red, green, blue.")
      .def_property_readonly(
          "confidence",
          [](const py::object& self) {
            return confidence_over(self.cast<const FramedCloud&>().cloud, self);
          },
          "float32, N, with cloud_confidence=True; else None.");
  py::class_<FramedMesh>(
      module, "Mesh",
      "A surface of triangles between the points of a disparity map.\n\n"
      "Mesh(points, colours, triangles, confidence=None) makes one of arrays, to "
      "be written.")
      .def(py::init(&mesh_from), py::arg("points"), py::arg("colours"), py::arg("triangles"),
           py::arg("confidence") = py::none())
      .def(py::pickle(
          [](const FramedMesh& self) {
            return py::make_tuple(state_of(self.mesh.vertices, self.frame),
                                  copied(self.mesh.triangles));
          },
          [](const py::tuple& state) {
            FramedCloud vertices = cloud_of_state(state[0].cast<py::tuple>());
            return FramedMesh{{std::move(vertices.cloud), restored<std::int32_t>(state[1])},
                              std::move(vertices.frame)};
          }))
      .def("__repr__",
           [](const FramedMesh& self) {
             return fmt::format("<vantage.Mesh: {} points, {} triangles>",
                                self.mesh.vertices.size(), self.mesh.triangles.size() / 3);
           })
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return rows_over(self.cast<const FramedMesh&>().mesh.vertices.positions, 3, self);
          },
          "float32, Nx3: X, Y, Z in metres.")
      .def_property_readonly(
          "colours",
          [](const py::object& self) {
            return rows_over(self.cast<const FramedMesh&>().mesh.vertices.colours, 3, self);
          },
          "uint8, Nx3: red, green, blue.")
      .def_property_readonly(
          "confidence",
          [](const py::object& self) {
            return confidence_over(self.cast<const FramedMesh&>().mesh.vertices, self);
          },
          "float32, N, with cloud_confidence=True; else None.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            return rows_over(self.cast<const FramedMesh&>().mesh.triangles, 3, self);
          },
          "int32, Mx3: numbers of points, counter-clockwise as the camera sees them.");
  module.def("write_cloud", [](const py::object& path, const FramedCloud& cloud) {
    write_ply(path, cloud.cloud, cloud.frame);
  });
  module.def("write_mesh", [](const py::object& path, const FramedMesh& mesh) {
    write_ply(path, mesh.mesh, mesh.frame);
  });
}

}  // namespace vantage::python
