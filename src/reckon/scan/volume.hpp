// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// Numbers of voxels along x, y and z.
using VoxelDims = std::array<std::int32_t, 3>;

/// The voxels from `low` on, `dims` of them along each axis.
struct Box {
  VoxelDims low{0, 0, 0};
  VoxelDims dims{0, 0, 0};

  Box() = default;
  Box(const VoxelDims& first, const VoxelDims& extents) : low{first}, dims{extents} {}
  explicit Box(const VoxelDims& extents) : dims{extents} {}

  /// One past the last voxel along an axis.
  [[nodiscard]] std::int32_t end(std::size_t axis) const { return low[axis] + dims[axis]; }
  [[nodiscard]] std::size_t voxels() const {
    return static_cast<std::size_t>(dims[0]) * static_cast<std::size_t>(dims[1]) *
           static_cast<std::size_t>(dims[2]);
  }
  [[nodiscard]] bool holds(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return i >= low[0] && j >= low[1] && k >= low[2] && i < end(0) && j < end(1) && k < end(2);
  }
  /// By so many voxels to all sides, as far as `limits` go.
  [[nodiscard]] Box widened(std::int32_t by, const Box& limits) const {
    Box wide;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      wide.low[axis] = std::max(low[axis] - by, limits.low[axis]);
      wide.dims[axis] = std::min(end(axis) + by, limits.end(axis)) - wide.low[axis];
    }
    return wide;
  }
  friend bool operator==(const Box&, const Box&) = default;
};

/// A scan, a result computed from it, or a part of either: one value per cubic voxel. Voxels have
/// the same numbers in a part as in the whole. The world frame has its origin at the outer corner
/// of voxel (0, 0, 0).
template <class Value>
struct Volume {
  VoxelDims low{0, 0, 0};     ///< the first voxel; other than (0, 0, 0) in a part
  VoxelDims dims{0, 0, 0};    ///< voxels along x, y, z
  double voxel{0};            ///< edge of a voxel [m]
  std::vector<Value> values;  ///< x fastest, then y, then z

  Volume() = default;
  Volume(const VoxelDims& extents, double edge, Value value = {})
      : Volume{Box{extents}, edge, value} {}
  Volume(const Box& box, double edge, Value value = {})
      : low{box.low}, dims{box.dims}, voxel{edge}, values(box.voxels(), value) {}
  /// Of the same voxels as another.
  template <class Other>
  explicit Volume(const Volume<Other>& like, Value value = {})
      : Volume{like.box(), like.voxel, value} {}

  [[nodiscard]] Box box() const { return {low, dims}; }
  [[nodiscard]] std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>(i - low[0]) +
           static_cast<std::size_t>(dims[0]) *
               (static_cast<std::size_t>(j - low[1]) +
                static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(k - low[2]));
  }
  [[nodiscard]] bool holds(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return box().holds(i, j, k);
  }
  [[nodiscard]] Vec3 center_world(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return voxel * Vec3{i + 0.5, j + 0.5, k + 0.5};
  }
};

using GrayVolume = Volume<float>;
using MaskVolume = Volume<std::uint8_t>;    ///< 0: void, 1: solid
using LabelVolume = Volume<std::uint32_t>;  ///< 0: no grain, else a grain's number from 1

/// Calls visit(i, j, k) for each voxel of a box, in the order in which volumes hold them.
template <class Visit>
void for_each_voxel(const Box& box, Visit&& visit) {
  for (std::int32_t k = box.low[2]; k < box.end(2); ++k) {
    for (std::int32_t j = box.low[1]; j < box.end(1); ++j) {
      for (std::int32_t i = box.low[0]; i < box.end(0); ++i) visit(i, j, k);
    }
  }
}

/// Calls visit(voxel, neighbour) for the pairs of voxels that share a face, each once, in order;
/// the first of them lies in the first `layers` of the volume.
template <class Value, class Visit>
void for_each_face(const Volume<Value>& volume, std::int32_t layers, Visit&& visit) {
  const std::array<std::size_t, 3> stride{
      1, static_cast<std::size_t>(volume.dims[0]),
      static_cast<std::size_t>(volume.dims[0]) * static_cast<std::size_t>(volume.dims[1])};
  std::size_t at = 0;
  for (std::int32_t k = 0; k < layers; ++k) {
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
