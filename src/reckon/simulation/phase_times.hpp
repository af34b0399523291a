// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace reckon {

/// Where the steps of a run spent their time on this rank, summed [s].
struct PhaseTimes {
  double frames{0};          ///< placing grains and walls for the kernels
  double border{0};          ///< listing ghosts, and waiting for their new states
  double migration{0};       ///< bringing grains to their owners
  double lists{0};           ///< listing pairs
  double grain_contacts{0};  ///< finding touching nodes and their forces
  double wall_contacts{0};
  double motion{0};     ///< summing forces per grain, moving grains, committing springs
  double agreement{0};  ///< looking whether lists still serve, with all ranks

  [[nodiscard]] double total() const {
    return frames + border + migration + lists + grain_contacts + wall_contacts + motion +
           agreement;
  }
};

}  // namespace reckon
