// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace reckon::app {

/// Threads of one process. OpenMP ends the program if the system refuses to start as many as
/// requested.
inline constexpr int most_threads = 1024;

}  // namespace reckon::app
