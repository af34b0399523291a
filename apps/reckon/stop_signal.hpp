// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace reckon::app {

/// From now on the first SIGINT, SIGTERM or SIGUSR1 (which batch systems send ahead of the end of a
/// job's time, and mpirun passes on) is only noted, so that a run can end in good order; a
/// second one ends the process at once.
void watch_stop_signals();

/// The signal that has come, or 0.
[[nodiscard]] int stop_signal();

}  // namespace reckon::app
