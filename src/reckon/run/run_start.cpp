// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/run_start.hpp"

#include <span>
#include <utility>

#include "reckon/avatar/library_file.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/xxhash64.hpp"
#include "reckon/run/resume.hpp"
#include "reckon/scene/scene_writer.hpp"

namespace reckon {

std::string resolved_scene(const SceneConfig& config, const PreparedScene& prepared,
                           std::optional<std::uint64_t> steps) {
  SceneConfig resolved = config;
  resolved.time.step = prepared.time_step.step;
  resolved.time.duration.reset();
  resolved.time.steps = resolved.stages.empty() ? steps : std::nullopt;
  return write_scene(resolved);
}

Checkpoint first_checkpoint(const LoadedScene& scene, const PreparedScene& prepared) {
  Checkpoint checkpoint;
  checkpoint.state = prepared.initial;
  checkpoint.time_step = prepared.time_step.step;
  // Without its length: a run that is extended must leave the same checkpoints as a long one.
  checkpoint.scene = resolved_scene(scene.config, prepared, std::nullopt);
  for (const ShapeSummary& shape : scene.shapes) checkpoint.shape_digests.push_back(shape.digest);
  XxHash64 hash;
  hash.update(std::as_bytes(std::span{scene.own_accelerations}));
  checkpoint.acceleration_digest = hash.digest();
  return checkpoint;
}

RunStart ready_folder(const RunFolder& folder, const RunOptions& options, Checkpoint first,
                      const std::function<void(const std::string&)>& note) {
  const std::string place = folder.root().string();
  if (options.resume && folder.holds_run()) {
    folder.remove_leftovers();
    for (const auto& file : {folder.history(), folder.log(), folder.json()})
      static_cast<void>(folder.own(file));
    const bool has_checkpoints = !folder.checkpoint_steps().empty();
    std::optional<Checkpoint> found = latest_checkpoint(folder, note);
    if (found) {
      require_same_run(*found, first, place);
      found->scene = std::move(first.scene);  // settings that may differ may have changed
      return {std::move(*found), true};
    }
    if (has_checkpoints) {
      throw Error{{.place = place,
                   .problem = "there is no good checkpoint to resume from",
                   .reason = "all of them are damaged; they are renamed to end in .damaged",
                   .fix = "Put a good copy back, or start anew with --overwrite, which removes the "
                          "run's tables and fields."}};
    }
    if (note) note("there is no checkpoint to resume from: the run starts anew");
    folder.remove_run();
    return {std::move(first), false};
  }
  if (!folder.has_content()) return {std::move(first), false};
  if (!folder.holds_run()) {
    throw Error{{.place = place,
                 .problem = "this folder has files in it that are not of a run",
                 .reason = {},
                 .fix = "Give another one with --out."}};
  }
  if (!options.overwrite) {
    throw Error{{.place = place,
                 .problem = "this folder holds a run already",
                 .reason = {},
                 .fix = "Go on with it by --resume, replace it by --overwrite, or give another "
                        "folder with --out."}};
  }
  folder.remove_run();
  return {std::move(first), false};
}

}  // namespace reckon
