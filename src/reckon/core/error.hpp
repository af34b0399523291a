// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace reckon {

/// What went wrong, in the order in which a reader needs it. Empty parts are left out.
struct ErrorText {
  std::string place;    ///< where: a file with line, an option, a grain id
  std::string problem;  ///< what is wrong, in one clause
  std::string reason;   ///< why it is wrong: the limit, the value found, the system's own word
  std::string fix;      ///< what to do about it, as a sentence
};

/// The one exception type of the library. Its text reads "place: problem (reason). Fix."
class Error : public std::runtime_error {
 public:
  explicit Error(ErrorText text);

  [[nodiscard]] const ErrorText& text() const { return text_; }

 private:
  ErrorText text_;
};

}  // namespace reckon
