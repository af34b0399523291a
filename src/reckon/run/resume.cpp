// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/resume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

/// Keys that may differ between sessions: they change no state and no row of the history (nor do
/// those of the tables `neighbor` and `parallel`). File names may differ too, since what the files
/// hold is compared by digests.
constexpr std::array free_keys{"title",
                               "time.steps",
                               "time.duration",
                               "time.stop_at_unbalanced_ratio",
                               "output.contacts",
                               "output.surfaces",
                               "output.ranks",
                               "output.checkpoint_interval",
                               "grains.library",
                               "grains.files.positions",
                               "grains.files.rotations",
                               "body.acceleration_file"};

struct Setting {
  std::string key;  ///< with its table, e.g. "wall.friction"
  std::string value;
};

/// The lines of a written scene that a resumed run must share.
std::vector<Setting> binding_settings(std::string_view scene) {
  std::vector<Setting> settings;
  std::string table;
  for (std::size_t begin = 0; begin < scene.size();) {
    const std::size_t end = std::min(scene.find('\n', begin), scene.size());
    const std::string_view line = scene.substr(begin, end - begin);
    begin = end + 1;
    if (line.starts_with('[')) {
      const std::size_t first = line.find_first_not_of('[');
      table = line.substr(first, line.find(']') - first);
      settings.push_back({table, {}});  // so that the number of walls counts
    } else if (const std::size_t equals = line.find(" = "); equals != std::string_view::npos) {
      const std::string name{line.substr(0, equals)};
      const std::string key = table.empty() ? name : fmt::format("{}.{}", table, name);
      if (key.starts_with("neighbor.") || key.starts_with("parallel.")) continue;
      if (std::find(free_keys.begin(), free_keys.end(), key) != free_keys.end()) continue;
      settings.push_back({key, std::string{line.substr(equals + 3)}});  // with its unit
    }
  }
  return settings;
}

[[noreturn]] void refuse(const std::string& place, std::string problem, std::string reason) {
  throw Error{{.place = place,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = "Resume with the scene and files of the run, or start a new run with another "
                      "--out."}};
}

}  // namespace

std::optional<Checkpoint> latest_checkpoint(const RunFolder& folder,
                                            const std::function<void(const std::string&)>& note) {
  std::vector<std::uint64_t> steps = folder.checkpoint_steps();
  std::reverse(steps.begin(), steps.end());
  for (const std::uint64_t step : steps) {
    const std::filesystem::path file = folder.checkpoint(step);
    try {
      return read_checkpoint(folder.own(file));
    } catch (const Error& error) {
      std::filesystem::rename(file, file.string() + ".damaged");
      if (note) note(fmt::format("{}. It is renamed to end in .damaged", error.what()));
    }
  }
  return std::nullopt;
}

void require_same_run(const Checkpoint& then, const Checkpoint& now, const std::string& place) {
  const std::vector<Setting> old_settings = binding_settings(then.scene);
  const std::vector<Setting> new_settings = binding_settings(now.scene);
  const std::size_t common = std::min(old_settings.size(), new_settings.size());
  for (std::size_t n = 0; n < common; ++n) {
    const Setting& a = old_settings[n];
    const Setting& b = new_settings[n];
    if (a.key == b.key && a.value == b.value) continue;
    if (a.key == b.key) {
      refuse(place, "the scene is not that of the run to be resumed",
             fmt::format("{} was {} and now is {}", a.key, a.value, b.value));
    }
    refuse(place, "the scene is not that of the run to be resumed",
           fmt::format("where it had {}, there now is {}", a.key, b.key));
  }
  if (old_settings.size() != new_settings.size()) {
    const auto& longer = old_settings.size() > common ? old_settings : new_settings;
    refuse(place, "the scene is not that of the run to be resumed",
           fmt::format("{} is in only one of them", longer[common].key));
  }
  if (then.shape_digests != now.shape_digests) {
    refuse(place, "the shape library is not that of the run to be resumed",
           then.shape_digests.size() == now.shape_digests.size()
               ? "its shapes have changed"
               : fmt::format("it had {} shapes and now has {}", then.shape_digests.size(),
                             now.shape_digests.size()));
  }
  if (then.acceleration_digest != now.acceleration_digest) {
    refuse(place, "the accelerations are not those of the run to be resumed",
           "the content of body.acceleration_file has changed");
  }
  const std::size_t grains = then.state.grains.size() + then.state.departed.size();
  if (grains != now.state.grains.size()) {
    refuse(place, "the number of grains is not that of the run to be resumed",
           fmt::format("it was {} and now is {}", grains, now.state.grains.size()));
  }
}

}  // namespace reckon
