// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reckon/avatar/shape_builder.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon::bench {

/// Sand-like grains of equal mean diameter.
struct GrainKind {
  double diameter{2};  ///< of the sphere of equal volume [m]
  std::uint32_t count{0};
  std::uint32_t nodes{279};
  double voxels_per_diameter{18};
};

/// One shape per grain, each with memory of its own, as in a run on scanned grains. Only `distinct`
/// forms are generated per kind and then copied, which makes no difference to the machine. All of
/// it `copies` times, one after the other.
[[nodiscard]] ShapeStore make_shapes(const std::vector<GrainKind>& kinds, std::uint32_t distinct,
                                     ShapeStorage storage, std::uint32_t copies = 1);

/// What holds for a workload from its packing to its measurement.
struct Material {
  AnyContactLaw law;
  double friction{0.5};
  double density{1000};  ///< [kg/m^3]
  MasterRule master{MasterRule::lower_id};
};

/// Grains in a closed box at rest under pressure.
struct Packing {
  SimulationSetup setup;  ///< walls stand still
  SimulationState state;
  Vec3 low;            ///< of the box [m]
  Vec3 high;           ///< [m]
  double pressure{0};  ///< mean normal stress on the walls [Pa]
};

/// Packs one grain per shape: placed apart, larger ones first, in a loose cube, which then shrinks,
/// without friction and with much damping, until the walls bear `pressure`. When
/// `file` is given, the result is kept there and read from there the next time.
[[nodiscard]] Packing squeeze(ShapeStore shapes, const Material& material, double pressure,
                              double time_step, double skin, const std::string& file);

/// Puts `copies` of the packing along each axis side by side, in a box as many times as large,
/// until there are `count` grains. The copies share their shapes.
void repeat(Packing& packing, int copies, std::size_t count);

/// Mean normal stress on the six walls of a box [Pa].
[[nodiscard]] double wall_pressure(const Measurement& now, const Vec3& size);

}  // namespace reckon::bench
