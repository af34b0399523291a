// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "scratch.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace reckon::fuzz {

ScratchFolder::ScratchFolder() {
  std::string name = std::filesystem::temp_directory_path() / "reckon_fuzz_XXXXXX";
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create " + name);
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path ScratchFolder::write(const std::string& name,
                                           std::string_view content) const {
  const std::filesystem::path file = path_ / name;
  std::ofstream{file, std::ios::binary} << content;
  return file;
}

}  // namespace reckon::fuzz
