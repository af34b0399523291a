// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>
#include <system_error>

#include "analyse_command.hpp"
#include "bench_command.hpp"
#include "check_command.hpp"
#include "command_pages.hpp"
#include "diff_command.hpp"
#include "exit_codes.hpp"
#include "grains_command.hpp"
#include "option_faults.hpp"
#include "paraview_command.hpp"
#include "reckon/core/build_info.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/failure_text.hpp"
#include "reckon/core/hdf5_handle.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/parallel/communicator.hpp"
#include "reckon/run/run.hpp"
#include "reference_command.hpp"
#include "report_command.hpp"
#include "run_command.hpp"
#include "standard_streams.hpp"
#include "surfaces_command.hpp"
#include "thread_limit.hpp"
#include "watch_command.hpp"

namespace reckon::app {
namespace {

std::string version() {
  const BuildInfo build = build_info();
  return fmt::format("reckon {} ({}, {}, {})", build.version, build.revision, build.compiler,
                     build.flags);
}

/// Some libraries read their settings before main, so the program restarts itself once with
/// suitable settings, unless the user has chosen:
/// - Idle threads of GNU's OpenMP spin for milliseconds before they sleep. Where other programs
/// want
///   the cores too, each of the many short parallel loops of a step then waits for a turn of the
///   scheduler, and a run becomes a hundred times slower. A short spin will do.
/// - OpenMP takes any OMP_NUM_THREADS, and ends the program where the system refuses so many.
/// - GNU's malloc can ask for huge pages. The near lists of many pairs need more pages than the
/// address cache of a processor holds.
// NOLINTBEGIN(concurrency-mt-unsafe): the environment is read before any thread starts
void restart_with_settings(char** argv) {
  bool changed = false;
  const auto prefer = [&](const char* name, const char* value) {
    if (std::getenv(name) != nullptr) return;
    changed = setenv(name, value, 1) == 0 || changed;
  };
  const char* threads = std::getenv("OMP_NUM_THREADS");
  if (threads != nullptr && std::strtod(threads, nullptr) > most_threads) {
    changed = setenv("OMP_NUM_THREADS", std::to_string(most_threads).c_str(), 1) == 0 || changed;
  }
  if (std::getenv("OMP_WAIT_POLICY") == nullptr) prefer("GOMP_SPINCOUNT", "1000");
  prefer("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1");
  if (changed) execv("/proc/self/exe", argv);  // on failure: go on as we are
}

/// Whether mpirun, srun or the like started this process. Without them MPI is left alone: its start
/// takes time, and most commands do not need it.
bool started_by_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}
// NOLINTEND(concurrency-mt-unsafe)

int complain(const Communicator& ranks, const std::string& problem, int code) {
  if (ranks.is_root()) {
    std::fputs(fmt::format("reckon: error: {}\n", printable(problem)).c_str(), stderr);
  }
  return code;
}

/// Ends a command that threw. An Error on all ranks is printed once, and all end in order. An error
/// on only some ranks is printed by them, and ends the others too, which may be waiting for a
/// message.
int end_failed(const Communicator& ranks, const std::string& problem, int code) {
  constexpr double patience = 3;  // [s]
  if (ranks.meet(patience)) return complain(ranks, problem, code);
  fmt::print(stderr, "reckon: error on rank {} of {}: {}\n", ranks.rank(), ranks.size(),
             printable(problem));
  std::fflush(nullptr);
  ranks.abort(code);
}

/// All commands but `run` are for one process.
void require_run_command(const Communicator& ranks, int argc, char** argv) {
  if (ranks.size() == 1 || (argc > 1 && std::string_view{argv[1]} == "run")) return;
  throw Error{{.place = {},
               .problem = fmt::format("started {} times at once", ranks.size()),
               .reason = "only `reckon run` uses several processes",
               .fix = "Start it without mpirun."}};
}

int run_command_line(int argc, char** argv, const Communicator& ranks) {
  CLI::App app{
      "Sand Reckoner: level-set discrete element method for grains of any shape.\n"
      "`grains` makes shapes. A scene describes a test on them. `check` finds faults in a scene, "
      "and `run` runs it.",
      "reckon"};
  use_help_format(app);
  app.set_version_flag("-v,--version", version());
  app.require_subcommand(1);
  CommandWords words{argv, argv + argc};
  if (!words.empty()) words.front() = "reckon";
  add_grains_command(app, words);
  add_check_command(app);
  add_run_command(app, ranks, started_by_launcher());
  add_diff_command(app);
  add_report_command(app);
  add_watch_command(app);
  add_paraview_command(app);
  add_surfaces_command(app);
  add_analyse_command(app);
  add_bench_command(app);
  add_reference_command(app);
  app.footer(std::string{"`reckon COMMAND --help` has examples.\n\n"} + exit_code_footer);
  refuse_odd_values(app);
  try {
    require_run_command(ranks, argc, argv);
    require_known_command(app, argc, argv);
    app.parse(argc, argv);
    return success;
  } catch (const CLI::RuntimeError& end) {
    return end.get_exit_code();  // the command has said why
  } catch (const CLI::Success& asked_for_help) {
    return ranks.is_root() ? app.exit(asked_for_help) : success;
  } catch (const CLI::ParseError& error) {
    return complain(ranks, explain(error, app), input_at_fault);
  } catch (const RunFailure& error) {
    return end_failed(ranks, error.what(), run_failed);
  } catch (const std::exception& error) {
    const std::string problem = Error{failure_text(error)}.what();
    if (is_failure_of_machine(error)) return end_failed(ranks, problem, run_failed);
    const bool is_of_input = dynamic_cast<const Error*>(&error) != nullptr ||
                             dynamic_cast<const std::system_error*>(&error) != nullptr;
    if (is_of_input) return end_failed(ranks, problem, input_at_fault);
    return end_failed(ranks, fmt::format("{}. This is a fault of reckon itself", problem),
                      internal_error);
  }
}

}  // namespace
}  // namespace reckon::app

// What escapes while the options are described ends the program with its own text.
int main(int argc, char** argv) {  // NOLINT(bugprone-exception-escape)
  using namespace reckon::app;
  open_missing_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond `ulimit -f` then fails with an error
  restart_with_settings(argv);
  reckon::skip_hdf5_cleanup_at_exit();
  if (!started_by_launcher()) return end_output(run_command_line(argc, argv, {}));
  try {
    const reckon::ParallelSession session{argc, argv};
    return end_output(run_command_line(argc, argv, session.world()));
  } catch (const reckon::Error& error) {  // a build without MPI
    return complain({}, error.what(), input_at_fault);
  }
}
