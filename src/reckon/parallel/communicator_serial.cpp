// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/parallel/communicator.hpp"
#include "reckon/parallel/foreign_communicator.hpp"

namespace reckon {

struct Communicator::Impl {};
struct RepeatedExchange::Impl {};

RepeatedExchange::RepeatedExchange() = default;
RepeatedExchange::~RepeatedExchange() = default;
RepeatedExchange::RepeatedExchange(RepeatedExchange&&) noexcept = default;
RepeatedExchange& RepeatedExchange::operator=(RepeatedExchange&&) noexcept = default;
void RepeatedExchange::start() {}
void RepeatedExchange::finish() {}

Communicator::Communicator() = default;
int Communicator::rank() const { return 0; }
int Communicator::size() const { return 1; }
Communicator Communicator::machine() const { return *this; }
void Communicator::barrier() const {}
bool Communicator::meet(double /*seconds*/) const { return true; }
void Communicator::sum(std::span<std::int64_t> /*values*/) const {}
void Communicator::join(std::span<std::uint64_t> /*words*/) const {}
double Communicator::max(double value) const { return value; }
bool Communicator::any(bool value) const { return value; }
Bytes Communicator::broadcast(Bytes bytes, int /*root*/) const { return bytes; }
std::vector<Bytes> Communicator::gather(const Bytes& bytes) const { return {bytes}; }
std::vector<Bytes> Communicator::all_to_all(const std::vector<Bytes>& outgoing) const {
  return outgoing;
}
std::vector<Bytes> Communicator::exchange(std::span<const int> /*peers*/,
                                          const std::vector<Bytes>& outgoing) const {
  return outgoing;  // the only peer there can be is oneself
}
RepeatedExchange Communicator::repeated_exchange(std::span<const Channel> /*send*/,
                                                 std::span<const Channel> /*receive*/,
                                                 int /*tag*/) const {
  return {};
}
void Communicator::abort(int exit_code) const { std::_Exit(exit_code); }

Communicator communicator_of(int /*fortran_handle*/) {
  throw Error{{.place = {},
               .problem = "this build has no MPI",
               .reason = {},
               .fix = "Build with -DRECKON_MPI=ON, or pass no communicator."}};
}

ParallelSession::ParallelSession(int& /*argc*/, char**& /*argv*/) {
  // Started by mpirun, every copy of a serial build would run the whole scene and overwrite the
  // others' files.
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* ranks = std::getenv(variable);
    if (ranks != nullptr && std::atoi(ranks) > 1) {
      throw Error{{.problem = "this build has no MPI but was started on several ranks",
                   .reason = std::string{variable} + "=" + ranks,
                   .fix = "Build with -DRECKON_MPI=ON, or start it without mpirun."}};
    }
  }
}
ParallelSession::~ParallelSession() = default;
std::string_view ParallelSession::library() { return "none"; }

}  // namespace reckon
