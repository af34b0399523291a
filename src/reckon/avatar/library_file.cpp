// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/library_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "reckon/avatar/legacy_morphology.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/exact_sum.hpp"
#include "reckon/core/hdf5_file.hpp"

namespace reckon {
namespace {

const Hdf5Kind library_kind{"shape library", 2};  // 2 added sphere_radius

/// The scalar fields of a shape, each a dataset of one row per shape.
struct ScalarField {
  const char* name;
  const char* unit;
  double& (*of)(Shape&);
};
constexpr std::array scalar_fields{
    ScalarField{"/shape/spacing", "m", [](Shape& s) -> double& { return s.level_set.spacing; }},
    ScalarField{"/shape/volume", "m^3", [](Shape& s) -> double& { return s.mass.volume; }},
    ScalarField{"/shape/bounding_radius", "m",
                [](Shape& s) -> double& { return s.bounding_radius; }},
    ScalarField{"/shape/lipschitz", "1", [](Shape& s) -> double& { return s.lipschitz; }},
    ScalarField{"/descriptor/length", "m",
                [](Shape& s) -> double& { return s.descriptors.length; }},
    ScalarField{"/descriptor/width", "m", [](Shape& s) -> double& { return s.descriptors.width; }},
    ScalarField{"/descriptor/thickness", "m",
                [](Shape& s) -> double& { return s.descriptors.thickness; }},
    ScalarField{"/descriptor/surface_area", "m^2",
                [](Shape& s) -> double& { return s.descriptors.surface_area; }},
    ScalarField{"/descriptor/equivalent_diameter", "m",
                [](Shape& s) -> double& { return s.descriptors.equivalent_diameter; }},
    ScalarField{"/descriptor/elongation", "1",
                [](Shape& s) -> double& { return s.descriptors.elongation; }},
    ScalarField{"/descriptor/flatness", "1",
                [](Shape& s) -> double& { return s.descriptors.flatness; }},
    ScalarField{"/descriptor/sphericity", "1",
                [](Shape& s) -> double& { return s.descriptors.sphericity; }},
    ScalarField{"/descriptor/convexity", "1",
                [](Shape& s) -> double& { return s.descriptors.convexity; }},
    ScalarField{"/descriptor/roundness", "1",
                [](Shape& s) -> double& { return s.descriptors.roundness; }},
};

constexpr const char* sphere_radius_field = "/shape/sphere_radius";

struct VectorField {
  const char* name;
  const char* unit;
  Vec3& (*of)(Shape&);
};
constexpr std::array vector_fields{
    VectorField{"/shape/origin", "m", [](Shape& s) -> Vec3& { return s.level_set.origin_body; }},
    VectorField{"/shape/inertia", "m^5", [](Shape& s) -> Vec3& { return s.mass.inertia; }},
};

struct NodeField {
  const char* name;
  const char* unit;
  std::vector<double> SurfaceNodes::*values;
};
constexpr std::array node_fields{NodeField{"/node/x", "m", &SurfaceNodes::x},
                                 NodeField{"/node/y", "m", &SurfaceNodes::y},
                                 NodeField{"/node/z", "m", &SurfaceNodes::z},
                                 NodeField{"/node/area", "m^2", &SurfaceNodes::area}};

[[noreturn]] void damaged(const std::filesystem::path& path, std::string reason) {
  throw Error{{.place = path.string(),
               .problem = "the shape library is damaged",
               .reason = std::move(reason),
               .fix = "Make it anew with reckon grains."}};
}

/// A shape's name and numbers without its arrays.
Shape table_row(const Shape& shape) {
  Shape row;
  row.name = shape.name;
  row.level_set.dims = shape.level_set.dims;
  row.level_set.spacing = shape.level_set.spacing;
  row.level_set.origin_body = shape.level_set.origin_body;
  row.mass = shape.mass;
  row.descriptors = shape.descriptors;
  row.bounding_radius = shape.bounding_radius;
  row.lipschitz = shape.lipschitz;
  row.sphere_radius = shape.sphere_radius;
  return row;
}

/// Where each shape's rows begin, and after the last one the total.
template <class Count>
std::vector<std::uint64_t> first_rows(const ShapeLibrary& library, Count&& count) {
  std::vector<std::uint64_t> first{0};
  for (const Shape& shape : library) first.push_back(first.back() + count(shape));
  return first;
}

void check_names(const std::filesystem::path& path, const ShapeLibrary& library) {
  std::set<std::string_view> names;
  for (const Shape& shape : library) {
    if (shape.name.empty() || !names.insert(shape.name).second) {
      throw Error{{.place = path.string(),
                   .problem = shape.name.empty() ? "a shape has no name"
                                                 : "two shapes are named " + shape.name,
                   .reason = "scenes pick shapes by name",
                   .fix = "Rename the sources."}};
    }
  }
}

/// Reads a library's table at once and its shapes one by one.
class LibraryReader {
 public:
  explicit LibraryReader(const std::filesystem::path& path) : file_{path, library_kind} {
    const Hdf5Extents extents = file_.extents("/shape/spacing");
    if (extents.size() != 1 || extents[0] == 0) damaged(path, "it holds no shapes");
    const std::uint64_t count = extents[0];
    table_.resize(count);
    const auto names = file_.read_texts("/shape/name", count);
    const auto dims = file_.read<std::int32_t>("/shape/dims", {count, 3});
    digest_ = file_.read<std::uint64_t>("/shape/digest", {count});
    for (std::size_t s = 0; s < count; ++s) {
      table_[s].name = names[s];
      table_[s].level_set.dims = {dims[3 * s], dims[3 * s + 1], dims[3 * s + 2]};
    }
    for (const ScalarField& field : scalar_fields) {
      const auto values = file_.read<double>(field.name, {count});
      for (std::size_t s = 0; s < count; ++s) field.of(table_[s]) = values[s];
    }
    if (file_.version() >= 2) {
      const auto radii = file_.read<double>(sphere_radius_field, {count});
      for (std::size_t s = 0; s < count; ++s) table_[s].sphere_radius = radii[s];
    }
    for (const VectorField& field : vector_fields) {
      const auto values = file_.read<double>(field.name, {count, 3});
      for (std::size_t s = 0; s < count; ++s) {
        field.of(table_[s]) = {values[3 * s], values[3 * s + 1], values[3 * s + 2]};
      }
    }
    first_value_ = read_first_rows("/shape/first_value", "/grid/values");
    first_node_ = read_first_rows("/shape/first_node", "/node/x");
    for (const NodeField& field : node_fields) {
      if (file_.extents(field.name) != Hdf5Extents{first_node_.back()}) {
        damaged(path, fmt::format("{} does not have a row per node", field.name));
      }
    }
  }

  [[nodiscard]] std::size_t size() const { return table_.size(); }
  /// All shapes without their arrays.
  [[nodiscard]] const ShapeLibrary& table() const { return table_; }

  [[nodiscard]] ShapeSummary summary(std::size_t s) const {
    ShapeSummary summary{table_[s].name, outline_of(table_[s]), 0, digest_[s]};
    const std::string place = file_.path().string() + ", shape " + table_[s].name;
    check_outline(summary.outline, first_value_[s + 1] - first_value_[s], place);
    std::vector<double> areas(first_node_[s + 1] - first_node_[s]);
    file_.read_rows<double>("/node/area", first_node_[s], areas);
    summary.outline.nodes = areas.size();
    summary.node_area = exact_sum(areas);
    return summary;
  }

  [[nodiscard]] Shape shape(std::size_t s) const {
    Shape shape = table_[s];
    shape.level_set.values.resize(first_value_[s + 1] - first_value_[s]);
    file_.read_rows<float>("/grid/values", first_value_[s], shape.level_set.values);
    for (const NodeField& field : node_fields) {
      auto& values = shape.nodes.*field.values;
      values.resize(first_node_[s + 1] - first_node_[s]);
      file_.read_rows<double>(field.name, first_node_[s], values);
    }
    const std::string place = file_.path().string() + ", shape " + shape.name;
    check_shape(shape, place);
    if (shape_digest(shape) != digest_[s]) damaged(place, "its digest is not the stored one");
    shape.clusters = make_clusters(shape.nodes);
    return shape;
  }

 private:
  /// A table of first rows that rises from 0 to the length of `data`.
  [[nodiscard]] std::vector<std::uint64_t> read_first_rows(const std::string& name,
                                                           const std::string& data) const {
    auto first = file_.read<std::uint64_t>(name, {table_.size() + 1});
    const bool rising = std::is_sorted(first.begin(), first.end());
    if (!rising || first.front() != 0 || file_.extents(data) != Hdf5Extents{first.back()}) {
      damaged(file_.path(), fmt::format("{} does not fit {}", name, data));
    }
    return first;
  }

  Hdf5Reader file_;
  ShapeLibrary table_;  // all but grids and nodes
  std::vector<std::uint64_t> digest_;
  std::vector<std::uint64_t> first_value_;
  std::vector<std::uint64_t> first_node_;
};

}  // namespace

void save_library(const std::filesystem::path& path, const ShapeLibrary& library) {
  if (library.empty()) {
    throw Error{{.place = path.string(),
                 .problem = "a shape library needs at least one shape",
                 .reason = {},
                 .fix = "Give at least one source."}};
  }
  check_names(path, library);
  for (const Shape& shape : library) check_shape(shape, "shape " + shape.name);

  const std::uint64_t count = library.size();
  Hdf5Writer file{path, library_kind};
  file.write_note("title",
                  "Grain shapes: signed-distance grids (negative inside, x fastest) and "
                  "surface nodes in principal body frames");
  ShapeLibrary table;
  std::vector<std::string> names;
  std::vector<std::int32_t> dims;
  std::vector<std::uint64_t> digests;
  for (const Shape& shape : library) {
    table.push_back(table_row(shape));
    names.push_back(shape.name);
    dims.insert(dims.end(), shape.level_set.dims.begin(), shape.level_set.dims.end());
    digests.push_back(shape_digest(shape));
  }
  file.write_texts("/shape/name", names);
  file.write("/shape/dims", dims, {count, 3}, "1");
  file.write("/shape/digest", digests, {count}, "1");
  for (const ScalarField& field : scalar_fields) {
    std::vector<double> values;
    for (Shape& shape : table) values.push_back(field.of(shape));
    file.write(field.name, values, {count}, field.unit);
  }
  std::vector<double> radii;
  for (const Shape& shape : library) radii.push_back(shape.sphere_radius);
  file.write(sphere_radius_field, radii, {count}, "m");
  for (const VectorField& field : vector_fields) {
    std::vector<double> values;
    for (Shape& shape : table) {
      const Vec3& v = field.of(shape);
      values.insert(values.end(), {v.x, v.y, v.z});
    }
    file.write(field.name, values, {count, 3}, field.unit);
  }
  const auto first_value =
      first_rows(library, [](const Shape& shape) { return shape.level_set.values.size(); });
  const auto first_node =
      first_rows(library, [](const Shape& shape) { return shape.nodes.size(); });
  file.write("/shape/first_value", first_value, {count + 1}, "1");
  file.write("/shape/first_node", first_node, {count + 1}, "1");

  file.create("/grid/values", Hdf5Number::float32, {first_value.back()}, "m");
  for (std::size_t s = 0; s < count; ++s) {
    file.write_rows<float>("/grid/values", first_value[s], library[s].level_set.values);
  }
  for (const NodeField& field : node_fields) {
    file.create(field.name, Hdf5Number::float64, {first_node.back()}, field.unit);
    for (std::size_t s = 0; s < count; ++s) {
      file.write_rows<double>(field.name, first_node[s], library[s].nodes.*field.values);
    }
  }
  file.finish();
}

ShapeLibrary load_library(const std::filesystem::path& path, double legacy_voxel) {
  if (std::filesystem::is_directory(path)) return load_legacy_folder(path, legacy_voxel);
  const LibraryReader reader{path};
  ShapeLibrary library;
  for (std::size_t s = 0; s < reader.size(); ++s) library.push_back(reader.shape(s));
  check_names(path, library);
  return library;
}

ShapeSummary summary_of(const Shape& shape) {
  return {shape.name, outline_of(shape), exact_sum(shape.nodes.area), shape_digest(shape)};
}

struct LibrarySource::Impl {
  std::optional<LibraryReader> file;
  ShapeLibrary folder;  // where there is no file
};

LibrarySource::LibrarySource(const std::filesystem::path& path, double legacy_voxel)
    : impl_{std::make_unique<Impl>()} {
  if (std::filesystem::is_directory(path)) {
    impl_->folder = load_legacy_folder(path, legacy_voxel);
  } else {
    impl_->file.emplace(path);
    check_names(path, impl_->file->table());
  }
}
LibrarySource::~LibrarySource() = default;
LibrarySource::LibrarySource(LibrarySource&&) noexcept = default;
LibrarySource& LibrarySource::operator=(LibrarySource&&) noexcept = default;

std::size_t LibrarySource::size() const {
  return impl_->file ? impl_->file->size() : impl_->folder.size();
}

ShapeSummary LibrarySource::summary(std::size_t shape) const {
  return impl_->file ? impl_->file->summary(shape) : summary_of(impl_->folder[shape]);
}

Shape LibrarySource::read(std::size_t shape) const {
  return impl_->file ? impl_->file->shape(shape) : impl_->folder[shape];
}

ShapeLibrary load_shapes(const std::filesystem::path& path, std::span<const ShapeId> wanted) {
  const LibraryReader reader{path};
  ShapeLibrary library;
  for (const ShapeId id : wanted) {
    if (id.get() >= reader.size()) {
      throw Error{{.place = path.string(),
                   .problem = fmt::format("has no shape {}", id.get()),
                   .reason = fmt::format("it has {} shapes, counted from 0", reader.size()),
                   .fix = "reckon grains info lists what it holds."}};
    }
    library.push_back(reader.shape(id.get()));
  }
  return library;
}

}  // namespace reckon
