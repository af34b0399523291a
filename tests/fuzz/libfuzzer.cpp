// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <string>

#include "reckon/core/error.hpp"
#include "target.hpp"

namespace {

const reckon::fuzz::Target& chosen_target() {
  static const reckon::fuzz::Target target = [] {
    for (reckon::fuzz::Target& candidate : reckon::fuzz::all_targets()) {
      if (candidate.name == RECKON_FUZZ_TARGET) return candidate;
    }
    __builtin_trap();  // the build names a target that does not exist
  }();
  return target;
}

}  // namespace

/// libFuzzer calls this with each input that it thinks of.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    chosen_target().read(std::string{reinterpret_cast<const char*>(data), size});
  } catch (const reckon::Error&) {
    // A clean answer.
  }
  return 0;
}
