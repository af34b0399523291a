// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// `reckon analyse`: local strains and the distribution of forces of a run.
void add_analyse_command(CLI::App& app);

}  // namespace reckon::app
