// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <utility>

#include "reckon/avatar/byte_reader.hpp"
#include "reckon/scan/volume_formats.hpp"

namespace reckon {
namespace {

[[noreturn]] void fail_cut_short(const std::filesystem::path& file, std::string reason) {
  refuse_volume(file, "the file is cut short or damaged", std::move(reason), "Copy it again.");
}

/// Reads pieces of a TIFF file by their places.
class TiffFile {
 public:
  explicit TiffFile(const std::filesystem::path& path)
      : path_{path}, size_{std::filesystem::file_size(path)}, stream_{path, std::ios::binary} {
    const std::string head = bytes(0, 8);
    if (!head.starts_with("II") && !head.starts_with("MM")) {
      refuse_volume(path, "this is no TIFF file", "it begins with neither II nor MM",
                    "Check its name.");
    }
    order_ = head[0] == 'I' ? ByteReader::Order::little_endian : ByteReader::Order::big_endian;
    big_ = number(2, 2) == 43;
  }

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] bool big() const { return big_; }
  [[nodiscard]] bool big_endian() const { return order_ == ByteReader::Order::big_endian; }
  [[nodiscard]] std::uint64_t number(std::uint64_t offset, std::size_t length) {
    const std::string text = bytes(offset, length);
    return ByteReader{text, path_.string(), order_}.unsigned_integer(length);
  }

 private:
  std::string bytes(std::uint64_t offset, std::size_t length) {
    if (offset > size_ || length > size_ - offset) {
      fail_cut_short(path_, fmt::format("byte {} is beyond its end", offset + length));
    }
    std::string text(length, '\0');
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(text.data(), static_cast<std::streamsize>(length));
    return text;
  }

  const std::filesystem::path& path_;
  std::uint64_t size_;
  std::ifstream stream_;
  ByteReader::Order order_{ByteReader::Order::little_endian};
  bool big_{false};
};

/// What a page's directory says that matters here.
struct TiffPage {
  std::uint64_t width{0};
  std::uint64_t height{0};
  std::uint64_t next{0};        // the next page's directory; 0: none
  std::uint64_t data_start{0};  // of the first strip or tile
  std::uint64_t data_end{0};    // of the last one
  std::uint64_t bits{1};        // of a number
  std::uint64_t format{1};      // 1: unsigned, 2: signed, 3: float
  bool plain{true};             // black is 0, one number a pixel, rows from the top, not compressed

  /// Numbers that lie in the file as in memory; which strips they are cut into does not matter.
  [[nodiscard]] std::optional<VoxelType> plain_type() const {
    if (!plain || width * height > data_end) return std::nullopt;
    if (data_end - data_start != width * height * bits / 8) return std::nullopt;
    if (format == 3) {
      return bits == 32 ? std::optional{VoxelType::float32} : std::nullopt;
    }
    if (bits == 8) return format == 2 ? VoxelType::int8 : VoxelType::uint8;
    if (bits == 16) return format == 2 ? VoxelType::int16 : VoxelType::uint16;
    return std::nullopt;
  }
};

constexpr std::uint64_t tag_width = 256;
constexpr std::uint64_t tag_height = 257;
constexpr std::uint64_t tag_bits = 258;
constexpr std::uint64_t tag_compression = 259;
constexpr std::uint64_t tag_photometric = 262;
constexpr std::uint64_t tag_strip_offsets = 273;
constexpr std::uint64_t tag_orientation = 274;
constexpr std::uint64_t tag_samples = 277;
constexpr std::uint64_t tag_strip_sizes = 279;
constexpr std::uint64_t tag_tile_offsets = 324;
constexpr std::uint64_t tag_tile_sizes = 325;
constexpr std::uint64_t tag_format = 339;

std::size_t size_of_type(std::uint64_t type) {
  return type == 3 ? 2 : type == 16 || type == 17 || type == 18 ? 8 : type == 1 ? 1 : 4;
}

TiffPage read_page(TiffFile& file, std::uint64_t directory) {
  const std::size_t word = file.big() ? 8 : 4;
  const std::size_t entry_size = 4 + 2 * word;
  const std::size_t count_size = file.big() ? 8 : 2;
  const std::uint64_t entries = file.number(directory, count_size);
  TiffPage page;
  // The last values of the lists of offsets and sizes: that strip ends the page's data.
  std::uint64_t last_offset = 0;
  std::uint64_t last_size = 0;
  for (std::uint64_t e = 0; e < entries; ++e) {
    const std::uint64_t at = directory + count_size + e * entry_size;
    const std::uint64_t tag = file.number(at, 2);
    const std::size_t length = size_of_type(file.number(at + 2, 2));
    const std::uint64_t count = std::min(file.number(at + 4, word), file.size());
    const bool inside = count * length <= word;
    const std::uint64_t values = inside ? at + 4 + word : file.number(at + 4 + word, word);
    const auto last = [&] {
      return file.number(values + (std::max<std::uint64_t>(count, 1) - 1) * length, length);
    };
    if (tag == tag_width) page.width = last();
    if (tag == tag_height) page.height = last();
    if (tag == tag_strip_offsets || tag == tag_tile_offsets) {
      page.data_start = file.number(values, length);
      last_offset = last();
    }
    if (tag == tag_bits) page.bits = last();
    if (tag == tag_format) page.format = last();
    const bool is_one = tag == tag_compression || tag == tag_photometric ||
                        tag == tag_orientation || tag == tag_samples;
    if (is_one && last() != 1) page.plain = false;
    if (tag == tag_tile_offsets) page.plain = false;
    if (tag == tag_strip_sizes || tag == tag_tile_sizes) last_size = last();
  }
  page.next = file.number(directory + count_size + entries * entry_size, word);
  page.data_end = last_offset + last_size;
  return page;
}

}  // namespace

TiffPages read_tiff_pages(const std::filesystem::path& path) {
  TiffFile file{path};
  std::uint64_t directory = file.big() ? file.number(8, 8) : file.number(4, 4);
  std::optional<TiffPage> first;
  TiffPages pages;
  bool plain = true;
  while (directory != 0) {
    const TiffPage page = read_page(file, directory);
    ++pages.count;
    if (!first) first = page;
    if (page.width != first->width || page.height != first->height) {
      refuse_volume(path, "the pages of the stack differ in size",
                    fmt::format("page {} has {} x {} pixels, the first {} x {}", pages.count,
                                page.width, page.height, first->width, first->height),
                    "Give a stack whose slices all have one size.");
    }
    if (page.data_end > file.size()) {
      fail_cut_short(path, fmt::format("page {} ends at byte {}, the file at {}", pages.count,
                                       page.data_end, file.size()));
    }
    if (pages.count > file.size() / 16) {
      fail_cut_short(path, "its pages follow each other in a circle");
    }
    const auto type = page.plain_type();
    plain &= type && type == first->plain_type();
    pages.layer_starts.push_back(page.data_start);
    directory = page.next;
  }
  if (pages.count == 0) fail_cut_short(path, "it has no pages");
  if (!plain) {
    pages.layer_starts.clear();
    return pages;
  }
  pages.header.type = *first->plain_type();
  pages.header.big_endian = file.big_endian();
  pages.header.dims = {static_cast<std::int64_t>(first->width),
                       static_cast<std::int64_t>(first->height),
                       static_cast<std::int64_t>(pages.count)};
  check_dims(pages.header.dims, file.size(), path.string());
  return pages;
}

}  // namespace reckon
