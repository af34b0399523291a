// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/library_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "reckon/avatar/legacy_morphology.hpp"
#include "reckon/avatar/library_layout.hpp"
#include "reckon/avatar/library_reader.hpp"
#include "reckon/core/build_info.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/exact_sum.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/seal.hpp"
#include "reckon/core/write_failure.hpp"

namespace reckon {

using namespace library_layout;

namespace {

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
    : impl_{std::make_unique<Impl>(path, storage, std::move(provenance))} {
  require_replaceable_library(path);
}
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

void require_replaceable_library(const std::filesystem::path& path) {
  require_replaceable(path, library_kind.name);
}

void save_library(const std::filesystem::path& path, const ShapeLibrary& library,
                  Provenance provenance) {
  LibraryWriter writer{path, library.empty() ? ShapeStorage::full : library.front().storage,
                       std::move(provenance)};
  for (const Shape& shape : library) writer.add(shape);
  writer.finish();
}

namespace {

/// A folder of `reckon grains from-scan` stands for the library in it.
std::filesystem::path file_of_library(const std::filesystem::path& path) {
  const std::filesystem::path within = path / "library.h5";
  return std::filesystem::is_directory(path) && std::filesystem::exists(within) ? within : path;
}

}  // namespace

ShapeLibrary load_library(const std::filesystem::path& file_or_folder, double legacy_voxel) {
  const std::filesystem::path path = file_of_library(file_or_folder);
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

LibrarySource::LibrarySource(const std::filesystem::path& file_or_folder, double legacy_voxel)
    : impl_{std::make_unique<Impl>()} {
  const std::filesystem::path path = file_of_library(file_or_folder);
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

bool LibrarySource::has_early_nodes() const {
  return impl_->file && impl_->file->provenance().program.empty();
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
