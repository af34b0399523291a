// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <memory>

#include "reckon/core/peak_memory.hpp"
#include "reckon/core/stopwatch.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon::bench {
namespace {

constexpr double ns_per_second = 1e9;

/// The parts of PhaseTimes that a process of its own has.
constexpr std::array all_phases{&PhaseTimes::frames,         &PhaseTimes::lists,
                                &PhaseTimes::grain_contacts, &PhaseTimes::wall_contacts,
                                &PhaseTimes::motion,         &PhaseTimes::agreement};

/// Seconds of this process: see measure().
double now(int threads) {
  if (threads == 1) {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
  }
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) / ns_per_second;
}

/// Sums what stretches of one engine cost.
class Meter {
 public:
  explicit Meter(int threads) : threads_{threads} {}

  /// Seconds that `steps` steps took.
  double run(Simulation& simulation, std::uint64_t steps) {
    const PhaseTimes before = simulation.phase_times();
    const double start = now(threads_);
    for (std::uint64_t n = 0; n < steps; ++n) simulation.step();
    const double seconds = now(threads_) - start;
    for (auto phase : all_phases) sum_.*phase += simulation.phase_times().*phase - before.*phase;
    steps_ += steps;
    seconds_ += seconds;
    return seconds;
  }
  [[nodiscard]] Cost cost(std::size_t grains) const {
    const double scale =
        ns_per_second / static_cast<double>(std::max<std::uint64_t>(steps_, 1) * grains);
    Cost cost{steps_, seconds_ * scale, {}};
    for (auto phase : all_phases) cost.phases.*phase = sum_.*phase * scale;
    return cost;
  }
  [[nodiscard]] double seconds_per_step() const {
    return seconds_ / static_cast<double>(std::max<std::uint64_t>(steps_, 1));
  }

 private:
  int threads_;
  PhaseTimes sum_;
  std::uint64_t steps_{0};
  double seconds_{0};
};

class Measuring {
 public:
  Measuring(const Workload& work, const MeasureOptions& options,
            const std::function<void(const std::string&)>& say)
      : work_{work},
        options_{options},
        say_{say},
        near_meter_{options.threads},
        plain_meter_{options.threads} {
    set_thread_count(options.threads);
    near_ = start(ContactEngine::near, work.state);
    result_.grains = work.state.grains.size();
  }

  BenchResult run() {
    for (std::uint64_t n = 0; n < work_.warm_up; ++n) near_->step();
    const ContactCounters pairs_before = near_->grain_contacts().counters();
    const ContactCounters walls_before = near_->wall_contacts().counters();
    const std::uint64_t rebuilds_before = near_->list_rebuilds();
    if (work_.course == Course::whole) {
      run_whole();
    } else {
      run_steady();
    }
    result_.counters = near_->grain_contacts().counters() - pairs_before;
    result_.wall_counters = near_->wall_contacts().counters() - walls_before;
    result_.list_rebuilds = near_->list_rebuilds() - rebuilds_before;
    result_.near = near_meter_.cost(result_.grains);
    result_.seconds_per_1000_steps = 1000 * near_meter_.seconds_per_step();
    if (options_.plain) {
      result_.plain = plain_meter_.cost(result_.grains);
      result_.ratio = result_.plain->ns_per_grain_step / result_.near.ns_per_grain_step;
    }
    if (one_thread_seconds_ > 0) result_.speedup = one_thread_seconds_ / all_threads_seconds_;
    count_bytes();
    return result_;
  }

 private:
  [[nodiscard]] std::unique_ptr<Simulation> start(ContactEngine engine,
                                                  const SimulationState& state) const {
    SimulationSetup setup = work_.setup;
    setup.engine = engine;
    setup.simd = options_.simd;
    return std::make_unique<Simulation>(std::move(setup), state);
  }

  void run_steady() {
    for (int stretch = 1; stretch <= work_.stretches; ++stretch) {
      const double seconds = near_meter_.run(*near_, work_.steps);
      say_(
          fmt::format("stretch {} of {}: {:.0f} ns per grain and step", stretch, work_.stretches,
                      ns_per_second * seconds / static_cast<double>(work_.steps * result_.grains)));
      if (options_.threads > 1) compare_with_one_thread();
      if (options_.plain) compare_with_plain(seconds / static_cast<double>(work_.steps));
    }
  }

  void compare_with_plain(double near_seconds_per_step) {
    const auto plain = start(ContactEngine::plain, near_->state());
    plain->step();
    const double seconds = plain_meter_.run(*plain, work_.plain_steps);
    near_meter_.run(*near_, work_.plain_steps + 1);
    result_.ratios.push_back(seconds / static_cast<double>(work_.plain_steps) /
                             near_seconds_per_step);
    result_.same_bits = result_.same_bits && near_->state() == plain->state();
  }

  void compare_with_one_thread() {
    set_thread_count(1);
    one_thread_seconds_ += near_meter_of_one_.run(*near_, work_.steps);
    set_thread_count(options_.threads);
    all_threads_seconds_ += near_meter_.run(*near_, work_.steps);
  }

  void run_whole() {
    std::unique_ptr<Simulation> plain;
    if (options_.plain) plain = start(ContactEngine::plain, work_.state);
    for (int stretch = 0; stretch < work_.stretches; ++stretch) {
      const double near_seconds = near_meter_.run(*near_, work_.steps);
      if (plain) {
        result_.ratios.push_back(plain_meter_.run(*plain, work_.steps) / near_seconds);
        result_.same_bits = result_.same_bits && near_->state() == plain->state();
      }
      const double unbalanced = near_->measure().unbalanced_ratio;
      if (stretch % 10 == 9) {
        say_(fmt::format("step {}: unbalanced ratio {:.2g}", near_->step_number(), unbalanced));
      }
      if (near_->step_number() > 1000 && unbalanced < work_.rests_at) break;
    }
  }

  void count_bytes() {
    const auto per_grain = [&](std::size_t bytes) {
      return static_cast<double>(bytes) / static_cast<double>(result_.grains);
    };
    result_.contact_bytes_per_grain =
        per_grain(near_->grain_contacts().bytes() + near_->wall_contacts().bytes());
    result_.shape_bytes_per_grain = per_grain(work_.setup.shapes.resident_bytes());
    result_.peak_resident_bytes = static_cast<double>(peak_memory());
  }

  const Workload& work_;
  const MeasureOptions& options_;
  const std::function<void(const std::string&)>& say_;
  std::unique_ptr<Simulation> near_;
  Meter near_meter_;
  Meter near_meter_of_one_{2};  // by the clock, as that of several threads
  Meter plain_meter_;
  double one_thread_seconds_{0};
  double all_threads_seconds_{0};
  BenchResult result_;
};

}  // namespace

BenchResult measure(const Workload& work, const MeasureOptions& options,
                    const std::function<void(const std::string&)>& say) {
  return Measuring{work, options, say}.run();
}

double memory_bandwidth() {
  constexpr std::size_t count = std::size_t{1} << 24;  // 128 MiB each: beyond any cache
  constexpr std::size_t chunk = std::size_t{1} << 16;
  std::vector<double> a(count, 0.0);
  std::vector<double> b(count, 1.0);
  std::vector<double> c(count, 2.0);
  double best = 0;
  for (int repetition = 0; repetition < 5; ++repetition) {
    Stopwatch watch;
    parallel_for(count / chunk, 1, [&](std::size_t part) {
      for (std::size_t n = part * chunk; n < (part + 1) * chunk; ++n) a[n] = b[n] + 3.0 * c[n];
    });
    best = std::max(best, 3 * static_cast<double>(count * sizeof(double)) / watch.lap());
  }
  return best;
}

}  // namespace reckon::bench
