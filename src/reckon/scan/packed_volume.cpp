// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <string>
#include <utility>

#include "reckon/scan/byte_layers.hpp"

namespace reckon {
namespace {

/// Unpacks what zlib or gzip packed (RFC 1950, 1952), from its first byte to its last. The format
/// tells itself. A gzip file may have several members, one behind the other.
class Inflater {
 public:
  Inflater(std::shared_ptr<const ByteFile> file, std::uint64_t start)
      : file_{std::move(file)}, start_{start}, next_{start} {
    constexpr int largest_window = 15;
    constexpr int either_format = 32;
    if (::inflateInit2(&stream_, largest_window + either_format) != Z_OK) throw std::bad_alloc{};
  }
  ~Inflater() { ::inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Fills `bytes`; returns how many there were before the end. Throws Error when they are damaged
  /// or cut short.
  [[nodiscard]] std::size_t read(std::span<std::byte> bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      if (stream_.avail_in == 0) refill();
      if (ended_ && stream_.avail_in == 0) break;
      if (std::exchange(ended_, false)) ::inflateReset(&stream_);
      const std::size_t room = std::min(bytes.size() - done, std::size_t{1} << 30U);
      stream_.next_out = reinterpret_cast<Bytef*>(bytes.data() + done);
      stream_.avail_out = static_cast<uInt>(room);
      const int code = ::inflate(&stream_, Z_NO_FLUSH);
      done += room - stream_.avail_out;
      unpacked_ += room - stream_.avail_out;
      ended_ = code == Z_STREAM_END;
      if (code == Z_BUF_ERROR) fail("is cut short", "the file ends before they do");
      if (code != Z_OK && !ended_) {
        fail("is damaged", stream_.msg != nullptr ? stream_.msg : ::zError(code));
      }
    }
    return done;
  }

  void restart() {
    ::inflateReset(&stream_);
    stream_.avail_in = 0;
    next_ = start_;
    unpacked_ = 0;
    ended_ = false;
  }

  [[noreturn]] void fail(const std::string& problem, const std::string& reason) const {
    refuse_volume(file_->path().string(), "the file " + problem,
                  fmt::format("its numbers are packed; {}, at byte {} of the file, {} bytes having "
                              "been unpacked before",
                              reason, next_ - stream_.avail_in, unpacked_),
                  "Copy it again, or correct its header.");
  }

 private:
  void refill() {
    const std::uint64_t left = file_->size() - std::min(file_->size(), next_);
    const std::size_t count = std::min<std::uint64_t>(left, buffer_.size());
    file_->read(next_, std::span{buffer_}.first(count));
    next_ += count;
    stream_.next_in = reinterpret_cast<Bytef*>(buffer_.data());
    stream_.avail_in = static_cast<uInt>(count);
  }

  std::shared_ptr<const ByteFile> file_;
  std::uint64_t start_;
  std::uint64_t next_;  // byte of the file that follows the buffer
  std::uint64_t unpacked_{0};
  std::array<std::byte, 65536> buffer_{};
  ::z_stream stream_{};
  bool ended_{false};
};

/// Layers are unpacked one after the other; to go back, unpacking starts again.
class PackedVolume : public ByteLayers {
 public:
  PackedVolume(std::shared_ptr<const ByteFile> file, const VolumeHeader& header)
      : ByteLayers{outline_of(header), header.big_endian},
        stream_{std::move(file), header.data_start} {}

 private:
  void read_layer(std::int32_t k, std::span<std::byte> bytes) override {
    if (k < next_layer_) {
      stream_.restart();
      next_layer_ = 0;
    }
    for (; next_layer_ <= k; ++next_layer_) {
      if (stream_.read(bytes) == bytes.size()) continue;
      stream_.fail("and its header disagree",
                   fmt::format("they end in layer {} of {}", next_layer_ + 1, outline.dims[2]));
    }
    if (next_layer_ < outline.dims[2]) return;
    std::array<std::byte, 1> more{};  // also verifies the checksum at the end
    if (stream_.read(more) > 0) {
      stream_.fail("and its header disagree",
                   fmt::format("they go on behind the {} layers", outline.dims[2]));
    }
  }

  Inflater stream_;
  std::int32_t next_layer_{0};
};

}  // namespace

std::unique_ptr<VolumeReader> open_packed_volume(std::shared_ptr<const ByteFile> file,
                                                 const VolumeHeader& header) {
  constexpr std::uint64_t most_compression = 1032;  // of the method, "deflate"
  const std::uint64_t packed = file->size() - std::min(file->size(), header.data_start);
  check_dims(header.dims, packed * most_compression / size_of(header.type), file->path().string());
  return std::make_unique<PackedVolume>(std::move(file), header);
}

}  // namespace reckon
