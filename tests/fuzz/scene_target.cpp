// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <stdexcept>

#include "reckon/core/error.hpp"
#include "reckon/scene/scene_reader.hpp"
#include "reckon/scene/scene_writer.hpp"
#include "scratch.hpp"
#include "targets.hpp"

namespace reckon::fuzz {
namespace {

constexpr const char* filled_scene = R"(title = "Settling"
seed = 7
[material]
density = "2.65 g/cm^3"
friction = 0.5
[contact]
law = "linear"
normal_stiffness = "30 kN/m"
restitution = 0.6
node_cap = 16
master = "smaller"
[body]
gravity = [0, 0, "-9.81 m/s^2"]
damping = "1.5 1/s"
[[grains]]
library = "sand.h5"
fill = { count = 500, box = { low = [0, 0, 0], high = ["2 cm", "20 mm", 0.05] } }
[[wall]]
name = "box"
box = { low = [0, 0, 0], high = [0.02, 0.02, 0.1], open_top = true }
[[wall]]
name = "plate"
plane = { point = [0, 0, 0.1], normal = [0, 0, -1] }
friction = 0.8
motion = { velocity = [0, 0, "-1 mm/s"], start = "10 ms", stop = 2 }
[time]
duration = "0.5 s"
[output]
surfaces = true
)";

constexpr const char* placed_scene = R"(material.friction = 0.1
contact.normal_stiffness = 1e9
time.duration = 0.1
[[grains]]
library = "sand.h5"
files = { positions = "table.dat", rotations = "table.dat" }
[[grains]]
library = "sand.h5"
fill = { count = 3, cylinder = { point = [0, 0, 0], axis = [1, 2, 3], radius = 1, low = 0, high = 1 } }
[[grains]]
library = "sand.h5"
place = [
  { position = [0, 0, 0], orientation = [0, 1, 0, 0] },
  { position = [0, 0, 2], rotation = { axis = [0, 0, 2], angle = "90 deg" }, fixed = true },
]
[[wall]]
name = "tube"
cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = 0.5 }
)";

/// All faults must have a text and a place; without faults the scene must survive writing and
/// reading to the last bit.
void read(const std::string& input, const std::filesystem::path& folder) {
  const SceneReading reading = read_scene_text(input, folder);
  std::string faults;
  for (const SceneFault& fault : reading.faults) {
    if (fault.problem.empty()) throw std::logic_error("a fault without text");
    faults += describe(fault, "scene.toml") + "\n";
  }
  if (!faults.empty()) throw Error{{.problem = faults}};

  const std::string written = write_scene(reading.config);
  const SceneReading again = read_scene_text(written, folder);
  if (!again.faults.empty()) {
    throw std::logic_error("not read back: " + describe(again.faults[0], "written") + written);
  }
  const std::string rewritten = write_scene(again.config);
  if (rewritten != written) {
    throw std::logic_error("changes when read back:\n" + written + "\nbecomes:\n" + rewritten);
  }
}

}  // namespace

Target scene_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  folder->write("sand.h5", "");
  folder->write("table.dat", "");
  return {.name = "scene",
          .valid_inputs =
              [] {
                return std::vector<std::string>{filled_scene, placed_scene};
              },
          .read = [folder](const std::string& input) { read(input, folder->path()); },
          .cost = 4};
}

}  // namespace reckon::fuzz
