// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/process.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon::testing {

/// How a program ended and what it said.
struct Outcome {
  int code;
  std::string out;
  std::string err;
};

/// Runs programs in a folder that holds scene.toml and its shapes.
class ProgramTest : public RunSceneTest {
 protected:
  void SetUp() override {
    RunSceneTest::SetUp();
    write("scene.toml", scene_text(usual));
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream{root_ / name} << text;
  }
  /// The program itself, with these arguments.
  [[nodiscard]] Process start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), RECKON_PROGRAM);
    return start_line(std::move(arguments));
  }
  [[nodiscard]] Outcome reckon(std::vector<std::string> arguments) const {
    return outcome_of(start(std::move(arguments)));
  }
  /// `line` begins with the program.
  [[nodiscard]] Process start_line(std::vector<std::string> line) const {
    return Process{std::move(line), root_};
  }
  [[nodiscard]] static Outcome outcome_of(Process process) {
    const int code = process.wait();
    return {code, process.out(), process.err()};
  }
  /// Waits until a run has written rows to its history.
  void wait_for_rows(const std::string& run, std::size_t rows) const {
    for (int tries = 0; tries < 3000; ++tries) {
      std::ifstream file{root_ / run / "history.csv"};
      std::string line;
      std::size_t lines = 0;
      while (std::getline(file, line)) ++lines;
      if (lines > rows) return;
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
    FAIL() << "the run does not get under way";
  }
};

}  // namespace reckon::testing
