// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "bench_command.hpp"
#include "check_command.hpp"
#include "diff_command.hpp"
#include "exit_codes.hpp"
#include "grains_command.hpp"
#include "reckon/core/build_info.hpp"
#include "reckon/core/error.hpp"
#include "reckon/io/nearest_name.hpp"
#include "reckon/io/run.hpp"
#include "reference_command.hpp"
#include "run_command.hpp"
#include "surfaces_command.hpp"

namespace {

std::string version() {
  const reckon::BuildInfo build = reckon::build_info();
  return fmt::format("reckon {} ({}, {}, {})", build.version, build.revision, build.compiler,
                     build.flags);
}

/// The subcommand that was being parsed, or the program itself.
std::string help_of(const CLI::App& app) {
  const auto used = app.get_subcommands();
  return used.empty() ? "reckon --help" : fmt::format("reckon {} --help", used.front()->get_name());
}

/// CLI11 would only say that a command is missing; a typo deserves the name that was meant.
void require_known_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == argv[1]) return;
    names.push_back(command->get_name());
  }
  const auto near = reckon::nearest_name(argv[1], names);
  throw reckon::Error{{.place = {},
                       .problem = fmt::format("there is no command \"{}\"", argv[1]),
                       .reason = {},
                       .fix = near ? fmt::format("Did you mean `reckon {}`?", *near)
                                   : fmt::format("There are {}.", fmt::join(names, ", "))}};
}

/// Idle threads of GNU's OpenMP spin for milliseconds before they sleep. Where other programs want
/// the cores too, each of the many short parallel loops of a step then waits for a turn of the
/// scheduler, and a run becomes a hundred times slower. The library reads its settings before main,
/// so the program starts itself once more with a short spin, unless the user has chosen one.
// NOLINTBEGIN(concurrency-mt-unsafe): the environment is read before any thread starts
void restart_with_short_spin(char** argv) {
  for (const char* name : {"GOMP_SPINCOUNT", "OMP_WAIT_POLICY"}) {
    if (std::getenv(name) != nullptr) return;
  }
  setenv("GOMP_SPINCOUNT", "20000", 1);
  execv("/proc/self/exe", argv);  // on failure: go on as we are
}

/// A run uses one process: copies of it would write over each other's files.
void require_one_process() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* count = std::getenv(name);
    if (count == nullptr || std::string_view{count} == "1") continue;
    throw reckon::Error{{.place = {},
                         .problem = fmt::format("started {} times at once", count),
                         .reason = "a run uses one process with threads",
                         .fix = "Start it without mpirun; --threads sets the number of threads."}};
  }
}
// NOLINTEND(concurrency-mt-unsafe)

int complain(const std::string& problem, int code) {
  fmt::print(stderr, "reckon: error: {}\n", problem);
  return code;
}

}  // namespace

// What escapes while the options are described ends the program with its own text.
int main(int argc, char** argv) {  // NOLINT(bugprone-exception-escape)
  using namespace reckon::app;
  restart_with_short_spin(argv);
  CLI::App app{
      "Sand Reckoner: level-set discrete element method for grains of any shape.\n"
      "Shapes come from `grains`, a scene says what happens to them, `check` and `run` do the "
      "rest.",
      "reckon"};
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  add_grains_command(app);
  add_check_command(app);
  add_run_command(app);
  add_diff_command(app);
  add_surfaces_command(app);
  add_bench_command(app);
  add_reference_command(app);
  app.footer(std::string{"`reckon COMMAND --help` has examples.\n\n"} + exit_code_footer);
  try {
    require_one_process();
    require_known_command(app, argc, argv);
    app.parse(argc, argv);
    return success;
  } catch (const CLI::RuntimeError& end) {
    return end.get_exit_code();  // the command has said why
  } catch (const CLI::Success& asked_for_help) {
    return app.exit(asked_for_help);
  } catch (const CLI::ParseError& error) {
    return complain(fmt::format("{}\nSee: {}", error.what(), help_of(app)), input_at_fault);
  } catch (const reckon::RunFailure& error) {
    return complain(error.what(), run_failed);
  } catch (const reckon::Error& error) {
    return complain(error.what(), input_at_fault);
  } catch (const std::bad_alloc&) {
    return complain("not enough memory for this scene", run_failed);
  } catch (const std::exception& error) {
    return complain(fmt::format("{}. This is a fault of reckon itself", error.what()),
                    internal_error);
  }
}
