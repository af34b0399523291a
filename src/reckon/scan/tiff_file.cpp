// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/tiff_file.hpp"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

namespace reckon {
namespace {

int keep_complaint(TIFF* /*tiff*/, void* kept, const char* /*module*/, const char* format,
                   va_list arguments) {
  std::array<char, 200> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  *static_cast<std::string*>(kept) = text.data();
  return 1;  // and do not print it
}
int ignore(TIFF* /*tiff*/, void* /*data*/, const char* /*module*/, const char* /*format*/,
           va_list /*arguments*/) {
  return 1;
}

template <class Number>
Number field(const TiffFile& file, std::uint32_t tag, Number otherwise = {}) {
  Number value = otherwise;
  return TIFFGetFieldDefaulted(file.get(), tag, &value) == 1 ? value : otherwise;
}

std::optional<VoxelType> type_of(unsigned format, unsigned bits) {
  const bool is_signed = format == SAMPLEFORMAT_INT;
  if (format == SAMPLEFORMAT_IEEEFP) {
    if (bits == 32) return VoxelType::float32;
    return bits == 64 ? std::optional{VoxelType::float64} : std::nullopt;
  }
  if (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_VOID && !is_signed) return {};
  if (bits == 8) return is_signed ? VoxelType::int8 : VoxelType::uint8;
  if (bits == 16) return is_signed ? VoxelType::int16 : VoxelType::uint16;
  if (bits == 32) return is_signed ? VoxelType::int32 : VoxelType::uint32;
  return {};
}

/// Throws Error unless each strip or tile lies in the file.
void check_places(const TiffFile& file) {
  TIFF* const tiff = file.get();
  const std::uint64_t size = std::filesystem::file_size(file.path());
  const std::uint32_t pieces =
      TIFFIsTiled(tiff) != 0 ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
  for (std::uint32_t piece = 0; piece < pieces; ++piece) {
    const std::uint64_t first = TIFFGetStrileOffset(tiff, piece);
    const std::uint64_t bytes = TIFFGetStrileByteCount(tiff, piece);
    file.require_no_fault();
    if (first > 0 && first <= size && bytes <= size - first) continue;
    refuse_volume(file.path(), TiffFile::damaged,
                  fmt::format("pixels are at bytes {} to {}, the file ends at {}", first,
                              first + bytes, size),
                  "Copy it again.");
  }
}

void read_strips(const TiffFile& file, const TiffPage& page, std::span<std::byte> bytes) {
  const auto all = static_cast<std::uint32_t>(page.height);
  const auto rows = std::min(field<std::uint32_t>(file, TIFFTAG_ROWSPERSTRIP, all), all);
  file.require(rows > 0, TiffFile::damaged);
  for (std::uint32_t first = 0, strip = 0; first < all; first += rows, ++strip) {
    const auto part = bytes.subspan(first * page.bytes_per_row(),
                                    std::min(rows, all - first) * page.bytes_per_row());
    const auto wanted = static_cast<tmsize_t>(part.size());
    file.require(TIFFReadEncodedStrip(file.get(), strip, part.data(), wanted) == wanted,
                 TiffFile::damaged);
  }
}

void read_tiles(const TiffFile& file, const TiffPage& page, std::span<std::byte> bytes) {
  TIFF* const tiff = file.get();
  const auto width = field<std::uint32_t>(file, TIFFTAG_TILEWIDTH);
  const auto height = field<std::uint32_t>(file, TIFFTAG_TILELENGTH);
  check_dims({width, height, 1}, most_tiff_voxels(file, page.type), file.path().string());
  const auto columns = static_cast<std::uint32_t>(page.width);
  const auto rows = static_cast<std::uint32_t>(page.height);
  const std::size_t number = size_of(page.type);
  std::vector<std::byte> tile(number * width * height);
  const auto wanted = static_cast<tmsize_t>(tile.size());
  file.require(TIFFTileSize(tiff) == wanted, TiffFile::damaged);
  for (std::uint32_t y = 0; y < rows; y += height) {
    for (std::uint32_t x = 0; x < columns; x += width) {
      const auto index = TIFFComputeTile(tiff, x, y, 0, 0);
      file.require(TIFFReadEncodedTile(tiff, index, tile.data(), wanted) == wanted,
                   TiffFile::damaged);
      const std::size_t run = number * std::min(width, columns - x);
      for (std::uint32_t row = 0; row < std::min(height, rows - y); ++row) {
        std::copy_n(tile.begin() + static_cast<std::ptrdiff_t>(row * number * width), run,
                    bytes.begin() +
                        static_cast<std::ptrdiff_t>((y + row) * page.bytes_per_row() + x * number));
      }
    }
  }
}

}  // namespace

void TiffFile::Close::operator()(TIFF* tiff) const { TIFFClose(tiff); }

TiffFile::TiffFile(const std::filesystem::path& file, const char* mode, std::filesystem::path shown)
    : path_{std::move(shown)}, complaint_{std::make_unique<std::string>()} {
  TIFFOpenOptions* const options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_complaint, complaint_.get());
  TIFFOpenOptionsSetWarningHandlerExtR(options, ignore, nullptr);
  tiff_.reset(TIFFOpenExt(file.c_str(), mode, options));
  TIFFOpenOptionsFree(options);
  if (tiff_ == nullptr && *mode == 'w') refuse_unwritten(path_);
  require(tiff_ != nullptr, "this is no TIFF file, or it is damaged");
}

void TiffFile::require(bool good, const std::string& problem) const {
  if (!good) refuse_volume(path_, problem, *complaint_, "Copy it again, or check its name.");
}

std::uint64_t most_tiff_voxels(const TiffFile& file, VoxelType type) {
  constexpr std::uint64_t most_compression = 2000;
  return std::filesystem::file_size(file.path()) * most_compression / size_of(type);
}

TiffPage describe_page(const TiffFile& file) {
  const auto width = field<std::uint32_t>(file, TIFFTAG_IMAGEWIDTH);
  const auto height = field<std::uint32_t>(file, TIFFTAG_IMAGELENGTH);
  const auto bits = field<std::uint16_t>(file, TIFFTAG_BITSPERSAMPLE, 1);
  const auto format = field<std::uint16_t>(file, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const auto samples = field<std::uint16_t>(file, TIFFTAG_SAMPLESPERPIXEL, 1);
  const auto meaning = field<std::uint16_t>(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  // Palettes, and whether 0 is black or white, concern only the display of the measured numbers.
  const bool gray = meaning <= PHOTOMETRIC_MINISBLACK || meaning == PHOTOMETRIC_PALETTE;
  if (samples != 1 || !gray) {
    refuse_volume(file.path(), "the file holds colours or vectors",
                  fmt::format("{} numbers a pixel, of meaning {}", samples, meaning),
                  "Save it in shades of gray.");
  }
  const auto type = type_of(format, bits);
  if (!type) {
    refuse_volume(file.path(), "the type of the numbers is not known",
                  fmt::format("{} bits, format {}", bits, format),
                  "Save it as integers of 8, 16 or 32 bits or as floats.");
  }
  const auto compression = field<std::uint16_t>(file, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (TIFFIsCODECConfigured(compression) == 0) {
    refuse_volume(file.path(), "the file's compression is not known",
                  fmt::format("number {}", compression), "Save it with LZW, deflate or none.");
  }
  const auto orientation = field<std::uint16_t>(file, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  if (orientation != ORIENTATION_TOPLEFT && orientation != ORIENTATION_BOTLEFT) {
    refuse_volume(file.path(), "the picture is turned",
                  fmt::format("its orientation is {}", orientation),
                  "Save it with rows from the top or from the bottom.");
  }
  check_dims({width, height, 1}, most_tiff_voxels(file, *type), file.path().string());
  check_places(file);
  return {static_cast<std::int32_t>(width), static_cast<std::int32_t>(height), *type};
}

TiffFrame describe_frame(const TiffFile& file) {
  TiffFrame frame;
  const std::string place = file.path().string();
  char* text = nullptr;
  if (TIFFGetField(file.get(), TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text != nullptr) {
    frame.description = parse_tiff_description(text);
  }
  const TiffDescription& said = frame.description;
  if (std::count_if(said.per_axis.begin(), said.per_axis.end(),
                    [](std::uint64_t count) { return count > 1; }) > 1) {
    refuse_volume(place, "the file holds several volumes whose slices alternate",
                  fmt::format("ImageJ counts {} channels, {} slices and {} frames",
                              said.per_axis[0], said.per_axis[1], said.per_axis[2]),
                  "Save one channel and one frame alone.");
  }
  // The dots per inch of picture programs have no meaning for a scan.
  const auto edge = [&](std::uint32_t tag) {
    const auto resolution = field<float>(file, tag);
    return resolution > 0 ? 1.0 / static_cast<double>(resolution) : 1.0;
  };
  if (said.by_imagej && (said.z_edge || !said.unit.empty())) {
    const double x = edge(TIFFTAG_XRESOLUTION);
    const auto unit = file_unit(said.unit);
    if (said.z_edge || unit) {
      set_spacing(frame.spacing, {x, edge(TIFFTAG_YRESOLUTION), said.z_edge.value_or(x)},
                  "ImageJ's description", place);
    }
    frame.spacing.unit = unit;
  } else if (said.x_edge && said.y_edge) {
    set_spacing(frame.spacing, {*said.x_edge, *said.y_edge, said.z_edge.value_or(*said.x_edge)},
                "OME's PhysicalSize", place);
    frame.spacing.unit = file_unit(said.unit);
  }
  return frame;
}

std::optional<std::uint64_t> place_of_plain_page(const TiffFile& file, bool& big_endian) {
  TIFF* const tiff = file.get();
  const bool plain =
      TIFFIsTiled(tiff) == 0 &&
      field<std::uint16_t>(file, TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE &&
      field<std::uint16_t>(file, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) == ORIENTATION_TOPLEFT;
  if (!plain) return std::nullopt;
  for (std::uint32_t strip = 1; strip < TIFFNumberOfStrips(tiff); ++strip) {
    if (TIFFGetStrileOffset(tiff, strip) !=
        TIFFGetStrileOffset(tiff, strip - 1) + TIFFGetStrileByteCount(tiff, strip - 1)) {
      return std::nullopt;
    }
  }
  big_endian = TIFFIsByteSwapped(tiff) != 0;  // this machine is little-endian
  return TIFFGetStrileOffset(tiff, 0);
}

void read_page(const TiffFile& file, const TiffPage& page, std::span<std::byte> bytes) {
  if (TIFFIsTiled(file.get()) != 0) {
    read_tiles(file, page, bytes);
  } else {
    read_strips(file, page, bytes);
  }
  if (field<std::uint16_t>(file, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) == ORIENTATION_BOTLEFT) {
    const auto row = [&](std::int32_t j) {
      return bytes.begin() +
             static_cast<std::ptrdiff_t>(static_cast<std::size_t>(j) * page.bytes_per_row());
    };
    for (std::int32_t j = 0; j < page.height / 2; ++j) {
      std::swap_ranges(row(j), row(j + 1), row(page.height - 1 - j));
    }
  }
}

}  // namespace reckon
