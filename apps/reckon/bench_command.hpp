// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon bench: the cost of a step on this machine, compared with the plain algorithm.
void add_bench_command(CLI::App& app);

}  // namespace reckon::app
