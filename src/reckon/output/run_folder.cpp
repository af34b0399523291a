// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/run_folder.hpp"

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
#include "reckon/core/file.hpp"
#include "reckon/core/write_failure.hpp"

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
  if (code) throw_write_failure(folder, code.value(), "this folder cannot be made");
}

bool is_link(const std::filesystem::path& path) {
  std::error_code code;
  return std::filesystem::is_symlink(path, code);
}

/// Whether a run has files of this name, in its folder itself or in one of those inside.
bool is_name_of_run(bool at_top, std::string_view name) {
  constexpr std::array at_top_names{
      "scene.toml",       "scene_resolved.toml",   "history.csv", "run.json",
      "performance.json", "report.html",           "grains.pvd",  "contacts.pvd",
      "surfaces.pvd",     "membrane.pvd",          "walls.pvd",   "cell.pvd",
      "strain.pvd",       "force_distribution.csv"};
  if (at_top) {
    return std::find(at_top_names.begin(), at_top_names.end(), name) != at_top_names.end();
  }
  const auto is_numbered = [&](std::string_view prefix, std::string_view suffix) {
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) return false;
    if (name.size() <= prefix.size() + suffix.size()) return false;
    const std::string_view middle =
        name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    return middle.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return is_numbered("step_", ".h5") ||
         std::any_of(field_kinds.begin(), field_kinds.end(), [&](const char* kind) {
           return is_numbered(fmt::format("{}_", kind), ".vtp");
         });
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

std::filesystem::path RunFolder::own(std::filesystem::path file) const {
  namespace fs = std::filesystem;
  std::error_code code;
  const fs::file_status status = fs::symlink_status(file, code);
  if (!fs::exists(status) || fs::is_regular_file(status)) return file;
  const auto refuse = [&](const char* problem) {
    throw Error{{.place = file.string(),
                 .problem = problem,
                 .reason = "a run writes plain files",
                 .fix = "Put the file itself there, or remove it."}};
  };
  if (!fs::is_symlink(status)) refuse("this is not a file that can be read");
  const fs::path target = fs::canonical(file, code);
  if (code) refuse("this is a link that leads nowhere");
  if (!fs::is_regular_file(target, code)) refuse("this is a link to what is not a file");
  const fs::path inside = target.lexically_relative(fs::canonical(root_, code));
  if (code || inside.empty() || *inside.begin() == "..") {
    refuse("this is a link to a file outside the run's folder");
  }
  return file;
}

void RunFolder::remove_field(std::string_view kind, std::uint64_t step) const {
  std::error_code code;
  if (is_link(root_ / "fields")) return;
  std::filesystem::remove(root_ / field_name(kind, step), code);
}

void RunFolder::remove_run() const {
  remove_leftovers();
  for (const char* name : {"fields", "checkpoints"}) {
    std::error_code code;
    if (is_link(root_ / name)) std::filesystem::remove(root_ / name, code);
  }
  for (const std::uint64_t step : checkpoint_steps()) std::filesystem::remove(checkpoint(step));
  for (const char* kind : field_kinds) {
    for (const std::uint64_t step : field_steps(kind)) remove_field(kind, step);
    std::filesystem::remove(index(kind));
  }
  for (const auto& file : {scene(), resolved(), history(), log(), json(), performance(), report(),
                           root_ / "force_distribution.csv"}) {
    std::filesystem::remove(file);
  }
  remove_paraview();
}

void RunFolder::remove_paraview() const {
  std::error_code code;
  if (is_link(paraview())) return;
  for (const char* name : {"state.py", "shapes.vtm"}) {
    std::filesystem::remove(paraview() / name, code);
  }
  const std::filesystem::path shapes = paraview() / "shapes";
  if (!is_link(shapes)) {
    for (const std::uint64_t shape : numbered_files(shapes, "", ".vtp")) {
      std::filesystem::remove(shapes / fmt::format("{:05}.vtp", shape), code);
    }
    std::filesystem::remove(shapes, code);  // only where they are empty
  }
  std::filesystem::remove(paraview(), code);
}

void RunFolder::remove_leftovers() const {
  for (const auto& folder : {root_, root_ / "fields", root_ / "checkpoints"}) {
    std::error_code code;
    if (folder != root_ && is_link(folder)) continue;
    std::vector<std::filesystem::path> leftovers;
    for (const auto& entry : std::filesystem::directory_iterator{folder, code}) {
      const std::string name = entry.path().filename().string();
      const auto target = target_of_temporary(name);
      if (target && is_name_of_run(folder == root_, *target)) leftovers.push_back(entry.path());
    }
    for (const auto& file : leftovers) std::filesystem::remove(file, code);
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
