// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// The points in the order of a Morton curve (Morton 1966) through the cube around them: what is
/// close in it is close in space. Positions must be finite [m].
[[nodiscard]] std::vector<std::uint32_t> space_order(std::span<const Vec3> positions);

}  // namespace reckon
