// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/scan/volume_file.hpp"

/// The formats behind volume_file.hpp, each with its own source.
namespace reckon {

/// As in NumPy's headers, e.g. "<u2".
[[nodiscard]] std::string numpy_name_of(VoxelType type);

/// Numbers in the machine's byte order or the other one, as floats. `bytes` holds what `dims` need.
[[nodiscard]] std::vector<float> decode_numbers(std::string_view bytes, VoxelType type, bool swap);
/// Rounded and clamped, little-endian.
[[nodiscard]] std::string encode_numbers(const std::vector<float>& values, VoxelType type);

/// Throws Error unless all are in 1 ... 2^31 - 1 and their product is at most `most`.
void check_dims(const std::array<std::int64_t, 3>& dims, std::uint64_t most,
                const std::string& place);

[[nodiscard]] StoredVolume read_hdf5_volume(const std::filesystem::path& file,
                                            const std::string& dataset);
void write_hdf5_volume(const std::filesystem::path& file, const GrayVolume& volume, VoxelType type);

// The libraries that read these formats are content with less than a whole file.

/// Throws Error unless all pages of a TIFF file are there and of one size.
void check_tiff_pages(const std::filesystem::path& file);
/// Throws Error unless a MetaImage's data, of so many bytes when not compressed, are all there.
void check_metaimage_size(const std::filesystem::path& file, std::uint64_t bytes);

// Those of the component `ct`.

/// MetaImage, NRRD or TIFF by the ending.
[[nodiscard]] StoredVolume read_itk_volume(const std::filesystem::path& file);
/// Slices of one volume, in this order.
[[nodiscard]] StoredVolume read_itk_slices(const std::vector<std::filesystem::path>& files);
void write_itk_volume(const std::filesystem::path& file, const GrayVolume& volume, VoxelType type);

}  // namespace reckon
