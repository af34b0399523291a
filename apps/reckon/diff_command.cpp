// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "diff_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "exit_codes.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/results/run_diff.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon::app {
namespace {

struct DiffOptions {
  std::string first;
  std::string second;
  bool json{false};
};

std::string as_text(const RunComparison& comparison) {
  std::string text = comparison.identical() ? "bit-identical\n" : "the runs differ\n";
  for (const RunComparison::Part& part : comparison.parts) {
    if (!part.difference) {
      text += fmt::format("  {}: same ({})\n", part.name, part.compared);
      continue;
    }
    const Difference& d = *part.difference;
    text +=
        fmt::format("  {}: first difference in {}, {}: {} and {}{}\n", part.name, d.what, d.where,
                    d.first, d.second, d.ulps ? fmt::format(" ({} ulp)", *d.ulps) : std::string{});
  }
  return text;
}

std::string as_json(const RunComparison& comparison) {
  JsonWriter json;
  json.begin_object();
  json.value("identical", comparison.identical());
  json.begin_array("parts");
  for (const RunComparison::Part& part : comparison.parts) {
    json.begin_object();
    json.value("name", part.name);
    json.value("compared", part.compared);
    json.value("identical", !part.difference.has_value());
    if (part.difference) {
      json.begin_object("first_difference");
      json.value("what", part.difference->what);
      json.value("where", part.difference->where);
      json.value("first", part.difference->first);
      json.value("second", part.difference->second);
      if (part.difference->ulps) json.value("ulps", *part.difference->ulps);
      json.end();
    }
    json.end();
  }
  json.end();
  json.end();
  return json.text();
}

void diff(const DiffOptions& options) {
  RunComparison comparison;
  try {
    comparison = compare_runs(RunFolder{options.first}, RunFolder{options.second});
  } catch (const Error& error) {
    // Like cmp and diff: 1 means that they differ, so an error needs another number.
    fmt::print(stderr, "reckon: error: {}\n", printable(error.what()));
    throw CLI::RuntimeError{run_failed};
  }
  std::fputs((options.json ? as_json(comparison) : as_text(comparison)).c_str(), stdout);
  if (!comparison.identical()) throw CLI::RuntimeError{input_at_fault};
}

}  // namespace

void add_diff_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("diff", "Compare two runs bit by bit");
  auto options = std::make_shared<DiffOptions>();
  command->add_option("first", options->first, "Folder of a run")->required();
  command->add_option("second", options->second, "Folder of another run")->required();
  command->add_flag("--json", options->json, "Answer in JSON");
  command->footer(
      "Compares the histories, the checkpoints of steps that both have, and the latest ones.\n\n"
      "Example:\n"
      "  reckon diff settle.run settle-4-threads.run\n\n"
      "Exit codes: 0 bit-identical, 1 the runs differ, 2 a run could not be read.");
  command->callback([options] { diff(*options); });
}

}  // namespace reckon::app
