// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "reckon/core/error.hpp"

namespace reckon::test {

/// Expects that `call` throws an Error whose text holds every one of `parts`.
template <class Call>
void expect_error(Call&& call, std::initializer_list<std::string> parts) {
  try {
    call();
    ADD_FAILURE() << "no error; expected one about '" << *parts.begin() << "'";
  } catch (const Error& error) {
    for (const std::string& part : parts) {
      EXPECT_NE(std::string{error.what()}.find(part), std::string::npos)
          << "'" << part << "' is not in: " << error.what();
    }
    EXPECT_FALSE(error.text().fix.empty()) << "does not say what to do: " << error.what();
  }
}

}  // namespace reckon::test
