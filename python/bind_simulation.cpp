// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "reckon/analysis/sample.hpp"
#include "reckon/core/error.hpp"
#include "reckon/output/quantities.hpp"
#include "reckon/run/run_start.hpp"
#include "reckon/scene/scene_loader.hpp"
#include "reckon/simulation/simulation.hpp"
#include "scene.hpp"
#include "tables.hpp"

namespace reckon::python {
namespace {

/// All faults in one exception, as `reckon check` lists them.
std::shared_ptr<Scene> sound(SceneReading reading, const std::string& name) {
  auto scene = std::make_shared<Scene>();
  scene->reading = std::move(reading);
  scene->loaded = load_scene(scene->reading);
  scene->name = name;
  const auto& faults = scene->reading.faults;
  if (faults.empty()) return scene;
  std::string list;
  for (const SceneFault& fault : faults) list += "\n  " + describe(fault, name);
  throw Error{{.place = {},
               .problem = fmt::format("{} has {} fault{}{}", name, faults.size(),
                                      faults.size() == 1 ? "" : "s", list),
               .reason = {},
               .fix = {}}};
}

/// All steps under the caller's control.
class Stepper {
 public:
  Stepper(std::shared_ptr<Scene> scene, const Communicator& ranks)
      : scene_{std::move(scene)}, prepared_{prepare(scene_->loaded, ranks)} {
    simulation_ = std::make_unique<Simulation>(
        prepared_.setup, ranks.is_root() ? prepared_.initial : SimulationState{}, ranks);
    energy_at_start_ = simulation_->measure().energy.total();
  }

  /// Ctrl-C is heard between steps.
  void step(std::uint64_t count) {
    using Clock = std::chrono::steady_clock;
    auto heard = Clock::now();
    const py::gil_scoped_release free;
    for (std::uint64_t n = 0; n < count; ++n) {
      simulation_->step();
      if (Clock::now() - heard < std::chrono::milliseconds(100)) continue;
      const py::gil_scoped_acquire held;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set{};
      heard = Clock::now();
    }
  }

  /// What history.csv has at a step, the sample included.
  [[nodiscard]] py::dict measure() {
    const Measurement measurement = simulation_->measure();
    const SampleMeasurement sample = measure_sample(*simulation_);
    HistoryRow row{.measurement = measurement, .energy_at_start = energy_at_start_};
    row.sample = &sample;
    if (simulation_->cell() != nullptr) row.cell = &simulation_->cell_state();
    if (simulation_->stage() != nullptr) row.stage = simulation_->stage_starts().size();
    const auto quantities = quantities_of(layout_of(simulation_->setup(), true));
    return table_of(measured(quantities, row), measurement.energy);
  }

  [[nodiscard]] Simulation& simulation() { return *simulation_; }
  [[nodiscard]] const PreparedScene& prepared() const { return prepared_; }

 private:
  std::shared_ptr<Scene> scene_;
  PreparedScene prepared_;
  std::unique_ptr<Simulation> simulation_;
  double energy_at_start_{0};  // [J]
};

void begin_next_stage(Stepper& stepper) {
  Simulation& simulation = stepper.simulation();
  if (simulation.stage_starts().size() >= simulation.setup().stages.size()) {
    throw Error{{.place = "Simulation.begin_next_stage",
                 .problem = "there is no further stage",
                 .reason = fmt::format("the scene has {}", simulation.setup().stages.size()),
                 .fix = {}}};
  }
  simulation.begin_next_stage();
}

}  // namespace

void bind_simulation(py::module_& module) {
  using py::arg;
  py::class_<Scene, std::shared_ptr<Scene>>(module, "_Scene")
      .def(py::init([](const std::filesystem::path& file) {
             return sound(read_scene_file(file), file.string());
           }),
           arg("file"))
      .def_static(
          "from_text",
          [](const std::string& text, const std::filesystem::path& directory,
             const std::string& name) { return sound(read_scene_text(text, directory), name); },
          arg("text"), arg("directory"), arg("name"))
      .def_property_readonly("text", [](const Scene& s) { return s.reading.text; })
      .def_property_readonly("title", [](const Scene& s) { return s.loaded.config.title; })
      .def_property_readonly("grain_count", [](const Scene& s) { return s.loaded.grains.size(); })
      .def("resolved", [](const Scene& s) {
        const PreparedScene prepared = prepare(s.loaded);
        return resolved_scene(s.loaded.config, prepared, prepared.steps);
      });
  py::class_<Stepper>(module, "_Simulation")
      .def(py::init([](std::shared_ptr<Scene> scene, std::optional<int> communicator) {
             return std::make_unique<Stepper>(std::move(scene), ranks_of(communicator));
           }),
           arg("scene"), arg("communicator"))
      .def("step", &Stepper::step, arg("count") = 1)
      .def("begin_next_stage", &begin_next_stage)
      .def_property_readonly("time", [](Stepper& s) { return s.simulation().time(); })
      .def_property_readonly("time_step", [](Stepper& s) { return s.prepared().setup.time_step; })
      .def_property_readonly("planned_steps", [](Stepper& s) { return s.prepared().steps; })
      .def_property_readonly("step_number", [](Stepper& s) { return s.simulation().step_number(); })
      .def_property_readonly("stage",
                             [](Stepper& s) -> py::object {
                               const StageSetup* stage = s.simulation().stage();
                               if (stage == nullptr) return py::none();
                               return py::str(stage->name);
                             })
      .def("measure", &Stepper::measure)
      .def("grains", [](Stepper& s) { return table_of(s.simulation().grain_states()); })
      .def("contacts", [](Stepper& s) { return table_of(s.simulation().contacts()); });
}

}  // namespace reckon::python
