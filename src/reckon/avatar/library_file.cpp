// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/library_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "reckon/avatar/legacy_morphology.hpp"
#include "reckon/core/build_info.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/exact_sum.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/write_failure.hpp"

namespace reckon {
namespace {

// 2 added sphere_radius, 3 bands, 4 provenance and sieve_size
const Hdf5Kind library_kind{"shape library", 4};

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
constexpr const char* sieve_size_field = "/descriptor/sieve_size";
constexpr const char* values_field = "/grid/values";
constexpr const char* band_field = "/grid/band";
constexpr const char* program_field = "/provenance/program";
constexpr const char* command_field = "/provenance/command";
constexpr const char* source_field = "/provenance/source";
constexpr const char* source_bytes_field = "/provenance/source_bytes";
constexpr const char* source_hash_field = "/provenance/source_xxh64";

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

/// Vertices of a grid that is read from a band.
constexpr std::uint64_t largest_band = 1'000'000'000;

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
  row.storage = shape.storage;
  return row;
}

/// Takes a name into those that a library has so far.
void add_name(const std::filesystem::path& path, const std::string& name,
              std::set<std::string>& names) {
  if (!name.empty() && names.insert(name).second) return;
  throw Error{{.place = path.string(),
               .problem = name.empty() ? "a shape has no name" : "two shapes are named " + name,
               .reason = "scenes pick shapes by name",
               .fix = "Rename the sources."}};
}

void check_names(const std::filesystem::path& path, const ShapeLibrary& library) {
  std::set<std::string> names;
  for (const Shape& shape : library) add_name(path, shape.name, names);
}

std::string this_program() {
  const BuildInfo build = build_info();
  return fmt::format("reckon {} ({})", build.version, build.revision);
}

void write_provenance(Hdf5Writer& file, const Provenance& made) {
  file.write_texts(program_field, {this_program()});
  file.write_texts(command_field, made.command);
  std::vector<std::string> paths;
  std::vector<std::uint64_t> bytes;
  std::vector<std::uint64_t> hashes;
  for (const SourceFile& source : made.sources) {
    paths.push_back(source.path);
    bytes.push_back(source.bytes);
    hashes.push_back(source.xxh64);
  }
  file.write_texts(source_field, paths);
  file.write(source_bytes_field, bytes, {bytes.size()}, "byte");
  file.write(source_hash_field, hashes, {hashes.size()}, "1");
}

Provenance read_provenance(const Hdf5Reader& file) {
  const auto rows = [&](const char* name) {
    const Hdf5Extents extents = file.extents(name);
    if (extents.size() != 1) damaged(file.path(), fmt::format("{} is not a list", name));
    return extents[0];
  };
  Provenance made;
  made.program = file.read_texts(program_field, 1).front();
  made.command = file.read_texts(command_field, rows(command_field));
  const std::uint64_t count = rows(source_field);
  const auto paths = file.read_texts(source_field, count);
  const auto bytes = file.read<std::uint64_t>(source_bytes_field, {count});
  const auto hashes = file.read<std::uint64_t>(source_hash_field, {count});
  for (std::size_t s = 0; s < count; ++s) made.sources.push_back({paths[s], bytes[s], hashes[s]});
  return made;
}

/// Reads a library's table at once and its shapes one by one.
class LibraryReader {
 public:
  explicit LibraryReader(const std::filesystem::path& path) : file_{path, library_kind} {
    const Hdf5Extents extents = file_.extents("/shape/spacing");
    if (extents.size() != 1 || extents[0] == 0) damaged(path, "it holds no shapes");
    const std::uint64_t count = extents[0];
    const auto names = file_.read_texts("/shape/name", count);
    const auto dims = file_.read<std::int32_t>("/shape/dims", {count, 3});
    digest_ = file_.read<std::uint64_t>("/shape/digest", {count});
    table_.resize(count);  // now that the file has been seen to hold as many
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
    if (file_.version() >= 4) {
      const auto sizes = file_.read<double>(sieve_size_field, {count});
      for (std::size_t s = 0; s < count; ++s) table_[s].descriptors.sieve_size = sizes[s];
      provenance_ = read_provenance(file_);
    } else {
      // That of the ellipse of width and thickness, which passes turned by 45 degrees.
      for (Shape& row : table_) {
        const auto& [width, thickness] =
            std::pair{row.descriptors.width, row.descriptors.thickness};
        row.descriptors.sieve_size = std::sqrt(0.5 * (width * width + thickness * thickness));
      }
    }
    for (const VectorField& field : vector_fields) {
      const auto values = file_.read<double>(field.name, {count, 3});
      for (std::size_t s = 0; s < count; ++s) {
        field.of(table_[s]) = {values[3 * s], values[3 * s + 1], values[3 * s + 2]};
      }
    }
    const bool in_band = file_.version() >= 3 && file_.has(band_field);
    for (Shape& row : table_) row.storage = in_band ? ShapeStorage::band : ShapeStorage::full;
    first_value_ = read_first_rows("/shape/first_value", in_band ? band_field : values_field);
    first_node_ = read_first_rows("/shape/first_node", "/node/x");
    for (const NodeField& field : node_fields) {
      if (file_.extents(field.name) != Hdf5Extents{first_node_.back()}) {
        damaged(path, fmt::format("{} does not have a row per node", field.name));
      }
    }
  }

  [[nodiscard]] std::size_t size() const { return table_.size(); }
  [[nodiscard]] const Provenance& provenance() const { return provenance_; }
  /// All shapes without their arrays.
  [[nodiscard]] const ShapeLibrary& table() const { return table_; }

  [[nodiscard]] ShapeSummary summary(std::size_t s) const {
    ShapeSummary summary{table_[s].name, outline_of(table_[s]), 0, digest_[s]};
    check_outline(summary.outline, grid_values(s), place(s));
    if (summary.outline.storage == ShapeStorage::band) summary.outline.band_words = rows(s);
    const std::vector<double> areas = column("/node/area", s);
    summary.outline.nodes = areas.size();
    summary.node_area = exact_sum(areas);
    return summary;
  }

  [[nodiscard]] Shape shape(std::size_t s) const {
    Shape shape = table_[s];
    if (shape.storage == ShapeStorage::band) {
      check_outline(outline_of(shape), grid_values(s), place(s));
      std::vector<LevelSetBand::Word> words(rows(s));
      file_.read_rows<LevelSetBand::Word>(band_field, first_value_[s], words);
      if (!is_band(shape.level_set.dims, words)) damaged(place(s), "its grid is not a band");
      decode_band(words, shape.level_set);
    } else {
      shape.level_set.values.resize(rows(s));
      file_.read_rows<float>(values_field, first_value_[s], shape.level_set.values);
    }
    for (const NodeField& field : node_fields) {
      shape.nodes.*field.values = column(field.name, s);
    }
    check_shape(shape, place(s));
    if (shape_digest(shape) != digest_[s]) damaged(place(s), "its digest is not the stored one");
    shape.clusters = make_clusters(shape.nodes);
    return shape;
  }

 private:
  [[nodiscard]] std::string place(std::size_t s) const {
    return file_.path().string() + ", shape " + table_[s].name;
  }
  /// Of its grid: values or words.
  [[nodiscard]] std::uint64_t rows(std::size_t s) const {
    return first_value_[s + 1] - first_value_[s];
  }
  /// What dims must make. Those of a band follow from the dims alone; 0: no grid is as large.
  [[nodiscard]] std::uint64_t grid_values(std::size_t s) const {
    if (table_[s].storage == ShapeStorage::full) return rows(s);
    std::uint64_t count = 1;
    for (const std::int32_t dim : table_[s].level_set.dims) {
      if (dim < 0 || static_cast<std::uint64_t>(dim) > largest_band / count) return 0;
      count *= static_cast<std::uint64_t>(dim);
      if (count == 0) return 0;
    }
    return count;
  }
  /// A column of a shape's nodes.
  [[nodiscard]] std::vector<double> column(const char* name, std::size_t s) const {
    std::vector<double> numbers(first_node_[s + 1] - first_node_[s]);
    if (table_[s].storage == ShapeStorage::full) {
      file_.read_rows<double>(name, first_node_[s], numbers);
      return numbers;
    }
    std::vector<float> singles(numbers.size());
    file_.read_rows<float>(name, first_node_[s], singles);
    std::copy(singles.begin(), singles.end(), numbers.begin());
    return numbers;
  }
  /// A table of first rows that rises from 0 to the length of `data`.
  [[nodiscard]] std::vector<std::uint64_t> read_first_rows(const std::string& name,
                                                           const std::string& data) const {
    auto first = file_.read<std::uint64_t>(name, {table_.size() + 1});
    const bool rising = std::is_sorted(first.begin(), first.end());
    const bool held = first.back() <= std::filesystem::file_size(file_.path());
    if (!rising || !held || first.front() != 0 ||
        file_.extents(data) != Hdf5Extents{first.back()}) {
      damaged(file_.path(), fmt::format("{} does not fit {}", name, data));
    }
    return first;
  }

  Hdf5Reader file_;
  ShapeLibrary table_;  // all but grids and nodes
  Provenance provenance_;
  std::vector<std::uint64_t> digest_;
  std::vector<std::uint64_t> first_value_;
  std::vector<std::uint64_t> first_node_;
};

}  // namespace

struct LibraryWriter::Impl {
  Impl(const std::filesystem::path& path, ShapeStorage stored_as, Provenance made)
      : storage{stored_as},
        provenance{std::move(made)},
        file{path, library_kind},
        arrays{path.string() + ".arrays"},
        spool{arrays.temporary(), O_RDWR | O_CREAT | O_TRUNC, path} {}

  template <class Number, class Given>
  void append(const std::vector<Given>& numbers) {
    const std::vector<Number> kept(numbers.begin(), numbers.end());
    const std::size_t size = kept.size() * sizeof(Number);
    spool.write(spooled, {reinterpret_cast<const char*>(kept.data()), size});
    spooled += size;
  }
  template <class Number>
  void take_back(std::uint64_t from, std::vector<Number>& numbers) const {
    const std::span<char> bytes{reinterpret_cast<char*>(numbers.data()),
                                numbers.size() * sizeof(Number)};
    if (spool.read(from, bytes) != bytes.size()) throw_write_failure(file.target(), 0);
  }
  template <class Number>
  void append_nodes(const SurfaceNodes& nodes) {
    for (const NodeField& field : node_fields) append<Number>(nodes.*field.values);
  }
  template <class Number>
  void write_grids(const char* name, std::string_view unit);
  template <class Number>
  void write_nodes();

  ShapeStorage storage;
  Provenance provenance;
  Hdf5Writer file;
  PendingFile arrays;  // all shapes' grids and nodes, one after the other; never committed
  OpenFile spool;
  std::uint64_t spooled{0};                  // [bytes]
  std::vector<std::uint64_t> first_byte{0};  // in the spool, by shape
  ShapeLibrary table;
  std::set<std::string> names;
  std::vector<std::uint64_t> digests;
  std::vector<std::uint64_t> first_value{0};
  std::vector<std::uint64_t> first_node{0};
};

template <class Number>
void LibraryWriter::Impl::write_grids(const char* name, std::string_view unit) {
  file.create(name, hdf5_number<Number>(), {first_value.back()}, unit);
  std::vector<Number> values;
  for (std::size_t s = 0; s < table.size(); ++s) {
    values.resize(first_value[s + 1] - first_value[s]);
    take_back(first_byte[s], values);
    file.write_rows<Number>(name, first_value[s], values);
  }
}

template <class Number>
void LibraryWriter::Impl::write_nodes() {
  std::vector<Number> values;
  for (std::size_t field = 0; field < node_fields.size(); ++field) {
    file.create(node_fields[field].name, hdf5_number<Number>(), {first_node.back()},
                node_fields[field].unit);
    for (std::size_t s = 0; s < table.size(); ++s) {
      values.resize(first_node[s + 1] - first_node[s]);
      const std::uint64_t column = values.size() * sizeof(Number);
      take_back(first_byte[s + 1] - (node_fields.size() - field) * column, values);
      file.write_rows<Number>(node_fields[field].name, first_node[s], values);
    }
  }
}

LibraryWriter::LibraryWriter(const std::filesystem::path& path, ShapeStorage storage,
                             Provenance provenance)
    : impl_{std::make_unique<Impl>(path, storage, std::move(provenance))} {}
LibraryWriter::~LibraryWriter() = default;

void LibraryWriter::add(const Shape& shape) {
  Impl& own = *impl_;
  const std::string place = "shape " + shape.name;
  check_shape(shape, place);
  add_name(own.file.target(), shape.name, own.names);
  if (shape.storage != own.storage) {
    throw Error{{.place = own.file.target().string(),
                 .problem = place + " is stored in another way than those before it",
                 .reason = "a library holds whole grids or bands",
                 .fix = "Make all shapes with the same storage."}};
  }
  if (own.storage == ShapeStorage::band) {
    const auto words = encode_band(shape.level_set);
    own.append<LevelSetBand::Word>(words);
    own.append_nodes<float>(shape.nodes);
    own.first_value.push_back(own.first_value.back() + words.size());
  } else {
    own.append<float>(shape.level_set.values);
    own.append_nodes<double>(shape.nodes);
    own.first_value.push_back(own.first_value.back() + shape.level_set.values.size());
  }
  own.first_byte.push_back(own.spooled);
  own.first_node.push_back(own.first_node.back() + shape.nodes.size());
  own.table.push_back(table_row(shape));
  own.digests.push_back(shape_digest(shape));
}

void LibraryWriter::finish() {
  Impl& own = *impl_;
  Hdf5Writer& file = own.file;
  if (own.table.empty()) {
    throw Error{{.place = file.target().string(),
                 .problem = "a shape library needs at least one shape",
                 .reason = {},
                 .fix = "Give at least one source."}};
  }
  const std::uint64_t count = own.table.size();
  file.write_note("title",
                  "Grain shapes: signed-distance grids (negative inside, x fastest) and "
                  "surface nodes in principal body frames");
  std::vector<std::string> names;
  std::vector<std::int32_t> dims;
  std::vector<double> radii;
  std::vector<double> sieve_sizes;
  for (const Shape& shape : own.table) {
    names.push_back(shape.name);
    dims.insert(dims.end(), shape.level_set.dims.begin(), shape.level_set.dims.end());
    radii.push_back(shape.sphere_radius);
    sieve_sizes.push_back(shape.descriptors.sieve_size);
  }
  file.write_texts("/shape/name", names);
  file.write("/shape/dims", dims, {count, 3}, "1");
  file.write("/shape/digest", own.digests, {count}, "1");
  for (const ScalarField& field : scalar_fields) {
    std::vector<double> values;
    for (Shape& shape : own.table) values.push_back(field.of(shape));
    file.write(field.name, values, {count}, field.unit);
  }
  file.write(sphere_radius_field, radii, {count}, "m");
  file.write(sieve_size_field, sieve_sizes, {count}, "m");
  for (const VectorField& field : vector_fields) {
    std::vector<double> values;
    for (Shape& shape : own.table) {
      const Vec3& v = field.of(shape);
      values.insert(values.end(), {v.x, v.y, v.z});
    }
    file.write(field.name, values, {count, 3}, field.unit);
  }
  file.write("/shape/first_value", own.first_value, {count + 1}, "1");
  file.write("/shape/first_node", own.first_node, {count + 1}, "1");
  if (own.storage == ShapeStorage::band) {
    own.write_grids<LevelSetBand::Word>(band_field, "1");
    own.write_nodes<float>();
  } else {
    own.write_grids<float>(values_field, "m");
    own.write_nodes<double>();
  }
  write_provenance(file, own.provenance);
  file.finish();
}

void save_library(const std::filesystem::path& path, const ShapeLibrary& library,
                  Provenance provenance) {
  LibraryWriter writer{path, library.empty() ? ShapeStorage::full : library.front().storage,
                       std::move(provenance)};
  for (const Shape& shape : library) writer.add(shape);
  writer.finish();
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

Provenance LibrarySource::provenance() const {
  return impl_->file ? impl_->file->provenance() : Provenance{};
}

const Shape& LibrarySource::entry(std::size_t shape) const {
  return impl_->file ? impl_->file->table()[shape] : impl_->folder[shape];
}

ShapeSummary LibrarySource::summary(std::size_t shape) const {
  return impl_->file ? impl_->file->summary(shape) : summary_of(impl_->folder[shape]);
}

Shape LibrarySource::read(std::size_t shape) const {
  return impl_->file ? impl_->file->shape(shape) : impl_->folder[shape];
}

ShapeLibrary entries_of(const LibrarySource& source) {
  ShapeLibrary entries;
  for (std::size_t s = 0; s < source.size(); ++s) entries.push_back(table_row(source.entry(s)));
  return entries;
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
