// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <itkImageFileWriter.h>
#include <itkPNGImageIO.h>
#include <itkRGBPixel.h>

#include "reckon/core/file.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/itk_bridge.hpp"

namespace reckon {

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
