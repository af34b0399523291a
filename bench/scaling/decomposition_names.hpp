// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <utility>

#include "reckon/domain/decomposition.hpp"

namespace reckon::bench {

constexpr std::array<std::pair<const char*, DecompositionKind>, 4> decomposition_names{{
    {"balanced", DecompositionKind::balanced},
    {"grid", DecompositionKind::grid},
    {"bins", DecompositionKind::bins},
    {"replicated", DecompositionKind::replicated},
}};

[[nodiscard]] inline std::string name_of(DecompositionKind kind) {
  for (const auto& [name, named] : decomposition_names) {
    if (named == kind) return name;
  }
  return "?";
}

}  // namespace reckon::bench
