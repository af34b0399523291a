// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/scene_loader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "reckon/avatar/shape_catalog.hpp"
#include "reckon/core/error.hpp"
#include "reckon/math/rotation.hpp"
#include "reckon/scene/placement_table.hpp"
#include "reckon/scene/scale_check.hpp"
#include "reckon/scene/stage_check.hpp"
#include "reckon/scene/start_check.hpp"
#include "reckon/simulation/fill_region.hpp"
#include "reckon/simulation/stage_setup.hpp"
#include "reckon/simulation/time_step.hpp"
#include "reckon/text/free_memory.hpp"
#include "reckon/text/nearest_name.hpp"
#include "reckon/text/number_table.hpp"

namespace reckon {
namespace {

class Loader {
 public:
  explicit Loader(SceneReading& reading) : reading_{reading} {}

  LoadedScene load() {
    const SceneConfig& config = reading_.config;
    LoadedScene scene;
    scene.config = config;
    for (std::size_t set = 0; set < config.grains.size(); ++set) {
      load_set(config.grains[set], fmt::format("grains[{}]", set), scene);
    }
    scene.shapes = std::move(shapes_);
    scene.read_shape = [catalog = catalog_](ShapeId shape) { return catalog->read(shape); };
    load_accelerations(scene);
    check_outflows(scene);
    if (reading_.faults.empty() && scene.grains.empty()) {
      fault("grains", "the scene has no grains", "Place at least one.");
    }
    if (reading_.faults.empty()) {
      resolve_rate_limits(scene.config, scene.grains, scene.shapes);
      check_time_step(scene);
      StageCheck{scene, [&](auto&&... text) { fault(text...); }}.run();
    }
    if (reading_.faults.empty()) check_start(scene);
    std::stable_sort(
        reading_.faults.begin(), reading_.faults.end(),
        [](const SceneFault& a, const SceneFault& b) { return a.position < b.position; });
    return scene;
  }

 private:
  /// The time step depends on the shapes, so what follows from it is known only here.
  void check_time_step(const LoadedScene& scene) {
    const TimeConfig& time = scene.config.time;
    const double step = choose_time_step(scene.config, scene.grains, scene.shapes).step;
    const std::string key = !scene.config.stages.empty() ? "stage"
                            : time.duration              ? "time.duration"
                                                         : "time.steps";
    if (!(step > 0 && std::isfinite(step))) {
      return fault(key, fmt::format("the rule for the time step gives {}", step),
                   "Where no grain moves freely, give time.step.");
    }
    constexpr double most_steps = 1e15;
    const auto check_duration = [&](const std::string& of, const std::optional<double>& duration) {
      if (!duration || !(*duration / step > most_steps)) return;
      fault(of,
            fmt::format("needs {:.3g} steps of {:.3g} s, more than any machine can make",
                        *duration / step, step),
            {});
    };
    check_duration(key, time.duration);
    for (std::size_t n = 0; n < scene.config.stages.size(); ++n) {
      check_duration(fmt::format("stage[{}].duration", n), scene.config.stages[n].duration);
    }
  }

  /// What only shows where all else is right.
  void check_start(LoadedScene& scene) {
    const auto to_faults = [&](auto&&... text) { fault(text...); };
    const auto to_warnings = [&](std::string text) { warnings_.push_back(std::move(text)); };
    const double step = choose_time_step(scene.config, scene.grains, scene.shapes).step;
    ScaleCheck scale{scene, step, to_faults, to_warnings};
    scale.run();
    if (scale.resolves_positions()) {
      attempt("grains", [&] { StartCheck{scene, first_ids_, to_faults, to_warnings}.run(); });
    }
    scene.warnings = std::move(warnings_);
  }

  void check_outflows(const LoadedScene& scene) {
    for (const PlaneSurface& plane : outflow_planes(scene.config)) {
      const auto out =
          std::find_if(scene.grains.begin(), scene.grains.end(),
                       [&](const GrainState& grain) { return plane.distance(grain.position) < 0; });
      if (out == scene.grains.end()) continue;
      return fault(
          "outflow",
          fmt::format("grain {} is beyond it from the start, at ({:.6g}, {:.6g}, {:.6g}) m",
                      out->id.get(), out->position.x, out->position.y, out->position.z),
          "Place grains where they may be; a plane's normal points to their side.");
    }
  }

  void warn_of_early_nodes(const std::string& library) {
    std::string text = fmt::format(
        "the library {} was written by an older version, whose nodes may lie inside the surface "
        "and stop short of sharp edges: boxes then tip too early, and corners sink in; make it "
        "anew",
        library);
    if (std::ranges::find(warnings_, text) == warnings_.end()) warnings_.push_back(std::move(text));
  }

  void load_set(const GrainsConfig& set, const std::string& path, LoadedScene& scene) {
    first_ids_.push_back(static_cast<std::uint32_t>(scene.grains.size()));
    if (set.library.empty()) return;  // its fault is known
    const std::size_t first_shape = shapes_.size();
    const bool loaded = attempt(path + ".library", [&] {
      if (catalog_->add(set.library, set.voxel).has_early_nodes()) warn_of_early_nodes(set.library);
      for (std::size_t s = first_shape; s < catalog_->size(); ++s) {
        shapes_.push_back(catalog_->summary(ShapeId{static_cast<std::uint32_t>(s)}));
      }
    });
    if (!loaded) return;
    const auto shapes = std::span<const ShapeSummary>{shapes_}.subspan(first_shape);
    const auto first_id = static_cast<std::uint32_t>(scene.grains.size());
    const auto shape_in_turn = [&](std::size_t n) {
      return ShapeId{static_cast<std::uint32_t>(first_shape + n % shapes.size())};
    };
    std::vector<GrainState> placed;
    if (const auto* fill = std::get_if<FillPlacement>(&set.placement)) {
      if (has_fault_below(path) || has_syntax_fault()) return;
      attempt(path + ".fill", [&] {
        require_memory(2 * sizeof(GrainState) * std::uint64_t{fill->count},
                       fmt::format("{} grains", fill->count), "Lower the count.");
        std::vector<ShapeView> views;
        for (const ShapeSummary& shape : shapes) views.emplace_back(shape.outline);
        placed = fill_region(*fill, views, ShapeId{static_cast<std::uint32_t>(first_shape)},
                             GrainId{first_id}, reading_.config.seed);
      });
    } else if (const auto* each = std::get_if<std::vector<ExplicitGrain>>(&set.placement)) {
      for (std::size_t n = 0; n < each->size(); ++n) {
        placed.push_back(to_state((*each)[n]));
        placed.back().shape = shape_in_turn(n);
        if (!(*each)[n].shape.empty()) {
          find_shape_of((*each)[n], fmt::format("{}.place[{}].shape", path, n), shapes, first_shape,
                        placed.back());
        }
      }
    } else if (const auto* table = std::get_if<TablePlacement>(&set.placement)) {
      if (table->file.empty()) return;  // its fault is known
      attempt(path + ".table.file", [&] {
        placed = read_placement(table->file, shapes.size());
        for (GrainState& grain : placed) {
          grain.shape = ShapeId{static_cast<std::uint32_t>(first_shape) + grain.shape.get()};
        }
      });
    } else {
      placed = load_legacy(std::get<LegacyPlacement>(set.placement), set.voxel, path + ".files");
      for (std::size_t n = 0; n < placed.size(); ++n) placed[n].shape = shape_in_turn(n);
    }
    for (GrainState& grain : placed) {
      grain.id = GrainId{static_cast<std::uint32_t>(scene.grains.size())};
      scene.grains.push_back(grain);
    }
  }

  static GrainState to_state(const ExplicitGrain& grain) {
    GrainState state;
    state.prescribed = grain.fixed;
    state.position = grain.position;
    state.orientation = normalized(Quaternion{grain.orientation[0], grain.orientation[1],
                                              grain.orientation[2], grain.orientation[3]});
    state.velocity = grain.velocity;
    state.angular_velocity_body =
        transposed_times(rotation_matrix(state.orientation), grain.angular_velocity);
    return state;
  }

  void find_shape_of(const ExplicitGrain& grain, const std::string& key,
                     std::span<const ShapeSummary> shapes, std::size_t first_shape,
                     GrainState& state) {
    std::vector<std::string> names;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      if (shapes[s].name == grain.shape) {
        state.shape = ShapeId{static_cast<std::uint32_t>(first_shape + s)};
        return;
      }
      names.push_back(shapes[s].name);
    }
    const auto near = nearest_name(grain.shape, names);
    fault(key, fmt::format("the library has no shape \"{}\"", grain.shape),
          near ? fmt::format("Did you mean \"{}\"?", *near)
               : "`reckon grains info` lists its shapes.");
  }

  std::vector<GrainState> load_legacy(const LegacyPlacement& files, double voxel,
                                      const std::string& path) {
    std::vector<std::array<double, 3>> positions;
    std::vector<std::array<double, 4>> rotations;
    if (files.positions_file.empty() || files.rotations_file.empty()) return {};
    const bool read_positions = attempt(
        path + ".positions", [&] { positions = read_number_table<3>(files.positions_file); });
    const bool read_rotations = attempt(
        path + ".rotations", [&] { rotations = read_number_table<4>(files.rotations_file); });
    if (!read_positions || !read_rotations) return {};
    if (positions.size() != rotations.size()) {
      fault(path + ".rotations",
            fmt::format("has {} lines, but there are {} positions", rotations.size(),
                        positions.size()),
            "Both files need one line per grain.");
      return {};
    }
    std::vector<GrainState> grains;
    for (std::size_t n = 0; n < positions.size(); ++n) {
      // The legacy order (a, b, c, d) stands for (w, x, y, z) = (d, -b, a, -c).
      const auto& [a, b, c, d] = rotations[n];
      if (!(a * a + b * b + c * c + d * d > 0)) {
        fault(path + ".rotations", fmt::format("line {} is no rotation: all zero", n + 1), {});
        return {};
      }
      GrainState grain;
      grain.position = voxel * Vec3{positions[n][0], positions[n][1], positions[n][2]};
      const Quaternion written{d, -b, a, -c};
      // The few digits of a file leave its length a little off one. The legacy code takes its first
      // step with it so, and so do we.
      constexpr double rounding = 1e-6;
      grain.orientation =
          std::abs(a * a + b * b + c * c + d * d - 1) < rounding ? written : normalized(written);
      grains.push_back(grain);
    }
    return grains;
  }

  void load_accelerations(LoadedScene& scene) {
    const std::string& file = reading_.config.body.acceleration_file;
    if (file.empty()) return;
    const std::string key = "body.acceleration_file";
    attempt(key, [&] {
      for (const auto& row : read_number_table<3>(file)) {
        scene.own_accelerations.push_back({row[0], row[1], row[2]});
      }
    });
    const bool grains_are_known =
        std::none_of(reading_.faults.begin(), reading_.faults.end(),
                     [](const SceneFault& fault) { return fault.key.starts_with("grains"); });
    if (grains_are_known && scene.own_accelerations.size() != scene.grains.size() &&
        !has_fault_below(key)) {
      fault(key,
            fmt::format("has {} lines, but there are {} grains", scene.own_accelerations.size(),
                        scene.grains.size()),
            "It needs one line per grain.");
    }
  }

  /// Runs `action`; an Error becomes a fault at `key`.
  template <class Action>
  bool attempt(const std::string& key, Action&& action) {
    try {
      action();
      return true;
    } catch (const Error& error) {
      const ErrorText& text = error.text();
      std::string problem = text.place.empty() ? text.problem : text.place + ": " + text.problem;
      if (!text.reason.empty()) problem += " (" + text.reason + ")";
      fault(key, std::move(problem), text.fix);
      return false;
    }
  }

  [[nodiscard]] bool has_fault_below(const std::string& path) const {
    return std::any_of(reading_.faults.begin(), reading_.faults.end(),
                       [&](const SceneFault& fault) { return fault.key.starts_with(path); });
  }

  /// Lines that are no TOML have been left out: what they say is not known.
  [[nodiscard]] bool has_syntax_fault() const {
    return std::any_of(reading_.faults.begin(), reading_.faults.end(),
                       [](const SceneFault& fault) { return fault.key.empty(); });
  }

  void fault(std::string key, std::string problem, std::string fix) {
    const auto known = reading_.positions.find(key);
    const SourcePosition position =
        known == reading_.positions.end() ? SourcePosition{} : known->second;
    reading_.faults.push_back({position, std::move(key), std::move(problem), std::move(fix)});
  }

  SceneReading& reading_;
  std::shared_ptr<ShapeCatalog> catalog_{std::make_shared<ShapeCatalog>()};
  std::vector<ShapeSummary> shapes_;
  std::vector<std::string> warnings_;
  std::vector<std::uint32_t> first_ids_;  // of the grains of each [[grains]] table
};

}  // namespace

LoadedScene load_scene(SceneReading& reading) { return Loader{reading}.load(); }

}  // namespace reckon
