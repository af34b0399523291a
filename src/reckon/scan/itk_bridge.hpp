// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <itkImage.h>
#include <itkMultiThreaderBase.h>

#include <algorithm>
#include <string>

#include "reckon/core/error.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/scan/volume.hpp"

// For the sources named itk_*.cpp alone: other headers keep the weight of the toolkit out.

namespace reckon {

template <class Value>
using ItkImage = itk::Image<Value, 3>;

/// A copy with a spacing of one, so that the toolkit's lengths are voxels.
template <class To, class Value>
[[nodiscard]] typename ItkImage<To>::Pointer to_image(const Volume<Value>& volume) {
  auto image = ItkImage<To>::New();
  typename ItkImage<To>::SizeType size;
  for (unsigned axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<itk::SizeValueType>(volume.dims[axis]);
  }
  image->SetRegions(size);
  image->Allocate();
  std::transform(volume.values.begin(), volume.values.end(), image->GetBufferPointer(),
                 [](Value value) { return static_cast<To>(value); });
  return image;
}

/// The reverse, for the voxels of the volume that the image was made from.
template <class Value, class From, class Like>
[[nodiscard]] Volume<Value> from_image(const ItkImage<From>& image, const Volume<Like>& like) {
  Volume<Value> volume{like};
  std::transform(image.GetBufferPointer(), image.GetBufferPointer() + volume.values.size(),
                 volume.values.begin(), [](From value) { return static_cast<Value>(value); });
  return volume;
}

/// Runs `action` with our number of threads; what the toolkit throws becomes an Error.
template <class Action>
decltype(auto) with_itk(const std::string& place, Action&& action) {
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(
      static_cast<itk::ThreadIdType>(thread_count()));
  try {
    return action();
  } catch (const itk::ExceptionObject& error) {
    std::string reason = error.GetDescription();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    throw Error{{.place = place,
                 .problem = "ITK could not finish its work",
                 .reason = reason,
                 .fix = "Where memory or a disk is full, make room."}};
  }
}

}  // namespace reckon
