// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/background_writer.hpp"

#include <utility>

namespace reckon {

BackgroundWriter::BackgroundWriter() : thread_{[this] { work(); }} {}

BackgroundWriter::~BackgroundWriter() {
  {
    const std::lock_guard lock{mutex_};
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundWriter::submit(Job job) {
  std::unique_lock lock{mutex_};
  changed_.wait(lock, [&] { return !waiting_; });
  throw_failure();
  waiting_ = std::move(job);
  lock.unlock();
  changed_.notify_all();
}

void BackgroundWriter::finish() {
  std::unique_lock lock{mutex_};
  changed_.wait(lock, [&] { return !waiting_ && !busy_; });
  throw_failure();
}

/// With the lock held.
void BackgroundWriter::throw_failure() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void BackgroundWriter::work() {
  std::unique_lock lock{mutex_};
  for (;;) {
    changed_.wait(lock, [&] { return waiting_ || ending_; });
    if (!waiting_) return;
    const Job job = std::move(*waiting_);
    waiting_.reset();
    busy_ = true;
    const bool failed_before = failure_ != nullptr;
    lock.unlock();
    changed_.notify_all();
    std::exception_ptr failure;
    try {
      if (!failed_before) job();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure) failure_ = failure;
    busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace reckon
