// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/write_failure.hpp"

namespace reckon {
namespace {

/// Distinct for every file that this process is writing.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<std::uint64_t> next{0};
  return target.string() + "." + std::to_string(getpid()) + "-" + std::to_string(next++) + ".tmp";
}

[[noreturn]] void fail_to_read(const std::filesystem::path& path, std::string reason) {
  throw Error{{.place = path.string(),
               .problem = "cannot be read",
               .reason = std::move(reason),
               .fix = "Check the path and its permissions."}};
}
[[noreturn]] void fail_to_read(const std::filesystem::path& path, int error_number) {
  if (error_number == EIO)
    throw_write_failure(path, error_number, "cannot be read");  // the device fails
  fail_to_read(path, std::generic_category().message(error_number));
}

/// Repeats a call that a signal has interrupted.
template <class Call>
auto persist(Call&& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

/// Makes the names in a folder last through a power failure. File systems that cannot do this for a
/// folder return other errors, and the folder may not be readable.
void flush_folder(const std::filesystem::path& file) {
  const std::filesystem::path parent = file.parent_path();
  const std::filesystem::path folder = parent.empty() ? "." : parent;
  const int descriptor =
      persist([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (descriptor < 0) return;
  const int flushed = persist([&] { return ::fsync(descriptor); });
  const int error_number = errno;
  ::close(descriptor);
  const bool refused = error_number == EIO || error_number == ENOSPC || error_number == EDQUOT;
  if (flushed != 0 && refused) throw_write_failure(file, error_number, "may not last");
}

/// Whether the text is digits, and some.
bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
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
  OpenFile file{temporary_, O_WRONLY, target_};
  file.flush();
  file.close();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw_write_failure(target_, errno, "could not be put in place");
  }
  committed_ = true;
  flush_folder(target_);
}

std::optional<std::string_view> target_of_temporary(std::string_view name) {
  constexpr std::string_view ending = ".tmp";
  if (!name.ends_with(ending)) return std::nullopt;
  name.remove_suffix(ending.size());
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos || dot == 0) return std::nullopt;
  const std::string_view number = name.substr(dot + 1);
  const std::size_t dash = number.find('-');
  if (dash == std::string_view::npos || !is_number(number.substr(0, dash)) ||
      !is_number(number.substr(dash + 1))) {
    return std::nullopt;
  }
  return name.substr(0, dot);
}

OpenFile::OpenFile(std::filesystem::path path, int flags, std::filesystem::path named)
    : named_{named.empty() ? path : std::move(named)}, descriptor_{persist([&] {
        return ::open(path.c_str(), flags | O_CLOEXEC, 0666);
      })} {
  if (descriptor_ >= 0) return;
  const int error_number = errno;
  if ((flags & O_ACCMODE) == O_RDONLY) fail_to_read(named_, error_number);
  fail_to_write(error_number);
}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::uint64_t OpenFile::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail_to_read(named_, errno);
  return static_cast<std::uint64_t>(status.st_size);
}

std::size_t OpenFile::read(std::uint64_t offset, std::span<char> bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = persist([&] {
      return ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                     static_cast<off_t>(offset + done));
    });
    if (count < 0) fail_to_read(named_, errno);
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

void OpenFile::write(std::uint64_t offset, std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = persist([&] {
      return ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    });
    if (count <= 0) fail_to_write(count < 0 ? errno : ENOSPC);
    offset += static_cast<std::uint64_t>(count);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void OpenFile::flush() const {
  if (persist([&] { return ::fsync(descriptor_); }) != 0) fail_to_write(errno);
}

void OpenFile::close() {
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail_to_write(errno);
}

void OpenFile::fail_to_write(int error_number) const { throw_write_failure(named_, error_number); }

void write_file(const std::filesystem::path& target, std::span<const std::string_view> parts) {
  PendingFile pending{target};
  OpenFile file{pending.temporary(), O_WRONLY | O_CREAT | O_TRUNC, target};
  std::uint64_t offset = 0;
  for (const std::string_view part : parts) {
    file.write(offset, part);
    offset += part.size();
  }
  file.close();
  pending.commit();
}

void write_file(const std::filesystem::path& target, std::string_view content) {
  write_file(target, std::span{&content, 1});
}

void require_own_file(const std::filesystem::path& target, std::string_view mark,
                      std::string_view kind) {
  if (!std::filesystem::is_regular_file(target)) return;
  std::string head(1000, '\0');
  head.resize(OpenFile{target, O_RDONLY}.read(0, head));
  if (head.empty() || head.find(mark) != std::string::npos) return;
  throw Error{{.place = target.string(),
               .problem = "is not replaced",
               .reason = fmt::format("there is another file of this name, no {}", kind),
               .fix = "Give another name, or remove that file first."}};
}

std::string read_file(const std::filesystem::path& path) {
  const OpenFile file{path, O_RDONLY};
  struct stat status {};
  if (::fstat(file.descriptor(), &status) != 0) fail_to_read(path, errno);
  if (S_ISDIR(status.st_mode)) fail_to_read(path, "it is a folder");
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) {
    fail_to_read(path, "it is a device, not a file");
  }
  std::string content;
  if (S_ISREG(status.st_mode)) content.reserve(static_cast<std::size_t>(status.st_size));
  std::string buffer(1 << 16, '\0');
  while (true) {
    const ssize_t count =
        persist([&] { return ::read(file.descriptor(), buffer.data(), buffer.size()); });
    if (count < 0) fail_to_read(path, errno);
    if (count == 0) return content;
    content.append(buffer, 0, static_cast<std::size_t>(count));
  }
}

}  // namespace reckon
