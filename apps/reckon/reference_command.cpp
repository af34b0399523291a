// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reference_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "command_pages.hpp"
#include "reckon/output/grain_fields.hpp"
#include "reckon/output/history.hpp"
#include "reckon/scene/scene_schema.hpp"

namespace reckon::app {

void add_reference_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("reference", "Print a page of the reference");
  auto page = std::make_shared<std::string>();
  command
      ->add_option("page", *page,
                   "scene: every key of a scene; history: columns of history.csv; fields: what is "
                   "saved of each grain; commands: every command and option (these in Markdown); "
                   "man: the commands as a manual page; bash: completion for bash")
      ->required()
      ->check(CLI::IsMember({"scene", "history", "fields", "commands", "man", "bash"}));
  command->footer(
      "Examples:\n"
      "  reckon reference scene | less\n"
      "  reckon reference man | man -l -\n"
      "  source <(reckon reference bash)");
  command->callback([page, &app] {
    std::string text;
    if (*page == "scene") text = scene_reference_markdown();
    if (*page == "history") text = history_reference_markdown();
    if (*page == "fields") text = grain_fields_markdown();
    if (*page == "commands") text = commands_markdown(app);
    if (*page == "man") text = manual_page(app);
    if (*page == "bash") text = bash_completion(app);
    std::fputs(text.c_str(), stdout);
  });
}

}  // namespace reckon::app
