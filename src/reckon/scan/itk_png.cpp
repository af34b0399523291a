// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <itkImageFileReader.h>
#include <itkImageFileWriter.h>
#include <itkPNGImageIO.h>
#include <itkRGBPixel.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "reckon/core/file.hpp"
#include "reckon/core/write_failure.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/itk_bridge.hpp"

namespace reckon {
namespace {

using Pixel = itk::RGBPixel<std::uint8_t>;
using Picture = itk::Image<Pixel, 2>;

Picture::Pointer make_picture(std::int32_t width, std::int32_t height,
                              const std::vector<std::uint8_t>& rgb) {
  auto picture = Picture::New();
  Picture::SizeType size;
  size[0] = static_cast<itk::SizeValueType>(width);
  size[1] = static_cast<itk::SizeValueType>(height);
  picture->SetRegions(size);
  picture->Allocate();
  for (std::size_t p = 0; p < rgb.size() / 3; ++p) {
    for (unsigned c = 0; c < 3; ++c) picture->GetBufferPointer()[p][c] = rgb[3 * p + c];
  }
  return picture;
}

void write(const Picture::Pointer& picture, const std::filesystem::path& file) {
  auto writer = itk::ImageFileWriter<Picture>::New();
  writer->SetInput(picture);
  writer->SetImageIO(itk::PNGImageIO::New());
  writer->SetFileName(file);
  writer->Update();
}

/// The library does not report every failure to write.
bool holds(const std::filesystem::path& file, const Picture::Pointer& picture) {
  try {
    auto reader = itk::ImageFileReader<Picture>::New();
    reader->SetImageIO(itk::PNGImageIO::New());
    reader->SetFileName(file);
    reader->Update();
    const auto found = reader->GetOutput();
    const auto region = picture->GetLargestPossibleRegion();
    return found->GetLargestPossibleRegion() == region &&
           std::equal(picture->GetBufferPointer(),
                      picture->GetBufferPointer() + region.GetNumberOfPixels(),
                      found->GetBufferPointer());
  } catch (const itk::ExceptionObject&) {
    return false;
  }
}

}  // namespace

void write_png(const std::filesystem::path& file, std::int32_t width, std::int32_t height,
               const std::vector<std::uint8_t>& rgb) {
  PendingFile pending{file};
  // The library goes by the ending of a name.
  const std::filesystem::path with_ending = pending.temporary().string() + ".png";
  std::error_code failure;
  try {
    with_itk(file.string(), [&] {
      const Picture::Pointer picture = make_picture(width, height, rgb);
      write(picture, with_ending);
      if (!holds(with_ending, picture)) throw_write_failure(file, 0);
    });
    std::filesystem::rename(with_ending, pending.temporary());
    pending.commit();
  } catch (...) {
    std::filesystem::remove(with_ending, failure);
    throw;
  }
}

}  // namespace reckon
