// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/error.hpp"

#include <utility>

namespace reckon {
namespace {

std::string sentence(const ErrorText& text) {
  std::string out = text.place.empty() ? text.problem : text.place + ": " + text.problem;
  if (!text.reason.empty()) out += " (" + text.reason + ")";
  if (!text.fix.empty()) out += ". " + text.fix;
  return out;
}

}  // namespace

Error::Error(ErrorText text) : std::runtime_error{sentence(text)}, text_{std::move(text)} {}

}  // namespace reckon
