// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

std::string last_system_error() { return std::generic_category().message(errno); }

/// Distinct for every file that this process has under way.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<std::uint64_t> next{0};
  return target.string() + "." + std::to_string(getpid()) + "-" + std::to_string(next++) + ".tmp";
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path target)
    : target_{std::move(target)}, temporary_{temporary_name(target_)} {
  const auto folder = target_.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw Error{{.place = target_.string(),
                 .problem = "cannot be written",
                 .reason = "the folder " + folder.string() + " does not exist",
                 .fix = "Create the folder or give another name."}};
  }
}

PendingFile::~PendingFile() {
  if (committed_) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void PendingFile::commit() {
  // The rename may reach the disk before the data does, unless the data is flushed first.
  const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool flushed = descriptor >= 0 && ::fsync(descriptor) == 0;
  const std::string reason = flushed ? "" : last_system_error();
  if (descriptor >= 0) ::close(descriptor);
  if (!flushed) {
    throw Error{{.place = target_.string(),
                 .problem = "could not be written to disk",
                 .reason = reason,
                 .fix = "Check the free space and the file system."}};
  }
  std::error_code failure;
  std::filesystem::rename(temporary_, target_, failure);
  if (failure) {
    throw Error{{.place = target_.string(),
                 .problem = "could not be put in place",
                 .reason = failure.message(),
                 .fix = "Check that the folder may be written and that the name is not a folder."}};
  }
  committed_ = true;
}

void write_file(const std::filesystem::path& target, std::span<const std::string_view> parts) {
  PendingFile pending{target};
  const auto fail = [&](const std::string& reason) {
    throw Error{{.place = target.string(),
                 .problem = "cannot be written",
                 .reason = reason,
                 .fix = "Check the folder's permissions and the free space."}};
  };
  FileHandle file{std::fopen(pending.temporary().c_str(), "wb")};
  if (!file) fail(last_system_error());
  for (const std::string_view part : parts) {
    if (!part.empty() && std::fwrite(part.data(), 1, part.size(), file.get()) != part.size()) {
      fail(last_system_error());
    }
  }
  if (std::fclose(file.release()) != 0) fail(last_system_error());
  pending.commit();
}

void write_file(const std::filesystem::path& target, std::string_view content) {
  write_file(target, std::span{&content, 1});
}

std::string read_file(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& reason) {
    throw Error{{.place = path.string(),
                 .problem = "cannot be read",
                 .reason = reason,
                 .fix = "Check the path and its permissions."}};
  };
  if (std::filesystem::is_directory(path)) fail("it is a folder");
  const FileHandle file{std::fopen(path.c_str(), "rb")};
  if (!file) fail(last_system_error());
  std::string content;
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file.get())) {
    content.append(buffer, count);
  }
  if (std::ferror(file.get()) != 0) fail(last_system_error());
  return content;
}

}  // namespace reckon
