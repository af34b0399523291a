// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exit_codes.hpp"
#include "grains_parts.hpp"
#include "progress.hpp"
#include "reckon/avatar/degree_table.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/shape_sources.hpp"
#include "reckon/avatar/shape_statistics.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/text/free_memory.hpp"
#include "reckon/text/human.hpp"
#include "thread_limit.hpp"

namespace reckon::app {
namespace {

/// What every source has in common.
struct MakeOptions {
  std::string output;
  double voxels_per_diameter{20};
  std::string voxel;
  double node_spacing{0.1};
  std::uint32_t nodes{0};
  int threads{0};
  ShapeStorage storage{ShapeStorage::full};
};

std::shared_ptr<MakeOptions> add_make_options(CLI::App& command) {
  auto options = std::make_shared<MakeOptions>();
  command.add_option("-o,--output", options->output, "Shape library to write (.h5)")->required();
  auto* per_diameter =
      command
          .add_option("--voxels-per-diameter", options->voxels_per_diameter,
                      "Grid spacings along the diameter of the sphere of equal volume")
          ->capture_default_str()
          ->check(CLI::Range(10.0, 1000.0));
  command.add_option("--voxel", options->voxel, "Grid spacing as a length, e.g. 25um")
      ->excludes(per_diameter);
  auto* spacing = command
                      .add_option("--node-spacing", options->node_spacing,
                                  "Square root of the mean area of a node, in diameters")
                      ->capture_default_str()
                      ->check(CLI::Range(0.005, 0.5));
  command.add_option("--nodes", options->nodes, "Number of surface nodes of each grain")
      ->excludes(spacing)
      ->check(CLI::Range(4, 10000000));
  add_storage_option(command, options->storage);
  command.add_option("--threads", options->threads, "Threads (default: all)")
      ->check(CLI::Range(1, most_threads));
  return options;
}

ShapeResolution resolution_of(const MakeOptions& options) {
  ShapeResolution resolution;
  resolution.voxels_per_diameter = options.voxels_per_diameter;
  resolution.node_spacing = options.node_spacing;
  resolution.storage = options.storage;
  if (!options.voxel.empty()) resolution.voxel_size = parse_length("--voxel", options.voxel);
  if (options.nodes > 0) resolution.node_count = options.nodes;
  return resolution;
}

/// Grids and nodes are refused before they fill the memory. What a node takes, with what spreads
/// the nodes over the surface, was measured.
void require_memory_for(const ShapeResolution& resolution) {
  constexpr std::uint64_t bytes_of_node = 2600;
  constexpr std::uint64_t bytes_of_voxel = 2 * sizeof(double);
  constexpr double grid_over_diameter = 1.4;
  if (resolution.node_count) {
    require_memory(bytes_of_node * *resolution.node_count,
                   fmt::format("{} nodes on a grain", *resolution.node_count), "Lower --nodes.");
  }
  if (resolution.voxel_size) return;  // the size of the grains is not known yet
  const double edge = grid_over_diameter * resolution.voxels_per_diameter;
  require_memory(static_cast<std::uint64_t>(edge * edge * edge) * bytes_of_voxel,
                 fmt::format("a grid of {:g} voxels per diameter", resolution.voxels_per_diameter),
                 "Lower --voxels-per-diameter.");
}

/// Prints the faults of some of the sources. That of a single one is thrown instead.
void report_faults(const std::vector<Error>& faults, std::size_t sources,
                   const std::string& library) {
  if (sources == 1) throw Error{faults.front().text()};
  for (const Error& fault : faults) fmt::print(stderr, "reckon: error: {}\n", fault.what());
  const bool none_left = faults.size() == sources;
  fmt::print(stderr, "reckon: {} of {} sources have faults; {}\n", faults.size(), sources,
             none_left ? library + " is not written" : "the others are in " + library);
  throw CLI::RuntimeError{input_at_fault};
}

void make(const std::vector<ShapeSource>& sources, const MakeOptions& options,
          const Provenance& provenance) {
  if (options.threads > 0) set_thread_count(options.threads);
  const ShapeResolution resolution = resolution_of(options);
  // What forbids the output is found before the work, not after it.
  (void)PendingFile{options.output};
  require_replaceable_library(options.output);
  require_memory_for(resolution);
  double seconds = 0;
  std::vector<Error> faults;
  {
    CountDisplay display{"grains"};
    faults = build_library_file(options.output, sources, resolution, provenance,
                                [&](std::size_t done) { display.show(done, sources.size()); });
    seconds = display.seconds();
  }
  const std::size_t made = sources.size() - faults.size();
  if (made > 0) {
    fmt::print("{}: {} {}, {}, {}\n", options.output, human_count(made),
               made == 1 ? "grain" : "grains",
               human_bytes(std::filesystem::file_size(options.output)), human_duration(seconds));
  }
  if (!faults.empty()) report_faults(faults, sources.size(), options.output);
}

/// --merge takes a length or none.
void add_mesh_options(CLI::App& command, MeshTreatment& treatment, std::string& merge) {
  static const std::map<std::string, bool> parts{{"refuse", false}, {"split", true}};
  command
      .add_option(
          "--parts", treatment.split,
          "If a file has several parts: refuse it, or split it into grains NAME_1, NAME_2, ...")
      ->transform(CLI::CheckedTransformer(parts, CLI::ignore_case))
      ->default_str("refuse");
  command
      .add_option("--merge", merge,
                  "Join corners along open edges that differ by rounding, or by up to this length")
      ->type_name("[LENGTH]")
      ->expected(0, 1);
  command.add_flag("--repair", treatment.repair,
                   "Close a scanned surface: join corners, remove loose fragments, turn faces "
                   "outward, close holes; the changes are printed");
}

void add_from_mesh(CLI::App& grains, const CommandWords& words) {
  CLI::App* command =
      grains.add_subcommand("from-mesh", "Make grains from closed surfaces: STL, OBJ or PLY files");
  command->footer(
      "Example:\n  reckon grains from-mesh scans/*.stl --unit mm -o scans.h5\n"
      "  reckon grains from-mesh heap.obj --unit mm --parts split --repair -o heap.h5");
  struct Options {
    std::vector<std::string> files;
    std::string unit;
    std::string merge;
    MeshTreatment treatment;
  };
  auto own = std::make_shared<Options>();
  command->add_option("files", own->files, "Files, one grain each; a grain is named after its file")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--unit", own->unit, "Unit of the numbers in the files, e.g. mm")->required();
  add_mesh_options(*command, own->treatment, own->merge);
  const auto options = add_make_options(*command);
  command->callback([=] {
    const double metres = parse_length_unit("--unit", own->unit);
    MeshTreatment treatment = own->treatment;
    treatment.merge = command->count("--merge") > 0;
    if (!own->merge.empty()) treatment.merge_distance = parse_length("--merge", own->merge);
    std::vector<ShapeSource> sources;
    for (const std::string& file : own->files) {
      const MeshFileSources made = mesh_file_sources(file, metres, treatment);
      for (const std::string& note : made.notes) fmt::print("{}: {}\n", file, note);
      sources.insert(sources.end(), made.sources.begin(), made.sources.end());
    }
    make(sources, *options, provenance_of(words, own->files));
  });
}

void add_from_grid(CLI::App& grains, const CommandWords& words) {
  CLI::App* command = grains.add_subcommand(
      "from-grid", "Make grains from signed-distance grids in LAMMPS-style text files");
  command->footer("Example:\n  reckon grains from-grid clay.txt --unit um -o clay.h5");
  auto files = std::make_shared<std::vector<std::string>>();
  auto unit = std::make_shared<std::string>();
  command->add_option("files", *files, "Files, one grain each; a grain is named after its file")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--unit", *unit, "Unit of the numbers in the files, e.g. mm")->required();
  const auto options = add_make_options(*command);
  command->callback([=] {
    const double metres = parse_length_unit("--unit", *unit);
    std::vector<ShapeSource> sources;
    for (const std::string& file : *files) sources.push_back(level_set_file_source(file, metres));
    make(sources, *options, provenance_of(words, *files));
  });
}

void add_from_harmonics(CLI::App& grains, const CommandWords& words) {
  CLI::App* command = grains.add_subcommand(
      "from-harmonics", "Make grains from spherical-harmonic coefficients, lines `n m Re Im`");
  command->footer(
      "Example:\n  reckon grains from-harmonics anm/*.dat --unit mm --degree-table geometry.dat "
      "-o rock.h5");
  struct Options {
    std::vector<std::string> files;
    std::string unit;
    std::uint32_t degree{0};
    std::string table;
  };
  auto own = std::make_shared<Options>();
  command->add_option("files", own->files, "Files, one grain each; a grain is named after its file")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--unit", own->unit, "Unit of the coefficients, e.g. mm")->required();
  auto* degree =
      command->add_option("--degree", own->degree, "Use coefficients up to this degree only")
          ->check(CLI::Range(1, 512));
  command
      ->add_option("--degree-table", own->table,
                   "Table with the degree of each file, in its columns Name and Nnn")
      ->excludes(degree)
      ->check(CLI::ExistingFile);
  const auto options = add_make_options(*command);
  command->callback([=] {
    const double metres = parse_length_unit("--unit", own->unit);
    std::map<std::string, std::uint32_t> degrees;
    if (!own->table.empty()) degrees = parse_degree_table(read_file(own->table), own->table);
    std::vector<ShapeSource> sources;
    for (const std::string& file : own->files) {
      std::optional<std::uint32_t> limit;
      if (own->degree > 0) limit = own->degree;
      if (!own->table.empty()) {
        const auto found = degrees.find(std::filesystem::path{file}.filename().string());
        if (found == degrees.end()) {
          throw Error{{.place = own->table,
                       .problem = "has no line for " + file,
                       .reason = "the column Name holds file names without folders",
                       .fix = "Add a line, or use --degree."}};
        }
        limit = found->second;
      }
      sources.push_back(harmonics_file_source(file, metres, limit));
    }
    std::vector<std::string> read = own->files;
    if (!own->table.empty()) read.push_back(own->table);
    make(sources, *options, provenance_of(words, read));
  });
}

struct SolidOptions {
  std::vector<std::string> sphere;
  std::vector<std::string> ellipsoid;
  std::vector<std::string> superellipsoid;
  std::vector<std::string> box;
  std::vector<std::string> cylinder;
};

std::vector<ShapeSource> solid_sources(const SolidOptions& own) {
  std::vector<ShapeSource> sources;
  const auto add_all = [&](const std::vector<std::string>& texts, const std::string& kind,
                           std::size_t lengths, std::size_t numbers, auto&& mesh) {
    for (std::size_t n = 0; n < texts.size(); ++n) {
      const auto v = parse_lengths("--" + kind, texts[n], lengths, numbers);
      double extent = 0;
      for (std::size_t l = 0; l < lengths; ++l) extent = std::max(extent, 2 * v[l]);
      const std::string name = texts.size() == 1 ? kind : fmt::format("{}_{}", kind, n + 1);
      sources.push_back(
          solid_source(name, extent, [v, mesh](double edge) { return mesh(v, edge); }));
    }
  };
  using Values = std::vector<double>;
  add_all(own.sphere, "sphere", 1, 1,
          [](const Values& v, double edge) { return sphere_mesh(v[0], edge); });
  for (std::size_t n = 0; n < sources.size(); ++n) {
    sources[n].sphere_radius = parse_lengths("--sphere", own.sphere[n], 1, 1)[0];
  }
  add_all(own.ellipsoid, "ellipsoid", 3, 3, [](const Values& v, double edge) {
    return ellipsoid_mesh({v[0], v[1], v[2]}, edge);
  });
  add_all(own.superellipsoid, "superellipsoid", 3, 5, [](const Values& v, double edge) {
    return superellipsoid_mesh({{v[0], v[1], v[2]}, v[3], v[4]}, edge);
  });
  for (std::size_t n = 0; n < own.superellipsoid.size(); ++n) {
    // Only edges along the coordinate planes are edges of its mesh.
    const auto v = parse_lengths("--superellipsoid", own.superellipsoid[n], 3, 5);
    if (std::min(v[3], v[4]) >= 1) continue;
    sources[sources.size() - own.superellipsoid.size() + n].kind = SurfaceKind::curved;
  }
  add_all(own.box, "box", 3, 3, [](const Values& v, double edge) {
    return box_mesh({v[0] / 2, v[1] / 2, v[2] / 2}, edge);
  });
  add_all(own.cylinder, "cylinder", 2, 2,
          [](const Values& v, double edge) { return cylinder_mesh(v[0], v[1] / 2, edge); });
  return sources;
}

void add_solid(CLI::App& grains, const CommandWords& words) {
  CLI::App* command =
      grains.add_subcommand("solid", "Make grains of simple form; each option can be repeated");
  command->footer("Example:\n  reckon grains solid --sphere 1mm --box 2mm,1.5mm,1mm -o solids.h5");
  auto own = std::make_shared<SolidOptions>();
  const auto add = [&](const char* name, std::vector<std::string>& values, const char* form,
                       const char* what) {
    command->add_option(name, values, what)
        ->type_name(form)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  add("--sphere", own->sphere, "R", "Radius, e.g. 1mm");
  add("--ellipsoid", own->ellipsoid, "A,B,C", "Half axes, e.g. 1mm,0.8mm,0.5mm");
  add("--superellipsoid", own->superellipsoid, "A,B,C,EXY,EZ",
      "Half extents and the exponents across and along z (1: round, towards 0: boxy)");
  add("--box", own->box, "LX,LY,LZ", "Edge lengths");
  add("--cylinder", own->cylinder, "R,L", "Radius and length");
  const auto options = add_make_options(*command);
  command->callback([=] {
    const auto sources = solid_sources(*own);
    if (sources.empty()) {
      throw Error{{.place = "reckon grains solid",
                   .problem = "no solid is given",
                   .reason = {},
                   .fix = "Give one, for example --sphere 1mm."}};
    }
    make(sources, *options, provenance_of(words, {}));
  });
}

struct GenerateOptions {
  std::uint32_t count{0};
  std::uint64_t seed{1};
  std::string median{"1mm"};
  std::string smallest;
  std::string largest;
  std::string like;
  GrainStatistics statistics;
};

/// The statistics of the generator that make grains like those of a library; prints its progress.
GrainStatistics statistics_of(const std::string& library, std::uint64_t seed) {
  const ShapeLibrary model = entries_of(LibrarySource{library});
  fmt::print("trial      roundness  convexity\n");
  const GrainStatistics s =
      match_statistics(model, seed, {}, [](double roundness, double convexity) {
        fmt::print("           {:9.4f}  {:9.4f}\n", roundness, convexity);
      });
  fmt::print(
      "matched    --d50 {:.6g}m --log-deviation {:.4g} --elongation {:.4g} --elongation-deviation "
      "{:.4g} --flatness {:.4g} --flatness-deviation {:.4g} --roundness {:.4g} "
      "--roundness-deviation {:.4g} --roughness {:.4g}\n",
      s.median_diameter, s.log_deviation, s.elongation.mean, s.elongation.deviation,
      s.flatness.mean, s.flatness.deviation, s.roundness.mean, s.roundness.deviation, s.roughness);
  return s;
}

void add_generate(CLI::App& grains, const CommandWords& words) {
  CLI::App* command =
      grains.add_subcommand("generate", "Make random sand-like grains with given statistics");
  command->footer("Example:\n  reckon grains generate --count 40 --seed 7 --d50 0.3mm -o sand.h5");
  auto own = std::make_shared<GenerateOptions>();
  GrainStatistics& s = own->statistics;
  command->add_option("--count", own->count, "Number of grains")
      ->required()
      ->check(CLI::Range(1U, 10000000U));
  command
      ->add_option("--seed", own->seed,
                   "Seed of the random numbers; the same seed gives the same grains")
      ->capture_default_str();
  const auto number = [&](const char* name, auto& value, const char* what) {
    command->add_option(name, value, what)->capture_default_str();
  };
  number("--d50", own->median, "Median diameter of the sphere of equal volume");
  number("--log-deviation", s.log_deviation, "Standard deviation of ln(diameter)");
  command->add_option("--smallest", own->smallest, "Min diameter");
  command->add_option("--largest", own->largest, "Max diameter");
  number("--elongation", s.elongation.mean, "Mean width / length");
  number("--elongation-deviation", s.elongation.deviation, "Standard deviation of width / length");
  number("--flatness", s.flatness.mean, "Mean thickness / width");
  number("--flatness-deviation", s.flatness.deviation, "Standard deviation of thickness / width");
  number("--fewest-faces", s.fewest_faces, "Min number of faces cut into a grain");
  number("--most-faces", s.most_faces, "Max number of faces cut into a grain");
  number("--face-irregularity", s.face_irregularity, "Depth of a cut face / radius");
  number("--roundness", s.roundness.mean, "Mean corner radius / inscribed radius");
  number("--roundness-deviation", s.roundness.deviation, "Standard deviation of the roundness");
  number("--roughness", s.roughness, "Root mean square of the surface's relief / radius");
  number("--hurst", s.hurst, "Hurst exponent of the relief; a higher value is smoother");
  number("--lowest-degree", s.lowest_degree,
         "Degree of the longest wave of the relief, 2 pi radius / degree");
  number("--highest-degree", s.highest_degree, "Degree of the shortest wave of the relief");
  auto* like = command->add_option(
      "--like", own->like, "Match the statistics of this library's grains instead of giving them");
  for (CLI::Option* option : command->get_options()) {
    const std::string name = option->get_name();
    if (name != "--count" && name != "--seed" && name != "--like" && name != "--help") {
      like->excludes(option);
    }
  }
  const auto options = add_make_options(*command);
  command->callback([=] {
    if (options->threads > 0) set_thread_count(options->threads);
    GrainStatistics statistics = own->statistics;
    if (!own->like.empty()) {
      statistics = statistics_of(own->like, own->seed);
    } else {
      statistics.median_diameter = parse_length("--d50", own->median);
      if (!own->smallest.empty()) {
        statistics.smallest_diameter = parse_length("--smallest", own->smallest);
      }
      if (!own->largest.empty()) {
        statistics.largest_diameter = parse_length("--largest", own->largest);
      }
    }
    statistics.validate();
    std::vector<ShapeSource> sources;
    for (std::uint32_t n = 0; n < own->count; ++n) {
      sources.push_back(generated_source(statistics, own->seed, n));
    }
    std::vector<std::string> read;
    if (!own->like.empty()) read.push_back(own->like);
    make(sources, *options, provenance_of(words, read));
  });
}

void add_spheres(CLI::App& grains, const CommandWords& words) {
  CLI::App* command = grains.add_subcommand(
      "spheres", "Make a sphere of the same name and volume for each grain of a library");
  command->footer(
      "Two scenes that differ only in these libraries have grains of the same masses. The "
      "difference\n"
      "between their results is the effect of shape.\n\nExample:\n  reckon grains spheres sand.h5 "
      "-o spheres.h5");
  auto library = std::make_shared<std::string>();
  command->add_option("library", *library, "Shape library (.h5) or legacy folder")->required();
  const auto options = add_make_options(*command);
  command->callback([=] {
    const LibrarySource grains_of{*library};
    std::vector<ShapeSource> sources;
    for (std::size_t n = 0; n < grains_of.size(); ++n) {
      const ShapeSummary shape = grains_of.summary(n);
      sources.push_back(equal_sphere_source(shape.name, shape.outline.mass.volume));
    }
    make(sources, *options, provenance_of(words, {*library}));
  });
}

}  // namespace

void add_grains_sources(CLI::App& grains, const CommandWords& words) {
  add_generate(grains, words);
  add_solid(grains, words);
  add_spheres(grains, words);
  add_from_mesh(grains, words);
  add_from_harmonics(grains, words);
  add_from_grid(grains, words);
}

}  // namespace reckon::app
