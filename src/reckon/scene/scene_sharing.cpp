// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/scene_sharing.hpp"

#include <memory>
#include <string>
#include <utility>

#include "reckon/avatar/shape_catalog.hpp"
#include "reckon/domain/packing.hpp"
#include "reckon/scene/scene_reader.hpp"
#include "reckon/scene/scene_writer.hpp"
#include "reckon/simulation/time_step.hpp"

namespace reckon {
namespace {

Bytes packed(const LoadedScene& scene) {
  SceneConfig config = scene.config;
  // The rule for the time step needs the grains.
  config.time.step = choose_time_step(scene.config, scene.grains, scene.shapes).step;
  std::vector<ShapeOutline> outlines;
  for (const ShapeSummary& shape : scene.shapes) outlines.push_back(shape.outline);
  Bytes bytes;
  pack<char>(bytes, write_scene(config));
  pack(bytes, *config.time.step);
  pack<ShapeOutline>(bytes, outlines);
  pack<Vec3>(bytes, scene.own_accelerations);
  return bytes;
}

/// Opens the libraries when the first shape is needed: most ranks read none.
ShapeStore::Read lazy_reader(const std::vector<GrainsConfig>& sets) {
  auto catalog = std::make_shared<ShapeCatalog>();
  return [catalog, sets](ShapeId shape) {
    if (catalog->size() == 0) {
      for (const GrainsConfig& set : sets) catalog->add(set.library, set.voxel);
    }
    return catalog->read(shape);
  };
}

LoadedScene unpacked(const Bytes& bytes) {
  Unpacker message{bytes};
  const auto text = message.take_all<char>();
  LoadedScene scene;
  scene.config = read_scene_text(std::string{text.begin(), text.end()}, "/").config;
  scene.config.time.step = message.take<double>();
  for (const ShapeOutline& outline : message.take_all<ShapeOutline>()) {
    scene.shapes.push_back({.name = {}, .outline = outline});
  }
  scene.own_accelerations = message.take_all<Vec3>();
  scene.read_shape = lazy_reader(scene.config.grains);
  return scene;
}

}  // namespace

LoadedScene share_scene(const LoadedScene& scene, const Communicator& ranks) {
  if (ranks.size() == 1) return scene;
  const Bytes bytes = ranks.broadcast(ranks.is_root() ? packed(scene) : Bytes{});
  return ranks.is_root() ? scene : unpacked(bytes);
}

}  // namespace reckon
