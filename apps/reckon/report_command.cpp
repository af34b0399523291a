// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "report_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "progress.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/report/page.hpp"
#include "reckon/results/run_verdict.hpp"
#include "reckon/text/human.hpp"

namespace reckon::app {
namespace {

struct ReportOptions {
  std::vector<std::string> folders;
  std::string output;
  PageLimits limits;
};

void report(const ReportOptions& options) {
  const std::vector<RunFolder> runs(options.folders.begin(), options.folders.end());
  std::filesystem::path output = options.output;
  if (output.empty()) output = runs.front().report();
  require_own_file(output, "content=\"Sand Reckoner\"", "report of reckon");
  for (const RunFolder& run : runs) {
    if (const std::string verdict = verdict_text(verdict_of(run)); !verdict.empty()) {
      fmt::print("{}: {}", run.root().string(), verdict);
    }
    const std::size_t saved = run.field_steps("grains").size();
    const std::size_t shown = std::min(saved, options.limits.frames);
    if (shown == saved) continue;
    fmt::print("{}: {} of {} saved times (--frames)\n", run.root().string(), shown, saved);
  }
  std::string page;
  std::vector<std::string> notes;
  {
    CountDisplay display{"saved times"};
    page = report_page(
        runs, options.limits,
        [&](std::size_t done, std::size_t total) { display.show(done, total); },
        [&](const std::string& note) { notes.push_back(note); });
  }
  for (const std::string& note : notes) std::fputs((printable(note) + '\n').c_str(), stderr);
  write_file(output, page);
  fmt::print("{}: {}; open it in a browser\n", output.string(),
             human_bytes(std::filesystem::file_size(output)));
}

}  // namespace

void add_report_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "report", "Write one HTML file that shows runs: curves, grains in three dimensions, tables");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("runs", options->folders, "Folders of runs; several are compared")
      ->required();
  command->add_option("-o,--output", options->output,
                      "The file (default: report.html in the first folder)");
  command
      ->add_option("--frames", options->limits.frames,
                   "Max number of saved times, evenly spread; 0: only curves and tables")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command->footer(
      "The file needs no network and no other file. The run may still be in progress.\n\n"
      "Examples:\n"
      "  reckon report settle.run\n"
      "  reckon report loose.run dense.run -o compared.html");
  command->callback([options] { report(*options); });
}

}  // namespace reckon::app
