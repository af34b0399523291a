// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "reckon/scene/scene_key.hpp"
#include "reckon/simulation/config.hpp"

/// Part of the description of a scene (scene_description.hpp): the membrane and its pressure.
namespace reckon {

template <class Visitor>
void describe(Visitor& v, MembraneConfig& membrane) {
  v.text({.name = "mould",
          .required = true,
          .meaning = "Name of the cylinder wall whose place it takes, between the planes at its "
                     "ends, in the first stage with a `membrane`."},
         membrane.mould);
  v.number({.name = "spacing",
            .unit = "m",
            .range = above(0),
            .required = true,
            .meaning = "Between its nodes; a third of a grain's diameter or less, or corners of "
                       "grains poke through."},
           membrane.spacing);
  v.number({.name = "modulus",
            .unit = "Pa",
            .range = above(0),
            .meaning = "Young's modulus; bonds give Poisson's ratio 1/3."},
           membrane.modulus);
  v.number({.name = "thickness", .unit = "m", .range = above(0), .meaning = "Of the sheet."},
           membrane.thickness);
  v.number({.name = "friction",
            .unit = "1",
            .range = at_least(0),
            .meaning = "Coulomb coefficient between it and grains."},
           membrane.friction);
  v.number({.name = "normal_stiffness",
            .unit = "N/m^3",
            .range = above(0),
            .standard = "law area: a tenth of contact.normal_stiffness",
            .meaning = "Stiffness per area with which it pushes on grains; also that of the shear "
                       "springs there."},
           membrane.normal_stiffness);
  constexpr std::array ends{Choice{"sealed", MembraneEnds::sealed},
                            Choice{"sliding", MembraneEnds::sliding}};
  v.choice({.name = "ends",
            .meaning = "Its end rings are `sealed` to the planes there, or keep to the planes but "
                       "are `sliding` freely in them."},
           membrane.ends, ends);
  v.number({.name = "damping",
            .unit = "1/s",
            .range = at_least(0),
            .standard = "0.01 per time step",
            .meaning = "Global damping of its nodes."},
           membrane.damping);
}

template <class Visitor>
void describe(Visitor& v, MembranePressureConfig& membrane) {
  v.number({.name = "pressure",
            .unit = "Pa",
            .required = true,
            .meaning = "On the membrane from outside; below zero, from inside."},
           membrane.pressure);
  v.number({.name = "ramp",
            .unit = "s",
            .range = at_least(0),
            .meaning = "Time over which the pressure gets there from that of the stage before, "
                       "linearly; the first stage of a membrane has it from the start."},
           membrane.ramp);
}

}  // namespace reckon
