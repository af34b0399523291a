// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace reckon {

using Bytes = std::vector<std::byte>;

/// A message of fixed length to or from one other rank, for repeated exchange.
struct Channel {
  int peer{0};
  std::span<std::byte> buffer;
};

/// A set of channels that is used step after step: buffers stay where they are, only what they hold
/// changes. Between start() and finish() buffers must not be touched.
class RepeatedExchange {
 public:
  RepeatedExchange();
  ~RepeatedExchange();
  RepeatedExchange(RepeatedExchange&&) noexcept;
  RepeatedExchange& operator=(RepeatedExchange&&) noexcept;

  void start();
  void finish();

  struct Impl;

 private:
  friend class Communicator;
  std::unique_ptr<Impl> impl_;
};

/// The ranks that run one simulation together: MPI, or a single rank without it. Passed in, never
/// looked up. Every function but rank() and size() is collective: all ranks call it in the same
/// order. Copies mean the same ranks.
class Communicator {
 public:
  /// A single rank. Works with and without MPI.
  Communicator();

  [[nodiscard]] int rank() const;
  [[nodiscard]] int size() const;
  [[nodiscard]] bool is_root() const { return rank() == 0; }

  /// Those of these ranks that share this rank's memory. Collective.
  [[nodiscard]] Communicator machine() const;

  void barrier() const;
  /// Waits up to `seconds` for all ranks to call this; returns whether they did. May be called
  /// when other ranks are elsewhere, once in a communicator's life: to end a failed run in order if
  /// all ranks have failed, and by abort() if not.
  [[nodiscard]] bool meet(double seconds) const;
  /// Replaces each element by its sum over all ranks.
  void sum(std::span<std::int64_t> values) const;
  /// Replaces each word by the bitwise or over all ranks: joins arrays whose parts no two ranks
  /// both fill, without rounding anything.
  void join(std::span<std::uint64_t> words) const;
  [[nodiscard]] double max(double value) const;
  [[nodiscard]] bool any(bool value) const;

  /// What `root` passes, on all ranks.
  [[nodiscard]] Bytes broadcast(Bytes bytes, int root = 0) const;
  /// On the root: what each rank passes, by rank. Elsewhere: empty.
  [[nodiscard]] std::vector<Bytes> gather(const Bytes& bytes) const;
  /// outgoing[r] goes to rank r; returns what came from each rank (Alltoall of the lengths, then
  /// Alltoallv of the contents).
  [[nodiscard]] std::vector<Bytes> all_to_all(const std::vector<Bytes>& outgoing) const;

  /// outgoing[k] goes to peers[k]; returns what came from each peer. Point to point: only these
  /// ranks take part, and each must be among its peers' peers.
  [[nodiscard]] std::vector<Bytes> exchange(std::span<const int> peers,
                                            const std::vector<Bytes>& outgoing) const;

  /// Prepares messages to be sent again and again. Two ranks must name each other in the same
  /// order; `tag` identifies the exchange.
  [[nodiscard]] RepeatedExchange repeated_exchange(std::span<const Channel> send,
                                                   std::span<const Channel> receive, int tag) const;

  /// Ends all ranks at once with this exit code. Without MPI: ends the process.
  [[noreturn]] void abort(int exit_code) const;

  struct Impl;

 private:
  friend class ParallelSession;
  friend struct MpiAccess;
  explicit Communicator(std::shared_ptr<const Impl> impl) : impl_{std::move(impl)} {}
  std::shared_ptr<const Impl> impl_;
};

/// Starts and ends MPI. One per process, in main. Without MPI it does nothing.
class ParallelSession {
 public:
  ParallelSession(int& argc, char**& argv);
  ~ParallelSession();
  ParallelSession(const ParallelSession&) = delete;
  ParallelSession& operator=(const ParallelSession&) = delete;

  /// All ranks that were started together.
  [[nodiscard]] const Communicator& world() const { return world_; }
  /// "Open MPI 4.1.4", "none".
  [[nodiscard]] static std::string_view library();

 private:
  Communicator world_;
};

}  // namespace reckon
