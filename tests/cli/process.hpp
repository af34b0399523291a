// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "reckon/core/file.hpp"

namespace reckon::testing {

/// A program under test, with its output in files.
class Process {
 public:
  /// Starts argv[0] in `folder`.
  Process(std::vector<std::string> arguments, std::filesystem::path folder)
      : folder_{std::move(folder)} {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const std::string out = (folder_ / "stdout.txt").string();
    const std::string err = (folder_ / "stderr.txt").string();
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error{"fork failed"};
    if (pid_ > 0) return;
    const int out_file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    const int err_file = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (::chdir(folder_.c_str()) == 0 && ::dup2(out_file, 1) == 1 && ::dup2(err_file, 2) == 2) {
      ::setenv("OMP_NUM_THREADS", "1", 0);  // small scenes on a busy machine
      ::execv(argv[0], argv.data());
    }
    ::_exit(127);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    wait();
  }

  [[nodiscard]] pid_t id() const { return pid_; }

  void send(int signal) const { ::kill(pid_, signal); }

  /// Waits for the end; the exit code, or minus the signal that ended it.
  int wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  [[nodiscard]] std::string out() const { return read_file(folder_ / "stdout.txt"); }
  [[nodiscard]] std::string err() const { return read_file(folder_ / "stderr.txt"); }

 private:
  std::filesystem::path folder_;
  pid_t pid_{-1};
};

/// Kills the last child of a process, as a failing machine might. Returns how many were killed.
inline int kill_one_child(pid_t parent) {
  const std::string list = read_file("/proc/" + std::to_string(parent) + "/task/" +
                                     std::to_string(parent) + "/children");
  const std::size_t end = list.find_last_of("0123456789");
  if (end == std::string::npos) return 0;
  const std::size_t before = list.find_last_of(' ', end);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  return ::kill(std::stoi(list.substr(first, end - first + 1)), SIGKILL) == 0 ? 1 : 0;
}

}  // namespace reckon::testing
