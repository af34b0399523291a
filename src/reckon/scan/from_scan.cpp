// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/from_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/xxhash64.hpp"
#include "reckon/scan/image_filters.hpp"

namespace reckon {
namespace {

const Hdf5Kind stage_kind{"scan stage", 1};

/// What a stage's result depends on: the input's values and all settings up to it.
using Key = std::uint64_t;

Key key_after(Key before, const std::string& settings) {
  XxHash64 hash;
  hash.update(std::as_bytes(std::span{&before, 1}));
  hash.update(std::as_bytes(std::span{settings}));
  return hash.digest();
}

Key key_of(const GrayVolume& volume) {
  XxHash64 hash;
  hash.update(std::as_bytes(std::span{volume.dims}));
  hash.update(std::as_bytes(std::span{volume.values}));
  return hash.digest();
}

/// A stage's file: a volume, a few numbers, and the key.
template <class Value>
void store(const std::filesystem::path& file, Key key, const Volume<Value>& volume,
           const std::vector<double>& numbers) {
  Hdf5Writer writer{file, stage_kind};
  writer.write("/key", std::vector<std::uint64_t>{key}, {1}, "1");
  writer.write("/dims", std::vector<std::int32_t>(volume.dims.begin(), volume.dims.end()), {3},
               "1");
  writer.write("/numbers", numbers, {numbers.size()}, "1");
  writer.write("/values", volume.values, {volume.values.size()}, "1");
  writer.finish();
}

/// The volume of a stage's file if it is sound and has this key; `numbers` are filled.
template <class Value>
std::optional<Volume<Value>> recall(const std::filesystem::path& file, Key key, double voxel,
                                    std::vector<double>& numbers) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    const Hdf5Reader reader{file, stage_kind};
    if (reader.read<std::uint64_t>("/key", {1}).front() != key) return std::nullopt;
    const auto dims = reader.read<std::int32_t>("/dims", {3});
    Volume<Value> volume{{dims[0], dims[1], dims[2]}, voxel};
    volume.values = reader.read<Value>("/values", {volume.values.size()});
    numbers = reader.read<double>("/numbers", {numbers.size()});
    return volume;
  } catch (const Error&) {
    return std::nullopt;  // damaged: made anew
  }
}

class Segmenter {
 public:
  Segmenter(const SegmentSettings& settings, std::filesystem::path folder,
            const std::function<void(ScanStage)>& on_stage)
      : settings_{settings}, folder_{std::move(folder)}, on_stage_{on_stage} {}

  Segmentation run(ScanStage last) {
    require_ct_component();
    if (settings_.labelled) return run_labelled();
    begin(ScanStage::read);
    scan_.raw = read_volume(settings_.volume).gray;
    key_ = key_of(scan_.raw);
    if (last >= ScanStage::denoise) denoise();
    if (last >= ScanStage::threshold) threshold();
    if (last >= ScanStage::split) split();
    if (last >= ScanStage::choose) choose();
    return std::move(scan_);
  }

 private:
  void begin(ScanStage stage) {
    if (on_stage_) on_stage_(stage);
  }
  [[nodiscard]] std::filesystem::path file_of(ScanStage stage) const {
    return folder_ / fmt::format("stage-{}.h5", name_of(stage));
  }

  /// Labels as they were given; their gray volume, or else the mask itself, tells the surfaces.
  Segmentation run_labelled() {
    begin(ScanStage::read);
    const GrayVolume stored = read_volume(settings_.volume).gray;
    scan_.labels = to_labels(stored, settings_.volume.file.string());
    (void)renumber(scan_.labels);
    scan_.mask = MaskVolume{scan_.labels};
    for (std::size_t v = 0; v < scan_.labels.values.size(); ++v) {
      scan_.mask.values[v] = scan_.labels.values[v] != 0;
    }
    if (settings_.gray.empty()) {
      scan_.raw = GrayVolume{scan_.labels};
      for (std::size_t v = 0; v < scan_.mask.values.size(); ++v) {
        scan_.raw.values[v] = scan_.mask.values[v];
      }
      scan_.denoised = scan_.raw;
    } else {
      scan_.raw = read_volume({settings_.gray, settings_.volume.voxel, {}}).gray;
      if (scan_.raw.dims != scan_.labels.dims) {
        throw Error{
            {.place = settings_.gray.string(),
             .problem = "the gray volume and the labels differ in size",
             .reason = fmt::format("{} x {} x {} and {} x {} x {} voxels", scan_.raw.dims[0],
                                   scan_.raw.dims[1], scan_.raw.dims[2], scan_.labels.dims[0],
                                   scan_.labels.dims[1], scan_.labels.dims[2]),
             .fix = "Give two volumes of the same scan."}};
      }
      begin(ScanStage::denoise);
      scan_.denoised = denoised(scan_.raw, settings_.denoise);
    }
    scan_.levels = levels_of(scan_.raw, scan_.mask, 0);
    choose();
    return std::move(scan_);
  }

  void denoise() {
    begin(ScanStage::denoise);
    const DenoiseSettings& s = settings_.denoise;
    key_ = key_after(key_, fmt::format("denoise {} {} {}", static_cast<int>(s.method), s.iterations,
                                       s.conductance));
    std::vector<double> none;
    if (auto known = recall<float>(file_of(ScanStage::denoise), key_, voxel(), none)) {
      scan_.resumed.push_back(ScanStage::denoise);
      scan_.denoised = std::move(*known);
      return;
    }
    scan_.denoised = denoised(scan_.raw, s);
    store(file_of(ScanStage::denoise), key_, scan_.denoised, none);
  }

  void threshold() {
    begin(ScanStage::threshold);
    const MaskSettings& s = settings_.mask;
    key_ = key_after(key_, fmt::format("threshold {} {} {} {}", s.threshold.has_value(),
                                       s.threshold.value_or(0), s.fill, s.open_radius));
    std::vector<double> numbers(3);
    if (auto known = recall<std::uint8_t>(file_of(ScanStage::threshold), key_, voxel(), numbers)) {
      scan_.resumed.push_back(ScanStage::threshold);
      scan_.mask = std::move(*known);
      scan_.levels = {numbers[0], numbers[1], numbers[2]};
      return;
    }
    SolidMask solid = find_solid(scan_.denoised, s);
    scan_.mask = std::move(solid.mask);
    scan_.levels = solid.levels;
    store(file_of(ScanStage::threshold), key_, scan_.mask,
          {scan_.levels.threshold, scan_.levels.void_gray, scan_.levels.solid_gray});
  }

  void split() {
    begin(ScanStage::split);
    const SplitSettings& s = settings_.split;
    key_ = key_after(key_, fmt::format("split {} {} {}", s.least_rise, s.neck, s.neck_void));
    std::vector<double> numbers(1);
    if (auto known = recall<std::uint32_t>(file_of(ScanStage::split), key_, voxel(), numbers)) {
      scan_.resumed.push_back(ScanStage::split);
      scan_.labels = std::move(*known);
      scan_.joined = static_cast<std::uint32_t>(numbers[0]);
      return;
    }
    SplitGrains split = split_grains(scan_.mask, s, &scan_.raw, scan_.levels);
    scan_.labels = std::move(split.labels);
    scan_.joined = split.joined;
    store(file_of(ScanStage::split), key_, scan_.labels, {static_cast<double>(scan_.joined)});
  }

  void choose() {
    begin(ScanStage::choose);
    scan_.grains = measure_labels(scan_.labels);
    scan_.choice = choose_grains(scan_.grains, settings_.keep_border, settings_.fewest_voxels);
    if (!scan_.choice.kept.empty()) return;
    throw Error{
        {.place = settings_.volume.file.string(),
         .problem = "no grains were found",
         .reason = fmt::format("{} are cut off by the border, {} have fewer than {} voxels",
                               scan_.choice.on_border, scan_.choice.tiny, settings_.fewest_voxels),
         .fix = "Look at the pictures of the slices; check --threshold, and give "
                "--keep-border or a smaller --fewest-voxels if they are right."}};
  }

  [[nodiscard]] double voxel() const { return settings_.volume.voxel; }

  const SegmentSettings& settings_;
  std::filesystem::path folder_;
  const std::function<void(ScanStage)>& on_stage_;
  Segmentation scan_;
  Key key_{0};
};

}  // namespace

const char* name_of(ScanStage stage) {
  switch (stage) {
    case ScanStage::read:
      return "read";
    case ScanStage::denoise:
      return "denoise";
    case ScanStage::threshold:
      return "threshold";
    case ScanStage::split:
      return "split";
    case ScanStage::choose:
      return "choose";
  }
  return "";
}

Segmentation segment_scan(const SegmentSettings& settings, const std::filesystem::path& folder,
                          ScanStage last, const std::function<void(ScanStage)>& on_stage) {
  return Segmenter{settings, folder, on_stage}.run(last);
}

}  // namespace reckon
