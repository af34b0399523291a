// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/core/xxhash64.hpp"
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

/// The extension of a file name, in small letters: ".tif".
[[nodiscard]] std::string ending_of(const std::filesystem::path& file);

/// The content of the header of a file, or of its substitute. Heads of MetaImage and NRRD are read
/// by ourselves: the libraries for these formats do not survive every damaged one, and take less
/// than a whole file for whole.
struct VolumeHeader {
  std::array<std::int64_t, 3> dims{};
  VoxelType type{VoxelType::uint8};
  bool big_endian{false};
  bool compressed{false};
  FileSpacing spacing;
  std::array<bool, 3> mirrored{};       ///< axes that run backwards
  std::vector<std::string> data_files;  ///< beside the header; none: the numbers follow the header
  std::uint64_t data_start{0};          ///< where the numbers begin in a file
  std::uint64_t skip_lines{0};          ///< lines of text that follow there, before the numbers
  std::uint64_t skip_bytes{0};          ///< bytes behind these lines, before the numbers
  bool at_end{false};                   ///< the numbers end with the file
  bool may_go_on{false};                ///< other things may follow the numbers
  std::vector<std::string> remarks;
};
/// From the first bytes of a file. Throw Error for unknown content.
[[nodiscard]] VolumeHeader parse_metaimage_header(std::string_view bytes, const std::string& place);
[[nodiscard]] VolumeHeader parse_nrrd_header(std::string_view bytes, const std::string& place);
[[nodiscard]] VolumeHeader parse_npy_header(std::string_view bytes, const std::string& name);
/// The text beside a raw volume.
[[nodiscard]] VolumeHeader parse_raw_sidecar(std::string_view text, const std::string& name);
/// The three axes that count: of more than three, those of length 1 are left out. Throws Error when
/// three are not left.
[[nodiscard]] std::array<std::size_t, 3> axes_that_count(const std::vector<std::int64_t>& lengths,
                                                         const std::string& place);

/// Metres in a unit of length as files name it: "um", "micron", "mm", ...
[[nodiscard]] std::optional<double> file_unit(std::string_view name);
/// Sets a spacing. Throws Error, naming the field, when the edges are not the same.
void set_spacing(FileSpacing& spacing, const std::array<double, 3>& edges, std::string field,
                 const std::string& place);

/// How much of a file's beginning they need at most [bytes].
inline constexpr std::size_t longest_header = 131072;

/// Throws Error unless the numbers take just `bytes`.
void check_length(const VolumeHeader& header, std::uint64_t bytes, const std::string& place);

/// The content of a header, after its dimensions were checked.
[[nodiscard]] VolumeOutline outline_of(const VolumeHeader& header);

/// A volume whose numbers are stored unpacked, in sequence from the header's `data_start` on.
/// Throws Error unless they end with the file.
[[nodiscard]] std::unique_ptr<VolumeReader> open_plain_volume(std::shared_ptr<const ByteFile> file,
                                                              const VolumeHeader& header);
/// Likewise, with the same count of layers in each of several files.
[[nodiscard]] std::unique_ptr<VolumeReader> open_plain_files(
    std::vector<std::filesystem::path> files, const VolumeHeader& header);
/// The same volume with axes turned round.
[[nodiscard]] std::unique_ptr<VolumeReader> mirrored(std::unique_ptr<VolumeReader> reader,
                                                     const std::array<bool, 3>& axes);
/// Likewise, as zlib or gzip packed them. Reading throws Error when they are damaged, cut short, or
/// not as many as in the header.
[[nodiscard]] std::unique_ptr<VolumeReader> open_packed_volume(std::shared_ptr<const ByteFile> file,
                                                               const VolumeHeader& header);
[[nodiscard]] std::unique_ptr<VolumeReader> open_hdf5_volume(const std::filesystem::path& file,
                                                             const std::string& dataset);
/// A file of several pages, compressed or not.
[[nodiscard]] std::unique_ptr<VolumeReader> open_tiff_volume(const std::filesystem::path& file);
/// Files of one page each, in the order of the numbers in their names.
[[nodiscard]] std::unique_ptr<VolumeReader> open_tiff_slices(
    std::vector<std::filesystem::path> files, const std::string& folder);

// Writing: an outline's spacing is in metres.

[[nodiscard]] std::unique_ptr<VolumeWriter> create_hdf5_volume(const std::filesystem::path& file,
                                                               const VolumeOutline& what);
[[nodiscard]] std::unique_ptr<VolumeWriter> create_tiff_volume(const std::filesystem::path& file,
                                                               const VolumeOutline& what);
[[nodiscard]] std::string metaimage_header(const VolumeOutline& what);
[[nodiscard]] std::string nrrd_header(const VolumeOutline& what);
[[nodiscard]] std::filesystem::path sidecar_of(const std::filesystem::path& file);
/// Throws MachineFailure with the system's last word.
[[noreturn]] void refuse_unwritten(const std::filesystem::path& file);

/// The data passed to a library that writes volumes, for a comparison with the written file: such
/// libraries do not report every failure.
class LayerRecord {
 public:
  void add(std::string_view bytes);  ///< of encode_numbers, layer by layer
  /// Throws MachineFailure about the file `named` unless the volume that `open` opens is the one
  /// that was handed over.
  void compare(const VolumeOutline& what, const std::filesystem::path& named,
               const std::function<std::unique_ptr<VolumeReader>()>& open) const;

 private:
  XxHash64 hash_;
};

}  // namespace reckon
