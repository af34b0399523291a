// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/from_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/xxhash64.hpp"
#include "reckon/scan/doubts.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/label_pieces.hpp"
#include "reckon/text/human.hpp"

namespace reckon {
namespace {

const Hdf5Kind stage_kind{"scan stage", 3};

/// The inputs of a stage: the values of the volume and all settings up to it.
using Key = std::uint64_t;

Key key_after(Key before, const std::string& settings) {
  XxHash64 hash;
  hash.update(std::as_bytes(std::span{&before, 1}));
  hash.update(std::as_bytes(std::span{settings}));
  return hash.digest();
}

/// A stage's file: a volume, a few numbers, and the key.
template <class Value>
void store(const std::filesystem::path& file, Key key, const DiskVolume<Value>& volume,
           const Workspace& work, const std::vector<double>& numbers) {
  const auto& dims = volume.dims();
  Hdf5Writer writer{file, stage_kind};
  writer.write("/key", std::vector<std::uint64_t>{key}, {1}, "1");
  writer.write("/dims", std::vector<std::int32_t>(dims.begin(), dims.end()), {3}, "1");
  writer.write("/numbers", numbers, {numbers.size()}, "1");
  const auto voxels = [&](std::size_t axis) { return static_cast<std::uint64_t>(dims[axis]); };
  writer.create("/values", hdf5_number<Value>(), {voxels(2), voxels(1), voxels(0)}, "1");
  for (const Box& slab : work.slabs(dims)) {
    writer.write_rows("/values", static_cast<std::uint64_t>(slab.low[2]),
                      std::span<const Value>{volume.read(slab).values});
  }
  writer.finish();
}

/// The volume of a stage's file if it is valid and has this key; `numbers` are filled, with as many
/// as it had or more.
template <class Value>
std::optional<DiskVolume<Value>> recall(const std::filesystem::path& file, Key key,
                                        const GrayOnDisk& raw, std::vector<double>& numbers) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    const Hdf5Reader reader{file, stage_kind};
    if (reader.read<std::uint64_t>("/key", {1}).front() != key) return std::nullopt;
    const auto dims = reader.read<std::int32_t>("/dims", {3});
    if (!std::equal(dims.begin(), dims.end(), raw.dims().begin())) return std::nullopt;
    const Hdf5Extents extents = reader.extents("/numbers");
    if (extents.size() != 1 || extents[0] < numbers.size()) return std::nullopt;
    numbers = reader.read<double>("/numbers", extents);
    return DiskVolume<Value>{std::make_shared<ByteFile>(file),
                             reader.place<Value>("/values", raw.box().voxels()), raw.dims(),
                             raw.voxel()};
  } catch (const Error&) {
    return std::nullopt;  // damaged: made again
  }
}

class Segmenter {
 public:
  Segmenter(const SegmentSettings& settings, std::filesystem::path folder,
            const std::function<void(ScanStage)>& on_stage,
            const std::function<void(const std::string&)>& on_remark)
      : settings_{settings},
        folder_{std::move(folder)},
        on_stage_{on_stage},
        on_remark_{on_remark} {
    scan_.work = {folder_, settings.memory, settings.overlap};
  }

  Segmentation run(ScanStage last) {
    require_ct_component();
    if (settings_.labelled) return run_labelled();
    begin(ScanStage::read);
    XxHash64 hash;
    auto loaded = load_volume(settings_.volume, scan_.work, [&](const GrayVolume& layers) {
      hash.update(std::as_bytes(std::span{layers.values}));
    });
    scan_.raw = std::move(loaded.volume);
    remark(loaded.remarks);
    hash.update(std::as_bytes(std::span{scan_.raw.dims()}));
    key_ = hash.digest();
    if (last >= ScanStage::threshold) remark_blocks();
    if (last >= ScanStage::specimen) find_specimen_stage();
    if (last >= ScanStage::denoise) denoise();
    if (last >= ScanStage::threshold) threshold();
    if (last >= ScanStage::split) split();
    if (last >= ScanStage::choose) choose();
    measure_solid();
    return std::move(scan_);
  }

 private:
  void measure_solid() {
    if (scan_.mask.empty()) return;
    std::uint64_t solid = 0;
    std::uint64_t all = 0;
    for (const Box& slab : scan_.work.slabs(scan_.mask.dims())) {
      const MaskVolume mask = scan_.mask.read(slab);
      const MaskVolume inside =
          scan_.inside.empty() ? MaskVolume{slab, 0, 1} : scan_.inside.read(slab);
      for (std::size_t v = 0; v < mask.values.size(); ++v) {
        solid += mask.values[v];
        all += inside.values[v];
      }
    }
    scan_.solid_share = static_cast<double>(solid) / static_cast<double>(all);
  }

  void remark(const std::vector<std::string>& remarks) {
    for (const std::string& text : remarks) {
      scan_.remarks.push_back(text);
      if (on_remark_) on_remark_(text);
    }
  }
  void begin(ScanStage stage) {
    if (on_stage_) on_stage_(stage);
  }
  [[nodiscard]] std::filesystem::path file_of(ScanStage stage) const {
    return folder_ / fmt::format("stage-{}.h5", name_of(stage));
  }

  /// Labels as they were given; their gray volume, or else the mask itself, gives the surfaces.
  Segmentation run_labelled() {
    begin(ScanStage::read);
    const Workspace& work = scan_.work;
    const auto loaded = load_labels(settings_.volume, work);
    remark(loaded.remarks);
    const LabelsOnDisk& given = loaded.volume;
    pieces_ = find_label_pieces(given, work);
    scan_.labels = pieces_->labels;
    scan_.mask = MaskOnDisk{given.dims(), given.voxel(), folder_};
    GrayOnDisk solid{given.dims(), given.voxel(), folder_};
    for (const Box& slab : work.slabs(given.dims())) {
      const LabelVolume labels = given.read(slab);
      MaskVolume mask{labels};
      GrayVolume gray{labels};
      for (std::size_t v = 0; v < labels.values.size(); ++v) {
        mask.values[v] = labels.values[v] != 0 ? 1 : 0;
        gray.values[v] = mask.values[v];
      }
      scan_.mask.write(mask, slab);
      solid.write(gray, slab);
    }
    scan_.raw = solid;
    if (!settings_.gray.empty()) {
      auto gray =
          load_volume({settings_.gray, settings_.volume.voxel, {}, settings_.volume.invert}, work);
      scan_.raw = std::move(gray.volume);
      remark(gray.remarks);
    }
    if (scan_.raw.dims() != given.dims()) {
      const VoxelDims& gray = scan_.raw.dims();
      const VoxelDims& labels = given.dims();
      throw Error{{.place = settings_.gray.string(),
                   .problem = "the gray volume and the labels differ in size",
                   .reason = fmt::format("{} x {} x {} and {} x {} x {} voxels", gray[0], gray[1],
                                         gray[2], labels[0], labels[1], labels[2]),
                   .fix = "Give two volumes of the same scan."}};
    }
    begin(ScanStage::denoise);
    scan_.denoised = settings_.gray.empty() ? solid : denoised(scan_.raw, settings_.denoise, work);
    scan_.levels = levels_of(scan_.raw, scan_.mask, 0, work);
    if (settings_.gray.empty()) scan_.levels.blur = 0;
    choose();
    measure_solid();
    return std::move(scan_);
  }

  /// How often a volume's voxels are worked on, because blocks overlap.
  [[nodiscard]] double repetition(const Workspace& work) const {
    std::uint64_t voxels = 0;
    for (const Block& block : work.blocks(scan_.raw.dims(), scan_.work.grain_overlap())) {
      voxels += block.whole.voxels();
    }
    return static_cast<double>(voxels) / static_cast<double>(scan_.raw.box().voxels());
  }

  /// Before the work that it would slow down.
  void remark_blocks() {
    constexpr double bearable = 4;
    const double times = repetition(scan_.work);
    if (times < bearable) return;
    Workspace more = scan_.work;
    more.memory = scan_.work.memory_limit();
    while (repetition(more) > bearable / 2) more.memory += more.memory / 4;
    const auto blocks = scan_.work.blocks(scan_.raw.dims(), scan_.work.grain_overlap());
    const VoxelDims& core = blocks.front().core.dims;
    remark({fmt::format(
        "{} blocks of {} x {} x {} voxels overlap by {} voxels, so each voxel is worked on {:.0f} "
        "times. --memory {}MB, or a smaller --overlap, makes this at most {:.0f} times",
        blocks.size(), core[0], core[1], core[2], scan_.work.grain_overlap(), times,
        more.memory / 1000000 + 1, bearable / 2)});
  }

  /// Not stored: it takes a few passes through the volume.
  void find_specimen_stage() {
    begin(ScanStage::specimen);
    Specimen specimen = find_specimen(scan_.raw, settings_.specimen, scan_.work);
    scan_.outer = specimen.outer;
    scan_.inside = specimen.inside;
    remark(specimen.remarks);
    if (specimen.remarks.empty()) return;
    scan_.raw = specimen.gray;
    XxHash64 hash;
    for (const Box& slab : scan_.work.slabs(scan_.raw.dims())) {
      const GrayVolume part = scan_.raw.read(slab);
      hash.update(std::as_bytes(std::span{part.values}));
    }
    key_ = key_after(key_, fmt::format("specimen {}", hash.digest()));
  }

  /// Grains that are cut off by the outside: bright to the very edge over a part of their
  /// cross-section. One that merely touches it has its own blurred surface there, and stays.
  void mark_cut_grains() {
    if (scan_.outer.empty()) return;
    constexpr double small_face = 0.25;  // cuts off about one percent of a ball
    constexpr double full = 0.9;         // solid share of a voxel that lies under no surface
    std::vector<double> faces(scan_.grains.size(), 0);
    std::vector<bool> at_edge(scan_.grains.size(), false);
    for (const Box& slab : scan_.work.slabs(scan_.labels.dims())) {
      const Box wide = slab.widened(1, scan_.labels.box());
      const LabelVolume labels = scan_.labels.read(slab);
      const MaskVolume outer = scan_.outer.read(wide);
      const GrayVolume gray = scan_.raw.read(slab);
      std::size_t v = 0;
      for_each_voxel(slab, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
        const std::size_t at = v++;
        const std::uint32_t label = labels.values[at];
        if (label == 0) return;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const std::int32_t step : {-1, 1}) {
            VoxelDims next{i, j, k};
            next[axis] += step;
            if (!outer.holds(next[0], next[1], next[2])) continue;
            if (outer.values[outer.index(next[0], next[1], next[2])] != 0) continue;
            at_edge[label - 1] = true;
            if (scan_.levels.share(gray.values[at]) > full) faces[label - 1] += 1;
          }
        }
      });
    }
    std::size_t touching = 0;
    for (std::size_t n = 0; n < faces.size(); ++n) {
      LabelledGrain& grain = scan_.grains[n];
      const double cut = faces[n] / cross_section_in_faces(grain.voxels);
      if (cut > small_face) grain.on_border = true;
      touching += at_edge[n] && cut <= small_face ? 1U : 0U;
    }
    if (touching == 0) return;
    remark(
        {fmt::format("{} at the border of the specimen; about one percent of the volume of each "
                     "may be missing there",
                     counted(touching, "grain"))});
  }

  void denoise() {
    begin(ScanStage::denoise);
    const DenoiseSettings& s = settings_.denoise;
    key_ = key_after(key_, fmt::format("denoise {} {} {}", static_cast<int>(s.method), s.iterations,
                                       s.conductance));
    std::vector<double> none;
    if (auto known = recall<float>(file_of(ScanStage::denoise), key_, scan_.raw, none)) {
      scan_.resumed.push_back(ScanStage::denoise);
      scan_.denoised = std::move(*known);
      return;
    }
    scan_.denoised = denoised(scan_.raw, s, scan_.work);
    store(file_of(ScanStage::denoise), key_, scan_.denoised, scan_.work, none);
  }

  void threshold() {
    begin(ScanStage::threshold);
    const MaskSettings& s = settings_.mask;
    key_ = key_after(key_, fmt::format("threshold {} {} {} {} {} {}", s.threshold.has_value(),
                                       s.threshold.value_or(0), s.fill, s.open_radius, s.phases,
                                       fmt::join(s.grays, " ")));
    std::vector<double> numbers(3);
    if (auto known =
            recall<std::uint8_t>(file_of(ScanStage::threshold), key_, scan_.raw, numbers)) {
      scan_.resumed.push_back(ScanStage::threshold);
      scan_.mask = std::move(*known);
      scan_.levels = {numbers[0], numbers[1], numbers[2]};
      scan_.phases.assign(numbers.begin() + 3, numbers.end());
      remark_phases();
      return;
    }
    SolidMask solid = find_solid(scan_.denoised, s, scan_.work, scan_.inside);
    scan_.mask = std::move(solid.mask);
    scan_.levels = solid.levels;
    scan_.phases = solid.phases;
    remark_phases();
    numbers = {scan_.levels.threshold, scan_.levels.void_gray, scan_.levels.solid_gray};
    numbers.insert(numbers.end(), scan_.phases.begin(), scan_.phases.end());
    store(file_of(ScanStage::threshold), key_, scan_.mask, scan_.work, numbers);
  }

  void remark_phases() {
    if (scan_.phases.empty()) return;
    std::string grays;
    for (const double gray : scan_.phases) {
      grays += fmt::format("{}{:.6g}", grays.empty() ? "" : ", ", gray);
    }
    remark(
        {fmt::format("the solid has {} phases, of gray {}; quality.csv says which a grain "
                     "belongs to (--phases 1 looks for one only)",
                     scan_.phases.size(), grays)});
  }

  void split() {
    begin(ScanStage::split);
    const SplitSettings& s = settings_.split;
    key_ = key_after(key_, fmt::format("split {} {} {}", s.least_rise, s.neck, s.neck_void));
    std::vector<double> numbers(4);
    if (auto known = recall<std::uint32_t>(file_of(ScanStage::split), key_, scan_.raw, numbers)) {
      scan_.resumed.push_back(ScanStage::split);
      scan_.labels = std::move(*known);
      scan_.joined = static_cast<std::uint32_t>(numbers[0]);
      scan_.blocks = {static_cast<std::size_t>(numbers[1]), static_cast<std::int32_t>(numbers[2]),
                      static_cast<std::uint64_t>(numbers[3])};
      for (std::size_t n = 4; n + 4 < numbers.size(); n += 5) {
        scan_.waists.push_back(
            {static_cast<std::uint32_t>(numbers[n]),
             numbers[n + 1],
             {static_cast<std::int32_t>(numbers[n + 2]), static_cast<std::int32_t>(numbers[n + 3]),
              static_cast<std::int32_t>(numbers[n + 4])}});
      }
      return;
    }
    SplitGrains split = split_grains(scan_.mask, s, &scan_.raw, scan_.levels, scan_.work);
    scan_.labels = std::move(split.labels);
    scan_.joined = split.joined;
    scan_.blocks = split.blocks;
    scan_.waists = split.waists;
    numbers = {static_cast<double>(split.joined), static_cast<double>(split.blocks.blocks),
               static_cast<double>(split.blocks.overlap),
               static_cast<double>(split.blocks.disputed)};
    for (const Waist& waist : split.waists) {
      numbers.push_back(waist.label);
      numbers.push_back(waist.width);
      for (const std::int32_t place : waist.voxel) numbers.push_back(place);
    }
    store(file_of(ScanStage::split), key_, scan_.labels, scan_.work, numbers);
  }

  void choose() {
    begin(ScanStage::choose);
    scan_.grains = measure_labels(scan_.labels, scan_.work);
    if (pieces_) {
      name_by_label(scan_.grains, *pieces_);
      remark(label_remarks(scan_.grains, settings_.fewest_voxels));
    }
    mark_cut_grains();
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

  const SegmentSettings& settings_;
  std::filesystem::path folder_;
  const std::function<void(ScanStage)>& on_stage_;
  const std::function<void(const std::string&)>& on_remark_;
  Segmentation scan_;
  std::optional<LabelPieces> pieces_;  // of labels that were given
  Key key_{0};
};

}  // namespace

const char* name_of(ScanStage stage) {
  switch (stage) {
    case ScanStage::read:
      return "read";
    case ScanStage::specimen:
      return "specimen";
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
                          ScanStage last, const std::function<void(ScanStage)>& on_stage,
                          const std::function<void(const std::string&)>& on_remark) {
  return Segmenter{settings, folder, on_stage, on_remark}.run(last);
}

}  // namespace reckon
