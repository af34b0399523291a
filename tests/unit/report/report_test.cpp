// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numbers>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/output/checkpoint.hpp"
#include "reckon/report/page.hpp"
#include "reckon/report/piece.hpp"
#include "reckon/report/watch_version.hpp"
#include "reckon/results/saved_fields.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

/// The text of a piece and the bytes of its arrays.
std::pair<std::string, std::string> opened(const std::string& piece) {
  std::string plain(50'000'000, '\0');
  uLongf size = plain.size();
  EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(plain.data()), &size,
                         reinterpret_cast<const Bytef*>(piece.data()), piece.size()),
            Z_OK);
  plain.resize(size);
  std::uint32_t length = 0;
  std::memcpy(&length, plain.data(), sizeof length);
  return {plain.substr(sizeof length, length), plain.substr(sizeof length + length)};
}

TEST(Piece, HoldsTextAndArraysAtTheirOffsets) {
  Piece piece;
  piece.json().value("step", 12);
  const std::vector<std::uint8_t> small{7, 8, 9};
  const std::vector<double> wide{0.1, -2};
  piece.add("small", small);
  piece.add("wide", wide, 2);
  const auto [text, bytes] = opened(piece.finish());
  EXPECT_EQ((text.size() + 4) % 8, 0U);
  EXPECT_NE(text.find("\"step\": 12"), std::string::npos);
  EXPECT_NE(text.find("\"type\": \"Float64\""), std::string::npos);
  EXPECT_NE(text.find("\"offset\": 8"), std::string::npos);
  ASSERT_EQ(bytes.size(), 8U + 16U);
  EXPECT_EQ(bytes.substr(0, 3), "\x07\x08\x09");
  double second = 0;
  std::memcpy(&second, bytes.data() + 16, sizeof second);
  EXPECT_EQ(second, -2);
}

TEST(Base64, AgreesWithTheStandardsExamples) {  // RFC 4648, section 10
  const std::map<std::string, std::string> examples{{"", ""},
                                                    {"f", "Zg=="},
                                                    {"fo", "Zm8="},
                                                    {"foo", "Zm9v"},
                                                    {"foob", "Zm9vYg=="},
                                                    {"fooba", "Zm9vYmE="},
                                                    {"foobar", "Zm9vYmFy"},
                                                    {"\xff\xfe\xfd", "//79"}};
  for (const auto& [plain, coded] : examples) EXPECT_EQ(base64(plain), coded);
}

double volume_of(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    six += dot(mesh.vertices[a], cross(mesh.vertices[b], mesh.vertices[c]));
  }
  return six / 6;
}

TEST(DisplayMesh, CoarseSurfacesAreClosedAndLieOnTheGrain) {
  const Shape ball = testing::sphere(0.001, 100, 40);
  for (const std::size_t wanted : {48U, 300U, 1500U}) {
    const DisplayMesh display = display_mesh(ball.level_set, wanted);
    const std::size_t made = display.mesh.triangles.size();
    EXPECT_GT(made, wanted / 3);
    EXPECT_LT(made, 2 * wanted + 40);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& triangle : display.mesh.triangles) {
      for (std::size_t n = 0; n < 3; ++n) ++edges[{triangle[n], triangle[(n + 1) % 3]}];
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(edges.contains({edge.second, edge.first}));
    }
    for (std::size_t n = 0; n < display.mesh.vertices.size(); ++n) {
      const Vec3& vertex = display.mesh.vertices[n];
      EXPECT_NEAR(norm(vertex), 0.001, 0.001 * 0.01);
      EXPECT_GT(dot(display.normals_unit[n], normalized(vertex)), 0.85);
    }
    const double sphere = 4.0 / 3 * std::numbers::pi * 1e-9;
    EXPECT_GT(volume_of(display.mesh), 0.6 * sphere);
    EXPECT_LT(volume_of(display.mesh), 1.001 * sphere);
  }
}

TEST(DisplayMesh, AsksNoMoreThanTheGridGives) {
  const Shape ball = testing::sphere(0.001, 100, 8);
  const std::size_t native = display_mesh(ball.level_set, 1'000'000).mesh.triangles.size();
  EXPECT_EQ(display_mesh(ball.level_set, native).mesh.triangles.size(), native);
}

TEST(SpreadSteps, KeepsTheEndsAndSpreadsTheRest) {
  const std::vector<std::uint64_t> steps{0, 10, 20, 30, 40, 50, 60};
  EXPECT_EQ(spread_steps(steps, 4), (std::vector<std::uint64_t>{0, 20, 40, 60}));
  EXPECT_EQ(spread_steps(steps, 9), steps);
  EXPECT_EQ(spread_steps(steps, 1), (std::vector<std::uint64_t>{60}));
  EXPECT_TRUE(spread_steps(steps, 0).empty());
}

class ReportTest : public testing::RunSceneTest {
 protected:
  [[nodiscard]] RunFolder folder() const { return RunFolder{root_ / "a"}; }
};

TEST_F(ReportTest, SavedFieldsAreTheStateOfTheirStep) {
  run(scene_text(usual), {.folder = root_ / "a"});
  const SavedFields fields = read_fields(folder(), 600);
  const Checkpoint checkpoint = read_checkpoint(folder().checkpoint(600));
  EXPECT_EQ(fields.step, 600U);
  EXPECT_EQ(fields.time, 600 * checkpoint.time_step);
  ASSERT_EQ(fields.grains.size(), checkpoint.state.grains.size());
  for (std::size_t n = 0; n < fields.grains.size(); ++n) {
    const SavedGrain& saved = fields.grains[n];
    const GrainState& state = checkpoint.state.grains[n];
    EXPECT_EQ(saved.id, state.id);
    EXPECT_EQ(saved.shape, state.shape);
    EXPECT_EQ(saved.position, state.position);
    EXPECT_EQ(saved.orientation, state.orientation);
    EXPECT_EQ(saved.velocity, state.velocity);
    EXPECT_GT(saved.mass, 0);
  }
  ASSERT_TRUE(fields.has_contacts);
  std::vector<std::uint32_t> touching(fields.grains.size());
  for (const ContactRecord& contact : fields.contacts) {
    ++touching[contact.grain.get()];
    if (!contact.with_wall) ++touching[contact.partner];
  }
  for (std::size_t n = 0; n < touching.size(); ++n)
    EXPECT_EQ(touching[n], fields.grains[n].touching);
  ASSERT_EQ(fields.wall_displacement.size(), 6U);
  EXPECT_EQ(fields.wall_displacement[0], Vec3{});
  EXPECT_NEAR(fields.wall_displacement[5].z, -0.4 * fields.time, 1e-12);  // the plate
  EXPECT_THROW((void)read_fields(folder(), 601), Error);
}

TEST_F(ReportTest, DamagedFieldsAreRefused) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 100});
  const std::filesystem::path file = folder().root() / RunFolder::field_name("grains", 100);
  const std::string good = read_file(file);
  for (const std::size_t length : {good.size() / 2, good.size() - 60, std::size_t{100}}) {
    write_file(file, good.substr(0, length));
    EXPECT_THROW((void)read_fields(folder(), 100), Error) << length;
  }
  std::string bad = good;
  bad.replace(bad.find("\"UInt32\""), 8, "\"Float9\"");
  write_file(file, bad);
  EXPECT_THROW((void)read_fields(folder(), 100), Error);
}

TEST_F(ReportTest, ThePiecesOfARunTellItsStory) {
  run(staged(), {.folder = root_ / "a"});
  RunPieces pieces{folder(), {}};
  const auto [head, arrays] = opened(pieces.head());
  for (const char* part : {"\"title\": \"Squeezed grains\"", "\"press\"", "\"void_ratio\"",
                           "volume that is not solid over volume that is", "\"box.x-\"",
                           "\"fine_position\"", "\"sphericity\"", "friction angle"}) {
    EXPECT_NE(head.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(head.find("\"triangles\": 0"), std::string::npos) << "a shape without surface";
  EXPECT_EQ(head.find("\"meaning\": \"\""), std::string::npos) << "a column without a meaning";
  // These grains are too soft for their stress.
  EXPECT_NE(head.find("\"verdict\": \"THE FIGURES OF THIS RUN MEAN NOTHING:"), std::string::npos);
  EXPECT_GE(pieces.frame_steps().size(), 4U);
  const auto [frame, numbers] = opened(pieces.frame(0));
  EXPECT_NE(frame.find("\"orientation\""), std::string::npos);
  EXPECT_GT(numbers.size(), 24U * 60U);
  EXPECT_EQ((RunPieces{folder(), {.frames = 2}}.frame_steps().size()), 2U);
}

TEST_F(ReportTest, WithoutTheLibraryTheRunIsShownWithoutSurfaces) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 100});
  std::filesystem::remove(root_ / "grains.h5");
  const std::string head = opened(RunPieces{folder(), {}}.head()).first;
  EXPECT_EQ(head.find("\"shapes_missing\": \"\""), std::string::npos);
  EXPECT_NE(head.find("grains.h5"), std::string::npos);
}

TEST_F(ReportTest, AFolderWithoutARunIsRefused) {
  std::filesystem::create_directories(folder().root());
  try {
    (void)RunPieces{folder(), {}}.head();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string{error.what()}.find("not the folder of a run"), std::string::npos);
  }
}

TEST_F(ReportTest, ThePageHoldsEveryPiece) {
  if (viewer_page().empty()) GTEST_SKIP() << "built without the page: no Node.js, or no network";
  run(scene_text(usual), {.folder = root_ / "a", .steps = 200});
  const std::vector<RunFolder> runs{folder(), folder()};
  const std::string page = report_page(runs, {});
  for (const char* name : {"0/head", "0/frame/0", "0/frame/200", "1/head", "1/frame/100"}) {
    EXPECT_NE(page.find("data-piece=\"" + std::string{name} + '"'), std::string::npos) << name;
  }
  EXPECT_EQ(page.find("<!--DATA-->"), std::string::npos);
  EXPECT_NE(live_page().find("reckon-live"), std::string::npos);
}

TEST_F(ReportTest, TheVersionChangesWithTheRunAlone) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 100});
  const std::string before = version_of(folder());
  EXPECT_EQ(version_of(folder()), before);
  write_file(folder().report(), "a page");
  EXPECT_EQ(version_of(folder()), before);
  run(scene_text(usual), {.folder = root_ / "a", .resume = true, .steps = 200});
  EXPECT_NE(version_of(folder()), before);
}

}  // namespace
}  // namespace reckon
