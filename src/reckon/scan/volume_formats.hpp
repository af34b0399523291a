// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/scan/volume_file.hpp"

/// The formats behind volume_file.hpp, each with its own source.
namespace reckon {

/// Throws Error about a volume's file, or whatever else `place` names.
[[noreturn]] void refuse_volume(const std::string& place, std::string problem, std::string reason,
                                std::string fix);

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

/// What the text at the head of a MetaImage or NRRD file says. Headers are read by ourselves: the
/// libraries for these formats do not survive every damaged header, and take less than a whole file
/// for whole.
struct TextHeader {
  std::array<std::int64_t, 3> dims{};
  VoxelType type{VoxelType::uint8};
  bool big_endian{false};
  bool compressed{false};
  std::optional<double> spacing;
  std::string data_file;      ///< beside the header; empty: the numbers follow the header
  std::size_t data_start{0};  ///< length of the header
};
/// Throw Error for whatever they do not understand.
[[nodiscard]] TextHeader parse_metaimage_header(std::string_view bytes, const std::string& place);
[[nodiscard]] TextHeader parse_nrrd_header(std::string_view bytes, const std::string& place);

/// The volume of these numbers. Throws Error unless `bytes` are just what it needs.
[[nodiscard]] StoredVolume assemble_volume(const std::array<std::int64_t, 3>& dims, VoxelType type,
                                           bool swap, std::string_view bytes,
                                           const std::string& place);

/// Throws Error unless all pages of a TIFF file are there and of one size.
void check_tiff_pages(const std::filesystem::path& path);

// Those of the component `ct`.

/// TIFF, or MetaImage or NRRD with compressed numbers, by the ending.
[[nodiscard]] StoredVolume read_itk_volume(const std::filesystem::path& file);
/// Slices of one volume, in this order.
[[nodiscard]] StoredVolume read_itk_slices(const std::vector<std::filesystem::path>& files);
void write_itk_volume(const std::filesystem::path& file, const GrayVolume& volume, VoxelType type);

}  // namespace reckon
