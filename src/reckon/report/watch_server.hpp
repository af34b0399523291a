// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "reckon/report/run_pieces.hpp"

namespace reckon {

/// Shows one run in browsers on this machine while it runs. Answers GET only, on 127.0.0.1 only,
/// and only
///
///   /TOKEN/                       the page
///   /TOKEN/version                a word that changes when the run has written something
///   /TOKEN/piece/0/head           RunPieces::head()
///   /TOKEN/piece/0/frame/STEP     RunPieces::frame(STEP), where the run has saved that step
///
/// TOKEN is new for each server: other users of the machine can reach the port, but only a client
/// with the address can read the run. No part of a request becomes part of a path, so only the run
/// can be read. Requests that name another host (a foreign page's attempt to reach it, by DNS
/// rebinding) are refused.
class WatchServer {
 public:
  /// Takes the port, any free one for 0. Throws Error when it is taken.
  WatchServer(RunFolder folder, PageLimits limits, int port);
  ~WatchServer();
  WatchServer(const WatchServer&) = delete;
  WatchServer& operator=(const WatchServer&) = delete;

  /// Where the page is, with the token.
  [[nodiscard]] std::string address() const;
  /// Answers until stop() is called, from another thread.
  void serve();
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace reckon
