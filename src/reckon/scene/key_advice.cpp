// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/key_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include "reckon/scene/scene_schema.hpp"
#include "reckon/text/nearest_name.hpp"

namespace reckon {
namespace {

struct Symbol {
  std::string_view written;
  std::string_view meant;
};
/// What papers and other programs call the keys of a scene.
constexpr std::array usual_symbols{Symbol{"kn", "normal_stiffness"},
                                   Symbol{"k_n", "normal_stiffness"},
                                   Symbol{"stiffness", "normal_stiffness"},
                                   Symbol{"ks", "shear_stiffness"},
                                   Symbol{"k_s", "shear_stiffness"},
                                   Symbol{"kt", "shear_stiffness"},
                                   Symbol{"k_t", "shear_stiffness"},
                                   Symbol{"mu", "friction"},
                                   Symbol{"rho", "density"},
                                   Symbol{"young", "young_modulus"},
                                   Symbol{"youngs_modulus", "young_modulus"},
                                   Symbol{"E", "young_modulus"},
                                   Symbol{"nu", "poisson_ratio"},
                                   Symbol{"poisson", "poisson_ratio"},
                                   Symbol{"dt", "step"},
                                   Symbol{"timestep", "step"},
                                   Symbol{"time_step", "step"},
                                   Symbol{"g", "gravity"}};

}  // namespace

std::string advice_on_unknown_key(const std::string& name, std::span<const std::string> known) {
  if (const auto near = nearest_name(name, known)) return fmt::format("Did you mean `{}`?", *near);
  std::vector<std::string> homes;
  static const SceneSchema schema = scene_schema();
  for (const SchemaRow& row : schema.rows) {
    if (row.name != name) continue;
    const bool is_table = row.table.empty() && row.type.ends_with("table");
    homes.push_back(is_table            ? fmt::format("the top: write [{}]", name)
                    : row.table.empty() ? "the top, before any table"
                                        : table_header(row.table));
  }
  constexpr std::size_t most_homes = 4;
  if (!homes.empty() && homes.size() <= most_homes) {
    std::string all = homes[0];
    for (std::size_t n = 1; n < homes.size(); ++n) {
      all += (n + 1 < homes.size() ? ", " : " or ") + homes[n];
    }
    return fmt::format("`{}` belongs {} {}.", name, all.starts_with('[') ? "in" : "at", all);
  }
  for (const auto& [symbol, meant] : usual_symbols) {
    const bool is_known = std::find(known.begin(), known.end(), meant) != known.end();
    if (symbol == name && is_known) return fmt::format("Did you mean `{}`?", meant);
  }
  for (const std::string& other : known) {
    if (other.ends_with('_' + name)) return fmt::format("Did you mean `{}`?", other);
  }
  std::vector<std::string> all{known.begin(), known.end()};
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return fmt::format("Known here: {}.", fmt::join(all, ", "));
}

std::string advice_on_dimension(const SceneKey& key, const Quantity& quantity,
                                const std::string& text) {
  constexpr Dimension angle{.mass = 0, .length = 0, .time = 0, .angle = 1};
  if (key.name == "friction" && quantity.dimension == angle) {
    return fmt::format("A coefficient of friction is the tangent of an angle: write {:.4g}.",
                       std::tan(quantity.value));
  }
  if (key.unit == "1") return "Write a number without a unit.";
  if (quantity.dimension != Dimension{}) return fmt::format("Give it in {}.", key.unit);
  return fmt::format("Write \"{} {}\".", text, key.unit);
}

}  // namespace reckon
