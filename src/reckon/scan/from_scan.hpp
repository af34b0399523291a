// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "reckon/scan/labels.hpp"
#include "reckon/scan/scan_avatars.hpp"
#include "reckon/scan/segmentation.hpp"
#include "reckon/scan/specimen.hpp"
#include "reckon/scan/volume_file.hpp"

namespace reckon {

/// The stages from a volume to labelled grains, in order.
enum class ScanStage : std::uint8_t { read, specimen, denoise, threshold, split, choose };

struct SegmentSettings {
  VolumeRequest volume;
  std::uint64_t memory{0};     ///< Workspace::memory
  std::int32_t overlap{0};     ///< Workspace::overlap
  bool labelled{false};        ///< the volume holds labels already
  std::filesystem::path gray;  ///< with `labelled`: the gray volume of these labels, if there is
  SpecimenSettings specimen;
  DenoiseSettings denoise;
  MaskSettings mask;
  SplitSettings split;
  bool keep_border{false};
  std::uint64_t fewest_voxels{500};  ///< of a grain: a ball of ten voxels diameter has 524
};

/// Everything that the avatars are made of, and what became of the rest.
struct Segmentation {
  Workspace work;
  GrayOnDisk raw;     ///< as scanned, where nothing had to be cleaned
  MaskOnDisk outer;   ///< Specimen::outer
  MaskOnDisk inside;  ///< Specimen::inside
  GrayOnDisk denoised;
  MaskOnDisk mask;
  LabelsOnDisk labels;
  GrayLevels levels;
  double solid_share{0};       ///< of the volume
  std::vector<double> phases;  ///< grays of solid, if there are several
  std::uint32_t joined{0};     ///< pieces that were put together again
  std::vector<Waist> waists;
  BlockFigures blocks;
  std::vector<LabelledGrain> grains;
  GrainChoice choice;
  std::vector<ScanStage> resumed;    ///< stages whose results were found, not computed
  std::vector<std::string> remarks;  ///< what was assumed, and what is doubtful
};

/// Runs the stages up to `last`, within the memory that the settings allow. Each leaves its volume
/// in `folder`, a sealed file that also records its source and its settings, and is read instead of
/// computed when both are still the same. `on_stage` is called before each, and `on_remark` with
/// each of Segmentation::remarks as soon as it is known. Throws Error; files appear only when
/// complete.
[[nodiscard]] Segmentation segment_scan(const SegmentSettings& settings,
                                        const std::filesystem::path& folder, ScanStage last,
                                        const std::function<void(ScanStage)>& on_stage,
                                        const std::function<void(const std::string&)>& on_remark);

[[nodiscard]] const char* name_of(ScanStage stage);

/// Pictures of slice `k` across z: the gray values; with the surface of the mask; with the grains
/// in colours. Stages that are not done yet get no picture.
void write_slices(const Segmentation& scan, std::int32_t k, const std::filesystem::path& folder);

/// A picture of a place across z, enlarged: the grains in colours, with a cross at the voxel.
void write_place(const Segmentation& scan, const VoxelDims& voxel,
                 const std::filesystem::path& file);

}  // namespace reckon
