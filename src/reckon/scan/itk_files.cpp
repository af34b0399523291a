// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <itkImageFileReader.h>
#include <itkImageFileWriter.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkPNGImageIO.h>
#include <itkRGBPixel.h>
#include <itkTIFFImageIO.h>

#include <utility>

#include "reckon/avatar/text_reader.hpp"
#include "reckon/core/file.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/itk_bridge.hpp"
#include "reckon/scan/volume_formats.hpp"

namespace reckon {
namespace {

/// Chosen by ourselves: the toolkit's way to find formats needs factories registered at start.
itk::ImageIOBase::Pointer format_of(const std::filesystem::path& file) {
  const std::string ending = lower_case(file.extension().string());
  if (ending == ".mha" || ending == ".mhd") return itk::MetaImageIO::New().GetPointer();
  if (ending == ".nrrd" || ending == ".nhdr") return itk::NrrdImageIO::New().GetPointer();
  return itk::TIFFImageIO::New().GetPointer();
}

VoxelType type_of(itk::IOComponentEnum component) {
  switch (component) {
    case itk::IOComponentEnum::UCHAR:
      return VoxelType::uint8;
    case itk::IOComponentEnum::CHAR:
      return VoxelType::int8;
    case itk::IOComponentEnum::USHORT:
      return VoxelType::uint16;
    case itk::IOComponentEnum::SHORT:
      return VoxelType::int16;
    case itk::IOComponentEnum::UINT:
    case itk::IOComponentEnum::ULONG:
    case itk::IOComponentEnum::ULONGLONG:
      return VoxelType::uint32;
    case itk::IOComponentEnum::INT:
    case itk::IOComponentEnum::LONG:
    case itk::IOComponentEnum::LONGLONG:
      return VoxelType::int32;
    case itk::IOComponentEnum::FLOAT:
      return VoxelType::float32;
    default:
      return VoxelType::float64;
  }
}

/// Reads a header and compares what it announces with the file's length, so that a damaged header
/// does not ask for memory that no file could fill. Compressed data are at most so many times
/// smaller.
void inspect(itk::ImageIOBase& io, const std::filesystem::path& file, unsigned dimensions) {
  constexpr std::uint64_t most_compression = 2000;
  if (dynamic_cast<itk::TIFFImageIO*>(&io) != nullptr) (void)read_tiff_pages(file);
  if (!io.CanReadFile(file.c_str())) {
    refuse_volume(file, "the file is not what its name says",
                  "its header is damaged or of another kind",
                  "Copy it again, or give it the right ending.");
  }
  io.SetFileName(file);
  io.ReadImageInformation();
  if (io.GetNumberOfDimensions() != dimensions) {
    refuse_volume(file, fmt::format("the file has {} dimensions", io.GetNumberOfDimensions()),
                  fmt::format("{} are needed", dimensions),
                  "Give a volume, or a folder of slices for one.");
  }
  if (io.GetNumberOfComponents() != 1) {
    refuse_volume(file, "the file holds colours or vectors",
                  fmt::format("{} numbers a voxel", io.GetNumberOfComponents()),
                  "Save it in shades of gray.");
  }
  std::array<std::int64_t, 3> dims{1, 1, 1};
  for (unsigned axis = 0; axis < dimensions; ++axis) {
    dims[axis] = static_cast<std::int64_t>(io.GetDimensions(axis));
  }
  const bool data_elsewhere = lower_case(file.extension().string()) == ".mhd" ||
                              lower_case(file.extension().string()) == ".nhdr";
  const std::uint64_t bytes =
      data_elsewhere ? std::uint64_t{1} << 40U : std::filesystem::file_size(file);
  check_dims(dims, bytes * most_compression / io.GetComponentSize() + 1, file.string());
}

template <unsigned dimensions>
typename itk::Image<float, dimensions>::Pointer read_image(itk::ImageIOBase::Pointer io,
                                                           const std::filesystem::path& file) {
  auto reader = itk::ImageFileReader<itk::Image<float, dimensions>>::New();
  reader->SetImageIO(std::move(io));
  reader->SetFileName(file);
  reader->Update();
  return reader->GetOutput();
}

class UnpackedVolume : public VolumeReader {
 public:
  UnpackedVolume(const VolumeOutline& what, ItkImage<float>::Pointer image)
      : image_{std::move(image)} {
    outline = what;
  }
  GrayVolume read_layers(std::int32_t first, std::int32_t count) override {
    GrayVolume layers{Box{{0, 0, first}, {outline.dims[0], outline.dims[1], count}}, 0};
    const std::size_t pixels = layers.index(0, 0, first + 1);
    std::copy_n(image_->GetBufferPointer() + static_cast<std::size_t>(first) * pixels,
                layers.values.size(), layers.values.begin());
    return layers;
  }

 private:
  ItkImage<float>::Pointer image_;
};

/// TIFF files of one slice each. All are looked at before the first is read.
class SliceFiles : public VolumeReader {
 public:
  explicit SliceFiles(std::vector<std::filesystem::path> files) : files_{std::move(files)} {
    for (const std::filesystem::path& file : files_) {
      const VolumeOutline slice = outline_of(file);
      if (&file == &files_.front()) outline = slice;
      if (slice.dims == outline.dims && slice.type == outline.type) continue;
      refuse_volume(file, "the slices of the stack differ",
                    fmt::format("this one has {} x {} pixels of {}, the first {} x {} of {}",
                                slice.dims[0], slice.dims[1], name_of(slice.type), outline.dims[0],
                                outline.dims[1], name_of(outline.type)),
                    "Leave one stack only in the folder.");
    }
    outline.dims[2] = static_cast<std::int32_t>(files_.size());
  }

  GrayVolume read_layers(std::int32_t first, std::int32_t count) override {
    GrayVolume layers{Box{{0, 0, first}, {outline.dims[0], outline.dims[1], count}}, 0};
    const std::size_t pixels = layers.index(0, 0, first + 1);
    for (std::int32_t k = first; k < first + count; ++k) {
      const std::filesystem::path& file = files_[static_cast<std::size_t>(k)];
      with_itk(file.string(), [&] {
        const auto slice = read_image<2>(itk::TIFFImageIO::New().GetPointer(), file);
        std::copy_n(slice->GetBufferPointer(), pixels,
                    layers.values.begin() + static_cast<std::ptrdiff_t>(layers.index(0, 0, k)));
      });
    }
    return layers;
  }

 private:
  static VolumeOutline outline_of(const std::filesystem::path& file) {
    return with_itk(file.string(), [&] {
      const itk::ImageIOBase::Pointer io = itk::TIFFImageIO::New().GetPointer();
      inspect(*io, file, 2);
      return VolumeOutline{{static_cast<std::int32_t>(io->GetDimensions(0)),
                            static_cast<std::int32_t>(io->GetDimensions(1)), 1},
                           type_of(io->GetComponentType()),
                           {}};
    });
  }

  std::vector<std::filesystem::path> files_;
};

template <class Number>
void write_numbers(const std::filesystem::path& file, const GrayVolume& volume, VoxelType type,
                   itk::ImageIOBase::Pointer io) {
  const std::string bytes = encode_numbers(volume.values, type);
  auto image = to_image<Number>(volume);
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(image->GetBufferPointer()));
  typename ItkImage<Number>::SpacingType millimetres;
  millimetres.Fill(1e3 * volume.voxel);
  image->SetSpacing(millimetres);
  auto writer = itk::ImageFileWriter<ItkImage<Number>>::New();
  writer->SetInput(image);
  writer->SetImageIO(std::move(io));
  writer->SetFileName(file);
  writer->UseCompressionOff();
  writer->Update();
}

}  // namespace

std::unique_ptr<VolumeReader> unpack_itk_volume(const std::filesystem::path& file,
                                                std::uint64_t memory) {
  return with_itk(file.string(), [&] {
    const itk::ImageIOBase::Pointer io = format_of(file);
    inspect(*io, file, 3);
    VolumeOutline outline;
    for (unsigned axis = 0; axis < 3; ++axis) {
      outline.dims[axis] = static_cast<std::int32_t>(io->GetDimensions(axis));
    }
    outline.type = type_of(io->GetComponentType());
    // A TIFF's resolution is about printing.
    const bool tiff = dynamic_cast<itk::TIFFImageIO*>(io.GetPointer()) != nullptr;
    if (!tiff) {
      const double spacing = io->GetSpacing(0);
      for (unsigned axis = 1; axis < 3; ++axis) {
        if (!(std::abs(io->GetSpacing(axis) / spacing - 1) < 1e-3)) {
          refuse_volume(file, "the voxels are not cubes",
                        fmt::format("their edges are {}, {} and {}", spacing, io->GetSpacing(1),
                                    io->GetSpacing(2)),
                        "Resample the volume to cubic voxels.");
        }
      }
      outline.spacing = spacing;
    }
    const std::uint64_t bytes =
        Box{outline.dims}.voxels() * (sizeof(float) + size_of(outline.type));
    if (memory > 0 && bytes > memory) {
      refuse_volume(
          file, "the file is compressed, and unpacked it does not fit into memory",
          fmt::format("it would take {} bytes, {} are allowed", bytes, memory),
          "Save it without compression or as a folder of slices, or allow more --memory.");
    }
    return std::unique_ptr<VolumeReader>{
        std::make_unique<UnpackedVolume>(outline, read_image<3>(io, file))};
  });
}

std::unique_ptr<VolumeReader> open_itk_slices(const std::vector<std::filesystem::path>& files) {
  return std::make_unique<SliceFiles>(files);
}

void write_itk_volume(const std::filesystem::path& file, const GrayVolume& volume, VoxelType type) {
  // The toolkit knows a format by the ending, which a temporary name lacks.
  const PendingFile pending{file};  // finds a missing folder
  const std::filesystem::path temporary =
      file.parent_path() / (".writing-" + file.filename().string());
  with_itk(file.string(), [&] {
    const itk::ImageIOBase::Pointer io = format_of(file);
    switch (type) {
      case VoxelType::uint8:
        return write_numbers<std::uint8_t>(temporary, volume, type, io);
      case VoxelType::uint16:
        return write_numbers<std::uint16_t>(temporary, volume, type, io);
      case VoxelType::float32:
        return write_numbers<float>(temporary, volume, type, io);
      default:
        refuse_volume(file, fmt::format("numbers of type {} are not written here", name_of(type)),
                      "this format gets uint8, uint16 or float32", "Choose one of these.");
    }
  });
  std::filesystem::rename(temporary, file);
}

void write_png(const std::filesystem::path& file, std::int32_t width, std::int32_t height,
               const std::vector<std::uint8_t>& rgb) {
  const PendingFile pending{file};
  const std::filesystem::path temporary =
      file.parent_path() / (".writing-" + file.filename().string());
  with_itk(file.string(), [&] {
    using Image = itk::Image<itk::RGBPixel<std::uint8_t>, 2>;
    auto image = Image::New();
    Image::SizeType size;
    size[0] = static_cast<itk::SizeValueType>(width);
    size[1] = static_cast<itk::SizeValueType>(height);
    image->SetRegions(size);
    image->Allocate();
    for (std::size_t p = 0; p < rgb.size() / 3; ++p) {
      for (unsigned c = 0; c < 3; ++c) image->GetBufferPointer()[p][c] = rgb[3 * p + c];
    }
    auto writer = itk::ImageFileWriter<Image>::New();
    writer->SetInput(image);
    writer->SetImageIO(itk::PNGImageIO::New());
    writer->SetFileName(temporary);
    writer->Update();
  });
  std::filesystem::rename(temporary, file);
}

}  // namespace reckon
