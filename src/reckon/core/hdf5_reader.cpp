// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>

#include <functional>
#include <numeric>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/hdf5_handle.hpp"
#include "reckon/core/hdf5_parts.hpp"
#include "reckon/core/seal.hpp"

namespace reckon {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string problem,
                       std::string reason = {}) {
  throw Error{{.place = path.string(),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = {}}};
}

}  // namespace

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
  const Hdf5Handle dataset = hdf5_open_dataset(file_, name, path_);
  return dataset.valid();
}

Hdf5Extents Hdf5Reader::extents(const std::string& name) const {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset = hdf5_open_dataset(file_, name, path_);
  if (!dataset.valid()) fail(path_, "lacks the dataset " + name);
  Hdf5Extents found = hdf5_extents(dataset.get());
  // Datasets are stored as they are, so none is larger than its file: no surprise allocations.
  const Hdf5Handle type{H5Dget_type(dataset.get()), H5Tclose};
  const std::size_t number_size = type.valid() ? H5Tget_size(type.get()) : 0;
  std::uint64_t numbers = 1;
  for (const std::uint64_t extent : found) {
    if (number_size == 0 || (extent > 0 && numbers > file_size_ / number_size / extent)) {
      fail(path_, fmt::format("dataset {} claims more data than the file has", name));
    }
    numbers *= extent;
  }
  return found;
}

std::size_t Hdf5Reader::check_extents(const std::string& name, const Hdf5Extents& expected) const {
  const Hdf5Extents found = extents(name);
  if (found != expected) {
    fail(path_, fmt::format("dataset {} has extents [{}] where [{}] are needed", name,
                            fmt::join(found, ", "), fmt::join(expected, ", ")));
  }
  return std::accumulate(found.begin(), found.end(), std::uint64_t{1}, std::multiplies<>{});
}

void Hdf5Reader::read_raw(const std::string& name, std::uint64_t first, Hdf5Number type,
                          void* values, std::uint64_t count) const {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset = hdf5_open_dataset(file_, name, path_);
  if (!dataset.valid()) fail(path_, "lacks the dataset " + name);
  const Hdf5Handle stored{H5Dget_type(dataset.get()), H5Tclose};
  if (!stored.valid() || H5Tequal(stored.get(), hdf5_native_type(type)) <= 0) {
    fail(path_, "dataset " + name + " has another number type than expected");
  }
  const Hdf5Rows rows = hdf5_rows(dataset.get(), first, count);
  if (!rows.good) {
    fail(path_,
         fmt::format("dataset {} does not have {} numbers from row {} on", name, count, first));
  }
  if (count > 0 && H5Dread(dataset.get(), hdf5_native_type(type), rows.memory_space.get(),
                           rows.file_space.get(), H5P_DEFAULT, values) < 0) {
    fail(path_, "dataset " + name + " could not be read");
  }
}

std::uint64_t Hdf5Reader::place_of(const std::string& name, Hdf5Number type, std::uint64_t count,
                                   std::size_t number_size) const {
  const QuietHdf5 quiet;
  const Hdf5Extents found = extents(name);
  const Hdf5Handle dataset = hdf5_open_dataset(file_, name, path_);
  const Hdf5Handle stored{H5Dget_type(dataset.get()), H5Tclose};
  const std::uint64_t bytes = count * number_size;
  const haddr_t offset = H5Dget_offset(dataset.get());
  const bool whole = !found.empty() && found[0] * hdf5_row_size(found) == count &&
                     offset != HADDR_UNDEF && bytes <= file_size_ && offset <= file_size_ - bytes;
  if (!whole || !stored.valid() || H5Tequal(stored.get(), hdf5_native_type(type)) <= 0) {
    fail(path_, "dataset " + name + " is not stored as expected");
  }
  return offset;
}

std::vector<std::string> Hdf5Reader::read_texts(const std::string& name,
                                                std::uint64_t count) const {
  const QuietHdf5 quiet;
  const Hdf5Handle dataset = hdf5_open_dataset(file_, name, path_);
  if (!dataset.valid()) fail(path_, "lacks the dataset " + name);
  const Hdf5Handle stored{H5Dget_type(dataset.get()), H5Tclose};
  const std::size_t width = stored.valid() ? H5Tget_size(stored.get()) : 0;
  if (width == 0 || width > longest_hdf5_text || H5Tget_class(stored.get()) != H5T_STRING ||
      H5Tis_variable_str(stored.get()) != 0) {
    fail(path_, "dataset " + name + " does not hold texts");
  }
  std::string packed(check_extents(name, {count}) * width, '\0');
  const Hdf5Handle type = hdf5_text_type(width);
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
  if (width == 0 || width > longest_hdf5_text || H5Tget_class(stored.get()) != H5T_STRING ||
      H5Tis_variable_str(stored.get()) != 0) {
    fail(path_, "lacks the note " + name);
  }
  std::string text(width, '\0');
  const Hdf5Handle type = hdf5_text_type(width);
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) {
    fail(path_, "note " + name + " could not be read");
  }
  return text.substr(0, text.find('\0'));
}

}  // namespace reckon
