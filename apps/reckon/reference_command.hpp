// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon reference: prints the reference pages.
void add_reference_command(CLI::App& app);

}  // namespace reckon::app
