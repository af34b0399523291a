// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace reckon {

/// How many letters must be inserted, deleted, replaced or swapped with their neighbour to turn `a`
/// into `b` (optimal string alignment distance).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name that `written` was most likely meant to be: the nearest one, the first of equals;
/// nothing when none is near enough (a third of the longer name, at least two letters).
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view written,
                                                      std::span<const std::string> names);

}  // namespace reckon
