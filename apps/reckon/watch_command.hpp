// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon watch: shows a run in progress in a browser.
void add_watch_command(CLI::App& app);

}  // namespace reckon::app
