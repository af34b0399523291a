// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/disk_volume.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/write_failure.hpp"

namespace reckon {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* problem) {
  throw Error{{.place = path.string(),
               .problem = problem,
               .reason = std::generic_category().message(errno),
               .fix = "Check the folder's permissions and the free space."}};
}

}  // namespace

ByteFile::ByteFile(int descriptor, std::filesystem::path path)
    : descriptor_{descriptor}, path_{std::move(path)} {}

ByteFile::ByteFile(const std::filesystem::path& file)
    : ByteFile{::open(file.c_str(), O_RDONLY | O_CLOEXEC), file} {
  if (descriptor_ < 0) fail(path_, "cannot be read");
}

std::shared_ptr<ByteFile> ByteFile::scratch(const std::filesystem::path& folder) {
  std::string name = (folder / ".scratch-XXXXXX").string();
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) throw_write_failure(folder, errno, "a scratch file cannot be made");
  ::unlink(name.c_str());
  return std::shared_ptr<ByteFile>{new ByteFile{descriptor, folder}};
}

ByteFile::~ByteFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ByteFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const auto got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got == 0) errno = ENODATA;
    if (got <= 0) fail(path_, "cannot be read");
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

void ByteFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const auto put = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) {
      throw_write_failure(path_, put < 0 ? errno : ENOSPC, "a scratch file cannot be written");
    }
    offset += static_cast<std::uint64_t>(put);
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
}

void ByteFile::resize(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) {
    throw_write_failure(path_, errno, "a scratch file cannot be made");
  }
}

std::uint64_t ByteFile::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail(path_, "cannot be read");
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace reckon
