// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/program_fixture.hpp"

namespace reckon {
namespace {

using testing::Outcome;

class CliTest : public testing::ProgramTest {
 protected:
  void expect_identical(const std::string& a, const std::string& b) const {
    const Outcome outcome = reckon({"diff", a, b});
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.out.find("bit-identical\n"), 0U) << outcome.out;
  }
};

/// Grains far too soft for their stress: every command reports it before anything else.
TEST_F(CliTest, FiguresThatMeanNothingAreAnnouncedFirst) {
  write("soft.toml", with(staged(), "2e9 N/m^3", "1e9 N/m^3"));
  const Outcome check = reckon({"check", "soft.toml", "--timing", "0"});
  EXPECT_EQ(check.code, 0);
  EXPECT_NE(check.out.find("TOO SOFT"), std::string::npos) << check.out;
  EXPECT_NE(
      reckon({"check", "soft.toml", "--json", "--timing", "0"}).out.find("\"too_deep\": true"),
      std::string::npos);
  const Outcome run = reckon({"run", "soft.toml"});
  EXPECT_EQ(run.code, 0);
  const std::size_t verdict = run.out.find("THE FIGURES OF THIS RUN MEAN NOTHING:");
  ASSERT_NE(verdict, std::string::npos) << run.out;
  EXPECT_LT(verdict, run.out.find("complete at step"));
  EXPECT_LT(verdict, run.out.find("peak friction angle"));
  const Outcome quiet = reckon({"run", "soft.toml", "--out", "quiet.run", "--quiet"});
  EXPECT_EQ(quiet.out, "");
  EXPECT_TRUE(quiet.err.starts_with("THE FIGURES OF THIS RUN MEAN NOTHING:")) << quiet.err;
  const Outcome again = reckon({"run", "soft.toml", "--resume", "--json"});
  EXPECT_TRUE(again.out.starts_with("{\n  \"valid\": false,\n  \"reasons\": [\n")) << again.out;
  EXPECT_TRUE(reckon({"analyse", "soft.run"}).out.starts_with("THE FIGURES OF THIS RUN MEAN"));
  EXPECT_TRUE(reckon({"analyse", "soft.run", "--json"}).out.starts_with("{\n  \"valid\": false"));
  EXPECT_NE(reckon({"report", "soft.run"}).out.find("THE FIGURES OF THIS RUN MEAN NOTHING"),
            std::string::npos);
}

TEST_F(CliTest, WithoutTimedStepsNoDurationIsClaimed) {
  const Outcome text = reckon({"check", "scene.toml", "--timing", "0"});
  EXPECT_NE(text.out.find("not known: no steps were timed"), std::string::npos) << text.out;
  EXPECT_EQ(text.out.find("from 0 steps"), std::string::npos) << text.out;
  EXPECT_NE(
      reckon({"check", "scene.toml", "--timing", "0", "--json"}).out.find("\"duration_s\": null"),
      std::string::npos);
}

TEST_F(CliTest, HelpAndVersion) {
  const Outcome version = reckon({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.find("reckon "), 0U);
  EXPECT_EQ(version.err, "");
  EXPECT_EQ(reckon({"-v"}).out, version.out);
  EXPECT_EQ(reckon({"--help"}).code, 0);
}

/// What takes much is said.
TEST_F(CliTest, SizesOfSurfacesAreAnnounced) {
  ASSERT_EQ(reckon({"run", "scene.toml", "--steps", "2", "--threads", "1"}).code, 0);
  const Outcome surfaces = reckon({"surfaces", "scene.run"});
  EXPECT_EQ(surfaces.code, 0) << surfaces.err;
  EXPECT_NE(surfaces.err.find(" triangles: "), std::string::npos) << surfaces.err;
}

/// More threads than the system starts must not end the program.
TEST_F(CliTest, TheEnvironmentMayAskForAnyNumberOfThreads) {
  const Outcome outcome =
      outcome_of(start_line({"/usr/bin/env", "OMP_NUM_THREADS=100000", RECKON_PROGRAM, "check",
                             "scene.toml", "--timing", "0.1"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("on 1,024 threads"), std::string::npos) << outcome.out;
}

TEST_F(CliTest, BenchComparesWithThePlainAlgorithm) {
  const Outcome outcome = reckon({"bench", "paper-592", "--size", "small", "--json", "--quiet"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out.find("{"), 0U);
  for (const char* part : {"\"ratio\": ", "\"same_bits\": true", "\"pair_lists_made\": "}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << outcome.out;
  }
  EXPECT_EQ(reckon({"bench", "nothing"}).code, 1);
}

TEST_F(CliTest, ManualPageAndCompletionKnowEveryCommand) {
  const std::string manual = reckon({"reference", "man"}).out;
  for (const char* part : {".TH RECKON 1", ".SS reckon run SCENE", "\\-\\-resume",
                           ".SS reckon grains generate", ".SH EXIT STATUS"}) {
    EXPECT_NE(manual.find(part), std::string::npos) << part;
  }
  write("completion.sh", reckon({"reference", "bash"}).out);
  const auto completed = [&](const std::string& words, int at) {
    return outcome_of(start_line({"/bin/bash", "-c",
                                  "source ./completion.sh; COMP_WORDS=(" + words +
                                      "); COMP_CWORD=" + std::to_string(at) +
                                      "; _reckon; echo \"${COMPREPLY[@]}\""}))
        .out;
  };
  EXPECT_EQ(completed("reckon wa", 1), "watch\n");
  EXPECT_EQ(completed("reckon grains gen", 2), "generate\n");
  EXPECT_EQ(completed("reckon run scene.toml --res", 3), "--resume\n");
  EXPECT_EQ(completed("reckon report \"\"", 2), "\n");  // bash itself completes file names
}

/// HDF5 would crash at the end over a file that it could not close. A limit on the length of files
/// stands for the disk's.
TEST_F(CliTest, AFullDiskEndsEveryCommandInTheSameWay) {
  ASSERT_EQ(reckon({"run", "scene.toml", "--steps", "1"}).code, 0);
  const auto limited = [&](const std::string& command) {
    return outcome_of(
        start_line({"/bin/bash", "-c", "ulimit -f 20; exec " RECKON_PROGRAM " " + command}));
  };
  for (const char* command :
       {"grains scan scene.run --voxel 0.1mm --out scan", "run scene.toml --out other.run",
        "report scene.run", "grains generate -o many.h5 --count 3"}) {
    const Outcome outcome = limited(command);
    if (outcome.err.find("built without") != std::string::npos) continue;
    EXPECT_EQ(outcome.code, 2) << command << outcome.err;
    EXPECT_NE(outcome.err.find("ulimit -f"), std::string::npos) << command << outcome.err;
  }
}

TEST_F(CliTest, MessagesCannotSteerATerminal) {
  const Outcome outcome = reckon({"check", "bad\x1b[2J\xff.toml"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("bad\\x1b[2J\\xff.toml"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos) << outcome.err;
}

TEST_F(CliTest, AReportIsOneFileAndNamesWhatIsWrong) {
  ASSERT_EQ(reckon({"run", "scene.toml", "--steps", "100"}).code, 0);
  const Outcome made = reckon({"report", "scene.run", "--frames", "1"});
  if (made.err.find("built without") != std::string::npos) GTEST_SKIP() << made.err;
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("scene.run/report.html"), std::string::npos);
  EXPECT_EQ(read_file(root_ / "scene.run/report.html").find("<!doctype html>"), 0U);
  EXPECT_EQ(reckon({"report", "scene.run"}).code, 0);  // replaces its own
  const Outcome other = reckon({"report", "scene.run", "-o", "scene.toml"});
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.err.find("no report of reckon"), std::string::npos) << other.err;
  EXPECT_EQ(reckon({"run", "scene.toml", "--steps", "100", "--overwrite"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(root_ / "scene.run/report.html"));
  const Outcome none = reckon({"report", "nothing.run"});
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.err.find("not the folder of a run"), std::string::npos);
  EXPECT_EQ(reckon({"watch", "nothing.run"}).code, 1);
}

TEST_F(CliTest, MisuseIsOneClearBlock) {
  Outcome outcome = reckon({"rnu", "scene.toml"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err,
            "reckon: error: there is no command \"rnu\". Did you mean `reckon run`?\n");
  outcome = reckon({"run"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err.find("reckon: error: "), 0U);
  outcome = reckon({"run", "scene.toml", "--threads", "zero"});
  EXPECT_EQ(outcome.code, 1);
  outcome = reckon({"run", "nothing.toml"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err, "reckon: error: nothing.toml: cannot read the scene (no such file)\n");
}

TEST_F(CliTest, CheckListsAllFaultsWithTheirPlaces) {
  write("bad.toml",
        "contact.normal_stiffnes = 1e9\n[time]\nsteps = -3\n[[grains]]\n"
        "library = 'grains.h5'\n[[grains.place]]\nposition = [0, 0, 0]\n"
        "shape = 'cube'\n");
  const Outcome outcome = reckon({"check", "bad.toml"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  for (const char* part :
       {"reckon: error: bad.toml has 4 faults\n", "bad.toml:1:9: contact.normal_stiffnes: unknown",
        "Did you mean `normal_stiffness`?", "bad.toml:1:1: contact.normal_stiffness: is missing",
        "bad.toml:3:9: time.steps: -3 is out of range",
        "bad.toml:8:9: grains[0].place[0].shape: the library has no shape \"cube\""}) {
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " not in\n" << outcome.err;
  }
  const Outcome json = reckon({"check", "bad.toml", "--json"});
  EXPECT_EQ(json.code, 1);
  EXPECT_NE(json.out.find("\"valid\": false"), std::string::npos);
  EXPECT_NE(json.out.find("\"line\": 8"), std::string::npos);
}

TEST_F(CliTest, CheckSaysWhatTheRunWillDo) {
  const Outcome outcome = reckon({"check", "scene.toml", "--timing", "0.1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part :
       {"no faults", "grains", "24, with 2 of the library's 2 shapes", "time step", "sqrt(m / k)",
        "600", "memory", "25 history rows, 7 ParaView frames, 4 checkpoints", "in memory, "}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " not in\n" << outcome.out;
  }
  const Outcome json = reckon({"check", "scene.toml", "--timing", "0", "--json"});
  EXPECT_EQ(json.code, 0);
  EXPECT_NE(json.out.find("\"steps\": 600"), std::string::npos) << json.out;
  EXPECT_FALSE(std::filesystem::exists(root_ / "scene.run"));
}

TEST_F(CliTest, CheckWarnsOfWhatWillBlowUp) {
  const auto said_of = [&](const std::string& scene) {
    write("odd.toml", scene);
    const Outcome outcome = reckon({"check", "odd.toml", "--timing", "0"});
    return outcome.out + outcome.err;
  };
  const std::string usual_text = said_of(scene_text(usual));
  EXPECT_EQ(usual_text.find("DEEP"), std::string::npos) << usual_text;
  EXPECT_EQ(usual_text.find("TOO LONG"), std::string::npos) << usual_text;
  const std::string long_step = said_of(scene_text("[time]\nsteps = 600\nstep = '1 ms'\n"));
  EXPECT_NE(long_step.find("TOO LONG"), std::string::npos) << long_step;
  const Outcome run = reckon({"run", "odd.toml", "--steps", "1"});  // says so, too
  EXPECT_NE((run.out + run.err).find("TOO LONG"), std::string::npos) << run.out << run.err;
  std::string outside = scene_text(usual);
  outside.replace(outside.find("low = [0"), 8, "low = [-0.01");
  const std::string beyond = said_of(outside);
  EXPECT_NE(beyond.find("is beyond wall \"box.x-\""), std::string::npos) << beyond;
  outside.replace(outside.find("restitution"), 0, "allow_inside = true\n");
  const std::string allowed = said_of(outside);
  EXPECT_NE(allowed.find("DEEP"), std::string::npos) << allowed;
  EXPECT_NE(allowed.find("WARNING"), std::string::npos) << allowed;
}

TEST_F(CliTest, RunsAndRefusesToRunOverARun) {
  const Outcome outcome = reckon({"run", "scene.toml", "--steps", "12", "--threads", "2"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("complete at step 12"), std::string::npos) << outcome.out;
  EXPECT_TRUE(std::filesystem::exists(root_ / "scene.run" / "grains.pvd"));
  const Outcome again = reckon({"run", "scene.toml", "--steps", "12"});
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.err.find("--resume"), std::string::npos) << again.err;
  const Outcome quiet = reckon({"run", "scene.toml", "--steps", "12", "--overwrite", "--quiet"});
  EXPECT_EQ(quiet.code, 0) << quiet.err;
  EXPECT_EQ(quiet.out, "");
}

TEST_F(CliTest, SignalsWriteACheckpointFromWhichTheRunGoesOn) {
  write("long.toml", scene_text("[time]\nsteps = 4000\n[output]\nhistory_interval = 10\n"
                                "fields_interval = 1000\n"));
  ASSERT_EQ(reckon({"run", "long.toml", "--out", "whole"}).code, 0);
  for (const auto& [signal, code] : {std::pair{SIGTERM, 143}, std::pair{SIGINT, 130}}) {
    const std::string run = "parts" + std::to_string(code);
    testing::Process process = start({"run", "long.toml", "--out", run});
    wait_for_rows(run, 3);
    process.send(signal);
    EXPECT_EQ(process.wait(), code) << process.err();
    EXPECT_NE(process.err().find("checkpoint written"), std::string::npos) << process.err();
    EXPECT_EQ(RunFolder{root_ / run}.checkpoint_steps().size(), 1U);
    const Outcome resumed = reckon({"run", "long.toml", "--out", run, "--resume"});
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_NE(resumed.out.find("resumed from the checkpoint of step"), std::string::npos);
    expect_identical("whole", run);
    expect_equal_folders(root_ / "whole", root_ / run);
  }
}

TEST_F(CliTest, AKilledRunLeavesNoHalfFilesAndGoesOn) {
  write("long.toml", scene_text("[time]\nsteps = 1500\n[output]\nhistory_interval = 10\n"
                                "fields_interval = 50\ncheckpoint_interval = 50\n"));
  ASSERT_EQ(reckon({"run", "long.toml", "--out", "whole"}).code, 0);
  testing::Process process = start({"run", "long.toml", "--out", "parts"});
  wait_for_rows("parts", 20);
  process.send(SIGKILL);
  EXPECT_EQ(process.wait(), -SIGKILL);
  const Outcome resumed = reckon({"run", "long.toml", "--out", "parts", "--resume"});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  expect_identical("whole", "parts");
  expect_equal_folders(root_ / "whole", root_ / "parts");  // what was left half-written is gone
}

TEST_F(CliTest, DiffNamesTheFirstDifference) {
  ASSERT_EQ(reckon({"run", "scene.toml", "--out", "a", "--steps", "300"}).code, 0);
  std::string other = scene_text(usual);
  other.replace(other.find("damping = 2"), 11, "damping = 2.0000000000000004");
  write("other.toml", other);
  ASSERT_EQ(reckon({"run", "other.toml", "--out", "b", "--steps", "300"}).code, 0);
  const Outcome outcome = reckon({"diff", "a", "b"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out.find("the runs differ\n"), 0U);
  EXPECT_NE(outcome.out.find("checkpoint of step 150: first difference in /grain/"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find(" ulp)"), std::string::npos) << outcome.out;
  const Outcome json = reckon({"diff", "a", "b", "--json"});
  EXPECT_EQ(json.code, 1);
  EXPECT_NE(json.out.find("\"identical\": false"), std::string::npos);
  const Outcome missing = reckon({"diff", "a", "c"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(missing.err.find("reckon: error: c: "), 0U) << missing.err;
}

TEST_F(CliTest, SurfacesOnDemand) {
  ASSERT_EQ(reckon({"run", "scene.toml", "--out", "a", "--steps", "160"}).code, 0);
  const Outcome outcome = reckon({"surfaces", "a"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(RunFolder{root_ / "a"}.field_steps("surfaces"), (std::vector<std::uint64_t>{150, 160}));
  EXPECT_TRUE(std::filesystem::exists(root_ / "a" / "surfaces.pvd"));
  EXPECT_EQ(reckon({"surfaces", "a", "--step", "7"}).code, 1);
  std::filesystem::create_directory(root_ / "no_run");
  const Outcome no_run = reckon({"surfaces", "no_run", "--step", "7"});
  EXPECT_NE(no_run.err.find("Name the folder of a run"), std::string::npos) << no_run.err;
}

TEST_F(CliTest, AStateForParaViewCountsFromTheStartOfTheLastStage) {
  ASSERT_EQ(reckon({"run", "scene.toml", "--out", "a", "--steps", "100"}).code, 0);
  const Outcome outcome = reckon({"paraview", "a"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("paraview --script=a/paraview/state.py"), std::string::npos);
  const std::string state = read_file(root_ / "a/paraview/state.py");
  EXPECT_NE(state.find("\ncounted_from = 0  # [s]"), std::string::npos) << state;
  EXPECT_NE(state.find("os.fsdecode(b\"" + (root_ / "a").string() + "\")\n"), std::string::npos)
      << state;
  EXPECT_EQ(state.find("@"), std::string::npos);
  for (const char* file : {"shapes.vtm", "shapes/00000.vtp", "shapes/00001.vtp"}) {
    EXPECT_TRUE(std::filesystem::exists(root_ / "a/paraview" / file)) << file;
  }
  write("staged.toml", staged());
  ASSERT_EQ(reckon({"run", "staged.toml", "--out", "a", "--overwrite"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(root_ / "a/paraview"));
  ASSERT_EQ(reckon({"paraview", "a"}).code, 0);
  const std::string later = read_file(root_ / "a/paraview/state.py");
  EXPECT_EQ(later.find("\ncounted_from = 0  # [s]"), std::string::npos);
  EXPECT_NE(later.find(", at which the last stage began"), std::string::npos);
  EXPECT_EQ(reckon({"paraview", "nothing.run"}).code, 1);
}

/// Whether a text is one JSON object with all its brackets closed, judged by its brackets and
/// strings.
bool looks_like_json(const std::string& text) {
  std::string open;
  bool in_string = false;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const char c = text[n];
    if (in_string) {
      if (c == '\\') ++n;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      open += c == '{' ? '}' : ']';
    } else if (c == '}' || c == ']') {
      if (open.empty() || open.back() != c) return false;
      open.pop_back();
      if (open.empty()) return text.substr(n + 1) == "\n";
    }
  }
  return false;
}

TEST_F(CliTest, EveryCommandKeepsTheSameManners) {
  ASSERT_EQ(reckon({"run", "scene.toml", "--out", "a", "--steps", "100", "--quiet"}).out, "");
  ASSERT_EQ(reckon({"grains", "scan", "a", "--voxel", "0.1mm", "--out", "scan"}).code, 0);
  write("placed.toml",
        "title = 'placed'\ntime = { steps = 1 }\n[contact]\nnormal_stiffness = '1e9 N/m^3'\n"
        "[[grains]]\nlibrary = 'scan/library.h5'\ntable = { file = 'scan/placement.csv' }\n");
  ASSERT_EQ(reckon({"run", "placed.toml", "--out", "placed"}).code, 0);
  struct Row {
    std::vector<std::string> arguments;
    bool answers_in_json{false};
  };
  const std::vector<Row> commands{
      {{"check", "scene.toml"}, true},
      {{"run", "scene.toml", "--overwrite", "--steps", "100"}, true},
      {{"diff", "a", "a"}, true},
      {{"report", "a", "--frames", "0"}},
      {{"surfaces", "a"}},
      {{"paraview", "a"}},
      {{"analyse", "a"}, true},
      {{"reference", "man"}},
      {{"grains", "generate", "--count", "2", "--d50", "1mm", "-o", "two.h5"}},
      {{"grains", "solid", "--sphere", "1mm", "-o", "solid.h5"}},
      {{"grains", "info", "grains.h5"}, true},
      {{"grains", "statistics", "grains.h5"}, true},
      {{"grains", "spheres", "grains.h5", "-o", "spheres.h5"}},
      {{"grains", "export", "grains.h5", "--out", "look"}},
      {{"grains", "to-legacy", "grains.h5", "morphologies"}},
      {{"grains", "from-legacy", "morphologies", "-o", "legacy.h5"}},
      {{"grains", "scan", "a", "--voxel", "0.1mm", "--out", "scan"}, true},
      {{"grains", "moved", "scan/placement.csv", "placed"}, true},
  };
  for (const auto& [arguments, answers_in_json] : commands) {
    SCOPED_TRACE(arguments[0] + " " + arguments[1]);
    Outcome plain = reckon(arguments);
    if (plain.err.find("built without") != std::string::npos) continue;
    EXPECT_EQ(plain.code, 0) << plain.err;
    // No terminal here: nothing is coloured or drawn over.
    EXPECT_EQ((plain.out + plain.err).find_first_of("\033\r"), std::string::npos);

    std::vector<std::string> with_json = arguments;
    with_json.emplace_back("--json");
    const Outcome json = reckon(with_json);
    if (answers_in_json) {
      EXPECT_EQ(json.code, 0) << json.err;
      EXPECT_TRUE(looks_like_json(json.out)) << json.out;
    } else {
      EXPECT_EQ(json.code, 1);
    }

    std::vector<std::string> path{arguments[0]};
    if (arguments[0] == "grains") path.push_back(arguments[1]);
    path.emplace_back("--help");
    const Outcome help = reckon(path);
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_NE(help.out.find("Example"), std::string::npos) << help.out;
    EXPECT_EQ(help.out.find("--json") != std::string::npos, answers_in_json);

    path.back() = "--no-such-option";
    const Outcome wrong = reckon(path);
    EXPECT_EQ(wrong.code, 1);
    EXPECT_EQ(wrong.out, "");
    EXPECT_EQ(wrong.err.find("reckon: error: "), 0U) << wrong.err;
    EXPECT_NE(wrong.err.find("--help"), std::string::npos) << wrong.err;
  }
}

/// The table in docs/reference/command-line.md names every command, and those with --json.
TEST_F(CliTest, TheTableOfCommandsIsTrue) {
  const std::string page = reckon({"reference", "commands"}).out;
  std::istringstream table{read_file(RECKON_SOURCE_DIR "/docs/reference/command-line.md")};
  std::size_t rows = 0;
  for (std::string line; std::getline(table, line);) {
    if (line.find("| `reckon ") != 0) continue;
    ++rows;
    std::vector<std::string> cells;
    std::istringstream row{line.substr(2)};
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    const std::string command = cells[0].substr(1, cells[0].find('`', 1) - 1);
    const std::size_t section = page.find("\n## " + command + "\n");
    ASSERT_NE(section, std::string::npos) << command;
    const std::string described = page.substr(section, page.find("\n## ", section + 1) - section);
    EXPECT_NE(described.find("Example"), std::string::npos) << command;
    EXPECT_EQ(described.find("`--json`") != std::string::npos, cells[2] == " yes ") << command;
  }
  std::size_t commands = 0;
  for (std::size_t at = 0; (at = page.find("\n## reckon ", at)) != std::string::npos; ++at)
    ++commands;
  EXPECT_EQ(rows, commands - 1);  // `reckon grains` is the name of a group
}

TEST_F(CliTest, ARunAnswersInJsonWithWhatItsStagesHaveShown) {
  write("staged.toml", staged());
  const Outcome outcome = reckon({"run", "staged.toml", "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_TRUE(looks_like_json(outcome.out)) << outcome.out;
  for (const char* key : {"\"status\": \"complete\"", "\"driven_stages\": [",
                          "\"peak_friction_angle_deg\": ", "\"inertial_number\": "}) {
    EXPECT_NE(outcome.out.find(key), std::string::npos) << key << outcome.out;
  }
  const Outcome again = reckon({"run", "staged.toml", "--resume", "--json"});
  EXPECT_NE(again.out.find("\"nothing_to_do\": true"), std::string::npos) << again.out;
}

TEST_F(CliTest, ReferencePagesArePrinted) {
  EXPECT_EQ(reckon({"reference", "scene"}).out,
            read_file(RECKON_SOURCE_DIR "/docs/reference/scene.md"));
  EXPECT_EQ(reckon({"reference", "history"}).out,
            read_file(RECKON_SOURCE_DIR "/docs/reference/history.md"));
  EXPECT_EQ(reckon({"reference", "commands"}).out,
            read_file(RECKON_SOURCE_DIR "/docs/reference/commands.md"));
}

}  // namespace
}  // namespace reckon
