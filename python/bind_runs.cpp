// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "reckon/output/history.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/results/run_verdict.hpp"
#include "reckon/results/saved_fields.hpp"
#include "reckon/run/run.hpp"
#include "scene.hpp"
#include "tables.hpp"

namespace reckon::python {
namespace {

namespace py = pybind11;

const char* word_of(RunEnd end) {
  switch (end) {
    case RunEnd::complete:
      return "complete";
    case RunEnd::at_rest:
      return "at rest";
    case RunEnd::interrupted:
      return "interrupted";
    case RunEnd::nothing_to_do:
      return "nothing to do";
  }
  return "";
}

/// `valid`, and `reasons` with a code and a text each.
void add_verdict(const RunVerdict& verdict, py::dict& table) {
  py::list reasons;
  for (const VerdictReason& reason : verdict.reasons) {
    reasons.append(py::make_tuple(reason.code, reason.text));
  }
  table["valid"] = verdict.valid();
  table["reasons"] = reasons;
}

py::dict report_of(const RunReport& report) {
  py::dict told;
  told["end"] = word_of(report.end);
  told["step"] = report.progress.step;
  told["time"] = report.progress.time;
  told["wall_seconds"] = report.progress.wall_seconds;
  told["energy_error"] = report.energy_error;
  told["energy_turnover"] = report.energy_turnover;
  add_verdict(report.verdict, told);
  told["last"] = table_of(report.measured, report.last.energy);
  told["stages"] = report.stages;
  return told;
}

/// As `reckon run`. A signal such as Ctrl-C ends the run in order, with a checkpoint, and is then
/// raised.
py::dict run(const Scene& scene, const RunOptions& options,
             const std::function<void(std::uint64_t, std::uint64_t)>& progress,
             const Communicator& ranks) {
  using Clock = std::chrono::steady_clock;
  auto heard = Clock::now();
  bool stop = false;
  std::optional<py::error_already_set> raised;
  RunHooks hooks;
  hooks.stop_requested = [&] { return stop; };
  hooks.progressed = [&](const RunProgress& at) {
    if (at.step < at.steps && Clock::now() - heard < std::chrono::milliseconds(100)) return;
    heard = Clock::now();
    const py::gil_scoped_acquire held;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set{};
      if (progress) progress(at.step, at.steps);
    } catch (py::error_already_set& error) {
      raised.emplace(error);
      stop = true;
    }
  };
  RunReport report;
  {
    const py::gil_scoped_release free;
    report = run_scene(scene.reading, scene.loaded, options, hooks, ranks);
  }
  if (raised) throw py::error_already_set{*raised};
  return report_of(report);
}

py::dict fields(const std::filesystem::path& folder, std::uint64_t step) {
  const SavedFields saved = read_fields(RunFolder{folder}, step);
  py::dict table;
  table["step"] = saved.step;
  table["time"] = saved.time;
  table["grains"] = table_of(saved.grains);
  table["contacts"] = saved.has_contacts ? py::object{table_of(saved.contacts)} : py::none();
  table["cell_corners"] = rows_of(saved.cell_corners);
  return table;
}

}  // namespace

void bind_runs(py::module_& module) {
  using py::arg;
  module.def(
      "_run",
      [](const Scene& scene, const std::filesystem::path& folder, bool resume, bool overwrite,
         std::optional<std::uint64_t> steps,
         const std::function<void(std::uint64_t, std::uint64_t)>& progress,
         std::optional<int> communicator) {
        RunOptions options;
        options.folder = folder;
        options.resume = resume;
        options.overwrite = overwrite;
        options.steps = steps;
        return run(scene, options, progress, ranks_of(communicator));
      },
      arg("scene"), arg("folder"), arg("resume"), arg("overwrite"), arg("steps"), arg("progress"),
      arg("communicator"));
  module.def(
      "_history",
      [](const std::filesystem::path& folder) {
        const HistoryTable table = read_history(RunFolder{folder}.history());
        return py::make_tuple(table.header, table.rows);
      },
      arg("folder"));
  module.def(
      "_steps",
      [](const std::filesystem::path& folder) { return RunFolder{folder}.field_steps("grains"); },
      arg("folder"));
  module.def(
      "_holds_run",
      [](const std::filesystem::path& folder) { return RunFolder{folder}.holds_run(); },
      arg("folder"));
  module.def(
      "_verdict",
      [](const std::filesystem::path& folder) {
        py::dict table;
        add_verdict(verdict_of(RunFolder{folder}), table);
        return table;
      },
      arg("folder"));
  module.def("_fields", &fields, arg("folder"), arg("step"));
}

}  // namespace reckon::python
