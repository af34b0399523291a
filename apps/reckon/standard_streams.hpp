// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace reckon::app {

/// Opens /dev/null in place of standard streams that the caller has closed. A file that a command
/// opens would take their place, and get what is meant for the terminal.
void open_missing_streams();

/// Prints at once on standard output, and ignores that it takes no more (its reader is gone, its
/// disk is full): a run is worth more than its log.
void say(std::string_view text);

/// Prints the remaining output. Returns `code`, or that of a failed run where a command succeeded
/// but its answer could not be written. A reader that closes early is no failure.
[[nodiscard]] int end_output(int code);

}  // namespace reckon::app
