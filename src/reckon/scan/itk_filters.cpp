// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <itkBinaryBallStructuringElement.h>
#include <itkBinaryFillholeImageFilter.h>
#include <itkBinaryMorphologicalOpeningImageFilter.h>
#include <itkCurvatureAnisotropicDiffusionImageFilter.h>
#include <itkMedianImageFilter.h>
#include <itkOtsuThresholdCalculator.h>

#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/itk_bridge.hpp"

namespace reckon {
namespace {

constexpr std::size_t bins = 256;

}  // namespace

bool has_ct_component() { return true; }
void require_ct_component() {}

GrayVolume curvature_diffused(const GrayVolume& gray, std::uint32_t iterations,
                              double conductance) {
  return with_itk("denoise", [&] {
    using Filter = itk::CurvatureAnisotropicDiffusionImageFilter<ItkImage<float>, ItkImage<float>>;
    auto filter = Filter::New();
    filter->SetInput(to_image<float>(gray));
    filter->SetNumberOfIterations(iterations);
    filter->SetTimeStep(0.0625);  // the largest that is stable in three dimensions
    filter->SetConductanceParameter(conductance);
    filter->Update();
    return from_image<float>(*filter->GetOutput(), gray.voxel);
  });
}

GrayVolume median_filtered(const GrayVolume& gray) {
  return with_itk("denoise", [&] {
    auto filter = itk::MedianImageFilter<ItkImage<float>, ItkImage<float>>::New();
    filter->SetInput(to_image<float>(gray));
    filter->SetRadius(1);
    filter->Update();
    return from_image<float>(*filter->GetOutput(), gray.voxel);
  });
}

double otsu_threshold(const GrayVolume& gray) {
  return with_itk("threshold", [&] {
    std::vector<float> sorted = gray.values;
    const std::size_t tail = sorted.size() / 1000;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(tail),
                     sorted.end());
    const float low = sorted[tail];
    std::nth_element(sorted.begin(), sorted.end() - static_cast<std::ptrdiff_t>(tail + 1),
                     sorted.end());
    const float high = sorted[sorted.size() - tail - 1];
    if (!(high > low)) {
      throw Error{{.place = "threshold",
                   .problem = "the volume has one gray value only",
                   .reason = "nearly all voxels are equal",
                   .fix = "Is this the right file and data set?"}};
    }
    using Histogram = itk::Statistics::Histogram<double>;
    auto histogram = Histogram::New();
    histogram->SetMeasurementVectorSize(1);
    Histogram::SizeType size(1);
    size.Fill(bins);
    Histogram::MeasurementVectorType lower(1);
    Histogram::MeasurementVectorType upper(1);
    lower.Fill(low);
    upper.Fill(high);
    histogram->SetClipBinsAtEnds(false);
    histogram->Initialize(size, lower, upper);
    std::vector<std::uint64_t> counts(bins, 0);
    const float scale = static_cast<float>(bins) / (high - low);
    for (const float value : gray.values) {
      const float place = std::clamp((value - low) * scale, 0.0F, static_cast<float>(bins) - 1);
      ++counts[static_cast<std::size_t>(place)];
    }
    for (std::size_t b = 0; b < bins; ++b) histogram->SetFrequency(b, counts[b]);
    auto otsu = itk::OtsuThresholdCalculator<Histogram, double>::New();
    otsu->SetInput(histogram);
    otsu->Compute();
    return otsu->GetThreshold();
  });
}

MaskVolume holes_filled(const MaskVolume& mask) {
  return with_itk("fill", [&] {
    auto filter = itk::BinaryFillholeImageFilter<ItkImage<std::uint8_t>>::New();
    filter->SetInput(to_image<std::uint8_t>(mask));
    filter->SetForegroundValue(1);
    filter->Update();
    return from_image<std::uint8_t>(*filter->GetOutput(), mask.voxel);
  });
}

MaskVolume opened(const MaskVolume& mask, std::uint32_t radius) {
  return with_itk("open", [&] {
    using Ball = itk::BinaryBallStructuringElement<std::uint8_t, 3>;
    using Image = ItkImage<std::uint8_t>;
    Ball ball;
    ball.SetRadius(radius);
    ball.CreateStructuringElement();
    auto filter = itk::BinaryMorphologicalOpeningImageFilter<Image, Image, Ball>::New();
    filter->SetInput(to_image<std::uint8_t>(mask));
    filter->SetKernel(ball);
    filter->SetForegroundValue(1);
    filter->SetBackgroundValue(0);
    filter->Update();
    return from_image<std::uint8_t>(*filter->GetOutput(), mask.voxel);
  });
}

}  // namespace reckon
