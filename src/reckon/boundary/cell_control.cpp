// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/cell_control.hpp"

#include <algorithm>

namespace reckon {
namespace {

double component(const UpperMat3& m, CellAxis axis) {
  switch (axis) {
    case CellAxis::xy:
      return m.xy;
    case CellAxis::xz:
      return m.xz;
    case CellAxis::yz:
      return m.yz;
    default:
      return m.diagonal[static_cast<int>(axis)];
  }
}

/// Compression positive [1/s].
double servo_rate(const CellControl& control, const CellReaction& reaction,
                  const PeriodicCell& cell, double time_step) {
  const int axis = static_cast<int>(control.axis);
  const double stiffness = reaction.stiffness[axis] * time_step;
  const double damping = reaction.damping[axis];
  const double last = -cell.gradient().diagonal[axis];
  const double lacking = control.value * cell.volume() - reaction.virial.diagonal[axis];
  const double limit = control.rate_limit;
  if (!(stiffness > 0)) return lacking > 0 ? limit : lacking < 0 ? -limit : 0;
  const double rate = (control.gain * lacking + damping * last) / (stiffness + damping);
  return std::clamp(rate, -limit, limit);
}

}  // namespace

double stress_of(CellAxis axis, const CellReaction& reaction, const PeriodicCell& cell) {
  return component(reaction.virial, axis) / cell.volume();
}

UpperMat3 rates_for(std::span<const CellControl> controls, const CellReaction& reaction,
                    const PeriodicCell& cell, double time_step) {
  UpperMat3 gradient;
  for (const CellControl& control : controls) {
    const double value = control.target == WallTarget::stress
                             ? servo_rate(control, reaction, cell, time_step)
                             : control.value;
    switch (control.axis) {
      case CellAxis::xy:
        gradient.xy = value;
        break;
      case CellAxis::xz:
        gradient.xz = value;
        break;
      case CellAxis::yz:
        gradient.yz = value;
        break;
      default:
        gradient.diagonal[static_cast<int>(control.axis)] = -value;
    }
  }
  return gradient * cell.edges();
}

}  // namespace reckon
