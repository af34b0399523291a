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

bool has_ct_component() { return true; }
void require_ct_component() {}

GrayVolume curvature_diffused(const GrayVolume& gray, double gradient, double conductance) {
  return with_itk("denoise", [&] {
    using Filter = itk::CurvatureAnisotropicDiffusionImageFilter<ItkImage<float>, ItkImage<float>>;
    auto filter = Filter::New();
    filter->SetInput(to_image<float>(gray));
    filter->SetNumberOfIterations(1);
    filter->SetTimeStep(0.0625);  // the largest that is stable in three dimensions
    filter->SetConductanceParameter(conductance);
    filter->SetFixedAverageGradientMagnitude(gradient);
    filter->Update();
    return from_image<float>(*filter->GetOutput(), gray);
  });
}

GrayVolume median_filtered(const GrayVolume& gray) {
  return with_itk("denoise", [&] {
    auto filter = itk::MedianImageFilter<ItkImage<float>, ItkImage<float>>::New();
    filter->SetInput(to_image<float>(gray));
    filter->SetRadius(1);
    filter->Update();
    return from_image<float>(*filter->GetOutput(), gray);
  });
}

double otsu_threshold(std::span<const std::uint64_t> counts, double low, double high) {
  return with_itk("threshold", [&] {
    using Histogram = itk::Statistics::Histogram<double>;
    auto histogram = Histogram::New();
    histogram->SetMeasurementVectorSize(1);
    Histogram::SizeType size(1);
    size.Fill(counts.size());
    Histogram::MeasurementVectorType lower(1);
    Histogram::MeasurementVectorType upper(1);
    lower.Fill(low);
    upper.Fill(high);
    histogram->SetClipBinsAtEnds(false);
    histogram->Initialize(size, lower, upper);
    for (std::size_t b = 0; b < counts.size(); ++b) histogram->SetFrequency(b, counts[b]);
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
    return from_image<std::uint8_t>(*filter->GetOutput(), mask);
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
    return from_image<std::uint8_t>(*filter->GetOutput(), mask);
  });
}

}  // namespace reckon
