// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/domain/replicated_decomposition.hpp"

#include <cstring>

#include "reckon/domain/packing.hpp"

namespace reckon {
namespace {

/// All other ranks' grains, by one Allreduce over an array in which each rank fills its own places
/// and leaves the others zero.
class ReplicatedGhosts final : public Ghosts {
 public:
  ReplicatedGhosts(const Communicator& ranks, std::vector<BorderGrain> owned) : ranks_{ranks} {
    Bytes mine;
    pack<BorderGrain>(mine, owned);
    const std::vector<Bytes> outgoing(static_cast<std::size_t>(ranks.size()), mine);
    const std::vector<Bytes> incoming = ranks.all_to_all(outgoing);
    for (int rank = 0; rank < ranks.size(); ++rank) {
      const auto grains =
          Unpacker{incoming[static_cast<std::size_t>(rank)]}.take_all<BorderGrain>();
      if (rank == ranks.rank()) {
        own_place_ = place_count_;
        own_count_ = grains.size();
      } else {
        ghosts_.insert(ghosts_.end(), grains.begin(), grains.end());
      }
      place_count_ += grains.size();
    }
  }

  [[nodiscard]] std::span<const BorderGrain> ghosts() const override { return ghosts_; }

  void start(const std::function<GhostState(std::uint32_t)>& state_of) override {
    words_.assign(place_count_ * words_per_state, 0);
    for (std::uint32_t n = 0; n < own_count_; ++n) {
      const GhostState state = state_of(n);
      std::memcpy(&words_[(own_place_ + n) * words_per_state], &state, sizeof state);
    }
  }

  void finish() override {
    ranks_.join(words_);
    for (std::size_t g = 0; g < ghosts_.size(); ++g) {
      const std::size_t place = g < own_place_ ? g : g + own_count_;
      std::memcpy(static_cast<void*>(&ghosts_[g].state), &words_[place * words_per_state],
                  sizeof(GhostState));
    }
  }

  [[nodiscard]] std::uint64_t bytes_per_update() const override {
    return place_count_ * sizeof(GhostState);
  }
  [[nodiscard]] std::uint64_t messages_per_update() const override { return 1; }

 private:
  static constexpr std::size_t words_per_state = sizeof(GhostState) / sizeof(std::uint64_t);
  Communicator ranks_;
  std::vector<BorderGrain> ghosts_;
  std::vector<std::uint64_t> words_;
  std::size_t place_count_{0};
  std::size_t own_place_{0};
  std::size_t own_count_{0};
};

}  // namespace

int ReplicatedDecomposition::owner_of(GrainId id, const Vec3& /*position*/) const {
  return static_cast<int>(std::uint64_t{id.get()} * static_cast<std::uint64_t>(ranks_.size()) /
                          grain_count_);
}

std::unique_ptr<Ghosts> ReplicatedDecomposition::exchange_ghosts(
    std::vector<BorderGrain> owned) const {
  return std::make_unique<ReplicatedGhosts>(ranks_, std::move(owned));
}

}  // namespace reckon
