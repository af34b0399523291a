// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/hdf5_parts.hpp"

#include <hdf5.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

/// The library's word for a call of the system that failed holds "errno = 28".
herr_t find_error_number(unsigned /*depth*/, const H5E_error2_t* error, void* number) {
  constexpr std::string_view key = "errno = ";
  const std::string_view text = error->desc != nullptr ? error->desc : "";
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return 0;
  const std::string_view digits = text.substr(at + key.size());
  std::from_chars(digits.data(), digits.data() + digits.size(), *static_cast<int*>(number));
  return 0;
}

herr_t refuse_other_file(const char* /*parent_file*/, const char* /*parent_group*/,
                         const char* /*file*/, const char* /*object*/, unsigned* /*flags*/,
                         hid_t /*access*/, void* asked) {
  *static_cast<bool*>(asked) = true;
  return -1;
}

}  // namespace

std::int64_t hdf5_native_type(Hdf5Number type) {
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

Hdf5Handle hdf5_text_type(std::size_t size) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(size, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose};
}

Hdf5Extents hdf5_extents(std::int64_t dataset) {
  const Hdf5Handle space{H5Dget_space(dataset), H5Sclose};
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : 0;
  std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
  return {dims.begin(), dims.end()};
}

std::uint64_t hdf5_row_size(const Hdf5Extents& extents) {
  std::uint64_t size = 1;
  for (std::size_t d = 1; d < extents.size(); ++d) size *= extents[d];
  return size;
}

Hdf5Rows hdf5_rows(std::int64_t dataset, std::uint64_t first, std::uint64_t count) {
  const Hdf5Extents extents = hdf5_extents(dataset);
  const std::uint64_t row = hdf5_row_size(extents);
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

Hdf5Handle hdf5_open_dataset(std::int64_t file, const std::string& name,
                             const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& reason) {
    throw Error{{.place = path.string(),
                 .problem = "dataset " + name + " is kept in other files",
                 .reason = reason,
                 .fix = "Copy the values into this file (h5repack does)."}};
  };
  const Hdf5Handle access{H5Pcreate(H5P_DATASET_ACCESS), H5Pclose};
  bool leads_elsewhere = false;
  H5Pset_elink_cb(access.get(), refuse_other_file, &leads_elsewhere);
  Hdf5Handle dataset{H5Dopen2(file, name.c_str(), access.get()), H5Dclose};
  if (leads_elsewhere) refuse("a link of it leads to another file");
  if (!dataset.valid()) return dataset;
  const Hdf5Handle creation{H5Dget_create_plist(dataset.get()), H5Pclose};
  if (!creation.valid() || H5Pget_external_count(creation.get()) != 0) {
    refuse("it has external storage");
  }
  if (H5Pget_layout(creation.get()) == H5D_VIRTUAL) refuse("it is a virtual dataset");
  return dataset;
}

int hdf5_error_number() {
  int number = 0;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_error_number, &number);
  return number;
}

}  // namespace reckon
