// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/domain/ghost_exchange.hpp"

#include <algorithm>
#include <iterator>

#include "reckon/domain/packing.hpp"

namespace reckon {

GhostExchange::GhostExchange(const Communicator& ranks, std::vector<BorderGrain> owned,
                             std::span<const Choose> stages)
    : known_{std::move(owned)}, owned_count_{known_.size()} {
  constexpr int first_tag = 16;
  for (const Choose& choose : stages) {
    Stage stage;
    stage.sends = choose(known_);
    std::vector<Bytes> outgoing;
    for (const auto& indices : stage.sends.indices) {
      std::vector<BorderGrain> grains;
      grains.reserve(indices.size());
      for (const std::uint32_t index : indices) grains.push_back(known_[index]);
      pack<BorderGrain>(outgoing.emplace_back(), grains);
      stage.out.resize(stage.out.size() + indices.size());
    }
    const std::vector<Bytes> incoming = ranks.exchange(stage.sends.peers, outgoing);
    for (const Bytes& bytes : incoming) {
      const auto grains = Unpacker{bytes}.take_all<BorderGrain>();
      stage.first_received.push_back(static_cast<std::uint32_t>(known_.size()));
      stage.received.push_back(static_cast<std::uint32_t>(grains.size()));
      known_.insert(known_.end(), grains.begin(), grains.end());
      stage.in.resize(stage.in.size() + grains.size());
    }
    stages_.push_back(std::move(stage));
  }
  for (const Stage& stage : stages_) {
    for (const auto& indices : stage.sends.indices) {
      std::copy_if(indices.begin(), indices.end(), std::back_inserter(sent_owned_),
                   [this](std::uint32_t index) { return index < owned_count_; });
    }
  }
  std::sort(sent_owned_.begin(), sent_owned_.end());
  sent_owned_.erase(std::unique(sent_owned_.begin(), sent_owned_.end()), sent_owned_.end());
  // Buffers have their final place now: bind the repeated messages to them.
  int tag = first_tag;
  for (Stage& stage : stages_) {
    std::vector<Channel> send;
    std::vector<Channel> receive;
    std::size_t sent = 0;
    std::size_t received = 0;
    for (std::size_t k = 0; k < stage.sends.peers.size(); ++k) {
      const int peer = stage.sends.peers[k];
      const std::size_t send_count = stage.sends.indices[k].size();
      if (send_count > 0) {
        send.push_back(
            {peer, std::as_writable_bytes(std::span{stage.out}.subspan(sent, send_count))});
        bytes_per_update_ += send_count * sizeof(GhostState);
        ++messages_per_update_;
      }
      if (stage.received[k] > 0) {
        receive.push_back({peer, std::as_writable_bytes(
                                     std::span{stage.in}.subspan(received, stage.received[k]))});
      }
      sent += send_count;
      received += stage.received[k];
    }
    stage.exchange = ranks.repeated_exchange(send, receive, tag++);
  }
}

void GhostExchange::fill(Stage& stage) {
  std::size_t next = 0;
  for (const auto& indices : stage.sends.indices) {
    for (const std::uint32_t index : indices) stage.out[next++] = known_[index].state;
  }
}

void GhostExchange::take(Stage& stage) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < stage.received.size(); ++k) {
    for (std::uint32_t n = 0; n < stage.received[k]; ++n) {
      known_[stage.first_received[k] + n].state = stage.in[next++];
    }
  }
}

void GhostExchange::start(const std::function<GhostState(std::uint32_t)>& state_of) {
  if (stages_.empty()) return;
  for (const std::uint32_t index : sent_owned_) known_[index].state = state_of(index);
  fill(stages_.front());
  stages_.front().exchange.start();
}

void GhostExchange::finish() {
  for (std::size_t s = 0; s < stages_.size(); ++s) {
    if (s > 0) {
      fill(stages_[s]);
      stages_[s].exchange.start();
    }
    stages_[s].exchange.finish();
    take(stages_[s]);
  }
}

}  // namespace reckon
