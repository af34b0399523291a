// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <functional>

namespace reckon {

/// An integer that names one kind of thing, so that a grain's id cannot be passed for a shape's.
/// There is no value for "none": use std::optional where an id may be absent.
template <class Tag>
class OpaqueId {
 public:
  using value_type = std::uint32_t;

  constexpr OpaqueId() = default;
  explicit constexpr OpaqueId(value_type value) : value_{value} {}

  [[nodiscard]] constexpr value_type get() const { return value_; }
  friend constexpr auto operator<=>(OpaqueId, OpaqueId) = default;

 private:
  value_type value_{0};
};

/// A grain, for its whole life and on every rank.
using GrainId = OpaqueId<struct GrainTag>;
/// A shape, by its place in the shape library.
using ShapeId = OpaqueId<struct ShapeTag>;
/// A wall, by its place in the scene; walls are summed in this order.
using WallId = OpaqueId<struct WallTag>;
/// A surface node, by its place in its shape; contacts of a pair are summed in this order.
using NodeIndex = std::uint32_t;

}  // namespace reckon

template <class Tag>
struct std::hash<reckon::OpaqueId<Tag>> {
  std::size_t operator()(reckon::OpaqueId<Tag> id) const noexcept { return id.get(); }
};
