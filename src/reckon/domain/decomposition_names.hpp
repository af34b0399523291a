// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "reckon/domain/decomposition.hpp"

namespace reckon {

/// What users call them.
inline constexpr std::array<std::pair<std::string_view, DecompositionKind>, 4> decomposition_names{
    {{"balanced", DecompositionKind::balanced},
     {"grid", DecompositionKind::grid},
     {"bins", DecompositionKind::bins},
     {"replicated", DecompositionKind::replicated}}};

[[nodiscard]] constexpr std::string_view name_of(DecompositionKind kind) {
  for (const auto& [name, named] : decomposition_names) {
    if (named == kind) return name;
  }
  return "?";
}

[[nodiscard]] constexpr std::optional<DecompositionKind> decomposition_named(
    std::string_view name) {
  for (const auto& [known, kind] : decomposition_names) {
    if (known == name) return kind;
  }
  return std::nullopt;
}

}  // namespace reckon
