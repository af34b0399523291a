// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "reckon/analysis/sample.hpp"
#include "reckon/analysis/stage_goals.hpp"
#include "reckon/core/build_info.hpp"
#include "reckon/core/failure_text.hpp"
#include "reckon/core/stopwatch.hpp"
#include "reckon/domain/packing.hpp"
#include "reckon/output/output_schedule.hpp"
#include "reckon/parallel/on_root.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/results/stage_report.hpp"
#include "reckon/run/run_files.hpp"
#include "reckon/run/run_plan.hpp"
#include "reckon/scene/node_spacing.hpp"
#include "reckon/scene/scene_sharing.hpp"
#include "reckon/simulation/stage_setup.hpp"
#include "reckon/simulation/time_step.hpp"
#include "reckon/text/human.hpp"

namespace reckon {
namespace {

constexpr std::uint64_t rest_interval_without_history = 100;  // steps
constexpr std::uint64_t vote_interval = 16;      // steps; a vote costs all ranks a wait
constexpr double log_interval = 60;              // [s]
constexpr std::uint64_t membrane_interval = 50;  // steps between tests for grains outside

/// Which rank has each grain, by id, from the ids that this rank has. Whole on the root.
/// Collective.
std::vector<std::uint32_t> ranks_of_grains(const std::vector<GrainId>& own,
                                           const Communicator& ranks) {
  Bytes bytes;
  pack<GrainId>(bytes, own);
  std::vector<std::pair<GrainId, std::uint32_t>> found;
  std::uint32_t rank = 0;
  for (const Bytes& part : ranks.gather(bytes)) {
    for (const GrainId id : Unpacker{part}.take_all<GrainId>()) found.emplace_back(id, rank);
    ++rank;
  }
  std::sort(found.begin(), found.end());
  std::vector<std::uint32_t> result;
  result.reserve(found.size());
  for (const auto& [id, has] : found) result.push_back(has);
  return result;
}

/// One session of a run, the same on all ranks; the root alone has `files`.
class Session {
 public:
  Session(const SceneConfig& config, PreparedScene prepared, std::uint64_t steps, bool resumed,
          RunFiles* files, const RunOptions& options, const RunHooks& hooks,
          const Communicator& ranks)
      : hooks_{hooks},
        options_{options},
        config_{config},
        ranks_{ranks},
        files_{files},
        simulation_{std::move(prepared.setup),
                    files != nullptr ? files->take_start() : SimulationState{}, ranks},
        schedule_{config, simulation_.stage_starts()},
        persistence_{persistence(prepared.time_step, files, ranks)},
        goal_{persistence_.met_since},
        resumed_{resumed} {
    progress_.first_step = simulation_.step_number();
    progress_.step = progress_.first_step;
    progress_.steps = steps;
    if (has_stages()) progress_.steps = last_possible_step();
    progress_.time = simulation_.time();
    if (resumed) last_checkpoint_ = progress_.first_step;
  }

  RunReport run() {
    try {
      begin();
      RunEnd end = RunEnd::complete;
      bool interrupted = false;
      bool rests = resumed_ && (rests_after_history() || test_is_over());
      if (resumed_ && (rests || progress_.step >= progress_.steps)) end = RunEnd::nothing_to_do;
      if (end != RunEnd::nothing_to_do) save_record("running");
      while (!rests && !interrupted && progress_.step < progress_.steps) {
        simulation_.step();
        update_progress();
        const Votes votes = vote();
        rests = write_what_is_due(votes.checkpoint);
        interrupted = !rests && progress_.step < progress_.steps && votes.stop;
        if (hooks_.progressed) hooks_.progressed(progress_);
      }
      if (end != RunEnd::nothing_to_do) {
        end = interrupted              ? RunEnd::interrupted
              : rests && !has_stages() ? RunEnd::at_rest
                                       : RunEnd::complete;
      }
      return finish(end);
    } catch (const std::exception& error) {
      throw fail(failure_text(error));
    }
  }

 private:
  void begin() {
    const BuildInfo build = build_info();
    const std::string ranks =
        ranks_.size() == 1 ? std::string{} : fmt::format("{} ranks of ", ranks_.size());
    const std::string what =
        fmt::format("reckon {} ({}), {}{}", build.version, build.revision, ranks,
                    counted(static_cast<std::uint64_t>(thread_count()), "thread"));
    if (files_ != nullptr) files_->note(what);
    if (files_ != nullptr && config_.material.density_scaling != 1) {
      files_->note(fmt::format("inertia is scaled: grains move as if {:.4g} times denser",
                               config_.material.density_scaling));
    }
    if (resumed_) {
      if (files_ != nullptr) {
        files_->note(fmt::format("resumed from the checkpoint of step {}", progress_.step));
      }
    } else {
      measure();
      on_root(ranks_, [&] { files_->begin(row()); });
      write_fields();
    }
  }

  void update_progress() {
    progress_.step = simulation_.step_number();
    progress_.time = simulation_.time();
    progress_.wall_seconds = since_start_.seconds();
  }

  /// Requests of clocks and signals. They differ between ranks before the vote, and change when
  /// files are written, never their content.
  struct Votes {
    bool stop{false};
    bool checkpoint{false};
  };
  Votes vote() {
    if (ranks_.size() > 1 && progress_.step % vote_interval != 0) return {};
    const bool stop = hooks_.stop_requested && hooks_.stop_requested();
    const bool late = files_ != nullptr && options_.safety_interval > 0 &&
                      since_checkpoint_.seconds() >= options_.safety_interval;
    std::array<std::int64_t, 2> votes{stop ? 1 : 0, late ? 1 : 0};
    ranks_.sum(votes);
    return {votes[0] > 0, votes[1] > 0};
  }

  [[nodiscard]] bool has_stages() const { return !config_.stages.empty(); }
  [[nodiscard]] std::size_t stage_index() const { return simulation_.stage_starts().size() - 1; }

  /// Where the run ends if all stages from this one on take their whole time.
  [[nodiscard]] std::uint64_t last_possible_step() const {
    std::uint64_t step = simulation_.stage_starts().back();
    for (std::size_t n = stage_index(); n < config_.stages.size(); ++n) {
      step += most_steps(config_.stages[n], simulation_.setup().time_step);
    }
    return options_.steps ? std::min(step, *options_.steps) : step;
  }

  /// Data that only the root has, sent to all ranks: the period 2 pi sqrt(m / k) of the grain that
  /// limits the time step [steps], and since when a goal is met. Collective.
  struct Persistence {
    double period{0};
    std::optional<std::uint64_t> met_since;
  };
  static Persistence persistence(const TimeStepChoice& choice, const RunFiles* files,
                                 const Communicator& ranks) {
    Bytes bytes;
    if (files != nullptr) {
      const double period = 2 * std::numbers::pi * std::sqrt(choice.mass / choice.stiffness);
      pack<double>(bytes, std::array{period / choice.step});
      std::vector<std::uint64_t> since;
      if (files->goal_met_since()) since.push_back(*files->goal_met_since());
      pack<std::uint64_t>(bytes, since);
    }
    bytes = ranks.broadcast(std::move(bytes));
    Unpacker message{bytes};
    const double period = message.take_all<double>().front();
    const auto since = message.take_all<std::uint64_t>();
    return {period, since.empty() ? std::nullopt : std::optional{since.front()}};
  }
  /// Whether a condition has held for so many periods, and at two tests at least.
  bool lasts(bool holds, double periods) {
    constexpr double most = 1e9;
    const double span = std::min(std::ceil(periods * persistence_.period), most);
    return goal_.look(progress_.step, holds, span >= 1 ? static_cast<std::uint64_t>(span) : 1);
  }

  /// Goals are tested only at fixed steps, so that a resumed run ends a stage where an
  /// uninterrupted one does.
  bool stage_is_over() {
    if (!has_stages()) return false;
    const StageConfig& stage = config_.stages[stage_index()];
    const std::uint64_t start = simulation_.stage_starts().back();
    const std::uint64_t step = progress_.step;
    if (step <= start) return false;
    const bool is_late = step - start >= most_steps(stage, simulation_.setup().time_step);
    goal_is_met_ = !stage.until;
    std::uint64_t interval = schedule_.history_interval(step);
    if (interval == 0) interval = rest_interval_without_history;
    if (!stage.until || !is_due(step, interval)) return is_late;
    measure();
    const GoalState state = look_at(*stage.until, simulation_, last_, sample_);
    const double periods = periods_of(*stage.until);
    goal_is_met_ = (periods == 0 || lasts(state.holds, periods)) && state.passed;
    return goal_is_met_ || is_late;
  }
  bool test_is_over() {
    return has_stages() && stage_index() + 1 == config_.stages.size() && stage_is_over();
  }

  void begin_next_stage() {
    const StageConfig& over = config_.stages[stage_index()];
    measure();
    if (files_ != nullptr) {
      const std::uint64_t steps = progress_.step - simulation_.stage_starts().back();
      files_->note(stage_note(over.name, steps, goal_is_met_, last_, sample_));
    }
    if (stage_index() + 1 == config_.stages.size()) return;
    simulation_.begin_next_stage();
    goal_.forget();
    schedule_.begin_stage(progress_.step);
    progress_.steps = last_possible_step();
  }

  /// Returns whether the run is over: the assembly has come to rest, or the last stage has ended.
  bool write_what_is_due(bool safety_checkpoint) {
    const std::uint64_t step = progress_.step;
    bool rests = false;
    const bool stage_ends = stage_is_over();
    if (stage_ends || is_due(step, membrane_interval)) require_grains_in_membrane();
    if (stage_ends || schedule_.history_due(step)) append_history();
    if (is_due(step, rest_interval())) rests = rests_after_history();
    if (stage_ends || schedule_.fields_due(step)) write_fields();
    if (stage_ends) {
      rests = stage_index() + 1 == config_.stages.size();
      begin_next_stage();
    }
    if (is_due(step, config_.output.checkpoint_interval) || safety_checkpoint) save_checkpoint();
    if (files_ != nullptr && since_log_.seconds() >= log_interval) {
      since_log_ = {};
      files_->log(
          fmt::format("step {} of {}, {:.6g} s simulated", step, progress_.steps, progress_.time));
    }
    return rests;
  }

  /// A sample that has lost a grain is no longer valid. Its state is written first.
  void require_grains_in_membrane() {
    const std::optional<GrainOutside> lost = simulation_.grain_outside_membrane();
    if (!lost) return;
    append_history();
    write_fields();
    save_checkpoint();
    on_root(ranks_, [&] { files_->finish_writing(); });
    const Vec3& at = lost->position;
    throw Error{
        {.place = fmt::format(
             "grain {}, step {}{}", lost->grain.get(), progress_.step,
             has_stages() ? fmt::format(", stage \"{}\"", config_.stages[stage_index()].name)
                          : std::string{}),
         .problem = fmt::format("is outside the membrane, at ({:.6g}, {:.6g}, {:.6g}) m", at.x,
                                at.y, at.z),
         .reason =
             "its nodes let the grain through, so what is measured of the sample means nothing "
             "from here on",
         .fix =
             "Take a finer membrane.spacing (`reckon check` says which), or a stiffer membrane."}};
  }

  [[nodiscard]] std::uint64_t rest_interval() const {
    if (!config_.time.stop_at_unbalanced_ratio) return 0;
    const std::uint64_t interval = config_.output.history_interval;
    return interval > 0 ? interval : rest_interval_without_history;
  }

  /// Looked at only at fixed steps, so that a resumed run ends where an uninterrupted one does.
  bool rests_after_history() {
    if (!is_due(progress_.step, rest_interval())) return false;
    measure();
    return lasts(is_at_rest(last_, *config_.time.stop_at_unbalanced_ratio), rest_periods);
  }

  void measure() {
    if (last_.step == simulation_.step_number() && measured_) return;
    last_ = simulation_.measure();
    if (has_stages() || config_.output.sample) sample_ = measure_sample(simulation_);
    measured_ = true;
    progress_.unbalanced_ratio = last_.unbalanced_ratio;
    progress_.kinetic_energy = last_.energy.translation + last_.energy.rotation;
  }

  [[nodiscard]] HistoryRow row() {
    HistoryRow row{.measurement = last_};
    if (simulation_.cell() != nullptr) {
      cell_ = simulation_.cell_state();
      row.cell = &cell_;
    }
    if (has_stages()) row.stage = stage_index() + 1;
    if (config_.output.sample) row.sample = &sample_;
    return row;
  }
  /// The root's, on all ranks. Collective.
  [[nodiscard]] double energy_at_start() const {
    Bytes bytes;
    if (files_ != nullptr) pack<double>(bytes, std::array{files_->energy_at_start()});
    bytes = ranks_.broadcast(std::move(bytes));
    return Unpacker{bytes}.take_all<double>().front();
  }
  void append_history() {
    measure();
    on_root(ranks_, [&] { files_->append_history(row()); });
  }

  void write_fields() {
    FieldsAtStep fields;
    fields.step = simulation_.step_number();
    fields.time = simulation_.time();
    fields.contacts = simulation_.contacts();
    fields.grains = simulation_.grain_states();
    if (const PeriodicCell* cell = simulation_.cell()) put_into(*cell, fields);
    if (config_.output.ranks) fields.ranks = ranks_of_grains(simulation_.grains().id, ranks_);
    for (const WallPose& pose : simulation_.container().poses()) {
      fields.wall_displacement.push_back(pose.displacement);
    }
    if (files_ != nullptr) fields.membrane = membrane_now(simulation_);
    on_root(ranks_, [&] { files_->write_fields(std::move(fields)); });
  }

  void save_checkpoint() {
    SimulationState state = simulation_.state();
    on_root(ranks_, [&] { files_->write_checkpoint(std::move(state), goal_.since()); });
    last_checkpoint_ = progress_.step;
    since_checkpoint_ = {};
    save_record("running");
  }

  RunReport finish(RunEnd end) {
    measure();
    on_root(ranks_, [&] { files_->finish_writing(); });
    if (end != RunEnd::interrupted) {
      if (ranks_.any(files_ != nullptr && !files_->history_has(progress_.step))) append_history();
      if (ranks_.any(files_ != nullptr && !files_->fields_have(progress_.step))) write_fields();
    }
    if (end != RunEnd::nothing_to_do && last_checkpoint_ != progress_.step) {
      save_checkpoint();
    }
    on_root(ranks_, [&] { files_->finish_writing(); });
    const char* status = end == RunEnd::interrupted ? "interrupted"
                         : end == RunEnd::at_rest   ? "at rest"
                                                    : "complete";
    RunVerdict verdict;
    on_root(ranks_, [&] { verdict = files_->judge(config_, status); });
    // A session without a step keeps the results of the previous session.
    if (end != RunEnd::nothing_to_do ||
        ranks_.any(files_ != nullptr && !files_->record_says_ended())) {
      save_record(status);
    }
    RunReport report{.end = end, .progress = progress_, .last = last_};
    HistoryRow at_end = row();
    at_end.energy_at_start = energy_at_start();
    report.verdict = std::move(verdict);
    report.measured =
        measured(quantities_of(layout_of(simulation_.setup(), config_.output.sample)), at_end);
    if (files_ == nullptr) return report;
    files_->log(fmt::format("{} at step {} of {}", status, progress_.step, progress_.steps));
    const EnergyBudget& energy = last_.energy;
    report.energy_error = energy.total() - files_->energy_at_start();
    report.energy_turnover = energy.translation + energy.rotation + energy.elastic +
                             std::abs(energy.friction) + std::abs(energy.dashpot) +
                             std::abs(energy.damping) + std::abs(energy.fracture) +
                             std::abs(energy.body_work) + std::abs(energy.wall_work);
    report.checkpoint = files_->checkpoint_file();
    report.performance = files_->performance_text();
    if (has_stages()) report.stages = stage_report(config_, files_->history());
    return report;
  }

  RunFailure fail(ErrorText text) {
    if (files_ != nullptr) text = files_->fail(std::move(text), progress_);
    return RunFailure{std::move(text)};
  }

  void save_record(const char* status) {
    update_progress();
    const std::vector<RankPerformance> performance = simulation_.performance();
    on_root(ranks_, [&] { files_->write_record(status, progress_, performance); });
  }

  const RunHooks& hooks_;
  const RunOptions& options_;
  const SceneConfig& config_;
  Communicator ranks_;
  RunFiles* files_;
  Simulation simulation_;
  OutputSchedule schedule_;
  Persistence persistence_;
  HeldCondition goal_;       // of the run, or of the current stage
  bool goal_is_met_{false};  // of the stage, as of the last look
  bool resumed_;
  RunProgress progress_;
  Measurement last_;
  SampleMeasurement sample_;
  CellState cell_;  // of the last row
  bool measured_{false};
  std::optional<std::uint64_t> last_checkpoint_;  // its step
  Stopwatch since_start_;
  Stopwatch since_checkpoint_;
  Stopwatch since_log_;
};

}  // namespace

RunReport run_scene(const SceneReading& reading, const LoadedScene& scene,
                    const RunOptions& options, const RunHooks& hooks, const Communicator& ranks) {
  const LoadedScene shared = share_scene(scene, ranks);
  PreparedScene prepared = prepare(shared, ranks);
  const std::uint64_t steps = options.steps.value_or(prepared.steps);
  std::optional<RunFiles> files;
  on_root(ranks, [&] {
    files.emplace(reading, shared, prepared, steps, options, hooks);
    if (const auto coarse = coarse_nodes(shared)) files->note_coarse(*coarse);
    for (const std::string& warning : scene.warnings) files->note("WARNING: " + warning);
    const TimeStepChoice step = choose_time_step(scene.config, scene.grains, scene.shapes);
    if (step.is_too_long()) files->note(too_long_text(step));
  });
  const bool resumed = ranks.any(files && files->resumed());
  Session session{
      shared.config, std::move(prepared), steps, resumed, files ? &*files : nullptr, options, hooks,
      ranks};
  return session.run();
}

}  // namespace reckon
