// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <tiffio.h>

#include <string>
#include <utility>
#include <vector>

#include "reckon/core/file.hpp"
#include "reckon/scan/byte_layers.hpp"
#include "reckon/scan/slice_order.hpp"
#include "reckon/scan/tiff_file.hpp"

namespace reckon {
namespace {

constexpr bool numbers_big_endian = false;  // the library turns them as this machine has them

VolumeOutline stack_of(const TiffPage& page, std::size_t count, const TiffFrame& frame) {
  return {{page.width, page.height, static_cast<std::int32_t>(count)},
          page.type,
          frame.spacing,
          frame.remarks};
}

/// All slices behind the first, of which alone the file has a directory: how ImageJ stores stacks
/// that plain TIFF could not hold.
std::unique_ptr<VolumeReader> open_one_directory(const TiffFile& file, const TiffPage& page,
                                                 const TiffFrame& frame) {
  VolumeHeader header;
  const auto place = place_of_plain_page(file, header.big_endian);
  const std::string name = file.path().string();
  if (!place || frame.description.images > 2147483647) {
    refuse_volume(name, "the file's slices are not found",
                  fmt::format("ImageJ counts {} images, but there is one page, which is compressed "
                              "or in pieces",
                              frame.description.images),
                  "Save the stack anew.");
  }
  header.dims = {page.width, page.height, static_cast<std::int64_t>(frame.description.images)};
  header.type = page.type;
  header.spacing = frame.spacing;
  header.data_start = *place;
  header.may_go_on = true;
  return open_plain_volume(std::make_shared<const ByteFile>(file.path()), header);
}

void check_same(const TiffPage& page, const TiffPage& first, const std::filesystem::path& file,
                const std::string& name) {
  if (page == first) return;
  refuse_volume(
      file, "the slices of the stack differ",
      fmt::format("{} has {} x {} pixels of {}, the first {} x {} of {}", name, page.width,
                  page.height, name_of(page.type), first.width, first.height, name_of(first.type)),
      "Give one stack only, with slices of one size and type.");
}

/// The pages of a file. All are looked at before the first is read.
class TiffStack : public ByteLayers {
 public:
  [[nodiscard]] static std::unique_ptr<VolumeReader> open(const std::filesystem::path& path) {
    TiffFile file{path};
    const TiffPage first = describe_page(file);
    TiffFrame frame = describe_frame(file);
    std::vector<std::uint64_t> places{TIFFCurrentDirOffset(file.get())};
    while (TIFFLastDirectory(file.get()) == 0) {
      file.require(TIFFReadDirectory(file.get()) == 1, TiffFile::damaged);
      places.push_back(TIFFCurrentDirOffset(file.get()));
      check_same(describe_page(file), first, path, fmt::format("page {}", places.size()));
    }
    const std::uint64_t images = frame.description.images;
    if (places.size() == 1 && images > 1) return open_one_directory(file, first, frame);
    if (images > 0 && images != places.size()) {
      frame.remarks.push_back(
          fmt::format("ImageJ's description counts {} images, the file has {} "
                      "pages, which are read",
                      images, places.size()));
    }
    if (places.size() == 1) {
      refuse_volume(path, "the file has one slice only", "a volume has several",
                    "Give a file of several pages, or a folder of slices.");
    }
    check_dims({first.width, first.height, static_cast<std::int64_t>(places.size())},
               most_tiff_voxels(file, first.type), path.string());
    return std::unique_ptr<VolumeReader>{
        new TiffStack{std::move(file), first, std::move(places), frame}};
  }

 private:
  TiffStack(TiffFile&& file, const TiffPage& page, std::vector<std::uint64_t>&& places,
            const TiffFrame& frame)
      : ByteLayers{stack_of(page, places.size(), frame), numbers_big_endian},
        file_{std::move(file)},
        page_{page},
        places_{std::move(places)} {}

  void read_layer(std::int32_t k, std::span<std::byte> bytes) override {
    file_.require(TIFFSetSubDirectory(file_.get(), places_[static_cast<std::size_t>(k)]) == 1,
                  TiffFile::damaged);
    read_page(file_, page_, bytes);
  }

  TiffFile file_;
  TiffPage page_;
  std::vector<std::uint64_t> places_;
};

/// Files of one page each. All are looked at before the first is read.
class TiffSlices : public ByteLayers {
 public:
  explicit TiffSlices(SliceOrder order)
      : ByteLayers{stack_of(only_page(order.files.front()), order.files.size(),
                            describe_frame(TiffFile{order.files.front()})),
                   numbers_big_endian},
        files_{std::move(order.files)} {
    outline.remarks.insert(outline.remarks.end(), order.remarks.begin(), order.remarks.end());
    const TiffPage first{outline.dims[0], outline.dims[1], outline.type};
    for (const std::filesystem::path& file : files_) {
      check_same(only_page(file), first, file, "this one");
    }
  }

 private:
  static TiffPage only_page(const std::filesystem::path& path) {
    const TiffFile file{path};
    if (TIFFLastDirectory(file.get()) == 0) {
      refuse_volume(path, "the file has several pages",
                    "it lies in a folder of slices, which have one each",
                    "Name the file itself if it is the volume.");
    }
    return describe_page(file);
  }

  void read_layer(std::int32_t k, std::span<std::byte> bytes) override {
    const TiffFile file{files_[static_cast<std::size_t>(k)]};
    read_page(file, {outline.dims[0], outline.dims[1], outline.type}, bytes);
  }

  std::vector<std::filesystem::path> files_;
};

/// Pages of one strip each.
class TiffWriter : public VolumeWriter {
 public:
  TiffWriter(const std::filesystem::path& file, const VolumeOutline& what)
      : pending_{file}, what_{what} {
    // Places in a plain TIFF have 32 bits.
    const bool big = Box{what.dims}.voxels() * size_of(what.type) > 4000000000U;
    tiff_ = std::make_unique<TiffFile>(pending_.temporary(), big ? "w8" : "w", file);
  }

  void write_layers(const GrayVolume& layers) override {
    std::string bytes = encode_numbers(layers.values, what_.type);
    record_.add(bytes);
    const std::size_t page = bytes.size() / static_cast<std::size_t>(layers.dims[2]);
    for (std::size_t at = 0; at < bytes.size(); at += page) {
      set_fields();
      const auto size = static_cast<tmsize_t>(page);
      if (TIFFWriteEncodedStrip(tiff_->get(), 0, bytes.data() + at, size) != size ||
          TIFFWriteDirectory(tiff_->get()) != 1) {
        refuse_unwritten(pending_.target());
      }
    }
  }
  void finish() override {
    if (TIFFFlush(tiff_->get()) != 1) refuse_unwritten(pending_.target());
    tiff_.reset();
    record_.compare(what_, pending_.target(), [&]() -> std::unique_ptr<VolumeReader> {
      const std::filesystem::path& file = pending_.temporary();
      if (what_.dims[2] > 1) return TiffStack::open(file);
      return std::make_unique<TiffSlices>(SliceOrder{{file}, {}});
    });
    pending_.commit();
  }

 private:
  void set_fields() {
    TIFF* const tiff = tiff_->get();
    const VoxelType type = what_.type;
    const bool is_float = type == VoxelType::float32 || type == VoxelType::float64;
    const bool is_signed =
        type == VoxelType::int8 || type == VoxelType::int16 || type == VoxelType::int32;
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, what_.dims[0]);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, what_.dims[1]);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, what_.dims[1]);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * size_of(type)));
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT,
                 is_float    ? SAMPLEFORMAT_IEEEFP
                 : is_signed ? SAMPLEFORMAT_INT
                             : SAMPLEFORMAT_UINT);
  }

  PendingFile pending_;
  VolumeOutline what_;
  LayerRecord record_;
  std::unique_ptr<TiffFile> tiff_;
};

}  // namespace

std::unique_ptr<VolumeWriter> create_tiff_volume(const std::filesystem::path& file,
                                                 const VolumeOutline& what) {
  return std::make_unique<TiffWriter>(file, what);
}

std::unique_ptr<VolumeReader> open_tiff_volume(const std::filesystem::path& file) {
  return TiffStack::open(file);
}

std::unique_ptr<VolumeReader> open_tiff_slices(std::vector<std::filesystem::path> files,
                                               const std::string& folder) {
  return std::make_unique<TiffSlices>(order_slices(std::move(files), folder));
}

}  // namespace reckon
