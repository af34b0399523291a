// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "reckon/simulation/setup.hpp"

namespace reckon {

/// A shape whose nodes lie too far apart for what it touches.
struct CoarseNodes {
  std::string text;  ///< which shapes, how far, and the remedy
  double unseen{0};  ///< depth to which the partner sinks in without a force, over its thickness
};

/// Where nodes lie too far apart for what they touch, so that it can sink in between them without a
/// force. Nothing where the spacing is small enough. Tested are the pairs of grains that
/// `contact.master` allows, and walls.
///
///     master's nodes   o           o           o        spacing h = sqrt(area / nodes)
///                          .---.
///                         (     )  slave, as thin as t: sinks in by about 0.4 h^2/t
///                          '---'
[[nodiscard]] std::optional<CoarseNodes> coarse_nodes(const LoadedScene& scene);

}  // namespace reckon
