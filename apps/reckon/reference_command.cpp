// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reference_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "reckon/io/history.hpp"
#include "reckon/io/scene_schema.hpp"

namespace reckon::app {

void add_reference_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("reference", "Print a page of the reference, in Markdown");
  auto page = std::make_shared<std::string>();
  command->add_option("page", *page, "scene: every key of a scene; history: columns of history.csv")
      ->required()
      ->check(CLI::IsMember({"scene", "history"}));
  command->footer("Example:\n  reckon reference scene | less");
  command->callback([page] {
    const std::string text =
        *page == "scene" ? scene_reference_markdown() : history_reference_markdown();
    std::fputs(text.c_str(), stdout);
  });
}

}  // namespace reckon::app
