// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "check_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "exit_codes.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/run/run_plan.hpp"
#include "reckon/text/json_writer.hpp"
#include "scene_input.hpp"
#include "thread_limit.hpp"

namespace reckon::app {
namespace {

struct CheckOptions {
  std::string scene;
  bool json{false};
  int threads{0};
  double timing_seconds{2};
};

std::string faults_json(const SceneReading& reading, const std::string& file) {
  JsonWriter json;
  json.begin_object();
  json.value("valid", false);
  json.begin_array("faults");
  for (const SceneFault& fault : reading.faults) {
    json.begin_object();
    json.value("file", file);
    json.value("line", fault.position.line);
    json.value("column", fault.position.column);
    json.value("key", fault.key);
    json.value("problem", fault.problem);
    json.value("fix", fault.fix);
    json.end();
  }
  json.end();
  json.end();
  return json.text();
}

void check(const CheckOptions& options) {
  if (options.threads > 0) set_thread_count(options.threads);
  const SceneInput input = read_scene(options.scene);
  if (!input.reading.faults.empty()) {
    if (options.json) {
      std::fputs(faults_json(input.reading, options.scene).c_str(), stdout);
    } else {
      print_faults(options.scene, input.reading);
    }
    throw CLI::RuntimeError{input_at_fault};
  }
  const RunPlan plan = plan_run(input.scene, options.timing_seconds);
  if (options.json) {
    std::fputs(plan_json(plan).c_str(), stdout);
  } else {
    const std::string& title = input.scene.config.title;
    fmt::print("{}: no faults{}\n{}", printable(options.scene),
               title.empty() ? "" : " (" + printable(title) + ")", plan_text(plan));
  }
  if (plan.trial_failure) throw CLI::RuntimeError{run_failed};
}

}  // namespace

void add_check_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "check", "Find all faults of a scene and describe its run; writes no files");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("scene", options->scene, "Scene file (TOML)")->required();
  command->add_flag("--json", options->json, "Answer in JSON");
  command->add_option("--threads", options->threads, "Threads for the timed steps (default: all)")
      ->check(CLI::Range(1, most_threads));
  command
      ->add_option("--timing", options->timing_seconds,
                   "Seconds for which steps are run in memory, to measure their time")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->footer(std::string{"Examples:\n"
                              "  reckon check settle.toml\n"
                              "  reckon check settle.toml --json | jq .time_step\n\n"} +
                  exit_code_footer);
  command->callback([options] { check(*options); });
}

}  // namespace reckon::app
