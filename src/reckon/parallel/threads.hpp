// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <exception>
#include <span>
#include <vector>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace reckon {

/// Number of threads that the next parallel loop uses.
[[nodiscard]] inline int thread_count() {
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

/// This thread's number inside a parallel loop, from 0.
[[nodiscard]] inline int thread_index() {
#ifdef _OPENMP
  return omp_get_thread_num();
#else
  return 0;
#endif
}

inline void set_thread_count([[maybe_unused]] int count) {
#ifdef _OPENMP
  omp_set_num_threads(count);
#endif
}

/// The chunks of a loop, in one contiguous part per thread.
class ChunkParts {
 public:
  static constexpr std::size_t most = 32;  // parts; more threads share them
  /// The next chunk of a part that nobody has taken.
  struct alignas(64) Next {
    std::atomic<std::size_t> chunk{0};
  };

  ChunkParts(std::size_t count, std::size_t chunk)
      : count_{count},
        chunk_{chunk},
        chunks_{(count + chunk - 1) / chunk},
        parts_{std::min({most, static_cast<std::size_t>(thread_count()), chunks_})} {}

  /// Calls run(first, last) for chunks that no other thread has taken, those of part `own` first.
  template <class Run>
  void visit(std::span<Next> next, std::size_t own, Run&& run) const {
    for (std::size_t k = 0; k < parts_; ++k) {
      const std::size_t part = (own + k) % parts_;
      const std::size_t begin = chunks_ * part / parts_;
      const std::size_t end = chunks_ * (part + 1) / parts_;
      while (true) {
        const std::size_t c = begin + next[part].chunk.fetch_add(1, std::memory_order_relaxed);
        if (c >= end) break;
        run(c * chunk_, std::min((c + 1) * chunk_, count_));
      }
    }
  }

 private:
  std::size_t count_;
  std::size_t chunk_;
  std::size_t chunks_;
  std::size_t parts_;
};

/// Calls body(k) for k in [0, count), on all threads, `chunk` indices at a time. Every thread
/// begins with a part of its own, the same in every loop of this size, so that data stays in the
/// caches of its core from step to step. A thread that is done with its part takes chunks of the
/// others. The body may write only what belongs to its k (or to thread_index()). An exception of a
/// body is carried out of the parallel region: that of the lowest k, whichever came first.
template <class Body>
void parallel_for(std::size_t count, std::size_t chunk, Body&& body) {
  if (count <= chunk) {  // work for one thread: do not start the others
    for (std::size_t k = 0; k < count; ++k) body(k);
    return;
  }
#ifdef _OPENMP
  std::exception_ptr failure;
  std::size_t failure_index = count;
  const ChunkParts parts{count, chunk};
  std::array<ChunkParts::Next, ChunkParts::most> next{};
#pragma omp parallel
  {
    const auto own = static_cast<std::size_t>(omp_get_thread_num());
    parts.visit(next, own, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) {
        try {
          body(k);
        } catch (...) {
#pragma omp critical(reckon_parallel_for_failure)
          if (k < failure_index) {
            failure_index = k;
            failure = std::current_exception();
          }
        }
      }
    });
  }
  if (failure) std::rethrow_exception(failure);
#else
  for (std::size_t k = 0; k < count; ++k) body(k);
#endif
}

/// The largest value(k) over k in [0, count), or `least` if that is larger. The order of comparing
/// does not matter, so neither does the number of threads.
template <class Value>
[[nodiscard]] double parallel_max(std::size_t count, double least, Value&& value) {
  struct alignas(64) Largest {  // a cache line for each thread
    double of_thread;
  };
  std::vector<Largest> largest(static_cast<std::size_t>(thread_count()), Largest{least});
  parallel_for(count, 256, [&](std::size_t k) {
    double& mine = largest[static_cast<std::size_t>(thread_index())].of_thread;
    const double v = value(k);
    if (v > mine) mine = v;
  });
  double all = least;
  for (const Largest& one : largest) all = std::max(all, one.of_thread);
  return all;
}

}  // namespace reckon
