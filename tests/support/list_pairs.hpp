// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/contact/grain_contacts.hpp"
#include "reckon/neighbor/pair_list.hpp"

namespace reckon::testing {

/// Lists all pairs of grains within `skin`, as a simulation on one rank does.
inline void list_pairs(GrainContacts& contacts, std::span<const GrainFrame> frames, double skin) {
  std::vector<GrainId> ids;
  std::vector<Vec3> positions;
  std::vector<double> radii;
  for (const GrainFrame& frame : frames) {
    ids.push_back(frame.id);
    positions.push_back(frame.position);
    radii.push_back(frame.shape->bounding_radius);
  }
  contacts.rebuild(find_pairs(ids, positions, radii, skin, ids.size()), ids.size(), ids.size());
}

}  // namespace reckon::testing
