// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace reckon::app {

/// The command line as the user typed it, from the program's name on.
using CommandWords = std::vector<std::string>;

/// reckon grains: makes, describes and exports shape libraries.
/// `words` is the command line, which libraries record.
void add_grains_command(CLI::App& app, const CommandWords& words);

}  // namespace reckon::app
