// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/hdf5_handle.hpp"
#include "reckon/core/hdf5_parts.hpp"
#include "reckon/core/write_failure.hpp"
#include "reckon/scan/volume_formats.hpp"

namespace reckon {
namespace {

/// Lengths of a dataset's axes, x first.
std::vector<std::int64_t> lengths_of(hid_t dataset) {
  const Hdf5Handle space{H5Dget_space(dataset), H5Sclose};
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::vector<hsize_t> extents(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  std::vector<std::int64_t> lengths;
  lengths.reserve(extents.size());
  for (const hsize_t extent : extents) lengths.push_back(static_cast<std::int64_t>(extent));
  std::reverse(lengths.begin(), lengths.end());
  return lengths;
}

/// Whether a dataset has three axes that count.
bool is_volume(hid_t dataset) {
  const std::vector<std::int64_t> lengths = lengths_of(dataset);
  const auto longer = std::count_if(lengths.begin(), lengths.end(),
                                    [](std::int64_t length) { return length != 1; });
  return lengths.size() >= 3 && longer <= 3;
}

bool is_volume(hid_t root, const char* name) {
  try {
    const Hdf5Handle dataset = hdf5_open_dataset(root, name, {});
    return dataset.valid() && is_volume(dataset.get());
  } catch (const Error&) {
    return true;  // kept in another file: opening it reports that
  }
}

herr_t collect_volumes(hid_t root, const char* name, const H5O_info_t* info, void* data) {
  if (info->type == H5O_TYPE_DATASET && is_volume(root, name)) {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
  }
  return 0;
}

/// A damaged or hostile header must not cause an allocation that no file could fill. What is packed
/// takes less than it holds, but no scan of grains takes so little.
void check_storage(hid_t dataset, std::uint64_t bytes, const std::filesystem::path& path) {
  constexpr std::uint64_t most_compression = 10000;
  constexpr std::uint64_t small = std::uint64_t{64} << 20U;  // [bytes]
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  const std::uint64_t most =
      std::max(small, std::min(stored, std::filesystem::file_size(path)) * most_compression);
  if (bytes > most) {
    refuse_volume(path, "the volume claims more voxels than the file can hold",
                  fmt::format("{} bytes are said to be packed in {}", bytes, stored),
                  "The file is cut short, was never filled, or is damaged: copy it again.");
  }
  const Hdf5Handle creation{H5Dget_create_plist(dataset), H5Pclose};
  if (H5Pget_layout(creation.get()) != H5D_CHUNKED) return;
  const Hdf5Handle type{H5Dget_type(dataset), H5Tclose};
  std::vector<hsize_t> chunk(lengths_of(dataset).size());
  H5Pget_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data());
  const std::uint64_t chunk_bytes = std::accumulate(
      chunk.begin(), chunk.end(), std::uint64_t{H5Tget_size(type.get())}, std::multiplies<>{});
  if (chunk_bytes > most) {
    refuse_volume(path, "the volume has larger chunks than the file can hold",
                  fmt::format("{} bytes each", chunk_bytes),
                  "Copy the file again, or pack it anew (h5repack).");
  }
}

std::string only_volume(hid_t file, const std::filesystem::path& path) {
  std::vector<std::string> names;
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, collect_volumes, &names, H5O_INFO_BASIC);
  if (names.empty()) {
    refuse_volume(path, "the file holds no volume", "none of its datasets has three dimensions",
                  "h5dump -n lists what it holds.");
  }
  if (names.size() > 1) {
    refuse_volume(path, "the file holds several volumes",
                  fmt::format("{} and {}", names[0], names[1]), "Choose one with --dataset.");
  }
  return names.front();
}

VoxelType type_of(hid_t dataset) {
  const Hdf5Handle type{H5Dget_type(dataset), H5Tclose};
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

using Extents = std::array<hsize_t, 3>;

/// z first.
Extents extents_of(const VoxelDims& dims) {
  return {static_cast<hsize_t>(dims[2]), static_cast<hsize_t>(dims[1]),
          static_cast<hsize_t>(dims[0])};
}

/// A dataset's space with layers selected. `places`: which of its axes are z, y and x; the others
/// have length 1.
hid_t select(hid_t dataset, hsize_t first, const Extents& extents,
             const std::array<std::size_t, 3>& places) {
  const hid_t space = H5Dget_space(dataset);
  const auto rank = static_cast<std::size_t>(H5Sget_simple_extent_ndims(space));
  std::vector<hsize_t> start(rank, 0);
  std::vector<hsize_t> count(rank, 1);
  start[places[0]] = first;
  for (std::size_t n = 0; n < 3; ++n) count[places[n]] = extents[n];
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  return space;
}

constexpr std::array<std::size_t, 3> plain_places{0, 1, 2};

class Hdf5VolumeReader : public VolumeReader {
 public:
  Hdf5VolumeReader(const std::filesystem::path& file, const std::string& dataset)
      : path_{file},
        file_{H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose},
        name_{dataset_in(file_, file, dataset)},
        dataset_{hdf5_open_dataset(file_.get(), name_, file)} {
    if (!dataset_.valid()) {
      refuse_volume(file, fmt::format("there is no dataset {}", name_), {},
                    "h5dump -n lists what it holds.");
    }
    const std::vector<std::int64_t> lengths = lengths_of(dataset_.get());
    const auto axes = axes_that_count(lengths, fmt::format("{}, {}", file.string(), name_));
    check_dims({lengths[axes[0]], lengths[axes[1]], lengths[axes[2]]}, std::uint64_t{1} << 40U,
               file.string());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      outline.dims[axis] = static_cast<std::int32_t>(lengths[axes[axis]]);
      places_[2 - axis] = lengths.size() - 1 - axes[axis];
    }
    outline.type = type_of(dataset_.get());
    const Hdf5Handle type{H5Dget_type(dataset_.get()), H5Tclose};
    check_storage(dataset_.get(), Box{outline.dims}.voxels() * H5Tget_size(type.get()), file);
    const Hdf5Handle attribute{H5Aopen(dataset_.get(), "voxel", H5P_DEFAULT), H5Aclose};
    double spacing = 0;
    if (attribute.valid() && H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &spacing) >= 0) {
      outline.spacing = {spacing, {}, "the attribute voxel"};
    }
  }

  GrayVolume read_layers(std::int32_t first, std::int32_t count) override {
    const QuietHdf5 quiet;
    GrayVolume layers{Box{{0, 0, first}, {outline.dims[0], outline.dims[1], count}}, 0};
    const auto extents = extents_of(layers.dims);
    const Hdf5Handle space{select(dataset_.get(), static_cast<hsize_t>(first), extents, places_),
                           H5Sclose};
    const Hdf5Handle memory{H5Screate_simple(3, extents.data(), nullptr), H5Sclose};
    if (H5Dread(dataset_.get(), H5T_NATIVE_FLOAT, memory.get(), space.get(), H5P_DEFAULT,
                layers.values.data()) < 0) {
      refuse_volume(path_, fmt::format("{} cannot be read", name_),
                    "it is damaged or holds no numbers", "Copy the file again.");
    }
    return layers;
  }

 private:
  static std::string dataset_in(const Hdf5Handle& opened, const std::filesystem::path& file,
                                const std::string& asked) {
    if (!opened.valid()) {
      refuse_volume(file, "the file cannot be read as HDF5",
                    "it is damaged, cut short or something else", "Copy it again.");
    }
    return asked.empty() ? only_volume(opened.get(), file) : asked;
  }

  std::filesystem::path path_;
  Hdf5Handle file_;
  std::string name_;
  Hdf5Handle dataset_;
  std::array<std::size_t, 3> places_{};  // of z, y and x among the dataset's axes
};

class Hdf5VolumeWriter : public VolumeWriter {
 public:
  Hdf5VolumeWriter(const std::filesystem::path& file, const VolumeOutline& what)
      : pending_{file}, what_{what} {
    file_.emplace(H5Fcreate(pending_.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                  H5Fclose);
    require(file_->valid());
    const auto extents = extents_of(what.dims);
    const Hdf5Handle space{H5Screate_simple(3, extents.data(), nullptr), H5Sclose};
    const Hdf5Handle creation{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    H5Pset_obj_track_times(creation.get(), false);  // equal volumes make equal files
    dataset_.emplace(H5Dcreate2(file_->get(), "/volume", stored_type(what.type), space.get(),
                                H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                     H5Dclose);
    require(dataset_->valid());
    const Hdf5Handle scalar{H5Screate(H5S_SCALAR), H5Sclose};
    const Hdf5Handle attribute{H5Acreate2(dataset_->get(), "voxel", H5T_IEEE_F64LE, scalar.get(),
                                          H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose};
    require(H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &what.spacing.edge.value()) >= 0);
  }
  ~Hdf5VolumeWriter() override {
    const QuietHdf5 quiet;
    dataset_.reset();
    file_.reset();
  }

  void write_layers(const GrayVolume& layers) override {
    const QuietHdf5 quiet;
    const std::string bytes = encode_numbers(layers.values, what_.type);
    record_.add(bytes);
    const auto extents = extents_of(layers.dims);
    const Hdf5Handle space{select(dataset_->get(), next_, extents, plain_places), H5Sclose};
    const Hdf5Handle memory{H5Screate_simple(3, extents.data(), nullptr), H5Sclose};
    require(H5Dwrite(dataset_->get(), stored_type(what_.type), memory.get(), space.get(),
                     H5P_DEFAULT, bytes.data()) >= 0);
    next_ += extents[0];
  }
  void finish() override {
    const QuietHdf5 quiet;
    require(H5Fflush(file_->get(), H5F_SCOPE_GLOBAL) >= 0);
    require(dataset_->close());
    require(file_->close());
    record_.compare(what_, pending_.target(),
                    [&] { return open_hdf5_volume(pending_.temporary(), "/volume"); });
    pending_.commit();
  }

 private:
  void require(bool written) const {
    if (written) return;
    throw_write_failure(pending_.target(), hdf5_error_number(), "the volume could not be written");
  }

  PendingFile pending_;
  VolumeOutline what_;
  LayerRecord record_;
  std::optional<Hdf5Handle> file_;
  std::optional<Hdf5Handle> dataset_;
  hsize_t next_{0};  // layer
};

}  // namespace

std::unique_ptr<VolumeReader> open_hdf5_volume(const std::filesystem::path& file,
                                               const std::string& dataset) {
  const QuietHdf5 quiet;
  return std::make_unique<Hdf5VolumeReader>(file, dataset);
}

std::unique_ptr<VolumeWriter> create_hdf5_volume(const std::filesystem::path& file,
                                                 const VolumeOutline& what) {
  const QuietHdf5 quiet;
  return std::make_unique<Hdf5VolumeWriter>(file, what);
}

}  // namespace reckon
