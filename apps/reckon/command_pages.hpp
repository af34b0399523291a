// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace reckon::app {

// The description of the command line for CLI11, in other formats. `root` is the whole program.

/// Gives `--help` of the program, and of later additions, the same format.
void use_help_format(CLI::App& root);
/// The value that an option takes and what it means, in the words of `--help`.
[[nodiscard]] std::string option_summary(const CLI::Option& option);
/// The words that an option takes; none where it takes others too.
[[nodiscard]] std::vector<std::string> option_choices(const CLI::Option& option);
/// docs/reference/commands.md: every command with its options.
[[nodiscard]] std::string commands_markdown(const CLI::App& root);
/// The same as a manual page, reckon(1), in the macros of groff_man(7).
[[nodiscard]] std::string manual_page(const CLI::App& root);
/// Completes commands and options in bash, file names elsewhere.
[[nodiscard]] std::string bash_completion(const CLI::App& root);

}  // namespace reckon::app
