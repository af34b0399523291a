// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/scene/scene_key.hpp"
#include "reckon/simulation/config.hpp"

/// Part of the description of a scene (scene_description.hpp): cement.
namespace reckon {

template <class Visitor>
void describe(Visitor& v, BondConfig& bond, const ContactConfig& contact) {
  const bool by_contact = contact.law == ContactLawKind::area;
  v.number({.name = "normal_stiffness",
            .unit = "N/m^3",
            .range = above(0),
            .required = !by_contact,
            .standard = "law area: contact.normal_stiffness; else needed",
            .meaning = "Stress of the cement per opening between its faces: its Young's modulus "
                       "over its thickness."},
           bond.normal_stiffness);
  v.number({.name = "shear_stiffness",
            .unit = "N/m^3",
            .range = above(0),
            .standard = "0.4 normal_stiffness",
            .meaning = "The same for sliding of its faces."},
           bond.shear_stiffness);
  v.number({.name = "tensile_strength",
            .unit = "Pa",
            .range = above(0),
            .required = true,
            .meaning = "Tension at the rim of the disc, from pull and bending, at which it breaks "
                       "for good."},
           bond.tensile_strength);
  v.number({.name = "shear_strength",
            .unit = "Pa",
            .range = above(0),
            .required = true,
            .meaning = "Shear stress at the rim, from sliding and torsion, at which it does."},
           bond.shear_strength);
  v.number({.name = "radius_share",
            .unit = "1",
            .range = {.low = 0, .high = 1, .low_allowed = false},
            .meaning = "Radius of the disc over that of the sphere of equal volume of the smaller "
                       "grain."},
           bond.radius_share);
}

}  // namespace reckon
