// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon diff: compares two runs bit by bit.
void add_diff_command(CLI::App& app);

}  // namespace reckon::app
