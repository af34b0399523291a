// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/provenance.hpp"

#include <fcntl.h>

#include <algorithm>

#include "reckon/core/file.hpp"
#include "reckon/core/xxhash64.hpp"

namespace reckon {
namespace {

SourceFile hashed(const std::filesystem::path& path) {
  const OpenFile file{path, O_RDONLY};
  XxHash64 hash;
  const std::uint64_t bytes = hash_file(file, 0, hash);
  return {path.string(), bytes, hash.digest()};
}

}  // namespace

std::vector<SourceFile> source_files(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {hashed(path)};
  std::vector<std::filesystem::path> inside;
  for (const auto& entry : std::filesystem::directory_iterator{path}) {
    if (entry.is_regular_file()) inside.push_back(entry.path());
  }
  std::sort(inside.begin(), inside.end());
  std::vector<SourceFile> files;
  files.reserve(inside.size());
  for (const auto& file : inside) files.push_back(hashed(file));
  return files;
}

std::vector<SourceFile> source_files(const std::vector<std::string>& paths) {
  std::vector<SourceFile> files;
  for (const std::string& path : paths) {
    const auto found = source_files(std::filesystem::path{path});
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

}  // namespace reckon
