// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/domain/shape_store.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <exception>
#include <string>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/parallel/shared_memory.hpp"

namespace reckon {
namespace {

constexpr std::size_t alignment = 64;

/// Gives out consecutive, aligned parts of a block; without a block it only counts.
class Parts {
 public:
  explicit Parts(std::span<std::byte> block = {}) : block_{block} {}

  template <class Value>
  std::span<Value> take(std::uint64_t count) {
    const std::size_t first = used_;
    used_ += (count * sizeof(Value) + alignment - 1) / alignment * alignment;
    if (block_.empty()) return {};
    return {reinterpret_cast<Value*>(block_.data() + first), static_cast<std::size_t>(count)};
  }
  [[nodiscard]] std::size_t used() const { return used_; }

 private:
  std::span<std::byte> block_;
  std::size_t used_{0};
};

/// Where a shape's arrays lie: those of its storage, the others are empty.
struct ShapeParts {
  std::span<float> values;
  std::array<std::span<double>, 4> nodes;  // x, y, z, area
  std::span<LevelSetBand::Word> band;
  std::array<std::span<float>, 4> band_nodes;
  std::span<NodeCluster> clusters;
};

ShapeParts take_parts(Parts& parts, const ShapeOutline& outline) {
  ShapeParts shape;
  if (outline.storage == ShapeStorage::band) {
    shape.band = parts.take<LevelSetBand::Word>(outline.band_words);
    for (auto& column : shape.band_nodes) column = parts.take<float>(outline.nodes);
  } else {
    shape.values = parts.take<float>(outline.values());
    for (auto& column : shape.nodes) column = parts.take<double>(outline.nodes);
  }
  shape.clusters =
      parts.take<NodeCluster>((outline.nodes + nodes_per_cluster - 1) / nodes_per_cluster);
  return shape;
}

template <class Value, class Given>
void fill(std::span<Value> part, const std::vector<Given>& values) {
  if (part.size() != values.size()) {
    throw Error{{.problem = "a shape has changed while it was in use",
                 .reason = "its arrays have another length than at the start",
                 .fix = "Leave the shape library alone during a run."}};
  }
  std::transform(values.begin(), values.end(), part.begin(),
                 [](Given value) { return static_cast<Value>(value); });
}

void fill(const ShapeParts& parts, const Shape& shape) {
  const auto fill_nodes = [&](const auto& columns) {
    fill(columns[0], shape.nodes.x);
    fill(columns[1], shape.nodes.y);
    fill(columns[2], shape.nodes.z);
    fill(columns[3], shape.nodes.area);
  };
  if (shape.storage == ShapeStorage::band) {
    fill(parts.band, encode_band(shape.level_set));
    fill_nodes(parts.band_nodes);
  } else {
    fill(parts.values, shape.level_set.values);
    fill_nodes(parts.nodes);
  }
  fill(parts.clusters, shape.clusters);
}

template <class Number>
SurfaceNodesView nodes_in(const std::array<std::span<Number>, 4>& columns) {
  const auto column = [&](std::size_t c) { return std::span<const Number>{columns[c]}; };
  return {column(0), column(1), column(2), column(3)};
}

}  // namespace

struct ShapeStore::State {
  std::shared_ptr<const ShapeLibrary> library;
  Communicator machine;
  std::vector<ShapeOutline> outlines;
  Read read;
  std::vector<ShapeView> views;
  std::deque<LevelSetBand> bands;  // views point at them
  std::vector<bool> resident;
  std::vector<SharedMemory> blocks;
  std::uint64_t resident_bytes{0};

  void load(const std::vector<std::size_t>& wanted);
  void show(const ShapeParts& parts, ShapeView& view);
};

void ShapeStore::State::show(const ShapeParts& parts, ShapeView& view) {
  if (parts.band.empty()) {
    view.level_set.values = parts.values;
    view.set_nodes(nodes_in(parts.nodes));
  } else {
    view.level_set.band =
        &bands.emplace_back(view.level_set.dims, view.level_set.spacing, parts.band);
    view.set_nodes(nodes_in(parts.band_nodes));
  }
  view.clusters = parts.clusters;
}

/// Collective on the machine.
void ShapeStore::State::load(const std::vector<std::size_t>& wanted) {
  Parts counter;
  for (const std::size_t s : wanted) take_parts(counter, outlines[s]);
  SharedMemory block{machine, counter.used()};
  Parts parts{block.bytes()};
  std::vector<ShapeParts> places;
  places.reserve(wanted.size());
  for (const std::size_t s : wanted) places.push_back(take_parts(parts, outlines[s]));
  std::string problem;
  try {
    for (std::size_t n = 0; n < wanted.size(); ++n) {
      if (block.shared() && !machine.is_root()) break;
      fill(places[n], read(ShapeId{static_cast<std::uint32_t>(wanted[n])}));
    }
  } catch (const std::exception& error) {
    problem = error.what();
  }
  const bool failed = machine.any(!problem.empty());  // also: everything is written
  if (failed) {
    throw Error{{.problem = "the shapes that grains need could not be read",
                 .reason = problem.empty() ? "another rank of this machine says why" : problem,
                 .fix = {}}};
  }
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    show(places[n], views[wanted[n]]);
    resident[wanted[n]] = true;
  }
  resident_bytes += counter.used();
  blocks.push_back(std::move(block));
}

ShapeStore::ShapeStore() : state_{std::make_shared<State>()} {}

ShapeStore::ShapeStore(std::shared_ptr<const ShapeLibrary> library)
    : state_{std::make_shared<State>()} {
  state_->views.assign(library->begin(), library->end());
  for (const Shape& shape : *library) state_->resident_bytes += outline_of(shape).memory();
  state_->resident.assign(library->size(), true);
  state_->library = std::move(library);
}

ShapeStore::ShapeStore(const Communicator& ranks, std::vector<ShapeOutline> outlines, Read read)
    : state_{std::make_shared<State>()} {
  state_->machine = ranks.machine();
  state_->read = std::move(read);
  for (const ShapeOutline& outline : outlines) state_->views.emplace_back(outline);
  state_->resident.assign(outlines.size(), false);
  state_->outlines = std::move(outlines);
}

std::span<const ShapeView> ShapeStore::views() const { return state_->views; }

void ShapeStore::require(const std::vector<bool>& needed) {
  if (state_->library) return;
  std::vector<std::uint64_t> missing((needed.size() + 63) / 64, 0);
  bool some_missing = false;
  for (std::size_t s = 0; s < needed.size(); ++s) {
    if (!needed[s] || state_->resident[s]) continue;
    missing[s / 64] |= std::uint64_t{1} << (s % 64);
    some_missing = true;
  }
  if (!state_->machine.any(some_missing)) return;
  state_->machine.join(missing);
  std::vector<std::size_t> wanted;
  for (std::size_t s = 0; s < needed.size(); ++s) {
    if ((missing[s / 64] >> (s % 64) & 1U) != 0) wanted.push_back(s);
  }
  state_->load(wanted);
}

std::uint64_t ShapeStore::resident_bytes() const { return state_->resident_bytes; }

int ShapeStore::rank_on_machine() const { return state_->machine.rank(); }

std::uint64_t ShapeStore::resident_shapes() const {
  return static_cast<std::uint64_t>(
      std::count(state_->resident.begin(), state_->resident.end(), true));
}

}  // namespace reckon
