// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon bench: what a step costs on this machine, beside the plain algorithm.
void add_bench_command(CLI::App& app);

}  // namespace reckon::app
