// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace reckon {

/// The names in the folder of a run. docs/reference/run-folder.md has the content of each file.
///
///   scene.toml            the scene as given, to the letter
///   scene_resolved.toml   the same with every default and the time step filled in
///   history.csv           tables over time
///   grains.pvd contacts.pvd walls.pvd membrane.pvd cell.pvd surfaces.pvd     ParaView: open these
///   fields/grains_0000001000.vtp ...            what they list
///   checkpoints/step_0000001000.h5 ...
///   run.json run.log      what ran, where, how long
///   performance.json      time per phase and counters, for every rank
///   report.html           what `reckon report` made of it
///   paraview/             what `reckon paraview` made of it
class RunFolder {
 public:
  explicit RunFolder(std::filesystem::path root) : root_{std::move(root)} {}

  [[nodiscard]] const std::filesystem::path& root() const { return root_; }
  [[nodiscard]] std::filesystem::path scene() const { return root_ / "scene.toml"; }
  [[nodiscard]] std::filesystem::path resolved() const { return root_ / "scene_resolved.toml"; }
  [[nodiscard]] std::filesystem::path history() const { return root_ / "history.csv"; }
  [[nodiscard]] std::filesystem::path log() const { return root_ / "run.log"; }
  [[nodiscard]] std::filesystem::path json() const { return root_ / "run.json"; }
  [[nodiscard]] std::filesystem::path performance() const { return root_ / "performance.json"; }
  [[nodiscard]] std::filesystem::path report() const { return root_ / "report.html"; }
  [[nodiscard]] std::filesystem::path paraview() const { return root_ / "paraview"; }
  [[nodiscard]] std::filesystem::path index(std::string_view kind) const;
  /// `kind` is grains, contacts, walls, membrane, cell, surfaces or strain; the name is relative to
  /// the root.
  [[nodiscard]] static std::string field_name(std::string_view kind, std::uint64_t step);
  [[nodiscard]] std::filesystem::path checkpoint(std::uint64_t step) const;

  /// Steps of all checkpoints by name, ascending.
  [[nodiscard]] std::vector<std::uint64_t> checkpoint_steps() const;
  /// Steps of all field files of a kind, ascending.
  [[nodiscard]] std::vector<std::uint64_t> field_steps(std::string_view kind) const;

  /// The same file, to be read. Throws Error when it is there and is no plain file: a run writes
  /// nothing else, reading a pipe would block forever, and a link that leads out of the folder may
  /// expose private files. (`fields` and `checkpoints` themselves may be links to another disk.)
  [[nodiscard]] std::filesystem::path own(std::filesystem::path file) const;

  /// Whether it holds anything at all, empty folders aside.
  [[nodiscard]] bool has_content() const;
  /// Whether a run was begun in it.
  [[nodiscard]] bool holds_run() const;

  /// Makes the folder itself.
  void create() const;
  /// Makes what is to hold the files in it.
  void create_subfolders() const;
  /// Removes the files of a run, and nothing else: no file of another name, and none in a folder
  /// that a link points to. The link itself is removed.
  void remove_run() const;
  /// Removes what write_paraview_state wrote, and nothing else.
  void remove_paraview() const;
  /// Removes the temporary files of a run's files, which a killed run may have left.
  void remove_leftovers() const;
  /// Removes a saved file, unless it lies behind a link.
  void remove_field(std::string_view kind, std::uint64_t step) const;

 private:
  std::filesystem::path root_;
};

/// Holds a folder for one process; another that tries gets an Error. Ends with the process, so a
/// crash leaves nothing locked.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_{-1};
};

}  // namespace reckon
