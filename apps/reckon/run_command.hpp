// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon {
class Communicator;
}

namespace reckon::app {

/// reckon run: runs a scene, or goes on with a run, on all `ranks` together. The command holds a
/// reference to them. `launched`: by mpirun or the like, even if as a single rank; the terminal
/// that such a process sees is the launcher's.
void add_run_command(CLI::App& app, const Communicator& ranks, bool launched);

}  // namespace reckon::app
