// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// A scan, or what was computed from it: one value per cubic voxel. The world frame of a volume has
/// its origin at the outer corner of voxel (0, 0, 0).
template <class Value>
struct Volume {
  std::array<std::int32_t, 3> dims{0, 0, 0};  ///< voxels along x, y, z
  double voxel{0};                            ///< edge of a voxel [m]
  std::vector<Value> values;                  ///< x fastest, then y, then z

  Volume() = default;
  Volume(const std::array<std::int32_t, 3>& extents, double edge, Value value = {})
      : dims{extents},
        voxel{edge},
        values(static_cast<std::size_t>(extents[0]) * static_cast<std::size_t>(extents[1]) *
                   static_cast<std::size_t>(extents[2]),
               value) {}
  /// Of the same voxels as another.
  template <class Other>
  explicit Volume(const Volume<Other>& like, Value value = {})
      : dims{like.dims}, voxel{like.voxel}, values(like.values.size(), value) {}

  [[nodiscard]] std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(dims[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(k));
  }
  [[nodiscard]] bool holds(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < dims[0] && j < dims[1] && k < dims[2];
  }
  [[nodiscard]] Vec3 center_world(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return voxel * Vec3{i + 0.5, j + 0.5, k + 0.5};
  }
};

using GrayVolume = Volume<float>;
using MaskVolume = Volume<std::uint8_t>;    ///< 0: void, 1: solid
using LabelVolume = Volume<std::uint32_t>;  ///< 0: no grain, else a grain's number from 1

/// Calls visit(voxel, neighbour) for every pair of voxels that share a face, each once, in order.
template <class Value, class Visit>
void for_each_face(const Volume<Value>& volume, Visit&& visit) {
  const std::array<std::size_t, 3> stride{
      1, static_cast<std::size_t>(volume.dims[0]),
      static_cast<std::size_t>(volume.dims[0]) * static_cast<std::size_t>(volume.dims[1])};
  std::size_t at = 0;
  for (std::int32_t k = 0; k < volume.dims[2]; ++k) {
    for (std::int32_t j = 0; j < volume.dims[1]; ++j) {
      for (std::int32_t i = 0; i < volume.dims[0]; ++i, ++at) {
        if (i + 1 < volume.dims[0]) visit(at, at + stride[0]);
        if (j + 1 < volume.dims[1]) visit(at, at + stride[1]);
        if (k + 1 < volume.dims[2]) visit(at, at + stride[2]);
      }
    }
  }
}

}  // namespace reckon
