// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "grains_parts.hpp"
#include "progress.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/core/error.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/scan/from_scan.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scene/placement_table.hpp"
#include "reckon/text/human.hpp"
#include "scan_report.hpp"
#include "thread_limit.hpp"

namespace reckon::app {
namespace {

struct FromScanOptions {
  std::string voxel;
  std::string folder;
  std::string until{"avatars"};
  double voxels_per_diameter{0};
  std::string avatar_voxel;
  std::int32_t slice{-1};
  int threads{0};
  std::string truth;
  std::string threshold;
  std::string grays;
  bool no_fill{false};
  SegmentSettings segment;
  AvatarSettings avatars;
  std::uint32_t nodes{0};
};

const std::map<std::string, Denoising> denoisings{
    {"none", Denoising::none}, {"median", Denoising::median}, {"curvature", Denoising::curvature}};
const std::map<std::string, ScanStage> stages{
    {"read", ScanStage::read},       {"specimen", ScanStage::specimen},
    {"denoise", ScanStage::denoise}, {"threshold", ScanStage::threshold},
    {"split", ScanStage::split},     {"avatars", ScanStage::choose}};

/// The grid of the avatars is as fine as the scan unless an option changes it.
ShapeResolution resolution_of(const FromScanOptions& options) {
  ShapeResolution resolution = options.avatars.resolution;
  if (options.nodes > 0) resolution.node_count = options.nodes;
  if (options.voxels_per_diameter > 0) {
    resolution.voxels_per_diameter = options.voxels_per_diameter;
  } else {
    resolution.voxel_size = options.avatar_voxel.empty()
                                ? options.segment.volume.voxel
                                : parse_length("--avatar-voxel", options.avatar_voxel);
  }
  return resolution;
}

/// The files that the grains come from.
std::vector<std::string> sources_of(const SegmentSettings& settings) {
  std::vector<std::string> files = files_of_volume(settings.volume.file);
  for (const std::filesystem::path* other : {&settings.gray, &settings.specimen.mask}) {
    if (other->empty()) continue;
    const auto more = files_of_volume(*other);
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

void run(FromScanOptions options, const CommandWords& words) {
  if (options.threads > 0) set_thread_count(options.threads);
  require_ct_component();
  SegmentSettings& segment = options.segment;
  segment.volume.voxel = parse_length("--voxel", options.voxel);
  segment.mask.fill = !options.no_fill;
  if (!options.grays.empty()) segment.mask.grays = parse_numbers("--grays", options.grays);
  AvatarSettings avatars = options.avatars;
  avatars.resolution = resolution_of(options);
  if (!options.truth.empty() &&
      !std::filesystem::exists(std::filesystem::path{options.truth} / "library.h5")) {
    throw Error{{.place = "--truth",
                 .problem = fmt::format("{} holds no truth", options.truth),
                 .reason = "there is no library.h5 in it",
                 .fix = "Name a folder that `reckon grains scan` wrote."}};
  }
  const std::filesystem::path folder{options.folder};
  std::filesystem::create_directories(folder);
  ScanReport report{folder};
  const ScanStage last = stages.at(options.until);
  const Segmentation scan = segment_scan(
      segment, folder, last, [&](ScanStage stage) { report.begin(name_of(stage)); },
      [&](const std::string& text) { report.remark(text); });
  const std::int32_t layers = scan.raw.dims()[2];
  const std::int32_t slice =
      options.slice >= 0 && options.slice < layers ? options.slice : layers / 2;
  write_slices(scan, slice, folder);
  report.segmented(scan, last);
  if (last != ScanStage::choose) return report.finish();

  report.begin("avatars");
  const StoredScan stored{scan.raw, scan.denoised, scan.labels, scan.levels, scan.work};
  ScannedAssembly assembly;
  {
    const std::size_t kept = scan.choice.kept.size();
    CountDisplay display{"grains"};
    assembly = make_avatars(stored, scan.grains, scan.choice.kept, avatars,
                            [&](std::size_t done) { display.show(done, kept); });
  }
  LibraryWriter library{folder / "library.h5", avatars.resolution.storage,
                        provenance_of(words, sources_of(segment))};
  for (const KeptShape& shape : assembly.shapes) library.add(shape.whole());
  library.finish();
  write_placement(folder / "placement.csv", assembly.grains);
  report.avatars(assembly, scan);
  report.doubts(stored, scan, assembly);
  if (!options.truth.empty()) report.compare(options.truth, assembly, scan);
  report.finish();
}

void add_stage_options(CLI::App& command, FromScanOptions& options) {
  const auto number = [&](const char* name, auto& value, const char* what) {
    return command.add_option(name, value, what)->capture_default_str();
  };
  SegmentSettings& s = options.segment;
  command.add_option("--mask", s.specimen.mask,
                     "Volume whose voxels above 0 are the specimen (default: found)");
  command.add_flag("--keep-container", s.specimen.keep_container,
                   "Do not search for container walls and floors, and do not remove them");
  command.add_flag("--keep-shading", s.specimen.keep_shading,
                   "Do not correct gray values that vary over the volume");
  command
      .add_option("--phases", s.mask.phases,
                  "Number of solids of different gray: 1, or 0 to detect the number")
      ->capture_default_str()
      ->check(CLI::Range(0, 1));
  command.add_option("--denoise", s.denoise.method, "Method that removes noise")
      ->transform(CLI::CheckedTransformer(denoisings))
      ->default_str("curvature");
  number("--iterations", s.denoise.iterations, "Iterations of curvature diffusion");
  number("--conductance", s.denoise.conductance,
         "Conductance of curvature diffusion; a lower value keeps more edges")
      ->check(CLI::PositiveNumber);
  auto* threshold =
      command.add_option("--threshold", s.mask.threshold,
                         "Gray value between void and solid (default: found by Otsu's method)");
  command
      .add_option("--grays", options.grays,
                  "Gray values of void and of each solid, in ascending order (default: found)")
      ->type_name("VOID,SOLID,...")
      ->excludes(threshold);
  command.add_flag("--no-fill", options.no_fill, "Leave voids inside grains");
  command
      .add_option("--open", s.mask.open_radius, "Radius of a ball that opens the solid [voxels]")
      ->capture_default_str()
      ->check(CLI::Range(0, 20));
  command
      .add_option(
          "--rise", s.split.least_rise,
          "A neck divides two grains where the distance to the surface in the middle of both "
          "exceeds that in the neck by this [voxels]; a higher value splits less")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  command
      .add_option(
          "--neck", s.split.neck,
          "A neck wider than this share of the smaller grain does not divide; a lower value splits "
          "less")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  command
      .add_option(
          "--neck-void", s.split.neck_void,
          "A neck that is darker than the grains by less than this share of their gray does "
          "not divide; a higher value splits less")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  command.add_flag("--keep-border", s.keep_border,
                   "Keep grains that touch the border of the volume");
  number("--fewest-voxels", s.fewest_voxels, "Grains with fewer voxels are left out");
}

void add_avatar_options(CLI::App& command, FromScanOptions& options) {
  AvatarSettings& s = options.avatars;
  command.add_option("--smooth", s.smoothing, "Gaussian smoothing of the surface [voxels]")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 5.0));
  command
      .add_option(
          "--sharpen", s.sharpening,
          "Weight of the sharpening: the difference to a surface smoothed by one more voxel is "
          "added this many times")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10.0));
  command
      .add_option(
          "--contact-gap", s.contact_gap,
          "Two grains touch if the gap between them in the gray values is at most this [voxels]")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 2.0));
  auto* per_diameter =
      command
          .add_option("--voxels-per-diameter", options.voxels_per_diameter,
                      "Grid spacings along an avatar's diameter (default: the grid of the scan)")
          ->check(CLI::Range(10.0, 1000.0));
  command.add_option("--avatar-voxel", options.avatar_voxel, "Grid spacing of the avatars")
      ->excludes(per_diameter);
  auto* spacing = command
                      .add_option("--node-spacing", s.resolution.node_spacing,
                                  "Square root of the mean area of a node, in diameters")
                      ->capture_default_str()
                      ->check(CLI::Range(0.005, 0.5));
  command.add_option("--nodes", options.nodes, "Number of surface nodes of each grain")
      ->excludes(spacing)
      ->check(CLI::Range(4, 10000000));
  add_storage_option(command, s.resolution.storage);
}

}  // namespace

void add_grains_from_scan(CLI::App& grains, const CommandWords& words) {
  CLI::App* command = grains.add_subcommand(
      "from-scan", "Make grains and their positions from an X-ray volume, gray or labelled");
  command->footer(
      "Examples:\n"
      "  reckon grains from-scan scan.nrrd --voxel 3um --out sand --until split   # inspect first\n"
      "  reckon grains from-scan scan.nrrd --voxel 3um --out sand\n"
      "  reckon run sand/relax.toml");
  auto options = std::make_shared<FromScanOptions>();
  SegmentSettings& s = options->segment;
  command
      ->add_option("volume", s.volume.file,
                   "TIFF stack or folder, .nrrd, .mha, .raw with .raw.txt, .h5 or .npy")
      ->required();
  command->add_option("--voxel", options->voxel, "Edge of a voxel, e.g. 3um")->required();
  command->add_option("-o,--out", options->folder, "Output folder; created if missing")->required();
  command->add_flag("--invert", s.volume.invert, "Void is brighter than the grains in this volume");
  command->add_option("--dataset", s.volume.dataset, "Name of the dataset in an HDF5 file");
  auto* labelled =
      command->add_flag("--labelled", s.labelled, "The volume contains labels, not gray values");
  command->add_option("--gray", s.gray, "With --labelled: the gray volume of the same scan")
      ->needs(labelled);
  command
      ->add_option(
          "--until", options->until,
          "Stop after read, specimen, denoise, threshold or split, to inspect the pictures")
      ->capture_default_str()
      ->check(CLI::IsMember({"read", "specimen", "denoise", "threshold", "split", "avatars"}));
  command->add_option("--slice", options->slice,
                      "Layer that the pictures show (default: the middle)");
  add_stage_options(*command, *options);
  add_avatar_options(*command, *options);
  command->add_option("--truth", options->truth,
                      "Compare with this folder, written by `reckon grains scan`");
  command
      ->add_option("--memory", s.memory,
                   "Memory for volumes, e.g. 8GB; a larger volume is processed in blocks (default: "
                   "half of the machine's memory)")
      ->transform(CLI::AsSizeValue(true));
  command
      ->add_option(
          "--overlap", s.overlap,
          "Overlap of blocks [voxels]; must exceed the largest grain (default: a quarter of a "
          "block)")
      ->check(CLI::Range(8, 100000));
  command->add_option("--threads", options->threads, "Threads (default: all)")
      ->check(CLI::Range(1, most_threads));
  command->callback([=] { run(*options, words); });
}

}  // namespace reckon::app
