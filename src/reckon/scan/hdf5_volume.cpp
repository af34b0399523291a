// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <string>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/scan/volume_formats.hpp"

namespace reckon {
namespace {

/// An HDF5 handle and the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_{id}, close_{close} {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 prints its errors unless it is told not to.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_{nullptr};
  void* data_{nullptr};
};

[[noreturn]] void fail(const std::filesystem::path& file, std::string problem, std::string reason,
                       std::string fix) {
  throw Error{{.place = file.string(),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

int rank_of(hid_t dataset) {
  const Handle space{H5Dget_space(dataset), H5Sclose};
  return H5Sget_simple_extent_ndims(space.get());
}

herr_t collect_volumes(hid_t root, const char* name, const H5O_info_t* info, void* data) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Handle dataset{H5Dopen2(root, name, H5P_DEFAULT), H5Dclose};
  if (dataset.valid() && rank_of(dataset.get()) == 3) {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
  }
  return 0;
}

std::string only_volume(hid_t file, const std::filesystem::path& path) {
  std::vector<std::string> names;
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, collect_volumes, &names, H5O_INFO_BASIC);
  if (names.empty()) {
    fail(path, "the file holds no volume", "none of its datasets has three dimensions",
         "h5dump -n lists what it holds.");
  }
  if (names.size() > 1) {
    fail(path, "the file holds several volumes", fmt::format("{} and {}", names[0], names[1]),
         "Choose one with --dataset.");
  }
  return names.front();
}

VoxelType type_of(hid_t dataset) {
  const Handle type{H5Dget_type(dataset), H5Tclose};
  const std::size_t size = H5Tget_size(type.get());
  if (H5Tget_class(type.get()) == H5T_FLOAT) {
    return size <= 4 ? VoxelType::float32 : VoxelType::float64;
  }
  const bool negative = H5Tget_sign(type.get()) == H5T_SGN_2;
  if (size == 1) return negative ? VoxelType::int8 : VoxelType::uint8;
  if (size == 2) return negative ? VoxelType::int16 : VoxelType::uint16;
  return negative ? VoxelType::int32 : VoxelType::uint32;
}

hid_t stored_type(VoxelType type) {
  switch (type) {
    case VoxelType::uint8:
      return H5T_STD_U8LE;
    case VoxelType::int8:
      return H5T_STD_I8LE;
    case VoxelType::uint16:
      return H5T_STD_U16LE;
    case VoxelType::int16:
      return H5T_STD_I16LE;
    case VoxelType::uint32:
      return H5T_STD_U32LE;
    case VoxelType::int32:
      return H5T_STD_I32LE;
    case VoxelType::float32:
      return H5T_IEEE_F32LE;
    case VoxelType::float64:
      return H5T_IEEE_F64LE;
  }
  return -1;
}

}  // namespace

StoredVolume read_hdf5_volume(const std::filesystem::path& file, const std::string& dataset) {
  const Quiet quiet;
  const Handle handle{H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!handle.valid()) {
    fail(file, "the file cannot be read as HDF5", "it is damaged, cut short or something else",
         "Copy it again.");
  }
  const std::string name = dataset.empty() ? only_volume(handle.get(), file) : dataset;
  const Handle volume{H5Dopen2(handle.get(), name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!volume.valid()) {
    fail(file, fmt::format("there is no dataset {}", name), {}, "h5dump -n lists what it holds.");
  }
  if (const int rank = rank_of(volume.get()); rank != 3) {
    fail(file, fmt::format("{} is no volume", name), fmt::format("it has {} dimensions", rank),
         "Choose another with --dataset.");
  }
  std::array<hsize_t, 3> extents{};
  {
    const Handle space{H5Dget_space(volume.get()), H5Sclose};
    H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  }
  StoredVolume stored;
  check_dims({static_cast<std::int64_t>(extents[2]), static_cast<std::int64_t>(extents[1]),
              static_cast<std::int64_t>(extents[0])},
             std::uint64_t{1} << 40U, file.string());
  stored.gray =
      GrayVolume{{static_cast<std::int32_t>(extents[2]), static_cast<std::int32_t>(extents[1]),
                  static_cast<std::int32_t>(extents[0])},
                 0};
  stored.type = type_of(volume.get());
  if (H5Dread(volume.get(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT,
              stored.gray.values.data()) < 0) {
    fail(file, fmt::format("{} cannot be read", name), "it is damaged or holds no numbers",
         "Copy the file again.");
  }
  const Handle attribute{H5Aopen(volume.get(), "voxel", H5P_DEFAULT), H5Aclose};
  double spacing = 0;
  if (attribute.valid() && H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &spacing) >= 0) {
    stored.spacing = spacing;
  }
  return stored;
}

void write_hdf5_volume(const std::filesystem::path& file, const GrayVolume& volume,
                       VoxelType type) {
  const Quiet quiet;
  PendingFile pending{file};
  {
    const Handle handle{
        H5Fcreate(pending.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
    const std::array<hsize_t, 3> extents{static_cast<hsize_t>(volume.dims[2]),
                                         static_cast<hsize_t>(volume.dims[1]),
                                         static_cast<hsize_t>(volume.dims[0])};
    const Handle space{H5Screate_simple(3, extents.data(), nullptr), H5Sclose};
    const Handle dataset{H5Dcreate2(handle.get(), "/volume", stored_type(type), space.get(),
                                    H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Dclose};
    const std::string bytes = encode_numbers(volume.values, type);
    const Handle scalar{H5Screate(H5S_SCALAR), H5Sclose};
    const Handle attribute{
        H5Acreate2(dataset.get(), "voxel", H5T_IEEE_F64LE, scalar.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose};
    const bool written = H5Dwrite(dataset.get(), stored_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                  bytes.data()) >= 0 &&
                         H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &volume.voxel) >= 0 &&
                         H5Fflush(handle.get(), H5F_SCOPE_GLOBAL) >= 0;
    if (!written) fail(file, "the volume could not be written", {}, "Is the disk full?");
  }
  pending.commit();
}

}  // namespace reckon
