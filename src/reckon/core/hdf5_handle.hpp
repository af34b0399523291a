// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <utility>

/// What every caller of the HDF5 library needs. Its header stays out of ours: hid_t is std::int64_t
/// and herr_t is int, which hdf5_handle.cpp asserts.
namespace reckon {

/// An HDF5 handle and the function that closes it.
class Hdf5Handle {
 public:
  Hdf5Handle(std::int64_t id, int (*closer)(std::int64_t)) : id_{id}, close_{closer} {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_{std::exchange(other.id_, -1)}, close_{other.close_} {}
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;

  /// Whether closing succeeded: the library may write its remaining data only now.
  [[nodiscard]] bool close() {
    const std::int64_t id = std::exchange(id_, -1);
    return id < 0 || close_(id) >= 0;
  }

  [[nodiscard]] std::int64_t get() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }

 private:
  std::int64_t id_;
  int (*close_)(std::int64_t);
};

/// For programs, before anything else of HDF5: keeps the library from tidying up when the program
/// exits, which crashes when a full disk has kept a file from being closed. We close files where
/// they are used. Not for code in a process of another program, which may rely on it.
void skip_hdf5_cleanup_at_exit();

/// For the time of a call: reserves the library, which is not thread-safe, for this thread, and
/// stops it from printing its errors.
class QuietHdf5 {
 public:
  QuietHdf5();
  ~QuietHdf5();
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  std::lock_guard<std::recursive_mutex> lock_;
  int (*report_)(std::int64_t, void*){nullptr};
  void* report_data_{nullptr};
};

}  // namespace reckon
