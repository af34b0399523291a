// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/write_failure.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace reckon {
namespace {

namespace fs = std::filesystem;

/// The nearest folder above a file that exists.
fs::path folder_of(const fs::path& file) {
  std::error_code code;
  fs::path folder = fs::absolute(file, code).parent_path();
  while (folder.has_relative_path() && !fs::is_directory(folder, code)) {
    folder = folder.parent_path();
  }
  return folder;
}

/// Where the file system of a folder is mounted.
fs::path mount_point_of(fs::path folder) {
  std::error_code code;
  if (const fs::path real = fs::canonical(folder, code); !code) folder = real;
  struct stat own {};
  struct stat above {};
  while (folder.has_relative_path() && ::stat(folder.c_str(), &own) == 0 &&
         ::stat(folder.parent_path().c_str(), &above) == 0 && own.st_dev == above.st_dev) {
    folder = folder.parent_path();
  }
  return folder;
}

std::string amount(double bytes) {
  constexpr std::array units{"B", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  while (bytes >= 1000 && unit + 1 < units.size()) {
    bytes /= 1000;
    ++unit;
  }
  return fmt::format("{:.3g} {}", bytes, units[unit]);
}

/// "the disk at /scratch has 12 kB free of 2 TB"
std::string disk_of(const fs::path& file) {
  const fs::path folder = folder_of(file);
  std::string name = "the disk at " + mount_point_of(folder).string();
  struct statvfs disk {};
  if (::statvfs(folder.c_str(), &disk) != 0) return name;
  const auto block = static_cast<double>(disk.f_frsize);
  return fmt::format("{} has {} free of {}", name,
                     amount(block * static_cast<double>(disk.f_bavail)),
                     amount(block * static_cast<double>(disk.f_blocks)));
}

std::string cure_of(int error_number) {
  switch (error_number) {
    case EDQUOT:
      return "Your quota there is used up: remove files of yours, or write to another disk.";
    case EFBIG:
      return "A limit on the size of files is in force: raise it (ulimit -f unlimited), or write "
             "to "
             "a file system that allows larger files.";
    case EROFS:
      return "Write to another disk, or mount this one for writing.";
    case EIO:
      return "The device fails: check it, and write to another disk.";
    default:
      return "Make room there, or write to another disk.";
  }
}

}  // namespace

void throw_write_failure(const fs::path& file, int error_number, const std::string& problem) {
  ErrorText text{.place = file.string(), .problem = problem, .reason = {}, .fix = {}};
  const std::string system = error_number == 0
                                 ? std::string{"the disk did not keep what was written"}
                                 : std::generic_category().message(error_number);
  switch (error_number) {
    case EACCES:
    case EPERM:
    case ENOENT:
    case ENOTDIR:
    case EISDIR:
    case ENAMETOOLONG:
    case ELOOP:
      text.reason = system;
      text.fix = "Check the folder and its permissions, or give another name.";
      throw Error{std::move(text)};
    default:
      text.reason = fmt::format("{}; {}", system, disk_of(file));
      text.fix = cure_of(error_number);
      throw MachineFailure{std::move(text)};
  }
}

}  // namespace reckon
