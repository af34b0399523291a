// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/hdf5_record.hpp"

#include <hdf5.h>

#include <algorithm>
#include <bit>

#include "reckon/core/hdf5_parts.hpp"
#include "reckon/core/write_failure.hpp"
#include "reckon/core/xxhash64.hpp"

namespace reckon {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the numbers in a file are compared as they lie in memory");

constexpr std::uint64_t bytes_at_once = std::uint64_t{1} << 22U;

std::uint64_t hash_of(std::string_view bytes) {
  XxHash64 hash;
  hash.update(bytes);
  return hash.digest();
}

}  // namespace

void Hdf5Record::add_dataset(const std::string& name, std::optional<Hdf5Number> type,
                             const Hdf5Extents& extents) {
  datasets_[name] = {type, extents, {}};
}

void Hdf5Record::add_rows(const std::string& name, std::uint64_t first, std::string_view bytes) {
  datasets_[name].rows.push_back({first, bytes.size(), hash_of(bytes)});
}

void Hdf5Record::add_text(const std::string& object, const std::string& name,
                          std::string_view padded) {
  texts_.push_back({object, name, std::string{padded}});
}

void Hdf5Record::compare(const std::filesystem::path& file,
                         const std::filesystem::path& named) const {
  const Hdf5Handle opened{H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!opened.valid()) throw_write_failure(named, hdf5_error_number());
  for (const auto& [name, dataset] : datasets_) {
    if (!holds(opened.get(), name, dataset)) {
      throw_write_failure(named, hdf5_error_number(), "dataset " + name + " was not written");
    }
  }
  for (const Text& text : texts_) {
    if (!holds(opened.get(), text)) {
      throw_write_failure(named, hdf5_error_number(), "note " + text.name + " was not written");
    }
  }
}

bool Hdf5Record::holds(std::int64_t file, const std::string& name, const Dataset& expected) {
  const Hdf5Handle dataset{H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid() || hdf5_extents(dataset.get()) != expected.extents) return false;
  const Hdf5Handle type{H5Dget_type(dataset.get()), H5Tclose};
  if (!type.valid()) return false;
  const bool same_type = expected.type ? H5Tequal(type.get(), hdf5_native_type(*expected.type)) > 0
                                       : H5Tget_class(type.get()) == H5T_STRING;
  const std::uint64_t row_bytes = hdf5_row_size(expected.extents) * H5Tget_size(type.get());
  return same_type &&
         std::all_of(expected.rows.begin(), expected.rows.end(),
                     [&](const Rows& rows) { return holds(dataset.get(), row_bytes, rows); });
}

bool Hdf5Record::holds(std::int64_t dataset, std::uint64_t row_bytes, const Rows& rows) {
  if (rows.bytes == 0 || row_bytes == 0) return rows.bytes == 0;
  const Hdf5Handle type{H5Dget_type(dataset), H5Tclose};
  const std::uint64_t numbers_in_row = row_bytes / H5Tget_size(type.get());
  const std::uint64_t rows_at_once = std::max<std::uint64_t>(bytes_at_once / row_bytes, 1);
  const std::uint64_t end = rows.first + rows.bytes / row_bytes;
  std::string bytes;
  XxHash64 hash;
  for (std::uint64_t row = rows.first; row < end; row += rows_at_once) {
    const std::uint64_t count = std::min(rows_at_once, end - row);
    bytes.resize(count * row_bytes);
    const Hdf5Rows selected = hdf5_rows(dataset, row, count * numbers_in_row);
    if (!selected.good || H5Dread(dataset, type.get(), selected.memory_space.get(),
                                  selected.file_space.get(), H5P_DEFAULT, bytes.data()) < 0) {
      return false;
    }
    hash.update(bytes);
  }
  return hash.digest() == rows.digest;
}

bool Hdf5Record::holds(std::int64_t file, const Text& text) {
  const Hdf5Handle attribute{
      H5Aopen_by_name(file, text.object.c_str(), text.name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose};
  const Hdf5Handle type{attribute.valid() ? H5Aget_type(attribute.get()) : -1, H5Tclose};
  if (!type.valid() || H5Tget_size(type.get()) != text.padded.size()) return false;
  std::string found(text.padded.size(), '\0');
  return H5Aread(attribute.get(), type.get(), found.data()) >= 0 && found == text.padded;
}

}  // namespace reckon
