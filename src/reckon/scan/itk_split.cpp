// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <itkConnectedComponentImageFilter.h>
#include <itkHMaximaImageFilter.h>
#include <itkMorphologicalWatershedFromMarkersImageFilter.h>
#include <itkRegionalMaximaImageFilter.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

#include <cmath>

#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/itk_bridge.hpp"

namespace reckon {
namespace {

// The toolkit's floods keep a queue per value, so depths are rounded to steps.
using Level = std::int16_t;
constexpr double levels_per_voxel = 64;
constexpr double deepest_level = 32000;

}  // namespace

GrayVolume depth_in_solid(const MaskVolume& mask) {
  return with_itk("split", [&] {
    using Filter = itk::SignedMaurerDistanceMapImageFilter<ItkImage<std::uint8_t>, ItkImage<float>>;
    auto filter = Filter::New();
    // The filter measures to the nearest voxel of the mask's own border; turned inside out, that is
    // the nearest void voxel.
    MaskVolume outside{mask};
    for (std::size_t v = 0; v < mask.values.size(); ++v) outside.values[v] = mask.values[v] == 0;
    filter->SetInput(to_image<std::uint8_t>(outside));
    filter->SquaredDistanceOff();
    filter->UseImageSpacingOff();
    filter->InsideIsPositiveOff();
    filter->Update();
    GrayVolume depth = from_image<float>(*filter->GetOutput(), mask);
    for (std::size_t v = 0; v < mask.values.size(); ++v) {
      depth.values[v] = mask.values[v] != 0 ? std::max(depth.values[v], 0.0F) : 0.0F;
    }
    return depth;
  });
}

LabelVolume split_at_necks(const GrayVolume& depth, double least_rise) {
  return with_itk("split", [&] {
    Volume<Level> levels{depth};
    for (std::size_t v = 0; v < depth.values.size(); ++v) {
      levels.values[v] = static_cast<Level>(
          std::min(std::floor(depth.values[v] * levels_per_voxel + 0.5), deepest_level));
    }
    using Levels = ItkImage<Level>;
    using Mask = ItkImage<std::uint8_t>;
    using Labels = ItkImage<std::uint32_t>;
    auto flattened = itk::HMaximaImageFilter<Levels, Levels>::New();
    flattened->SetInput(to_image<Level>(levels));
    flattened->SetHeight(static_cast<Level>(
        std::clamp(std::floor(least_rise * levels_per_voxel + 0.5), 1.0, deepest_level)));
    auto maxima = itk::RegionalMaximaImageFilter<Levels, Mask>::New();
    maxima->SetInput(flattened->GetOutput());
    maxima->SetForegroundValue(1);
    maxima->SetBackgroundValue(0);
    maxima->FullyConnectedOn();
    maxima->Update();
    // Where there is no solid at all, the whole volume is one flat "maximum".
    Mask& seeds = *maxima->GetOutput();
    for (std::size_t v = 0; v < levels.values.size(); ++v) {
      if (levels.values[v] == 0) seeds.GetBufferPointer()[v] = 0;
    }
    auto numbered = itk::ConnectedComponentImageFilter<Mask, Labels>::New();
    numbered->SetInput(&seeds);
    numbered->FullyConnectedOn();
    numbered->Update();
    // Void gets its own seed, so that no flood passes through it.
    Labels& markers = *numbered->GetOutput();
    const auto void_label = static_cast<std::uint32_t>(numbered->GetObjectCount() + 1);
    auto floor = to_image<Level>(levels);
    for (std::size_t v = 0; v < levels.values.size(); ++v) {
      Level& level = floor->GetBufferPointer()[v];
      if (level == 0) markers.GetBufferPointer()[v] = void_label;
      level = static_cast<Level>(-level);
    }
    auto watershed = itk::MorphologicalWatershedFromMarkersImageFilter<Levels, Labels>::New();
    watershed->SetInput(floor);
    watershed->SetMarkerImage(&markers);
    watershed->MarkWatershedLineOff();
    watershed->FullyConnectedOff();
    watershed->Update();
    auto labels = from_image<std::uint32_t>(*watershed->GetOutput(), depth);
    for (std::uint32_t& label : labels.values) {
      if (label == void_label) label = 0;
    }
    return labels;
  });
}

}  // namespace reckon
