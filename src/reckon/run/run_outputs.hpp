// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/output/fields.hpp"
#include "reckon/output/history.hpp"
#include "reckon/output/output_schedule.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon {

/// The tables and pictures of a run in progress. When a run is resumed at a step, what lies behind
/// that step, and what only the end of the earlier session had written, is removed first: so the
/// files become those of a run without a break.
class RunOutputs {
 public:
  RunOutputs(RunFolder folder, const LoadedScene& scene, const PreparedScene& prepared,
             OutputSchedule schedule, std::optional<std::uint64_t> resumed_at);

  void append_history(const HistoryRow& row);
  /// Which rows up to the step of resuming are not in the history, in words; empty: none lacks. A
  /// full disk or a power failure may have kept them.
  [[nodiscard]] const std::string& lost_rows() const { return lost_rows_; }
  /// See HistoryFile::sync.
  void sync_history() const { history_.sync(); }
  void write_fields(const FieldsAtStep& fields);

  /// Whether the last row or files written are those of this step.
  [[nodiscard]] bool history_has(std::uint64_t step) const { return last_row_ == step; }
  [[nodiscard]] bool fields_have(std::uint64_t step) const { return last_frame_ == step; }

 private:
  void add_to_index(std::string_view kind, std::uint64_t step, std::vector<PvdEntry>& entries);
  void take_over(std::string_view kind, std::uint64_t resumed_at, std::vector<PvdEntry>& entries);

  RunFolder folder_;
  OutputConfig config_;
  OutputSchedule schedule_;  // as of the start of the session
  std::vector<ShapeSummary> shapes_;
  ShapeStore::Read read_shape_;
  std::vector<Wall> walls_;
  std::optional<WallId> mould_;
  double density_;
  double time_step_;
  HistoryFile history_;
  std::string lost_rows_;
  std::vector<PvdEntry> grains_;
  std::vector<PvdEntry> contacts_;
  std::vector<PvdEntry> surfaces_;
  std::vector<PvdEntry> membrane_;
  std::vector<PvdEntry> wall_polygons_;
  std::vector<PvdEntry> cell_;
  std::vector<TriangleMesh> surface_meshes_;  // made when first needed
  std::optional<std::uint64_t> last_row_;
  std::optional<std::uint64_t> last_frame_;
};

}  // namespace reckon
