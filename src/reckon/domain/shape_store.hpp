// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "reckon/core/id.hpp"
#include "reckon/parallel/communicator.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// The shapes of a simulation as kernels read them. Masses and radii of all shapes are there from
/// the start; grids and nodes are read when a grain of this machine first needs them, once per
/// machine, into memory that its ranks share. Copies mean the same store.
class ShapeStore {
 public:
  using Read = std::function<Shape(ShapeId)>;

  /// No shapes.
  ShapeStore();
  /// All shapes are already in this process.
  ShapeStore(std::shared_ptr<const ShapeLibrary> library);  // NOLINT(google-explicit-constructor)
  /// Collective. `outlines` are the same on all ranks; `read` is called on one rank per machine.
  ShapeStore(const Communicator& ranks, std::vector<ShapeOutline> outlines, Read read);

  /// By ShapeId. The views stay where they are; shapes that were never required have no grid and no
  /// nodes.
  [[nodiscard]] std::span<const ShapeView> views() const;

  /// Collective. Makes sure that the shapes with a true flag are whole on this rank. Throws what
  /// `read` throws, on all ranks of that machine.
  void require(const std::vector<bool>& needed);

  /// Memory of grids, nodes and clusters of the shapes that are loaded on this machine [bytes].
  [[nodiscard]] std::uint64_t resident_bytes() const;
  [[nodiscard]] std::uint64_t resident_shapes() const;
  /// This rank's number among those of its machine, from 0.
  [[nodiscard]] int rank_on_machine() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace reckon
