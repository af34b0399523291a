// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "paraview_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "reckon/core/utf8.hpp"
#include "reckon/report/paraview_state.hpp"
#include "reckon/text/human.hpp"

namespace reckon::app {

void add_paraview_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("paraview", "Write a ParaView state that shows a run");
  auto folder = std::make_shared<std::string>();
  command->add_option("run", *folder, "Folder of a run")->required();
  command->footer(
      "Files are written to the folder paraview in the folder of the run. The run may still be\n"
      "in progress.\n\n"
      "Examples:\n"
      "  reckon paraview settle.run\n"
      "  paraview --script=settle.run/paraview/state.py\n"
      "  pvpython settle.run/paraview/state.py settled.png");
  command->callback([folder] {
    const ParaviewState state = write_paraview_state(RunFolder{*folder});
    if (!state.missing.empty()) {
      fmt::print("Grains will be spheres of equal volume: {}\n", printable(state.missing));
    }
    fmt::print("{}: {} shapes; draw the run with\n  paraview --script={}\n", state.script.string(),
               state.shapes, shell_word(state.script.string()));
  });
}

}  // namespace reckon::app
