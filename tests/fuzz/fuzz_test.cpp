// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "guard.hpp"
#include "reckon/core/error.hpp"
#include "target.hpp"

namespace reckon::fuzz {

void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }  // NOLINT: gtest's

namespace {

constexpr int longest_case = 20;  // seconds of computing; sanitizers are slow, machines busy

std::size_t case_count(const Target& target) {
  const char* wanted = std::getenv("RECKON_FUZZ_CASES");  // NOLINT(concurrency-mt-unsafe)
  const std::size_t cases = wanted == nullptr ? 4000 : std::strtoul(wanted, nullptr, 10);
  return std::max<std::size_t>(cases / target.cost, 20);
}

enum class Answer { accepted, refused, broken };

/// Reads one input; an exception that is no reckon::Error fails the test and keeps the input.
Answer answer(const Target& target, const std::string& input, const std::string& what) {
  const std::string kept = std::string{RECKON_FUZZ_KEPT} + "/failed_" + target.name;
  try {
    const Guard guard{kept, input, longest_case};
    target.read(input);
    return Answer::accepted;
  } catch (const Error& error) {
    if (error.what()[0] != '\0') return Answer::refused;
    ADD_FAILURE() << what << ": an error without text";
  } catch (const std::exception& error) {
    ADD_FAILURE() << what << ": no reckon::Error, but: " << error.what();
  }
  std::ofstream{kept, std::ios::binary} << input;
  ADD_FAILURE() << "the input is kept in " << kept;
  return Answer::broken;
}

class Reader : public testing::TestWithParam<Target> {};

TEST_P(Reader, AcceptsTheInputsThatAreDamagedLater) {
  for (const std::string& input : GetParam().valid_inputs()) {
    EXPECT_NO_THROW(GetParam().read(input)) << input.substr(0, 2000);
  }
}

TEST_P(Reader, AnswersFormerFailuresCleanly) {
  const std::filesystem::path folder =
      std::filesystem::path{RECKON_SOURCE_DIR} / "tests/fuzz/regressions" / GetParam().name;
  if (!std::filesystem::exists(folder)) return;  // none is known
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    std::ostringstream content;
    content << std::ifstream{entry.path(), std::ios::binary}.rdbuf();
    EXPECT_NE(answer(GetParam(), content.str(), entry.path().filename()), Answer::broken);
  }
}

TEST_P(Reader, AnswersDamagedInputWithACleanErrorOrNone) {
  const Target& target = GetParam();
  const std::vector<std::string> inputs = target.valid_inputs();
  const std::size_t cases = case_count(target);
  std::size_t refused = 0;
  for (std::size_t n = 0; n < cases; ++n) {
    RandomStream random{2024, RandomPurpose::other, n};
    const std::string input = target.damage(inputs[n % inputs.size()], random);
    const Answer result = answer(target, input, target.name + ", case " + std::to_string(n));
    if (result == Answer::broken) return;
    refused += result == Answer::refused ? 1 : 0;
  }
  // A reader that refuses next to nothing does not look; without damage this test shows nothing.
  EXPECT_GT(refused, cases / 20) << "of " << cases;
}

INSTANTIATE_TEST_SUITE_P(All, Reader, testing::ValuesIn(all_targets()),
                         [](const auto& reader) { return reader.param.name; });

}  // namespace
}  // namespace reckon::fuzz
