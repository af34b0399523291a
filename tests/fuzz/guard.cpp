// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "guard.hpp"

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>

#if defined(__SANITIZE_ADDRESS__)
#define RECKON_FUZZ_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define RECKON_FUZZ_SANITIZED 1
#endif
#endif
#ifdef RECKON_FUZZ_SANITIZED
#include <sanitizer/common_interface_defs.h>
#endif

namespace reckon::fuzz {
namespace {

// What a signal handler can reach: plain memory, set before each case.
std::array<char, 512> kept_path{};
const char* current_input{nullptr};
std::size_t current_size{0};

/// Calls nothing but what a signal handler may call.
void keep_input() {
  if (current_input == nullptr) return;
  const auto say = [](const char* text) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
  };
  const int file = open(kept_path.data(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0) return;
  [[maybe_unused]] const auto written = write(file, current_input, current_size);
  close(file);
  say("\nfuzz: the input is kept in ");
  say(kept_path.data());
  say("\n");
}

void on_signal(int signal) {
  if (signal == SIGPROF) {
    constexpr std::string_view text = "\nfuzz: one input took too long\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
  }
  keep_input();
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void arm(int seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

}  // namespace

Guard::Guard(const std::string& path, std::string_view input, int seconds) {
  kept_path.fill('\0');
  std::copy_n(path.begin(), std::min(path.size(), kept_path.size() - 1), kept_path.begin());
  current_input = input.data();
  current_size = input.size();
#ifdef RECKON_FUZZ_SANITIZED
  __sanitizer_set_death_callback(keep_input);  // the sanitizer reports first
#else
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, on_signal);
#endif
  std::signal(SIGABRT, on_signal);
  std::signal(SIGPROF, on_signal);
  arm(seconds);
}

Guard::~Guard() {
  arm(0);
  current_input = nullptr;
}

}  // namespace reckon::fuzz
