// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "stop_signal.hpp"

#include <csignal>
#include <initializer_list>

namespace reckon::app {
namespace {

// A signal handler can use only a global of this type.
volatile std::sig_atomic_t received = 0;

extern "C" void note_stop_signal(int signal) { received = signal; }

}  // namespace

void watch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = note_stop_signal;
  // SA_RESETHAND: the second signal meets the default, which ends the process.
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) ::sigaction(signal, &action, nullptr);
  // SIGHUP comes when the terminal is closed, once from the shell and once from the kernel; nohup
  // has it ignored.
  struct sigaction hangup {};
  ::sigaction(SIGHUP, nullptr, &hangup);
  action.sa_flags = SA_RESTART;
  if (hangup.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
  // A log that is read no more does not end a run.
  std::signal(SIGPIPE, SIG_IGN);
}

int stop_signal() { return received; }

}  // namespace reckon::app
