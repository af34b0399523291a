// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// The small version of a benchmark's workload on all ranks of this mpirun, with one and two threads
// and all instructions of this machine, against the plain algorithm on one rank and thread, bit by
// bit:
//   workloads_test NAME STEPS
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "reckon/contact/simd_level.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/simulation.hpp"
#include "workloads.hpp"

namespace reckon {
namespace {

SimulationState run(SimulationSetup setup, const SimulationState& start, int steps, int threads,
                    const Communicator& ranks) {
  set_thread_count(threads);
  Simulation simulation{std::move(setup), ranks.is_root() ? start : SimulationState{}, ranks};
  for (int n = 0; n < steps; ++n) simulation.step();
  return simulation.state();
}

/// How many runs end otherwise than the plain one.
int test(const Communicator& world, const std::string& name, int steps) {
  set_thread_count(1);
  bench::WorkloadRequest request;
  request.small = true;
  const bench::Workload work = bench::make_workload(name, request);
  SimulationState expected;
  if (world.is_root()) {
    SimulationSetup setup = work.setup;
    setup.engine = ContactEngine::plain;
    expected = run(setup, work.state, steps, 1, Communicator{});
    if (expected == work.state) {
      std::fprintf(stderr, "%s: nothing moves\n", name.c_str());
      return 1;
    }
  }
  int different = 0;
  for (const SimdLevel level : simd_levels_here()) {
    for (const int threads : {1, 2}) {
      SimulationSetup setup = work.setup;
      setup.simd = level;
      const SimulationState found = run(setup, work.state, steps, threads, world);
      if (!world.is_root() || found == expected) continue;
      std::fprintf(stderr, "%s, %d ranks, %d threads, %s: other bits than the plain algorithm\n",
                   name.c_str(), world.size(), threads, std::string{name_of(level)}.c_str());
      ++different;
    }
  }
  return different;
}

}  // namespace
}  // namespace reckon

int main(int argc, char** argv) {
  const reckon::ParallelSession session{argc, argv};
  if (argc != 3) return 2;
  try {
    return reckon::test(session.world(), argv[1], std::atoi(argv[2])) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rank %d: %s\n", session.world().rank(), error.what());
    session.world().abort(1);
  }
}
