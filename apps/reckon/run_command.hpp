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

/// reckon run: runs a scene, or resumes a run, on all `ranks` together. The command holds a
/// reference to them. `launched`: by mpirun or the like, even if as a single rank; the terminal of
/// such a process is that of the launcher.
void add_run_command(CLI::App& app, const Communicator& ranks, bool launched);

}  // namespace reckon::app
