// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/simd_level.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reckon/contact/point_filter.hpp"
#include "reckon/core/error.hpp"

namespace reckon {

std::vector<SimdLevel> simd_levels_here() {
  std::vector<SimdLevel> levels{SimdLevel::scalar};
  for (const SimdLevel level : {SimdLevel::neon, SimdLevel::avx2, SimdLevel::avx512}) {
    if (vector_point_filter(level) != nullptr) levels.push_back(level);
  }
  return levels;
}

std::string_view name_of(SimdLevel level) {
  switch (level) {
    case SimdLevel::automatic:
      return "auto";
    case SimdLevel::scalar:
      return "scalar";
    case SimdLevel::avx2:
      return "avx2";
    case SimdLevel::avx512:
      return "avx512";
    case SimdLevel::neon:
      return "neon";
  }
  return "";
}

SimdLevel resolve(SimdLevel level) {
  const std::vector<SimdLevel> here = simd_levels_here();
  if (level == SimdLevel::automatic) return here.back();
  if (std::find(here.begin(), here.end(), level) != here.end()) return level;
  std::string names;
  for (const SimdLevel other : here) names += fmt::format(", \"{}\"", name_of(other));
  throw Error{{.place = fmt::format("neighbor.simd = \"{}\"", name_of(level)),
               .problem = "these instructions cannot run here",
               .reason = "this machine or this build of the program lacks them",
               .fix = fmt::format("Leave the key out, or choose one of \"auto\"{}.", names)}};
}

}  // namespace reckon
