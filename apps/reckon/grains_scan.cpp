// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grains_parts.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/results/run_surfaces.hpp"
#include "reckon/scan/near_pairs.hpp"
#include "reckon/scan/scan_avatars.hpp"
#include "reckon/scan/scanner.hpp"
#include "reckon/scan/volume_file.hpp"
#include "reckon/scene/placement_table.hpp"
#include "reckon/scene/scene_loader.hpp"
#include "reckon/text/human.hpp"
#include "reckon/text/json_writer.hpp"
#include "thread_limit.hpp"

namespace reckon::app {
namespace {

struct ScanOptions {
  std::string source;
  std::optional<std::uint64_t> step;
  std::string voxel;
  std::string folder;
  std::string format{"h5"};
  std::string type{"uint16"};
  bool no_partial_volume{false};
  std::uint64_t memory{0};
  int threads{0};
  bool json{false};
  ScannerSettings scanner;
};

/// Grains in place and a way to their shapes.
struct Assembly {
  std::vector<GrainState> grains;
  ReadShape read_shape;
  std::vector<std::string> files;  ///< that they were read from
};

Assembly open_run(const ScanOptions& options) {
  const RunFolder folder{options.source};
  const auto steps = folder.checkpoint_steps();
  const std::uint64_t step = options.step.value_or(steps.empty() ? 0 : steps.back());
  if (std::find(steps.begin(), steps.end(), step) == steps.end()) {
    throw Error{{.place = options.source,
                 .problem = "there is no checkpoint of this step",
                 .reason = steps.empty() ? "the run has none" : fmt::format("step {}", step),
                 .fix = "Its folder checkpoints lists them."}};
  }
  const std::filesystem::path file = folder.own(folder.checkpoint(step));
  const Checkpoint checkpoint = read_checkpoint(file);
  const auto catalog = std::make_shared<const ShapeCatalog>(shapes_of(checkpoint, options.source));
  return {fields_of(checkpoint).grains,
          [catalog](ShapeId shape) { return catalog->read(shape); },
          {file.string()}};
}

Assembly open_scene(const ScanOptions& options) {
  SceneReading reading = read_scene_file(options.source);
  LoadedScene scene = load_scene(reading);
  if (!reading.faults.empty()) {
    throw Error{{.place = options.source,
                 .problem = describe(reading.faults.front(), options.source),
                 .reason = {},
                 .fix = "`reckon check` lists every fault."}};
  }
  std::vector<std::string> files{options.source};
  for (const GrainsConfig& set : scene.config.grains) {
    if (std::find(files.begin(), files.end(), set.library) == files.end()) {
      files.push_back(set.library);
    }
  }
  return {std::move(scene.grains), std::move(scene.read_shape), std::move(files)};
}

/// The shapes that occur, under new ids in the order of the old ones.
ShapeLibrary collect_shapes(std::vector<GrainState>& grains, const ReadShape& read_shape) {
  std::map<ShapeId, ShapeId> place;
  for (const GrainState& grain : grains) place[grain.shape] = {};
  ShapeLibrary library;
  std::set<std::string> names;
  for (auto& [old, now] : place) {
    now = ShapeId{static_cast<std::uint32_t>(library.size())};
    library.push_back(read_shape(old));
    std::string& name = library.back().name;
    if (!names.insert(name).second) {
      name += fmt::format("_{}", old.get());
      names.insert(name);
    }
  }
  for (GrainState& grain : grains) grain.shape = place[grain.shape];
  return library;
}

void write_contacts(const std::filesystem::path& file, const std::vector<NearPair>& pairs) {
  std::string text = "a,b,gap_m,x_m,y_m,z_m,nx,ny,nz\n";
  for (const NearPair& pair : pairs) {
    const Vec3& p = pair.point_world;
    const Vec3& n = pair.normal_world;
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", pair.a, pair.b, pair.gap, p.x, p.y, p.z,
                        n.x, n.y, n.z);
  }
  write_file(file, text);
}

/// Grays that a type cannot hold would all become its largest number, and the volume one gray.
void require_grays_fit(const ScannerSettings& settings, VoxelType type) {
  if (type == VoxelType::float32) return;
  const double most = type == VoxelType::uint8 ? 255 : 65535;
  for (const double gray : {settings.void_gray, settings.solid_gray}) {
    if (gray >= 0 && gray <= most) continue;
    throw Error{{.place = "--type",
                 .problem = fmt::format("{} cannot hold a gray value of {}", name_of(type), gray),
                 .reason = fmt::format("its numbers go from 0 to {}", most),
                 .fix = fmt::format("Give another --type, or --void-gray {} --solid-gray {}, say.",
                                    std::floor(0.15 * most), std::floor(0.6 * most))}};
  }
}

void scan(const ScanOptions& options, const CommandWords& words) {
  if (options.threads > 0) set_thread_count(options.threads);
  const auto type = voxel_type_named(options.type);
  ScannerSettings settings = options.scanner;
  settings.voxel = parse_length("--voxel", options.voxel);
  settings.partial_volume = !options.no_partial_volume;
  settings.validate();
  require_grays_fit(settings, *type);
  const Assembly assembly =
      std::filesystem::is_directory(options.source) ? open_run(options) : open_scene(options);
  const Scanner scanner{assembly.grains, assembly.read_shape, settings};
  const Workspace work{options.folder, options.memory, 0};
  const auto slabs = work.slabs(scanner.dims(), scanner.margin());
  std::vector<GrainState> grains = scanner.grains();
  const ShapeLibrary library = collect_shapes(grains, assembly.read_shape);
  const std::filesystem::path folder{options.folder};
  std::filesystem::create_directories(folder);
  const auto create = [&](const std::string& name, VoxelType numbers) {
    return create_volume(folder / name, scanner.dims(), settings.voxel, numbers);
  };
  const auto volume = create("volume." + options.format, *type);
  const auto labels = create("labels.h5", VoxelType::uint32);
  for (const Box& slab : slabs) {
    const ScannedLayers layers = scanner.scan(slab);
    volume->write_layers(layers.gray);
    labels->write_layers(to_gray(layers.labels));
  }
  volume->finish();
  labels->finish();
  save_library(folder / "library.h5", library, provenance_of(words, assembly.files));
  write_placement(folder / "placement.csv", grains);
  const auto contacts = near_surfaces(shape_views(library), grains, 0);
  write_contacts(folder / "contacts.csv", contacts);
  const auto& dims = scanner.dims();
  if (options.json) {
    JsonWriter json;
    json.begin_object();
    json.value("folder", options.folder);
    json.value("grains", grains.size());
    json.value("contacts", contacts.size());
    json.begin_array("voxels");
    for (const std::int32_t dim : dims) json.value({}, dim);
    json.end();
    json.value("voxel_m", settings.voxel);
    json.end();
    fmt::print("{}", json.text());
    return;
  }
  fmt::print("{}: {} grains in {} x {} x {} voxels\n", options.folder, human_count(grains.size()),
             dims[0], dims[1], dims[2]);
}

}  // namespace

void add_grains_scan(CLI::App& grains, const CommandWords& words) {
  CLI::App* command = grains.add_subcommand(
      "scan",
      "Simulate an X-ray scan of a run or a scene; the true grains are written beside the volume");
  command->footer("Example:\n  reckon grains scan settle.run --voxel 30um --out scan");
  auto options = std::make_shared<ScanOptions>();
  ScannerSettings& s = options->scanner;
  command->add_option("source", options->source, "Folder of a run, or a scene's .toml")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("--step", options->step, "Checkpoint of the run (default: the last)");
  command->add_option("--voxel", options->voxel, "Edge of a voxel, e.g. 30um")->required();
  command->add_option("--out", options->folder, "Output folder; created if missing")->required();
  command->add_option("--format", options->format, "File format of the volume")
      ->capture_default_str()
      ->check(CLI::IsMember({"h5", "npy", "raw", "mha", "nrrd", "tif"}));
  command->add_option("--type", options->type, "Number type of the volume")
      ->capture_default_str()
      ->check(CLI::IsMember({"uint8", "uint16", "float32"}));
  const auto number = [&](const char* name, auto& value, const char* what) {
    command->add_option(name, value, what)->capture_default_str();
  };
  number("--blur", s.blur, "Standard deviation of the point spread function [voxels]");
  number("--noise", s.noise, "Standard deviation of the noise / (solid - void)");
  number("--beam-hardening", s.beam_hardening,
         "Share of its gray value that solid on the axis loses");
  command->add_flag("--no-partial-volume", options->no_partial_volume,
                    "A voxel is solid if its centre is; its solid share is not used");
  number("--margin", s.margin, "Width of the void around the grains [voxels]");
  number("--void-gray", s.void_gray, "Gray value of void");
  number("--solid-gray", s.solid_gray, "Gray value of solid");
  number("--seed", s.seed, "Seed of the noise");
  ScanArtefacts& a = s.artefacts;
  number("--tube", a.tube, "Gray value of a tube around the grains / (solid - void); 0: no tube");
  number("--floor", a.floor,
         "Gray value of a floor under the grains / (solid - void); 0: no floor");
  command->add_option_function<double>(
      "--circle",
      [options](double gray) {
        options->scanner.artefacts.circle = 1;
        options->scanner.artefacts.circle_gray = gray;
      },
      "Gray value outside the largest circle of a layer (default: as inside)");
  number("--shading", a.shading,
         "Change of the gray value from one side to the other along x / (solid - void)");
  number("--gain-shading", a.gain_shading,
         "Relative change of the gray value from one side to the other along x");
  number("--cupping", a.cupping, "Share of their gray value that solid and void on the axis lose");
  number("--rings", a.rings, "Standard deviation of rings about the axis / (solid - void)");
  number("--mineral-share", a.mineral_share, "Share of the grains that are of another mineral");
  number("--mineral-gray", a.mineral_gray, "(gray value of this mineral - void) / (solid - void)");
  number("--crack-share", a.crack_share, "Share of the grains that have a crack");
  number("--crack-width", a.crack_width, "Width of the cracks [voxels]");
  command
      ->add_option("--memory", options->memory,
                   "Memory for the volume, e.g. 8GB; a larger volume is scanned in slabs (default: "
                   "half of the machine's memory)")
      ->transform(CLI::AsSizeValue(true));
  command->add_option("--threads", options->threads, "Threads (default: all)")
      ->check(CLI::Range(1, most_threads));
  command->add_flag("--json", options->json, "Answer in JSON");
  command->callback([=] { scan(*options, words); });
}

}  // namespace reckon::app
