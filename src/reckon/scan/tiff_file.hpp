// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reckon/scan/tiff_description.hpp"
#include "reckon/scan/volume_formats.hpp"

using TIFF = struct tiff;

namespace reckon {

/// A TIFF file, opened by libtiff, which takes its pages as directories and their pixels as strips
/// or tiles. A complaint of the library becomes an Error.
class TiffFile {
 public:
  /// `mode` as libtiff has it; `shown` is the name for messages.
  TiffFile(const std::filesystem::path& file, const char* mode, std::filesystem::path shown);
  explicit TiffFile(const std::filesystem::path& file) : TiffFile{file, "rm", file} {}

  [[nodiscard]] TIFF* get() const { return tiff_.get(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Throws Error unless `good`, with what the library said last.
  void require(bool good, const std::string& problem) const;
  /// Throws Error when the library found fault since.
  void require_no_fault() const { require(complaint_->empty(), damaged); }

  static constexpr const char* damaged = "the file is cut short or damaged";

 private:
  struct Close {
    void operator()(TIFF* tiff) const;
  };

  std::filesystem::path path_;
  std::unique_ptr<std::string> complaint_;  // in its own place: the library holds its address
  std::unique_ptr<TIFF, Close> tiff_;
};

/// A page's pixels.
struct TiffPage {
  std::int32_t width{0};
  std::int32_t height{0};
  VoxelType type{VoxelType::uint8};

  [[nodiscard]] std::size_t bytes_per_row() const {
    return static_cast<std::size_t>(width) * size_of(type);
  }
  friend bool operator==(const TiffPage&, const TiffPage&) = default;
};
/// How many voxels a file of this length can hold at most, were it ever so well compressed: a
/// damaged header must not cause an allocation that no file could fill.
[[nodiscard]] std::uint64_t most_tiff_voxels(const TiffFile& file, VoxelType type);
/// The properties of the current page. Throws Error when it is not in shades of gray, or when its
/// pixels lie beyond the file's end.
[[nodiscard]] TiffPage describe_page(const TiffFile& file);
/// The voxel of the current page, and the description of the whole file.
struct TiffFrame {
  TiffDescription description;
  FileSpacing spacing;
  std::vector<std::string> remarks;
};
/// Throws Error when the voxels of the file are no cubes, or that it holds several volumes whose
/// slices alternate.
[[nodiscard]] TiffFrame describe_frame(const TiffFile& file);
/// Where the numbers of the present page begin if they lie in one piece, as they are, rows from the
/// top; `big_endian` is set.
[[nodiscard]] std::optional<std::uint64_t> place_of_plain_page(const TiffFile& file,
                                                               bool& big_endian);

/// Fills `bytes` with the page's numbers in this machine's order, rows as they are to be shown from
/// the top.
void read_page(const TiffFile& file, const TiffPage& page, std::span<std::byte> bytes);

}  // namespace reckon
