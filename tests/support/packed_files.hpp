// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tiffio.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace reckon::testing {

enum class Packing : std::uint8_t { zlib, gzip };

/// What zlib makes of bytes.
inline std::string packed(const std::string& plain, Packing packing) {
  ::z_stream stream{};
  constexpr int memory_level = 8;
  ::deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, packing == Packing::gzip ? 31 : 15,
                 memory_level, Z_DEFAULT_STRATEGY);
  std::string bytes(::deflateBound(&stream, plain.size()), '\0');
  std::string in = plain;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  ::deflate(&stream, Z_FINISH);
  bytes.resize(stream.total_out);
  ::deflateEnd(&stream);
  return bytes;
}

/// A volume's text header made to say that its numbers are packed, with them behind it.
inline std::string packed_metaimage(const std::string& header, const std::string& numbers) {
  constexpr std::string_view plain{"CompressedData = False"};
  std::string text = header;
  return text.replace(text.find(plain), plain.size(), "CompressedData = True") +
         packed(numbers, Packing::zlib);
}
inline std::string packed_nrrd(const std::string& header, const std::string& numbers) {
  constexpr std::string_view plain{"encoding: raw"};
  std::string text = header;
  return text.replace(text.find(plain), plain.size(), "encoding: gzip") +
         packed(numbers, Packing::gzip);
}

/// How a TIFF file is to be laid out; numbers of libtiff's header.
struct TiffLayout {
  int compression{COMPRESSION_LZW};
  int bits{8};
  int format{SAMPLEFORMAT_UINT};
  int meaning{PHOTOMETRIC_MINISBLACK};
  int orientation{ORIENTATION_TOPLEFT};
  std::uint32_t tile{0};  ///< its edge; 0: strips of two rows
  const char* mode{"w"};
  std::string description{};  ///< of each page; empty: none
  double pixels_per_unit{0};  ///< 0: not said
};

/// Pages of `width` x `height` numbers, as they lie in memory.
inline void write_tiff(const std::filesystem::path& file, const std::string& numbers,
                       std::uint32_t width, std::uint32_t height, const TiffLayout& layout) {
  TIFF* const tiff = TIFFOpen(file.c_str(), layout.mode);
  const std::size_t size = static_cast<std::size_t>(layout.bits) / 8;
  for (std::size_t at = 0; at < numbers.size(); at += size * width * height) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, layout.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, layout.format);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, layout.meaning);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, layout.orientation);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, layout.compression);
    if (!layout.description.empty()) {
      TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, layout.description.c_str());
    }
    if (layout.pixels_per_unit > 0) {
      TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
      TIFFSetField(tiff, TIFFTAG_XRESOLUTION, layout.pixels_per_unit);
      TIFFSetField(tiff, TIFFTAG_YRESOLUTION, layout.pixels_per_unit);
    }
    const auto bytes = [&](std::uint32_t x, std::uint32_t y) {
      return numbers.substr(at + size * (x + std::size_t{y} * width), size);
    };
    if (layout.tile == 0) {
      constexpr std::uint32_t rows = 2;
      TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, rows);
      for (std::uint32_t y = 0; y < height; y += rows) {
        std::string strip =
            numbers.substr(at + size * y * width, size * width * std::min(rows, height - y));
        TIFFWriteEncodedStrip(tiff, y / rows, strip.data(), static_cast<tmsize_t>(strip.size()));
      }
    } else {
      TIFFSetField(tiff, TIFFTAG_TILEWIDTH, layout.tile);
      TIFFSetField(tiff, TIFFTAG_TILELENGTH, layout.tile);
      for (std::uint32_t y = 0; y < height; y += layout.tile) {
        for (std::uint32_t x = 0; x < width; x += layout.tile) {
          std::string tile;
          for (std::uint32_t v = y; v < y + layout.tile; ++v) {
            for (std::uint32_t u = x; u < x + layout.tile; ++u) {
              tile += u < width && v < height ? bytes(u, v) : std::string(size, '\0');
            }
          }
          TIFFWriteTile(tiff, tile.data(), x, y, 0, 0);
        }
      }
    }
    TIFFWriteDirectory(tiff);
  }
  TIFFClose(tiff);
}

/// A stack as ImageJ writes those that plain TIFF could not hold: the directory of the first image
/// alone, and all images of bytes behind it. `edge`: of a pixel, in the description's unit.
inline std::string imagej_stack(const std::string& numbers, std::uint32_t width,
                                std::uint32_t height, const std::string& description,
                                std::uint32_t edge, bool big_endian) {
  constexpr std::uint16_t text = 2;
  constexpr std::uint16_t short_number = 3;
  constexpr std::uint16_t long_number = 4;
  constexpr std::uint16_t ratio = 5;
  std::string bytes = big_endian ? "MM" : "II";
  const auto put = [&](std::uint32_t value, int size) {
    for (int n = 0; n < size; ++n) {
      const int shift = 8 * (big_endian ? size - 1 - n : n);
      bytes += static_cast<char>((value >> static_cast<unsigned>(shift)) & 255U);
    }
  };
  constexpr std::uint32_t entries = 11;
  const std::uint32_t behind = 8 + 2 + 12 * entries + 4;
  const auto length = static_cast<std::uint32_t>(description.size() + 1);
  const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t count,
                         std::uint32_t value) {
    put(tag, 2);
    put(type, 2);
    put(count, 4);
    put(value, type == short_number ? 2 : 4);
    if (type == short_number) put(0, 2);
  };
  put(42, 2);
  put(8, 4);
  put(entries, 2);
  entry(256, long_number, 1, width);
  entry(257, long_number, 1, height);
  entry(258, short_number, 1, 8);
  entry(259, short_number, 1, 1);
  entry(262, short_number, 1, 1);
  entry(270, text, length, behind + 8);
  entry(273, long_number, 1, behind + 8 + length);
  entry(278, long_number, 1, height);
  entry(279, long_number, 1, width * height);
  entry(282, ratio, 1, behind);
  entry(283, ratio, 1, behind);
  put(0, 4);
  put(1, 4);
  put(edge, 4);
  return bytes + description + '\0' + numbers;
}

}  // namespace reckon::testing
