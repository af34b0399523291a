// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/boundary/cell_control.hpp"
#include "reckon/boundary/wall_contacts.hpp"
#include "reckon/boundary/wall_control.hpp"
#include "reckon/contact/grain_contacts.hpp"
#include "reckon/grains/grain_frame.hpp"
#include "reckon/grains/periodic_cell.hpp"
#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// The forces of the grains on every wall as of the last evaluation, summed over all ranks; zero
/// for walls that no control can move. Collective.
[[nodiscard]] std::vector<WallReaction> wall_reactions(const WallContacts& contacts,
                                                       const Communicator& ranks);

/// What the grains do to the periodic cell as of the last evaluation, summed over all ranks.
/// `frames`: the `owned` grains of this rank, then its ghosts. Collective.
[[nodiscard]] CellReaction cell_reaction(const GrainContacts& contacts,
                                         std::span<const GrainFrame> frames, std::size_t owned,
                                         const PeriodicCell& cell, const Communicator& ranks);

}  // namespace reckon
