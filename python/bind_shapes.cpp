// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/shape_sources.hpp"
#include "reckon/core/error.hpp"

namespace reckon::python {
namespace {

using SharedShape = std::shared_ptr<Shape>;

/// A view of the grid as [z, y, x] that keeps the shape alive and cannot be written.
py::array level_set(const SharedShape& shape) {
  const LevelSet& grid = shape->level_set;
  py::array view{py::dtype::of<float>(),
                 std::vector<py::ssize_t>{grid.dims[2], grid.dims[1], grid.dims[0]},
                 grid.values.data(), py::cast(shape)};
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

py::array_t<double> nodes(const SharedShape& shape) {
  std::vector<Vec3> all;
  for (std::size_t n = 0; n < shape->nodes.size(); ++n) all.push_back(shape->nodes.position(n));
  return rows_of(all);
}

py::dict descriptors(const SharedShape& shape) {
  const ShapeDescriptors& d = shape->descriptors;
  py::dict all;
  all["length"] = d.length;
  all["width"] = d.width;
  all["thickness"] = d.thickness;
  all["surface_area"] = d.surface_area;
  all["equivalent_diameter"] = d.equivalent_diameter;
  all["sieve_size"] = d.sieve_size;
  all["elongation"] = d.elongation;
  all["flatness"] = d.flatness;
  all["sphericity"] = d.sphericity;
  all["convexity"] = d.convexity;
  all["roundness"] = d.roundness;
  return all;
}

/// phi and its gradient at points of the body frame; not a number outside the grid.
py::tuple sample(const SharedShape& shape,
                 const py::array_t<double, py::array::c_style | py::array::forcecast>& points) {
  if (points.ndim() != 2 || points.shape(1) != 3) {
    throw Error{{.place = "Shape.sample",
                 .problem = "points are not rows of three numbers",
                 .reason = {},
                 .fix = "Pass an array of shape (n, 3)."}};
  }
  const LevelSetView grid{shape->level_set};
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> phi;
  std::vector<Vec3> gradient;
  for (py::ssize_t n = 0; n < points.shape(0); ++n) {
    const auto found = grid.sample({points.at(n, 0), points.at(n, 1), points.at(n, 2)});
    phi.push_back(found.inside_grid ? found.phi : none);
    gradient.push_back(found.inside_grid ? found.gradient_body : Vec3{none, none, none});
  }
  return py::make_tuple(array_of<double>(phi), rows_of(gradient));
}

std::vector<SharedShape> build(const std::vector<ShapeSource>& sources, double voxels_per_diameter,
                               std::optional<std::uint32_t> node_count) {
  ShapeResolution resolution;
  resolution.voxels_per_diameter = voxels_per_diameter;
  resolution.node_count = node_count;
  std::vector<SharedShape> shapes;
  for (Shape& shape : build_library(sources, resolution)) {
    shapes.push_back(std::make_shared<Shape>(std::move(shape)));
  }
  return shapes;
}

std::vector<SharedShape> generate(std::uint32_t count, std::uint64_t seed, double median_diameter,
                                  double roundness, double roughness, double voxels_per_diameter,
                                  std::optional<std::uint32_t> node_count) {
  GrainStatistics statistics;
  statistics.median_diameter = median_diameter;
  statistics.roundness.mean = roundness;
  statistics.roughness = roughness;
  statistics.validate();
  std::vector<ShapeSource> sources;
  for (std::uint32_t n = 0; n < count; ++n)
    sources.push_back(generated_source(statistics, seed, n));
  return build(sources, voxels_per_diameter, node_count);
}

std::vector<SharedShape> from_meshes(const std::vector<std::filesystem::path>& files, double unit,
                                     double voxels_per_diameter,
                                     std::optional<std::uint32_t> node_count) {
  std::vector<ShapeSource> sources;
  for (const auto& file : files) sources.push_back(mesh_file_source(file, unit));
  return build(sources, voxels_per_diameter, node_count);
}

void save(const std::vector<SharedShape>& shapes, const std::filesystem::path& path) {
  ShapeLibrary library;
  library.reserve(shapes.size());
  for (const SharedShape& shape : shapes) library.push_back(*shape);
  save_library(path, library, {{}, {"reckon.save_shapes"}, {}});
}

/// A library file whose shapes are read when they are requested.
class LibraryFile {
 public:
  explicit LibraryFile(const std::filesystem::path& path) : source_{path} {
    for (std::size_t s = 0; s < source_.size(); ++s) names_.push_back(source_.summary(s).name);
  }
  [[nodiscard]] std::size_t size() const { return names_.size(); }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] SharedShape at(py::ssize_t place) const {
    const auto count = static_cast<py::ssize_t>(size());
    const py::ssize_t from_start = place < 0 ? place + count : place;
    if (from_start < 0 || from_start >= count) {
      throw py::index_error{
          fmt::format("the library has {} shapes, not a number {}", count, place)};
    }
    return std::make_shared<Shape>(source_.read(static_cast<std::size_t>(from_start)));
  }
  [[nodiscard]] SharedShape named(const std::string& name) const {
    for (std::size_t s = 0; s < names_.size(); ++s) {
      if (names_[s] == name) return at(static_cast<py::ssize_t>(s));
    }
    throw py::key_error{fmt::format("the library has no shape \"{}\"", name)};
  }

 private:
  LibrarySource source_;
  std::vector<std::string> names_;
};

}  // namespace

void bind_shapes(py::module_& module) {
  using py::arg;
  const auto free_to_run = py::call_guard<py::gil_scoped_release>();
  py::class_<Shape, SharedShape>(module, "Shape")
      .def_readonly("name", &Shape::name)
      .def_property_readonly("level_set", &level_set)
      .def_property_readonly("spacing", [](const Shape& s) { return s.level_set.spacing; })
      .def_property_readonly("origin",
                             [](const Shape& s) { return tuple_of(s.level_set.origin_body); })
      .def_property_readonly("nodes", &nodes)
      .def_property_readonly("node_areas",
                             [](const Shape& s) { return array_of<double>(s.nodes.area); })
      .def_property_readonly("volume", [](const Shape& s) { return s.mass.volume; })
      .def_property_readonly("inertia", [](const Shape& s) { return tuple_of(s.mass.inertia); })
      .def_readonly("bounding_radius", &Shape::bounding_radius)
      .def_property_readonly("descriptors", &descriptors)
      .def("sample", &sample, arg("points"))
      .def("__repr__", [](const Shape& s) {
        return fmt::format("<reckon.Shape \"{}\": {} nodes, grid {} x {} x {}>", s.name,
                           s.nodes.size(), s.level_set.dims[0], s.level_set.dims[1],
                           s.level_set.dims[2]);
      });
  py::class_<LibraryFile>(module, "ShapeLibrary")
      .def(py::init<const std::filesystem::path&>(), arg("path"))
      .def_property_readonly("names", &LibraryFile::names)
      .def("__len__", &LibraryFile::size)
      .def("__getitem__", &LibraryFile::at, arg("place"))
      .def("__getitem__", &LibraryFile::named, arg("name"));
  const ShapeResolution usual;
  const GrainStatistics sand;
  module.def("generate_shapes", &generate, arg("count"), py::kw_only(), arg("seed") = 1,
             arg("median_diameter") = sand.median_diameter, arg("roundness") = sand.roundness.mean,
             arg("roughness") = sand.roughness,
             arg("voxels_per_diameter") = usual.voxels_per_diameter,
             arg("node_count") = usual.node_count, free_to_run);
  module.def("shapes_from_meshes", &from_meshes, arg("files"), py::kw_only(), arg("unit") = 1.0,
             arg("voxels_per_diameter") = usual.voxels_per_diameter,
             arg("node_count") = usual.node_count, free_to_run);
  module.def("save_shapes", &save, arg("shapes"), arg("path"), free_to_run);
}

}  // namespace reckon::python
