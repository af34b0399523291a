// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

namespace reckon {

/// The instructions that filters of nodes use. All give the same bits.
enum class SimdLevel {
  automatic,  ///< the widest that this machine has
  scalar,     ///< none
  avx2,
  avx512,
  neon
};

/// The levels that this program holds and this machine can run, from `scalar` to the widest.
[[nodiscard]] std::vector<SimdLevel> simd_levels_here();

/// As scenes spell it.
[[nodiscard]] std::string_view name_of(SimdLevel level);

/// `level` itself, or the widest for `automatic`. Throws Error for one that cannot run here.
[[nodiscard]] SimdLevel resolve(SimdLevel level);

}  // namespace reckon
