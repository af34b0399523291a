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

}  // namespace reckon::testing
