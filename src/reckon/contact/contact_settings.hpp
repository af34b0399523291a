// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <variant>

#include "reckon/contact/area_law.hpp"
#include "reckon/contact/bond_law.hpp"
#include "reckon/contact/hertz_law.hpp"
#include "reckon/contact/linear_law.hpp"

namespace reckon {

/// Every law that a scene can choose. Kernels are compiled once for each.
using AnyContactLaw = std::variant<LinearLaw, AreaLaw, HertzLaw>;

/// Whose nodes are tested in whose level set.
enum class MasterRule {
  lower_id,  ///< the grain with the lower id is the master (paper, appendix A)
  smaller,   ///< the grain with the smaller bounding radius; equal radii fall back to lower_id
  /// Both ways. A touching node of either grain stands for the same area A_a A_b / (A_a + A_b) on
  /// average, with A the mean area of a grain's nodes: the weights are A_b / (A_a + A_b) for a's
  /// nodes and A_a / (A_a + A_b) for b's, one half each for grains alike.
  both
};

/// How touching nodes are found. Both give the same bits.
enum class ContactEngine {
  near,  ///< remembers which nodes are near a partner and for how long they cannot touch
  plain  ///< tests every node of every listed pair at every step: slow, simple, the oracle
};

/// How two grains touch.
struct ContactSettings {
  AnyContactLaw law;
  double friction{0};  ///< Coulomb coefficient
  MasterRule master{MasterRule::both};
  std::optional<BondLaw> bond{};  ///< of cement, where a stage sets it
};

}  // namespace reckon
