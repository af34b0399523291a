// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace reckon::app {

/// Threads of one process. Where the system refuses to start as many as are asked for, OpenMP ends
/// the program.
inline constexpr int most_threads = 1024;

}  // namespace reckon::app
