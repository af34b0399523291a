// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace reckon::app {

// The command line as it is described to CLI11, told in other ways. `root` is the whole program.

/// Lets `--help` of the program, and of what is added to it afterwards, say the same.
void use_help_format(CLI::App& root);
/// What CLI11 would take as it is: no option takes NaN, and none that counts takes -1 for 2^64 - 1.
void refuse_odd_numbers(CLI::App& root);
/// docs/reference/commands.md: every command with its options.
[[nodiscard]] std::string commands_markdown(const CLI::App& root);
/// The same as a manual page, reckon(1), in the macros of groff_man(7).
[[nodiscard]] std::string manual_page(const CLI::App& root);
/// Completes commands and options in bash, file names elsewhere.
[[nodiscard]] std::string bash_completion(const CLI::App& root);

}  // namespace reckon::app
