// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "scan_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "reckon/avatar/library_file.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/scan/doubts.hpp"
#include "reckon/scan/scan_truth.hpp"
#include "reckon/scan/volume_file.hpp"
#include "reckon/scene/placement_table.hpp"
#include "reckon/text/csv_text.hpp"
#include "reckon/text/human.hpp"

namespace reckon::app {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// Which phase a gray belongs to, from 1.
std::size_t phase_of(double gray, const std::vector<double>& phases) {
  std::size_t nearest = 0;
  for (std::size_t p = 1; p < phases.size(); ++p) {
    if (std::abs(phases[p] - gray) < std::abs(phases[nearest] - gray)) nearest = p;
  }
  return nearest + 1;
}

void write_quality(const std::filesystem::path& file, const ScannedAssembly& assembly,
                   const std::vector<double>& phases) {
  std::string text =
      "grain,label,phase,gray,voxels,volume_m3,volume_over_labels,volume_over_gray,level,gradient_"
      "error,"
      "surface_distance_m,area_kept,neighbours,contacts,deepest_overlap_m\n";
  for (std::size_t n = 0; n < assembly.quality.size(); ++n) {
    const AvatarQuality& q = assembly.quality[n];
    text += fmt::format(
        "{},{},{},{:.6g},{},{},{:.6f},{:.6f},{:.4f},{:.6f},{:.6g},{:.5f},{},{},{:.6g}\n",
        csv_text(assembly.shapes[n].entry().name), q.given_label == 0 ? q.label : q.given_label,
        phase_of(q.solid_gray, phases), q.solid_gray, q.voxels, q.volume, q.volume / q.label_volume,
        q.volume / q.gray_volume, q.level, q.gradient_error, q.surface_distance, q.area_kept,
        q.neighbours, q.contacts, q.deepest_overlap);
  }
  write_file(file, text);
}

void write_contacts(const std::filesystem::path& file, const ScannedAssembly& assembly) {
  std::string text = "a,b,touching,gray_gap_m,gap_m,x_m,y_m,z_m,nx,ny,nz\n";
  for (const ScannedContact& contact : assembly.contacts) {
    const NearPair& pair = contact.pair;
    const Vec3& p = pair.point_world;
    const Vec3& n = pair.normal_world;
    text += fmt::format("{},{},{},{:.6g},{:.6g},{},{},{},{:.6g},{:.6g},{:.6g}\n", pair.a, pair.b,
                        contact.touching ? 1 : 0, contact.gray_gap, pair.gap, p.x, p.y, p.z, n.x,
                        n.y, n.z);
  }
  write_file(file, text);
}

/// A scene in which overlaps push grains apart and damping stops them at once. The nodes of both
/// grains of a pair are looked at, or else corners would stay in faces. Stiffness is such that a
/// thousandth of a diameter bears what a grain of this size weighs many times over; the damping is
/// near critical for one contact, whose area is about a fiftieth of d^2: with less, grains fly on
/// when they no longer touch.
void write_relaxation(const std::filesystem::path& file, double diameter) {
  const double density = 2650;
  const double stiffness = 4e6 / diameter;
  const double damping =
      2 * std::sqrt(0.02 * stiffness / (density * std::numbers::pi / 6 * diameter));
  write_file(file,
             fmt::format(R"(# Pushes the scanned grains out of each other, as little as possible.
#   reckon run relax.toml
#   reckon grains moved placement.csv relax.run
title = "Scanned grains, overlaps relaxed"

[material]
density = {}
friction = 0

[contact]
law = "area"
master = "both"
allow_inside = true
normal_stiffness = "{:.4g} N/m^3"

[body]
gravity = [0, 0, 0]
damping = {:.4g}

[[grains]]
library = "library.h5"
table = {{ file = "placement.csv" }}

[[stage]]
name = "relax"
steps = 50000
until = {{ overlap = {:.3g} }}

[output]
history_interval = 100
)",
                         density, stiffness, damping, 1e-4 * diameter));
}

}  // namespace

ScanReport::ScanReport(std::filesystem::path folder) : folder_{std::move(folder)} {
  json_.begin_object();
}

void ScanReport::end_stage() {
  if (stage_.empty()) return;
  seconds_.emplace_back(stage_, since_begin_.seconds());
  stage_.clear();
}

void ScanReport::begin(const std::string& stage) {
  end_stage();
  stage_ = stage;
  since_begin_ = {};
}

void ScanReport::remark(const std::string& text) {
  fmt::print("note       {}\n", text);
  std::fflush(stdout);
  remarks_.push_back(text);
}

void ScanReport::segmented(const Segmentation& scan, ScanStage last) {
  end_stage();
  const VoxelDims& dims = scan.raw.dims();
  fmt::print("volume     {} x {} x {} voxels\n", dims[0], dims[1], dims[2]);
  json_.begin_array("voxels");
  for (const std::int32_t dim : dims) json_.value({}, dim);
  json_.end();
  for (const ScanStage stage : scan.resumed) {
    fmt::print("resumed    {}: input and settings are the same as in its file\n", name_of(stage));
  }
  if (last >= ScanStage::threshold) {
    fmt::print("gray       void {:.6g}, solid {:.6g}, threshold {:.6g}\n", scan.levels.void_gray,
               scan.levels.solid_gray, scan.levels.threshold);
    fmt::print("solid      {:.2f} % of the volume\n", 100 * scan.solid_share);
    json_.value("void_gray", scan.levels.void_gray);
    json_.value("solid_gray", scan.levels.solid_gray);
    json_.value("threshold", scan.levels.threshold);
    json_.value("solid_share", scan.solid_share);
  }
  if (last >= ScanStage::split) {
    const BlockFigures& blocks = scan.blocks;
    if (blocks.blocks > 1) {
      fmt::print("blocks     {} that overlap by {} voxels; they disagree on {} solid voxels\n",
                 blocks.blocks, blocks.overlap, human_count(blocks.disputed));
    }
    json_.value("blocks", blocks.blocks);
    json_.value("disputed_voxels", blocks.disputed);
    json_.value("pieces_joined", scan.joined);
    fmt::print("split      {} joined again at wide necks\n", counted(scan.joined, "piece"));
  }
  if (last >= ScanStage::choose) {
    fmt::print("grains     {} found; {} cut off by the border and {} tiny ones dropped, {} kept\n",
               human_count(scan.grains.size()), human_count(scan.choice.on_border),
               human_count(scan.choice.tiny), human_count(scan.choice.kept.size()));
    json_.value("grains_found", scan.grains.size());
    json_.value("on_border", scan.choice.on_border);
    json_.value("tiny", scan.choice.tiny);
    json_.value("kept", scan.choice.kept.size());
  }
}

void ScanReport::avatars(const ScannedAssembly& assembly, const Segmentation& scan) {
  end_stage();
  const double voxel = scan.raw.voxel();
  write_quality(folder_ / "quality.csv", assembly, scan.phases);
  write_contacts(folder_ / "contacts.csv", assembly);
  double diameter = 0;
  double overlap = 0;
  double gradient = 0;
  double drift = 0;
  for (std::size_t n = 0; n < assembly.quality.size(); ++n) {
    const auto count = static_cast<double>(assembly.quality.size());
    const AvatarQuality& q = assembly.quality[n];
    diameter += assembly.shapes[n].entry().descriptors.equivalent_diameter / count;
    overlap = std::max(overlap, q.deepest_overlap);
    gradient += q.gradient_error / count;
    drift += std::abs(q.volume / q.gray_volume - 1) / count;
  }
  std::size_t touching = 0;
  std::size_t overlapping = 0;
  for (const ScannedContact& contact : assembly.contacts) {
    touching += contact.touching ? 1 : 0;
    overlapping += contact.pair.gap < 0 ? 1 : 0;
  }
  write_relaxation(folder_ / "relax.toml", diameter);
  const double seconds = seconds_.back().second;
  fmt::print("avatars    {} in {} ({:.3g} a second), mean diameter {:.4g} voxels\n",
             human_count(assembly.shapes.size()), human_duration(seconds),
             static_cast<double>(assembly.shapes.size()) / seconds, diameter / voxel);
  for (const std::string& reason : assembly.refused)
    fmt::print("left out   {}\n", printable(reason));
  fmt::print("quality    volume {:.3f} % off the gray values'; | |grad phi| - 1 | {:.4f}\n",
             100 * drift, gradient);
  fmt::print("contacts   {} touch; {} pairs overlap, by {:.3f} voxels at most\n",
             human_count(touching), human_count(overlapping), overlap / voxel);
  fmt::print("blur       {:.3f} voxels, measured on the surfaces\n", assembly.spread);
  json_.value("avatars", assembly.shapes.size());
  json_.value("refused", assembly.refused.size());
  json_.value("mean_diameter_voxels", diameter / voxel);
  json_.value("volume_drift", drift);
  json_.value("gradient_error", gradient);
  json_.value("contacts", touching);
  json_.value("blur_voxels", assembly.spread);
  json_.value("overlapping_pairs", overlapping);
  json_.value("deepest_overlap_voxels", overlap / voxel);
}

void ScanReport::doubts(const StoredScan& stored, const Segmentation& scan,
                        const ScannedAssembly& assembly) {
  constexpr std::size_t most_pictures = 24;
  std::vector<Doubt> doubts = doubtful_splits(scan.labels, scan.grains, scan.work);
  const std::size_t splits = doubts.size();
  const std::vector<std::string> many = check_doubts(doubts, assembly.shapes.size());
  const std::vector<Doubt> joins = doubtful_joins(scan.waists);
  doubts.insert(doubts.end(), joins.begin(), joins.end());
  std::string text = "what,grain_a,grain_b,measure,x_m,y_m,z_m,picture\n";
  const auto name = [&](std::uint32_t label) { return name_of(scan.grains[label - 1], label); };
  for (std::size_t n = 0; n < doubts.size(); ++n) {
    const Doubt& doubt = doubts[n];
    const bool is_split = doubt.kind == Doubt::Kind::split;
    std::string picture;
    const std::size_t place = is_split ? n : n - splits;
    if (place < most_pictures) {
      picture = fmt::format("doubt-{}-{}.png", is_split ? "split" : "join", place + 1);
      write_place(scan, doubt.voxel, folder_ / picture);
    }
    const Vec3 world =
        scan.raw.voxel() * Vec3{doubt.voxel[0] + 0.5, doubt.voxel[1] + 0.5, doubt.voxel[2] + 0.5};
    text += fmt::format("{},{},{},{:.3f},{:.6g},{:.6g},{:.6g},{}\n", is_split ? "split" : "join",
                        name(doubt.a), name(doubt.b), doubt.measure, world.x, world.y, world.z,
                        picture);
  }
  write_file(folder_ / "doubtful.csv", text);
  fmt::print(
      "doubtful   {} splits across a wide face, {} joins across a waist: doubtful.csv, with "
      "pictures\n",
      splits, joins.size());
  json_.value("doubtful_splits", splits);
  json_.value("doubtful_joins", joins.size());
  for (const auto& list : {many, check_packing(assembly, scan.grains, scan.choice, scan.levels),
                           check_scan(stored, scan.mask, assembly.spread)}) {
    for (const std::string& found : list) remark(found);
  }
}

void ScanReport::compare(const std::string& truth_folder, const ScannedAssembly& assembly,
                         const Segmentation& scan) {
  const std::filesystem::path folder{truth_folder};
  ScanTruth truth;
  truth.shapes = load_library(folder / "library.h5");
  truth.grains = read_placement(folder / "placement.csv", truth.shapes.size());
  truth.labels = load_labels({folder / "labels.h5", scan.labels.voxel(), {}}, scan.work).volume;
  const TruthFigures f = compare_with_truth(truth, assembly, scan.labels, scan.work);
  fmt::print("truth      {} of {} grains found once ({:.2f} %), {} split, {} joined\n",
             f.found_once, f.grains, 100.0 * f.found_once / std::max(1U, f.grains), f.split,
             f.joined);
  fmt::print("  volume   {:+.3f} % on average, {:.3f} % off; inertia {:.2f} % off\n",
             100 * f.volume_error, 100 * f.volume_error_absolute, 100 * f.inertia_error);
  fmt::print("  pose     centre {:.3f} voxels, long axis {:.2f} degrees off\n", f.center_error,
             degrees * f.axis_error);
  fmt::print("  surface  {:.3f} voxels, normals {:.2f} degrees off\n", f.surface_error,
             degrees * f.normal_error);
  fmt::print("  contacts recall {:.2f} %, precision {:.2f} % of {} true ones\n", 100 * f.recall(),
             100 * f.precision(), f.true_contacts);
  json_.begin_object("truth");
  json_.value("grains", f.grains);
  json_.value("found_once", f.found_once);
  json_.value("split", f.split);
  json_.value("joined", f.joined);
  json_.value("voxels_per_diameter", f.voxels_per_diameter);
  json_.value("volume_error", f.volume_error);
  json_.value("volume_error_absolute", f.volume_error_absolute);
  json_.value("inertia_error", f.inertia_error);
  json_.value("center_error_voxels", f.center_error);
  json_.value("axis_error_degrees", degrees * f.axis_error);
  json_.value("surface_error_voxels", f.surface_error);
  json_.value("normal_error_degrees", degrees * f.normal_error);
  json_.value("true_contacts", f.true_contacts);
  json_.value("found_contacts", f.found_contacts);
  json_.value("recall", f.recall());
  json_.value("precision", f.precision());
  json_.end();
}

void ScanReport::finish() {
  end_stage();
  json_.begin_array("remarks");
  for (const std::string& text : remarks_) json_.value({}, text);
  json_.end();
  json_.begin_object("seconds");
  for (const auto& [stage, seconds] : seconds_) json_.value(stage, seconds);
  json_.end();
  json_.end();
  write_file(folder_ / "report.json", json_.text());
}

}  // namespace reckon::app
