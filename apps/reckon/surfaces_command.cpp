// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "surfaces_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "progress.hpp"
#include "reckon/results/run_surfaces.hpp"
#include "reckon/text/human.hpp"

namespace reckon::app {

void add_surfaces_command(CLI::App& app) {
  struct Options {
    std::string folder;
    std::optional<std::uint64_t> step;
  };
  CLI::App* command = app.add_subcommand(
      "surfaces", "Write the grains' true surfaces at the checkpoints of a run, for ParaView");
  auto options = std::make_shared<Options>();
  command->add_option("run", options->folder, "Folder of a run")->required();
  command->add_option("--step", options->step, "Only the checkpoint of this step");
  command->footer(
      "Files are written to the folder of the run; surfaces.pvd lists them. To write surfaces at\n"
      "every frame, set output.surfaces = true in the scene.\n\n"
      "Example:\n  reckon surfaces settle.run");
  command->callback([options] {
    SurfaceFiles files;
    {
      CountDisplay display{"checkpoints"};
      files = write_run_surfaces(
          RunFolder{options->folder}, options->step,
          [](const std::string& size) { fmt::print(stderr, "{}\n", size); },
          [&](std::size_t done, std::size_t total) { display.show(done, total); });
    }
    fmt::print("{} written; open {}\n", counted(files.written, "file"), files.index.string());
  });
}

}  // namespace reckon::app
