// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every file of the project is written once for each call of the system that can fail, and this
// call fails. Either the writer says so, and what stands under the file's name is what stood there
// before, or it is the whole new content.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "faults/failing_calls.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/core/write_failure.hpp"
#include "reckon/output/checkpoint.hpp"
#include "reckon/results/run_record.hpp"
#include "reckon/scan/volume_file.hpp"
#include "support/test_path.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

using testing::FailingCall;
using File = std::filesystem::path;

/// A kind of file and how it is written.
struct Kind {
  const char* name;
  std::function<void(const File&)> write;
};

Checkpoint small_checkpoint() {
  Checkpoint checkpoint;
  checkpoint.state.step = 7;
  checkpoint.time_step = 1e-6;
  checkpoint.scene = "title = \"a scene\"\n";
  checkpoint.shape_digests = {1, 2};
  for (std::uint32_t id = 0; id < 5; ++id) {
    GrainState grain;
    grain.id = GrainId{id};
    grain.shape = ShapeId{id % 2};
    grain.position = {1.0 + id, 2, 3};
    checkpoint.state.grains.push_back(grain);
  }
  checkpoint.state.stage_starts = {0};
  checkpoint.state.pair_springs = {{GrainId{0}, GrainId{1}, {NodeSpring{3, false, {}, {}, 0.5}}}};
  return checkpoint;
}

void write_points(const File& file) {
  const std::vector<Vec3> places{{1, 2, 3}, {4, 5, 6}};
  VtkPolyData data;
  data.points = vtk_array("Points", places);
  data.vertices = consecutive_cells(places.size(), 1);
  write_vtp(file, data);
}

constexpr std::size_t volume_voxels = 60;

void write_gray(const File& file) {
  GrayVolume volume{Box{{0, 0, 0}, {5, 4, 3}}, 1e-5};
  for (std::size_t v = 0; v < volume.values.size(); ++v) {
    volume.values[v] = static_cast<float>(v + 1);
  }
  write_volume(file, volume, VoxelType::uint16);
}

void save_shapes(const File& file, ShapeStorage storage) {
  ShapeLibrary library{testing::sphere(0.001, 40, 8), testing::sphere(0.002, 30, 8)};
  library[1].name = "other";
  LibraryWriter writer{file, storage};
  for (Shape& shape : library) {
    if (storage == ShapeStorage::band) round_to_band(shape);
    writer.add(shape);
  }
  writer.finish();
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"table.csv", [](const File& file) { write_file(file, "a,b\n1,2\n"); }},
      {"grains.vtp", write_points},
      {"run.json", [](const File& file) { write_file(file, std::string(300000, ' ')); }},
      {"checkpoint.h5", [](const File& file) { write_checkpoint(file, small_checkpoint()); }},
      {"library.h5", [](const File& file) { save_shapes(file, ShapeStorage::full); }},
      {"bands.h5", [](const File& file) { save_shapes(file, ShapeStorage::band); }},
      {"volume.h5", write_gray},
      {"volume.tif", write_gray},
      {"volume.npy", write_gray},
      {"volume.mha", write_gray},
      {"volume.raw", write_gray}};
  return all;
}

enum class End : int { written = 0, refused = 1, disk_refused = 2, other = 3 };
struct Attempt {
  End end;
  bool failed;  ///< whether a call has failed
};

/// In a separate process: a library may be unusable after a failure.
Attempt attempt(const Kind& kind, const File& file, const FailingCall& failing) {
  constexpr int failed_flag = 64;
  const pid_t child = ::fork();
  if (child == 0) {
    End end = End::written;
    testing::set_failing_call(failing);
    try {
      kind.write(file);
    } catch (const MachineFailure&) {
      end = End::disk_refused;
    } catch (const Error&) {
      end = End::refused;
    } catch (...) {
      end = End::other;
    }
    ::_exit(static_cast<int>(end) + (testing::call_has_failed() ? failed_flag : 0));
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!WIFEXITED(status)) return {End::other, true};
  const int code = WEXITSTATUS(status);
  return {static_cast<End>(code % failed_flag), code >= failed_flag};
}

class WrittenFile : public ::testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    folder_ = File{::testing::TempDir()} / testing::test_path().filename();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    file_ = folder_ / GetParam().name;
    GetParam().write(file_);
    good_ = read_file(file_);
  }
  void TearDown() override {
    if (!HasFailure()) std::filesystem::remove_all(folder_);
  }

  /// Returns how many calls there were to fail.
  std::uint64_t fail_each(FailingCall failing) {
    // A library replaces only another library, which begins with the same seal.
    std::string old = "what was there before";
    if (file_.extension() == ".h5") old = good_.substr(0, 512) + old;
    for (failing.number = 1; failing.number < 5000; ++failing.number) {
      write_file(file_, old);
      const Attempt made = attempt(GetParam(), file_, failing);
      const std::string found = read_file(file_);
      const bool good = found == good_ || (found != old && holds_volume());
      const std::string what = std::string{failing.call} + " " + std::to_string(failing.number) +
                               (failing.lasting ? ", and all later ones" : "");
      EXPECT_NE(made.end, End::other) << what;
      if (made.end == End::written) {
        EXPECT_TRUE(good) << what << " failed, and the file is said to be written";
      } else {
        EXPECT_TRUE(found == old || good) << what << " left half a file";
      }
      if (made.end != End::written && std::string_view{failing.call} == "write") {
        EXPECT_EQ(made.end, End::disk_refused) << what;
      }
      if (!made.failed) return failing.number - 1;
      if (HasFailure()) break;
    }
    ADD_FAILURE() << "there is no end to " << failing.call;
    return failing.number;
  }

  /// libtiff's files differ in bytes that mean nothing, so their numbers are compared.
  [[nodiscard]] bool holds_volume() const {
    if (file_.extension() != ".tif") return false;
    try {
      const std::vector<float> values = read_volume({file_, 1e-5, {}}).gray.values;
      for (std::size_t v = 0; v < values.size(); ++v) {
        if (values[v] != static_cast<float>(v + 1)) return false;
      }
      return values.size() == volume_voxels;
    } catch (const Error&) {
      return false;
    }
  }

  File folder_;
  File file_;
  std::string good_;
};

TEST_P(WrittenFile, IsWholeOrNotThereWhateverCallFails) {
  for (const char* call :
       {"write", "read", "lseek", "ftruncate", "fsync", "close", "rename", "open"}) {
    const std::uint64_t calls = fail_each({.call = call, .file = folder_.c_str()});
    EXPECT_TRUE(calls > 0 || std::string_view{call} != "write");
  }
}

TEST_P(WrittenFile, IsWholeOrNotThereOnADiskThatStaysFull) {
  fail_each({.call = "write", .file = folder_.c_str(), .lasting = true});
}

TEST_P(WrittenFile, IsWholeWhereTheSystemWritesAPartOnly) {
  fail_each({.call = "write", .file = folder_.c_str(), .half = true});
}

INSTANTIATE_TEST_SUITE_P(EveryKind, WrittenFile, ::testing::ValuesIn(kinds()),
                         [](const auto& kind) {
                           std::string name = kind.param.name;
                           name[name.find('.')] = '_';
                           return name;
                         });

}  // namespace
}  // namespace reckon
