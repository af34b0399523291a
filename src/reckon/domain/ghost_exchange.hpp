// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "reckon/core/id.hpp"
#include "reckon/grains/grains.hpp"
#include "reckon/parallel/communicator.hpp"

namespace reckon {

/// The data of a grain of another rank that is needed at every step: 104 bytes. Shear springs are
/// not among it: they are computed on both sides from the same bits.
struct GhostState {
  Vec3 position;
  Quaternion orientation;
  Vec3 velocity;
  Vec3 angular_velocity_body;
};

/// A ghost when lists are made: its identity, its state, and its place for decompositions (in a
/// periodic cell, PeriodicCell::place).
struct BorderGrain {
  GrainId id;
  ShapeId shape;
  GhostState state;
  Vec3 place{};  ///< [m]
};

/// The grains of other ranks that this rank needs, updated at every step.
class Ghosts {
 public:
  virtual ~Ghosts() = default;
  [[nodiscard]] virtual std::span<const BorderGrain> ghosts() const = 0;
  /// Starts to send the owned grains' new states; `state_of` gives them by local index. Other work
  /// may go on until finish().
  virtual void start(const std::function<GhostState(std::uint32_t)>& state_of) = 0;
  /// Ends the exchange. `ghosts()` then hold their new states.
  virtual void finish() = 0;
  [[nodiscard]] virtual std::uint64_t bytes_per_update() const = 0;
  [[nodiscard]] virtual std::uint64_t messages_per_update() const = 0;
};

/// Ghosts that come in stages, each of which may pass on what earlier stages brought. A local index
/// counts owned grains first, then ghosts in the order in which they came.
///
///   owned 0 ... n-1 | ghosts of stage 0 | of stage 1 | ...
///                      \__ sent on by stage 1, as the paper's y phase sends on the x phase's
class GhostExchange final : public Ghosts {
 public:
  /// What one stage sends: to each peer the local indices of grains. Both sides name each other.
  struct Sends {
    std::vector<int> peers;
    std::vector<std::vector<std::uint32_t>> indices;
  };
  /// Chooses what the next stage sends, from all grains known so far.
  using Choose = std::function<Sends(std::span<const BorderGrain> known)>;

  /// Collective among peers. `owned` are this rank's grains; runs the stages once and remembers
  /// them. `ghosts()` are the border grains that came.
  GhostExchange(const Communicator& ranks, std::vector<BorderGrain> owned,
                std::span<const Choose> stages);

  [[nodiscard]] std::span<const BorderGrain> ghosts() const override {
    return std::span{known_}.subspan(owned_count_);
  }

  void start(const std::function<GhostState(std::uint32_t)>& state_of) override;
  void finish() override;
  [[nodiscard]] std::uint64_t bytes_per_update() const override { return bytes_per_update_; }
  [[nodiscard]] std::uint64_t messages_per_update() const override { return messages_per_update_; }

 private:
  struct Stage {
    Sends sends;
    std::vector<std::uint32_t> first_received;  // per peer, local index
    std::vector<std::uint32_t> received;        // per peer, how many
    std::vector<GhostState> out;                // all peers' sends, one after another
    std::vector<GhostState> in;
    RepeatedExchange exchange;
  };
  void fill(Stage& stage);
  void take(Stage& stage);

  std::vector<BorderGrain> known_;
  std::size_t owned_count_{0};
  std::vector<std::uint32_t> sent_owned_;  // owned grains that some stage sends, each once
  std::vector<Stage> stages_;
  std::uint64_t bytes_per_update_{0};
  std::uint64_t messages_per_update_{0};
};

}  // namespace reckon
