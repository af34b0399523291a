// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <system_error>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr std::array field_kinds{"grains", "contacts", "surfaces", "membrane",
                                 "walls",  "cell",     "strain"};

/// Steps of all files "PREFIX<digits>SUFFIX" in a folder, ascending.
std::vector<std::uint64_t> numbered_files(const std::filesystem::path& folder,
                                          const std::string& prefix, std::string_view suffix) {
  std::vector<std::uint64_t> steps;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator{folder, code}) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    if (name.size() <= prefix.size() + suffix.size()) continue;
    const char* first = name.data() + prefix.size();
    const char* last = name.data() + name.size() - suffix.size();
    std::uint64_t step = 0;
    const auto [end, error] = std::from_chars(first, last, step);
    if (error == std::errc{} && end == last) steps.push_back(step);
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (!code) return;
  throw Error{{.place = folder.string(),
               .problem = "this folder cannot be made",
               .reason = code.message(),
               .fix = "Give another one with --out."}};
}

}  // namespace

std::filesystem::path RunFolder::index(std::string_view kind) const {
  return root_ / fmt::format("{}.pvd", kind);
}

std::string RunFolder::field_name(std::string_view kind, std::uint64_t step) {
  return fmt::format("fields/{}_{:010}.vtp", kind, step);
}

std::filesystem::path RunFolder::checkpoint(std::uint64_t step) const {
  return root_ / fmt::format("checkpoints/step_{:010}.h5", step);
}

std::vector<std::uint64_t> RunFolder::checkpoint_steps() const {
  return numbered_files(root_ / "checkpoints", "step_", ".h5");
}

std::vector<std::uint64_t> RunFolder::field_steps(std::string_view kind) const {
  return numbered_files(root_ / "fields", fmt::format("{}_", kind), ".vtp");
}

bool RunFolder::has_content() const {
  std::error_code code;
  if (!std::filesystem::is_directory(root_, code)) return std::filesystem::exists(root_, code);
  for (const auto& entry : std::filesystem::recursive_directory_iterator{root_, code}) {
    if (!entry.is_directory()) return true;
  }
  return false;
}

bool RunFolder::holds_run() const {
  // Any of them: a run that was killed at its very beginning has only the first.
  return std::filesystem::exists(log()) || std::filesystem::exists(resolved()) ||
         std::filesystem::exists(json());
}

void RunFolder::create() const { make_folder(root_); }

void RunFolder::create_subfolders() const {
  make_folder(root_ / "fields");
  make_folder(root_ / "checkpoints");
}

void RunFolder::remove_run() const {
  remove_leftovers();
  for (const std::uint64_t step : checkpoint_steps()) std::filesystem::remove(checkpoint(step));
  for (const char* kind : field_kinds) {
    for (const std::uint64_t step : field_steps(kind)) {
      std::filesystem::remove(root_ / field_name(kind, step));
    }
    std::filesystem::remove(index(kind));
  }
  for (const auto& file : {scene(), resolved(), history(), log(), json(), performance(), report(),
                           root_ / "force_distribution.csv"}) {
    std::filesystem::remove(file);
  }
  std::filesystem::remove_all(paraview());
}

void RunFolder::remove_leftovers() const {
  for (const auto& folder : {root_, root_ / "fields", root_ / "checkpoints"}) {
    std::error_code code;
    std::vector<std::filesystem::path> leftovers;
    for (const auto& entry : std::filesystem::directory_iterator{folder, code}) {
      if (entry.path().extension() == ".tmp") leftovers.push_back(entry.path());
    }
    for (const auto& file : leftovers) std::filesystem::remove(file);
  }
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)} {
  if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const bool taken = errno == EWOULDBLOCK;
  const std::string reason = std::generic_category().message(errno);
  // File systems without locks (some network ones) leave only the user's care.
  if (descriptor_ >= 0 && !taken) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  throw Error{{.place = folder.string(),
               .problem = taken ? "another process is running in this folder" : "cannot be opened",
               .reason = taken ? "" : reason,
               .fix = taken ? "Wait for it or give another folder with --out." : ""}};
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace reckon
