// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Linked into a test, or loaded in front of a program by LD_PRELOAD. There the environment says
// what fails: RECKON_FAIL_CALL, RECKON_FAIL_FILE, RECKON_FAIL_NUMBER, RECKON_FAIL_LASTING.
#include "faults/failing_calls.hpp"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace reckon::testing {
namespace {

FailingCall plan;
std::atomic<std::uint64_t> matching{0};
std::atomic<bool> failed{false};

const bool from_environment = [] {
  // NOLINTBEGIN(concurrency-mt-unsafe): before main
  const char* call = std::getenv("RECKON_FAIL_CALL");
  const char* file = std::getenv("RECKON_FAIL_FILE");
  const char* number = std::getenv("RECKON_FAIL_NUMBER");
  if (call == nullptr || file == nullptr || number == nullptr) return false;
  plan = {call, file, std::strtoull(number, nullptr, 10),
          std::getenv("RECKON_FAIL_LASTING") != nullptr, false};
  // NOLINTEND(concurrency-mt-unsafe)
  return true;
}();

/// Whether this call is one to fail.
bool is_due(const char* call, const char* file) {
  if (plan.number == 0 || std::strcmp(plan.call, call) != 0) return false;
  if (std::strstr(file, plan.file) == nullptr) return false;
  const std::uint64_t count = ++matching;
  const bool due = plan.lasting ? count >= plan.number : count == plan.number;
  if (due && !failed.exchange(true) && from_environment) {
    constexpr std::string_view words = "a call has failed\n";
    ::syscall(SYS_write, STDERR_FILENO, words.data(), words.size());
  }
  return due;
}

bool is_due(const char* call, int descriptor) {
  if (plan.number == 0) return false;
  std::array<char, 64> link{};
  std::array<char, 4096> file{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", descriptor);
  if (::readlink(link.data(), file.data(), file.size() - 1) < 0) return false;
  return is_due(call, file.data());
}

/// As a call of the system that fails.
long refuse(int error_number) {
  errno = error_number;
  return -1;
}

/// How many bytes a write does; -1: it fails.
long permitted(int descriptor, std::size_t size) {
  if (!is_due("write", descriptor)) return static_cast<long>(size);
  if (plan.half && size > 1) return static_cast<long>(size / 2);
  return refuse(ENOSPC);
}

}  // namespace

void set_failing_call(const FailingCall& failing) {
  plan = failing;
  matching = 0;
  failed = false;
}

bool call_has_failed() { return failed; }

}  // namespace reckon::testing

using reckon::testing::is_due;
using reckon::testing::permitted;
using reckon::testing::refuse;

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
  const long count = permitted(file, size);
  return count < 0 ? count : ::syscall(SYS_write, file, bytes, count);
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t offset) {
  const long count = permitted(file, size);
  return count < 0 ? count : ::syscall(SYS_pwrite64, file, bytes, count, offset);
}
ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t offset) {
  return pwrite(file, bytes, size, offset);
}
ssize_t read(int file, void* bytes, size_t size) {
  if (is_due("read", file)) return refuse(EIO);
  return ::syscall(SYS_read, file, bytes, size);
}
ssize_t pread(int file, void* bytes, size_t size, off_t offset) {
  if (is_due("read", file)) return refuse(EIO);
  return ::syscall(SYS_pread64, file, bytes, size, offset);
}
ssize_t pread64(int file, void* bytes, size_t size, off64_t offset) {
  return pread(file, bytes, size, offset);
}
off_t lseek(int file, off_t offset, int from) noexcept {
  if (is_due("lseek", file)) return refuse(EIO);
  return ::syscall(SYS_lseek, file, offset, from);
}
off64_t lseek64(int file, off64_t offset, int from) noexcept { return lseek(file, offset, from); }
int ftruncate(int file, off_t size) noexcept {
  if (is_due("ftruncate", file)) return static_cast<int>(refuse(ENOSPC));
  return static_cast<int>(::syscall(SYS_ftruncate, file, size));
}
int ftruncate64(int file, off64_t size) noexcept { return ftruncate(file, size); }
/// Without effect: tests need not wait for a disk.
int fsync(int file) { return is_due("fsync", file) ? static_cast<int>(refuse(EIO)) : 0; }
int close(int file) {
  const bool due = is_due("close", file);
  const long result = ::syscall(SYS_close, file);
  return static_cast<int>(due ? refuse(EIO) : result);
}
int rename(const char* from, const char* to) noexcept {
  if (is_due("rename", to)) return static_cast<int>(refuse(ENOSPC));
  return static_cast<int>(::syscall(SYS_rename, from, to));
}
int open(const char* name, int flags, ...) {
  mode_t mode = 0;
  if ((flags & (O_CREAT | __O_TMPFILE)) != 0) {
    va_list arguments;
    va_start(arguments, flags);
    mode = va_arg(arguments, mode_t);
    va_end(arguments);
  }
  const bool writes = (flags & O_ACCMODE) != O_RDONLY;
  if (is_due("open", name)) return static_cast<int>(refuse(writes ? ENOSPC : EIO));
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, name, flags, mode));
}
int open64(const char* name, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = (flags & (O_CREAT | __O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return open(name, flags, mode);
}

}  // extern "C"
