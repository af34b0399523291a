// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/seal.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/write_failure.hpp"
#include "reckon/core/xxhash64.hpp"

namespace reckon {
namespace {

constexpr std::string_view family = "Sand Reckoner ";

[[noreturn]] void refuse(const std::filesystem::path& path, std::string problem, std::string reason,
                         std::string fix) {
  throw Error{{.place = path.string(),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

/// The first line of a seal.
std::string seal_line(const std::string& kind) { return fmt::format("{}{}\n", family, kind); }

/// The lines of a seal that its own hash covers.
std::string seal_head(const std::string& kind, std::uint64_t version, std::uint64_t size) {
  return fmt::format("{}version {}\nbytes {}\n", seal_line(kind), version, size);
}

std::string whole_seal(const std::string& head, std::uint64_t digest) {
  std::string seal = fmt::format("{}xxh64 {:016x}\n", head, digest);
  seal.resize(seal_size, '\0');
  return seal;
}

/// The number after `key` on the next line of `text`, which is consumed; false when it is not so.
bool take_number(std::string_view& text, std::string_view key, int base, std::uint64_t& number) {
  if (!text.starts_with(key)) return false;
  text.remove_prefix(key.size());
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number, base);
  text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
  if (result.ec != std::errc{} || !text.starts_with('\n')) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

void write_seal(const std::filesystem::path& path, const std::string& kind, std::uint32_t version,
                const std::filesystem::path& named) {
  OpenFile file{path, O_RDWR, named};
  XxHash64 hash;
  const std::uint64_t size = hash_file(file, seal_size, hash);
  if (size != file.size()) throw_write_failure(named, 0);  // shorter than a seal, or growing
  const std::string head = seal_head(kind, version, size);
  hash.update(head);
  const std::string seal = whole_seal(head, hash.digest());
  file.write(0, seal);
  std::array<char, seal_size> found{};
  if (file.read(0, found) != seal_size || std::string_view{found.data(), seal_size} != seal) {
    throw_write_failure(named, 0);
  }
  file.close();
}

void require_replaceable(const std::filesystem::path& path, const std::string& kind) {
  require_own_file(path, seal_line(kind), kind);
}

SealContent check_seal(const std::filesystem::path& path, const std::string& kind) {
  if (std::filesystem::is_directory(path)) {
    refuse(path, "cannot be read", "it is a folder", "Check the path and its permissions.");
  }
  const OpenFile file{path, O_RDONLY | O_NONBLOCK};  // a pipe must not keep us waiting
  std::array<char, seal_size> head{};
  const std::size_t head_size = file.read(0, head);
  std::string_view text{head.data(), head_size};
  text = text.substr(0, text.find('\0'));
  const std::string_view title = text.substr(0, text.find('\n'));
  if (!title.starts_with(family)) {
    refuse(path, "is not a " + kind, "it does not begin with the seal of one",
           "Give a file that reckon wrote.");
  }
  if (title.substr(family.size()) != kind) {
    refuse(path, "is not a " + kind, fmt::format("it is a {}", title.substr(family.size())),
           "Give a file of that kind.");
  }
  text.remove_prefix(std::min(text.size(), title.size() + 1));
  std::uint64_t version = 0;
  std::uint64_t size = 0;
  std::uint64_t expected = 0;
  if (head_size < seal_size || !take_number(text, "version ", 10, version) ||
      !take_number(text, "bytes ", 10, size) || !take_number(text, "xxh64 ", 16, expected)) {
    refuse(path, "is damaged", "its seal cannot be read", "Make it anew or restore a copy.");
  }
  XxHash64 hash;
  const std::uint64_t found_size = hash_file(file, seal_size, hash);
  if (found_size != size) {
    refuse(path, "is damaged",
           fmt::format("it has {} bytes where its seal says {}", found_size, size),
           "Make it anew or restore a copy.");
  }
  const std::string expected_head = seal_head(kind, version, size);
  hash.update(expected_head);
  if (hash.digest() != expected ||
      whole_seal(expected_head, expected) != std::string_view{head.data(), head_size}) {
    refuse(path, "is damaged",
           fmt::format("its content hashes to {:016x}, and its seal says {:016x}", hash.digest(),
                       expected),
           "Make it anew or restore a copy.");
  }
  return {static_cast<std::uint32_t>(version), size};
}

}  // namespace reckon
