// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "reckon/core/file.hpp"
#include "reckon/io/placement_table.hpp"
#include "reckon/scan/volume_file.hpp"
#include "reckon/scan/volume_formats.hpp"
#include "scratch.hpp"
#include "support/packed_files.hpp"
#include "targets.hpp"

namespace reckon::fuzz {
namespace {

GrayVolume small_volume() {
  GrayVolume volume{{5, 4, 3}, 2e-6};
  for (std::size_t v = 0; v < volume.values.size(); ++v) volume.values[v] = static_cast<float>(v);
  return volume;
}

void write_packed(const std::string& ending, const std::filesystem::path& file) {
  const GrayVolume volume = small_volume();
  const VolumeOutline what{volume.dims, VoxelType::uint16, volume.voxel};
  const std::string numbers = encode_numbers(volume.values, what.type);
  if (ending == "mha") {
    write_file(file, testing::packed_metaimage(metaimage_header(what), numbers));
  } else if (ending == "nrrd") {
    write_file(file, testing::packed_nrrd(nrrd_header(what), numbers));
  } else {
    testing::write_tiff(file, numbers, 5, 4, {.bits = 16});
  }
}

Target image_target(const std::string& ending) {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "volume_" + ending,
          .valid_inputs =
              [folder, ending] {
                std::vector<std::string> inputs;
                for (const VoxelType type : {VoxelType::uint8, VoxelType::float32}) {
                  const auto file = folder->path() / ("valid." + ending);
                  write_volume(file, small_volume(), type);
                  inputs.push_back(read_file(file));
                }
                write_packed(ending, folder->path() / "packed");
                inputs.push_back(read_file(folder->path() / "packed"));
                return inputs;
              },
          .read =
              [folder, ending](const std::string& input) {
                (void)read_volume({folder->write("volume." + ending, input), 2e-6, {}});
              },
          .cost = 10};
}

}  // namespace

Target volume_npy_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "volume_npy",
          .valid_inputs =
              [folder] {
                const auto file = folder->path() / "valid.npy";
                write_volume(file, small_volume(), VoxelType::uint16);
                return std::vector<std::string>{read_file(file)};
              },
          .read =
              [folder](const std::string& input) {
                (void)read_volume({folder->write("volume.npy", input), 2e-6, {}});
              },
          .cost = 4};
}

Target volume_raw_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "volume_raw",
          .valid_inputs =
              [] {
                return std::vector<std::string>{"dims 5 4 3\ntype uint8\norder little\n",
                                                "# a scan\ndims 3 5 1\ntype float32\norder big\n"};
              },
          .read =
              [folder](const std::string& input) {
                (void)folder->write("volume.raw.txt", input);
                (void)read_volume({folder->write("volume.raw", std::string(60, '\x3c')), 2e-6, {}});
              },
          .cost = 4};
}

std::vector<Target> image_targets() {
  return {image_target("mha"), image_target("nrrd"), image_target("tif")};
}

Target placement_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "placement",
          .valid_inputs =
              [] {
                return std::vector<std::string>{
                    "# shape,x_m,y_m,z_m,qw,qx,qy,qz\n0,1,2,3,1,0,0,0\n4,0,-1e-3,2,0.6,0,-0.8,0\n"};
              },
          .read =
              [folder](const std::string& input) {
                (void)read_placement(folder->write("placement.csv", input), 5);
              },
          .cost = 4};
}

}  // namespace reckon::fuzz
