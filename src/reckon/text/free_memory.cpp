// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/free_memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "reckon/core/error.hpp"
#include "reckon/text/human.hpp"

namespace reckon {

std::uint64_t free_memory() {
  std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  std::ifstream file{"/proc/meminfo"};  // lines "MemAvailable:   1234567 kB"
  std::string name;
  std::uint64_t kibibytes = 0;
  std::string unit;
  while (file >> name >> kibibytes && std::getline(file, unit)) {
    if (name == "MemAvailable:") most = 1024 * kibibytes;
  }
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    most = std::min<std::uint64_t>(most, limit.rlim_cur);
  }
  return most;
}

void require_memory(std::uint64_t bytes, const std::string& what, const std::string& fix) {
  const std::uint64_t most = free_memory();
  if (bytes <= most) return;
  throw Error{{.place = {},
               .problem = fmt::format("{} would take {} of memory, but {} are free", what,
                                      human_bytes(bytes), human_bytes(most)),
               .reason = {},
               .fix = fix}};
}

}  // namespace reckon
