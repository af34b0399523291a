// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "watch_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include "reckon/core/error.hpp"
#include "reckon/report/watch_server.hpp"
#include "stop_signal.hpp"

namespace reckon::app {
namespace {

struct WatchOptions {
  std::string folder;
  int port{0};
  PageLimits limits;
};

void watch(const WatchOptions& options) {
  const RunFolder folder{options.folder};
  if (!folder.holds_run()) {
    throw Error{{.place = options.folder,
                 .problem = "this is not the folder of a run",
                 .reason = {},
                 .fix = "Start the run first, then name its folder."}};
  }
  WatchServer server{folder, options.limits, options.port};
  watch_stop_signals();
  std::atomic<bool> ended{false};
  std::thread stopper{[&] {
    while (stop_signal() == 0 && !ended) std::this_thread::sleep_for(std::chrono::milliseconds{50});
    server.stop();
  }};
  fmt::print("{}: {}  (only on this machine, only with this address; Ctrl-C ends)\n",
             options.folder, server.address());
  std::fflush(stdout);
  server.serve();
  ended = true;
  stopper.join();
}

}  // namespace

void add_watch_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "watch", "Show a run in a browser while it is in progress, as `report` does");
  auto options = std::make_shared<WatchOptions>();
  command->add_option("run", options->folder, "Folder of a run")->required();
  command->add_option("--port", options->port, "Port on 127.0.0.1; 0: any free port")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command
      ->add_option("--frames", options->limits.frames,
                   "Max number of saved times, evenly spread; 0: only curves and tables")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command->footer(
      "The page follows the run. It is read-only, and gives access to the files of this run only.\n"
      "The address holds a token: without it, other users of the machine cannot read the run.\n"
      "From another machine: ssh -L 8000:127.0.0.1:8000 HOST, with --port 8000 there; then open\n"
      "the address that is printed.\n\n"
      "Example:\n"
      "  reckon run settle.toml & reckon watch settle.run");
  command->callback([options] { watch(*options); });
}

}  // namespace reckon::app
