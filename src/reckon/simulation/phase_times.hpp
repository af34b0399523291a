// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace reckon {

/// Where the steps of a run spent their time, summed [s].
struct PhaseTimes {
  double frames{0};          ///< placing grains and walls for the kernels
  double lists{0};           ///< looking whether lists are stale, and making them
  double grain_contacts{0};  ///< finding touching nodes and their forces
  double wall_contacts{0};
  double loads{0};   ///< summing forces per grain
  double motion{0};  ///< moving grains, committing springs, looking for numbers that are none

  [[nodiscard]] double total() const {
    return frames + lists + grain_contacts + wall_contacts + loads + motion;
  }
};

}  // namespace reckon
