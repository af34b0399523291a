// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <exception>

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

/// Calls body(k) for k in [0, count), on all threads, `chunk` indices at a time to the next free
/// thread. The body may write only what belongs to its k (or to thread_index()). An exception of a
/// body is carried out of the parallel region: that of the lowest k, whichever came first.
template <class Body>
void parallel_for(std::size_t count, std::size_t chunk, Body&& body) {
  if (count <= chunk) {  // work for one thread: do not wake the others
    for (std::size_t k = 0; k < count; ++k) body(k);
    return;
  }
  std::exception_ptr failure;
  std::size_t failure_index = count;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, static_cast <int>(chunk))
#endif
  for (std::size_t k = 0; k < count; ++k) {
    try {
      body(k);
    } catch (...) {
#ifdef _OPENMP
#pragma omp critical(reckon_parallel_for_failure)
#endif
      if (k < failure_index) {
        failure_index = k;
        failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

/// The largest value(k) over k in [0, count), or `least` if that is larger. The order of comparing
/// does not matter, so neither does the number of threads.
template <class Value>
[[nodiscard]] double parallel_max(std::size_t count, double least, Value&& value) {
  double largest = least;
  // A reduction of OpenMP begins at the lowest finite number with some compilers, so that a least
  // of -infinity would be lost.
#ifdef _OPENMP
#pragma omp parallel if (count > 4096)
#endif
  {
    double mine = least;
#ifdef _OPENMP
#pragma omp for schedule(static) nowait
#endif
    for (std::size_t k = 0; k < count; ++k) {
      const double v = value(k);
      if (v > mine) mine = v;
    }
#ifdef _OPENMP
#pragma omp critical(reckon_parallel_max)
#endif
    if (mine > largest) largest = mine;
  }
  return largest;
}

}  // namespace reckon
