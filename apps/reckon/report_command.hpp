// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon report: shows runs in one HTML file.
void add_report_command(CLI::App& app);

}  // namespace reckon::app
