// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "reckon/core/file.hpp"
#include "reckon/scan/volume_file.hpp"
#include "reckon/scan/volume_formats.hpp"
#include "reckon/scene/placement_table.hpp"
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
  const VolumeOutline what{volume.dims, VoxelType::uint16, {volume.voxel, 1.0, {}}, {}};
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

/// Headers beside their data, or with fields that say how the data lie.
Target layout_target(const std::string& ending, std::vector<std::string> inputs) {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "volume_layout_" + ending,
          .valid_inputs = [inputs = std::move(inputs)] { return inputs; },
          .read =
              [folder, ending](const std::string& input) {
                (void)folder->write("0.raw", std::string(30, '\x3c'));
                (void)folder->write("1.raw", std::string(30, '\x3d'));
                (void)read_volume({folder->write("layout." + ending, input), 2e-6, {}});
              },
          .cost = 10};
}

std::vector<Target> layout_targets() {
  const std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 4 2\nencoding: raw\n";
  const std::string meta = "NDims = 3\nDimSize = 3 4 2\nElementType = MET_UCHAR\n";
  return {
      layout_target("nhdr",
                    {nrrd + "byte skip: 6\nline skip: 0\ndata file: 0.raw\n",
                     nrrd + "space directions: (2,0,0) (0,-2,0) (0,0,2)\nspace units: \"um\" "
                            "\"um\" \"um\"\nbyte skip: -1\ndata file: 0.raw\n",
                     "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 1 5 6 2\nencoding: raw\n"
                     "axis mins: 0 0 0 0\naxis maxs: 1 10 12 4\ndata file: LIST\n0.raw\n1.raw\n",
                     "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 5 6 2\nencoding: raw\n"
                     "data file: %01d.raw 0 1 1\n"}),
      layout_target("mhd", {meta + "HeaderSize = 6\nElementSpacing = 2 2 2\nDistanceUnits = um\n"
                                   "ElementDataFile = 0.raw\n",
                            meta + "TransformMatrix = 1 0 0 0 1 0 0 0 -1\nHeaderSize = -1\n"
                                   "Modality = MET_MOD_CT\nElementDataFile = 0.raw\n",
                            "NDims = 3\nDimSize = 5 6 2\nElementType = MET_UCHAR\n"
                            "ElementDataFile = LIST\n0.raw\n1.raw\n",
                            "NDims = 3\nDimSize = 5 6 2\nElementType = MET_UCHAR\n"
                            "ElementDataFile = %d.raw 0 1 1\n"}),
      layout_target("tif", {testing::imagej_stack(std::string(24, '\x21'), 3, 4,
                                                  "ImageJ=1\nimages=2\nslices=2\nunit=um\n"
                                                  "spacing=2\n",
                                                  2, true)})};
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
  std::vector<Target> targets{image_target("mha"), image_target("nrrd"), image_target("tif")};
  for (Target& target : layout_targets()) targets.push_back(std::move(target));
  return targets;
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
