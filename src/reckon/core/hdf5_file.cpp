// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/hdf5_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/hdf5_handle.hpp"
#include "reckon/core/seal.hpp"

namespace reckon {
namespace {

constexpr std::size_t longest_text = 4096;

[[noreturn]] void fail(const std::filesystem::path& path, std::string problem,
                       std::string reason = {}) {
  throw Error{{.place = path.string(),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = {}}};
}

hid_t native_type(Hdf5Number type) {
  switch (type) {
    case Hdf5Number::float32:
      return H5T_NATIVE_FLOAT;
    case Hdf5Number::float64:
      return H5T_NATIVE_DOUBLE;
    case Hdf5Number::int32:
      return H5T_NATIVE_INT32;
    case Hdf5Number::uint32:
      return H5T_NATIVE_UINT32;
    case Hdf5Number::int64:
      return H5T_NATIVE_INT64;
    case Hdf5Number::uint64:
      return H5T_NATIVE_UINT64;
    case Hdf5Number::uint8:
      return H5T_NATIVE_UINT8;
    case Hdf5Number::uint16:
      return H5T_NATIVE_UINT16;
  }
  return -1;
}

/// A text of exactly `size` bytes, padded with NUL.
Hdf5Handle text_type(std::size_t size) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(size, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose};
}

bool write_text_attribute(hid_t object, const char* name, std::string_view text) {
  const Hdf5Handle type = text_type(text.size());
  const Hdf5Handle space{H5Screate(H5S_SCALAR), H5Sclose};
  const Hdf5Handle attribute{
      H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose};
  std::string padded{text};
  if (padded.empty()) padded.push_back('\0');
  return attribute.valid() && H5Awrite(attribute.get(), type.get(), padded.data()) >= 0;
}

Hdf5Handle create_dataset(hid_t file, const std::string& name, hid_t type,
                          const Hdf5Extents& extents) {
  const std::vector<hsize_t> dims(extents.begin(), extents.end());
  const Hdf5Handle space{H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
                         H5Sclose};
  const Hdf5Handle links{H5Pcreate(H5P_LINK_CREATE), H5Pclose};
  H5Pset_create_intermediate_group(links.get(), 1);
  // Times of creation would make equal libraries differ in their bytes.
  const Hdf5Handle creation{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  H5Pset_obj_track_times(creation.get(), false);
  return {
      H5Dcreate2(file, name.c_str(), type, space.get(), links.get(), creation.get(), H5P_DEFAULT),
      H5Dclose};
}

Hdf5Extents dataset_extents(hid_t dataset) {
  const Hdf5Handle space{H5Dget_space(dataset), H5Sclose};
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : 0;
  std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
  return {dims.begin(), dims.end()};
}

/// Numbers in one row.
std::uint64_t row_size(const Hdf5Extents& extents) {
  std::uint64_t size = 1;
  for (std::size_t d = 1; d < extents.size(); ++d) size *= extents[d];
  return size;
}

/// Dataspaces in file and memory for a run of whole rows.
struct RowSelection {
  Hdf5Handle file_space;
  Hdf5Handle memory_space;
  bool good;  ///< false: there are no such rows
};

RowSelection select_rows(hid_t dataset, std::uint64_t first, std::uint64_t count) {
  const Hdf5Extents extents = dataset_extents(dataset);
  const std::uint64_t row = row_size(extents);
  const std::uint64_t rows = row > 0 ? count / row : 0;
  const bool good =
      !extents.empty() && rows * row == count && first <= extents[0] && rows <= extents[0] - first;
  const hid_t file_space = H5Dget_space(dataset);
  if (good) {
    std::vector<hsize_t> start(extents.size(), 0);
    std::vector<hsize_t> length(extents.begin(), extents.end());
    start[0] = first;
    length[0] = rows;
    H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, length.data(), nullptr);
  }
  const hsize_t memory_length = count;
  return {{file_space, H5Sclose}, {H5Screate_simple(1, &memory_length, nullptr), H5Sclose}, good};
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& target, Hdf5Kind kind)
    : pending_{target}, kind_{std::move(kind)} {
  const QuietHdf5 quiet;
  const Hdf5Handle creation{H5Pcreate(H5P_FILE_CREATE), H5Pclose};
  H5Pset_userblock(creation.get(), seal_size);
  H5Pset_obj_track_times(creation.get(), false);
  file_ = H5Fcreate(pending_.temporary().c_str(), H5F_ACC_TRUNC, creation.get(), H5P_DEFAULT);
  if (file_ < 0) {
    throw Error{{.place = target.string(),
                 .problem = "cannot be written",
                 .reason = "HDF5 could not create it",
                 .fix = "Check the folder's permissions and the free space."}};
  }
}

Hdf5Writer::~Hdf5Writer() {
  const QuietHdf5 quiet;
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Writer::create(const std::string& name, Hdf5Number type, const Hdf5Extents& extents,
                        std::string_view unit) {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset = create_dataset(file_, name, native_type(type), extents);
  if (!dataset.valid() || !write_text_attribute(dataset.get(), "unit", unit)) {
    fail(pending_.target(), "dataset " + name + " could not be created");
  }
}

void Hdf5Writer::write_raw(const std::string& name, std::uint64_t first, Hdf5Number type,
                           const void* values, std::uint64_t count) {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset{H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) fail(pending_.target(), "dataset " + name + " does not exist");
  const RowSelection rows = select_rows(dataset.get(), first, count);
  if (!rows.good) {
    fail(pending_.target(),
         fmt::format("dataset {} has no room for {} numbers from row {} on", name, count, first));
  }
  if (count > 0 && H5Dwrite(dataset.get(), native_type(type), rows.memory_space.get(),
                            rows.file_space.get(), H5P_DEFAULT, values) < 0) {
    fail(pending_.target(), "dataset " + name + " could not be written", "is the disk full?");
  }
}

void Hdf5Writer::write_texts(const std::string& name, const std::vector<std::string>& texts) {
  const QuietHdf5 quiet;
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  if (width > longest_text) fail(pending_.target(), "a text of " + name + " is too long");
  std::string packed(width * texts.size(), '\0');
  for (std::size_t t = 0; t < texts.size(); ++t) {
    std::copy(texts[t].begin(), texts[t].end(),
              packed.begin() + static_cast<std::ptrdiff_t>(t * width));
  }
  const Hdf5Handle type = text_type(width);
  const Hdf5Handle dataset = create_dataset(file_, name, type.get(), {texts.size()});
  if (!dataset.valid() || !write_text_attribute(dataset.get(), "unit", "text") ||
      (!texts.empty() &&
       H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, packed.data()) < 0)) {
    fail(pending_.target(), "dataset " + name + " could not be written");
  }
}

void Hdf5Writer::write_note(const std::string& name, const std::string& text) {
  const QuietHdf5 quiet;
  const Hdf5Handle root{H5Gopen2(file_, "/", H5P_DEFAULT), H5Gclose};
  if (!write_text_attribute(root.get(), name.c_str(), text)) {
    fail(pending_.target(), "note " + name + " could not be written");
  }
}

void Hdf5Writer::finish() {
  const QuietHdf5 quiet;
  const herr_t closed = H5Fclose(file_);
  file_ = -1;
  if (closed < 0) {
    fail(pending_.target(), "could not be written to disk", "HDF5 could not close it");
  }
  write_seal(pending_.temporary(), kind_.name, kind_.version);
  pending_.commit();
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path, const Hdf5Kind& kind) : path_{path} {
  const SealContent seal = check_seal(path, kind.name);
  file_size_ = seal.file_size;
  version_ = seal.version;
  if (version_ > kind.version || version_ == 0) {
    throw Error{{.place = path.string(),
                 .problem = fmt::format("has version {} of the {} layout", version_, kind.name),
                 .reason = fmt::format("this program reads up to version {}", kind.version),
                 .fix = "Use a newer reckon, or make the file anew with this one."}};
  }
  const QuietHdf5 quiet;
  file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) fail(path, "is not an HDF5 file behind its seal");
}

Hdf5Reader::~Hdf5Reader() {
  const QuietHdf5 quiet;
  if (file_ >= 0) H5Fclose(file_);
}

bool Hdf5Reader::has(const std::string& name) const {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset{H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose};
  return dataset.valid();
}

Hdf5Extents Hdf5Reader::extents(const std::string& name) const {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset{H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) fail(path_, "lacks the dataset " + name);
  return dataset_extents(dataset.get());
}

std::size_t Hdf5Reader::check_extents(const std::string& name, const Hdf5Extents& expected,
                                      std::size_t number_size) const {
  const Hdf5Extents found = extents(name);
  if (found != expected) {
    fail(path_, fmt::format("dataset {} has extents [{}] where [{}] are needed", name,
                            fmt::join(found, ", "), fmt::join(expected, ", ")));
  }
  // Datasets are stored as they are, so none is larger than its file: no surprise allocations.
  std::uint64_t numbers = 1;
  for (const std::uint64_t extent : expected) {
    if (extent > 0 && numbers > file_size_ / number_size / extent) {
      fail(path_, fmt::format("dataset {} claims more data than the file has", name));
    }
    numbers *= extent;
  }
  return numbers;
}

void Hdf5Reader::read_raw(const std::string& name, std::uint64_t first, Hdf5Number type,
                          void* values, std::uint64_t count) const {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset{H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) fail(path_, "lacks the dataset " + name);
  const Hdf5Handle stored{H5Dget_type(dataset.get()), H5Tclose};
  if (!stored.valid() || H5Tequal(stored.get(), native_type(type)) <= 0) {
    fail(path_, "dataset " + name + " has another number type than expected");
  }
  const RowSelection rows = select_rows(dataset.get(), first, count);
  if (!rows.good) {
    fail(path_,
         fmt::format("dataset {} does not have {} numbers from row {} on", name, count, first));
  }
  if (count > 0 && H5Dread(dataset.get(), native_type(type), rows.memory_space.get(),
                           rows.file_space.get(), H5P_DEFAULT, values) < 0) {
    fail(path_, "dataset " + name + " could not be read");
  }
}

std::uint64_t Hdf5Reader::place_of(const std::string& name, Hdf5Number type, std::uint64_t count,
                                   std::size_t number_size) const {
  const QuietHdf5 quiet;
  const Hdf5Extents found = extents(name);
  const Hdf5Handle dataset{H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose};
  const Hdf5Handle stored{H5Dget_type(dataset.get()), H5Tclose};
  const std::uint64_t bytes = count * number_size;
  const haddr_t offset = H5Dget_offset(dataset.get());
  const bool whole = !found.empty() && found[0] * row_size(found) == count &&
                     offset != HADDR_UNDEF && bytes <= file_size_ && offset <= file_size_ - bytes;
  if (!whole || !stored.valid() || H5Tequal(stored.get(), native_type(type)) <= 0) {
    fail(path_, "dataset " + name + " is not stored as expected");
  }
  return offset;
}

std::vector<std::string> Hdf5Reader::read_texts(const std::string& name,
                                                std::uint64_t count) const {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset{H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) fail(path_, "lacks the dataset " + name);
  const Hdf5Handle stored{H5Dget_type(dataset.get()), H5Tclose};
  const std::size_t width = stored.valid() ? H5Tget_size(stored.get()) : 0;
  if (width == 0 || width > longest_text || H5Tget_class(stored.get()) != H5T_STRING ||
      H5Tis_variable_str(stored.get()) != 0) {
    fail(path_, "dataset " + name + " does not hold texts");
  }
  std::string packed(check_extents(name, {count}, width) * width, '\0');
  const Hdf5Handle type = text_type(width);
  if (count > 0 &&
      H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, packed.data()) < 0) {
    fail(path_, "dataset " + name + " could not be read");
  }
  std::vector<std::string> texts;
  for (std::size_t t = 0; t < count; ++t) {
    const std::string_view text = std::string_view{packed}.substr(t * width, width);
    texts.emplace_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

std::string Hdf5Reader::read_note(const std::string& name) const {
  const QuietHdf5 quiet;
  const Hdf5Handle attribute{H5Aopen(file_, name.c_str(), H5P_DEFAULT), H5Aclose};
  const Hdf5Handle stored{attribute.valid() ? H5Aget_type(attribute.get()) : -1, H5Tclose};
  const std::size_t width = stored.valid() ? H5Tget_size(stored.get()) : 0;
  if (width == 0 || width > longest_text || H5Tget_class(stored.get()) != H5T_STRING ||
      H5Tis_variable_str(stored.get()) != 0) {
    fail(path_, "lacks the note " + name);
  }
  std::string text(width, '\0');
  const Hdf5Handle type = text_type(width);
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) {
    fail(path_, "note " + name + " could not be read");
  }
  return text.substr(0, text.find('\0'));
}

}  // namespace reckon
