// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/watch_version.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "reckon/core/xxhash64.hpp"

namespace reckon {

std::string version_of(const RunFolder& folder) {
  XxHash64 hash;
  const auto add = [&](const std::filesystem::path& file) {
    std::error_code code;
    const auto size = std::filesystem::file_size(file, code);
    if (code) return;
    const auto time = std::filesystem::last_write_time(file, code).time_since_epoch().count();
    hash.update(fmt::format("{} {} {}\n", file.filename().string(), size, time));
  };
  for (const auto& file : {folder.resolved(), folder.history(), folder.json()}) add(file);
  const std::vector<std::uint64_t> saved = folder.field_steps("grains");
  if (!saved.empty()) add(folder.root() / RunFolder::field_name("grains", saved.back()));
  return fmt::format("{:016x}", hash.digest());
}

}  // namespace reckon
