// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/parallel/communicator.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon {

/// Collective. The root's scene on all ranks, but its grains, which stay with the root, and names
/// and digests of shapes. Shapes are read from the scene's libraries, so every machine needs their
/// files under the same paths.
[[nodiscard]] LoadedScene share_scene(const LoadedScene& scene, const Communicator& ranks);

}  // namespace reckon
