// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <mpi.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>
#include <thread>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/parallel/communicator.hpp"
#include "reckon/parallel/foreign_communicator.hpp"
#include "reckon/parallel/mpi_handle.hpp"

namespace reckon {

struct RepeatedExchange::Impl {
  std::vector<MPI_Request> requests;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    for (MPI_Request& request : requests) MPI_Request_free(&request);
  }
};

RepeatedExchange::RepeatedExchange() = default;
RepeatedExchange::~RepeatedExchange() = default;
RepeatedExchange::RepeatedExchange(RepeatedExchange&&) noexcept = default;
RepeatedExchange& RepeatedExchange::operator=(RepeatedExchange&&) noexcept = default;

void RepeatedExchange::start() {
  if (!impl_ || impl_->requests.empty()) return;
  MPI_Startall(static_cast<int>(impl_->requests.size()), impl_->requests.data());
}

void RepeatedExchange::finish() {
  if (!impl_ || impl_->requests.empty()) return;
  MPI_Waitall(static_cast<int>(impl_->requests.size()), impl_->requests.data(),
              MPI_STATUSES_IGNORE);
}

Communicator::Communicator() = default;
int Communicator::rank() const { return impl_ ? impl_->rank : 0; }
int Communicator::size() const { return impl_ ? impl_->size : 1; }

Communicator Communicator::machine() const {
  if (!impl_) return *this;
  MPI_Comm handle = MPI_COMM_NULL;
  MPI_Comm_split_type(impl_->handle, MPI_COMM_TYPE_SHARED, impl_->rank, MPI_INFO_NULL, &handle);
  auto release = [](Impl* impl) {
    MPI_Comm_free(&impl->handle);
    delete impl;
  };
  std::shared_ptr<Impl> impl{new Impl{handle, 0, 1}, release};
  MPI_Comm_rank(handle, &impl->rank);
  MPI_Comm_size(handle, &impl->size);
  return Communicator{std::move(impl)};
}

bool Communicator::meet(double seconds) const {
  if (!impl_) return true;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(impl_->handle, &request);
  const double end = MPI_Wtime() + seconds;
  int done = 0;
  do {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while (done == 0 && MPI_Wtime() < end);
  return done != 0;
}

void Communicator::barrier() const {
  if (impl_) MPI_Barrier(impl_->handle);
}

void Communicator::sum(std::span<std::int64_t> values) const {
  if (!impl_) return;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM,
                impl_->handle);
}

void Communicator::join(std::span<std::uint64_t> words) const {
  if (!impl_) return;
  MPI_Allreduce(MPI_IN_PLACE, words.data(), static_cast<int>(words.size()), MPI_UINT64_T, MPI_BOR,
                impl_->handle);
}

double Communicator::max(double value) const {
  if (impl_) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, impl_->handle);
  return value;
}

bool Communicator::any(bool value) const {
  int flag = value ? 1 : 0;
  if (impl_) MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_MAX, impl_->handle);
  return flag != 0;
}

namespace {

/// MPI 3 counts bytes in an int.
int checked_count(std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error{{.problem = "a message between ranks is too large",
                 .reason = std::to_string(bytes) + " bytes, MPI counts up to 2147483647",
                 .fix = "Use more ranks, so that each holds fewer grains."}};
  }
  return static_cast<int>(bytes);
}

}  // namespace

Bytes Communicator::broadcast(Bytes bytes, int root) const {
  if (!impl_) return bytes;
  auto length = static_cast<std::int64_t>(bytes.size());
  MPI_Bcast(&length, 1, MPI_INT64_T, root, impl_->handle);
  bytes.resize(static_cast<std::size_t>(length));
  MPI_Bcast(bytes.data(), checked_count(bytes.size()), MPI_BYTE, root, impl_->handle);
  return bytes;
}

std::vector<Bytes> Communicator::gather(const Bytes& bytes) const {
  if (!impl_) return {bytes};
  std::vector<Bytes> outgoing(static_cast<std::size_t>(size()));
  outgoing[0] = bytes;
  std::vector<Bytes> all = all_to_all(outgoing);
  if (!is_root()) all.clear();
  return all;
}

std::vector<Bytes> Communicator::all_to_all(const std::vector<Bytes>& outgoing) const {
  if (!impl_) return outgoing;
  const auto ranks = static_cast<std::size_t>(size());
  std::vector<int> send_counts(ranks);
  std::vector<int> receive_counts(ranks);
  std::size_t total_sent = 0;
  for (std::size_t r = 0; r < ranks; ++r) {
    send_counts[r] = checked_count(outgoing[r].size());
    total_sent += outgoing[r].size();
  }
  static_cast<void>(checked_count(total_sent));
  MPI_Alltoall(send_counts.data(), 1, MPI_INT, receive_counts.data(), 1, MPI_INT, impl_->handle);

  std::vector<int> send_offsets(ranks, 0);
  std::vector<int> receive_offsets(ranks, 0);
  std::partial_sum(send_counts.begin(), send_counts.end() - 1, send_offsets.begin() + 1);
  std::partial_sum(receive_counts.begin(), receive_counts.end() - 1, receive_offsets.begin() + 1);
  Bytes sent;
  sent.reserve(total_sent);
  for (const Bytes& bytes : outgoing) sent.insert(sent.end(), bytes.begin(), bytes.end());
  Bytes received(static_cast<std::size_t>(receive_offsets.back()) +
                 static_cast<std::size_t>(receive_counts.back()));
  MPI_Alltoallv(sent.data(), send_counts.data(), send_offsets.data(), MPI_BYTE, received.data(),
                receive_counts.data(), receive_offsets.data(), MPI_BYTE, impl_->handle);

  std::vector<Bytes> incoming(ranks);
  for (std::size_t r = 0; r < ranks; ++r) {
    const auto first = received.begin() + receive_offsets[r];
    incoming[r].assign(first, first + receive_counts[r]);
  }
  return incoming;
}

std::vector<Bytes> Communicator::exchange(std::span<const int> peers,
                                          const std::vector<Bytes>& outgoing) const {
  if (!impl_) return outgoing;
  constexpr int length_tag = 1;
  constexpr int content_tag = 2;
  const std::size_t count = peers.size();
  std::vector<std::int64_t> send_lengths(count);
  std::vector<std::int64_t> receive_lengths(count);
  std::vector<MPI_Request> requests(2 * count);
  for (std::size_t k = 0; k < count; ++k) {
    send_lengths[k] = checked_count(outgoing[k].size());
    MPI_Irecv(&receive_lengths[k], 1, MPI_INT64_T, peers[k], length_tag, impl_->handle,
              &requests[2 * k]);
    MPI_Isend(&send_lengths[k], 1, MPI_INT64_T, peers[k], length_tag, impl_->handle,
              &requests[2 * k + 1]);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  std::vector<Bytes> incoming(count);
  for (std::size_t k = 0; k < count; ++k) {
    incoming[k].resize(static_cast<std::size_t>(receive_lengths[k]));
    MPI_Irecv(incoming[k].data(), static_cast<int>(receive_lengths[k]), MPI_BYTE, peers[k],
              content_tag, impl_->handle, &requests[2 * k]);
    MPI_Isend(outgoing[k].data(), static_cast<int>(send_lengths[k]), MPI_BYTE, peers[k],
              content_tag, impl_->handle, &requests[2 * k + 1]);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return incoming;
}

RepeatedExchange Communicator::repeated_exchange(std::span<const Channel> send,
                                                 std::span<const Channel> receive, int tag) const {
  RepeatedExchange exchange;
  if (!impl_) return exchange;
  exchange.impl_ = std::make_unique<RepeatedExchange::Impl>();
  auto& requests = exchange.impl_->requests;
  for (const Channel& channel : receive) {
    requests.push_back(MPI_REQUEST_NULL);
    MPI_Recv_init(channel.buffer.data(), checked_count(channel.buffer.size()), MPI_BYTE,
                  channel.peer, tag, impl_->handle, &requests.back());
  }
  for (const Channel& channel : send) {
    requests.push_back(MPI_REQUEST_NULL);
    MPI_Send_init(channel.buffer.data(), checked_count(channel.buffer.size()), MPI_BYTE,
                  channel.peer, tag, impl_->handle, &requests.back());
  }
  return exchange;
}

void Communicator::abort(int exit_code) const {
  if (impl_) MPI_Abort(impl_->handle, exit_code);
  std::_Exit(exit_code);
}

Communicator communicator_of(int fortran_handle) {
  return MpiAccess::ranks(MPI_Comm_f2c(fortran_handle));
}

ParallelSession::ParallelSession(int& argc, char**& argv) {
  int provided = 0;
  // Threads compute, only the main thread speaks to other ranks.
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  world_ = MpiAccess::ranks(MPI_COMM_WORLD);
}

ParallelSession::~ParallelSession() { MPI_Finalize(); }

std::string_view ParallelSession::library() {
  static const std::string text = [] {
    std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> buffer{};
    int length = 0;
    MPI_Get_library_version(buffer.data(), &length);
    const std::string all{buffer.data(), static_cast<std::size_t>(length)};
    return all.substr(0, all.find_first_of(",\n"));
  }();
  return text;
}

}  // namespace reckon
