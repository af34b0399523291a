// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace reckon {

/// Executes jobs one after another on a separate thread, in the order of submission, while the
/// caller continues. One job may wait while another is executed. The caller of a third job waits,
/// so slow disks slow a run down but never fill the memory.
class BackgroundWriter {
 public:
  using Job = std::function<void()>;

  BackgroundWriter();
  /// Finishes all submitted jobs. Their exceptions are lost unless finish() was called before.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// Throws what an earlier job has thrown; later jobs are dropped then.
  void submit(Job job);
  /// Returns when all jobs are done. Throws what one of them has thrown.
  void finish();

 private:
  void work();
  void throw_failure();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Job> waiting_;
  bool busy_{false};
  bool ending_{false};
  std::exception_ptr failure_;
  std::thread thread_;  // last, so that it meets all else made
};

}  // namespace reckon
