// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace reckon::app {

// Faults of a command line, and what to write instead. `root` is the whole program.

/// Checks numbers before CLI11 does: no option takes NaN or a negative count, and what is nearly a
/// number is refused with the number to write.
void refuse_odd_values(CLI::App& root);
/// Throws Error for a command that does not exist, with the one that was probably meant.
void require_known_command(const CLI::App& root, int argc, char** argv);
/// The message for a command line that CLI11 refused.
[[nodiscard]] std::string explain(const CLI::ParseError& error, const CLI::App& root);

}  // namespace reckon::app
