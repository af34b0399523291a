// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon surfaces: writes the grains' true surfaces from checkpoints.
void add_surfaces_command(CLI::App& app);

}  // namespace reckon::app
