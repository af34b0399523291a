// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/library_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reckon/avatar/library_layout.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/exact_sum.hpp"

namespace reckon {

using namespace library_layout;

namespace {

/// Vertices of a grid that is read from a band.
constexpr std::uint64_t largest_band = 1'000'000'000;

[[noreturn]] void damaged(const std::filesystem::path& path, std::string reason) {
  throw Error{{.place = path.string(),
               .problem = "the shape library is damaged",
               .reason = std::move(reason),
               .fix = "Make it anew with reckon grains."}};
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

}  // namespace

LibraryReader::LibraryReader(const std::filesystem::path& path) : file_{path, library_kind} {
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
      const auto& [width, thickness] = std::pair{row.descriptors.width, row.descriptors.thickness};
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

ShapeSummary LibraryReader::summary(std::size_t s) const {
  ShapeSummary summary{table_[s].name, outline_without_grid(table_[s]), 0, digest_[s]};
  check_outline(summary.outline, grid_values(s), place(s));
  if (summary.outline.storage == ShapeStorage::band) summary.outline.band_words = rows(s);
  const std::vector<double> areas = column("/node/area", s);
  summary.outline.nodes = areas.size();
  summary.node_area = exact_sum(areas);
  return summary;
}

Shape LibraryReader::shape(std::size_t s) const {
  Shape shape = table_[s];
  if (shape.storage == ShapeStorage::band) {
    check_outline(outline_without_grid(shape), grid_values(s), place(s));
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

std::uint64_t LibraryReader::grid_values(std::size_t s) const {
  if (table_[s].storage == ShapeStorage::full) return rows(s);
  std::uint64_t count = 1;
  for (const std::int32_t dim : table_[s].level_set.dims) {
    if (dim < 0 || static_cast<std::uint64_t>(dim) > largest_band / count) return 0;
    count *= static_cast<std::uint64_t>(dim);
    if (count == 0) return 0;
  }
  return count;
}

std::vector<double> LibraryReader::column(const char* name, std::size_t s) const {
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

std::vector<std::uint64_t> LibraryReader::read_first_rows(const std::string& name,
                                                          const std::string& data) const {
  auto first = file_.read<std::uint64_t>(name, {table_.size() + 1});
  const bool rising = std::is_sorted(first.begin(), first.end());
  const bool held = first.back() <= std::filesystem::file_size(file_.path());
  if (!rising || !held || first.front() != 0 || file_.extents(data) != Hdf5Extents{first.back()}) {
    damaged(file_.path(), fmt::format("{} does not fit {}", name, data));
  }
  return first;
}

}  // namespace reckon
