// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "reckon/scene/scene_key.hpp"
#include "reckon/text/units.hpp"

/// Advice on the keys of a scene: what to write instead, as a sentence.
namespace reckon {

/// The likely meaning of an unknown key: a similar one among those of its table, else the same word
/// in other tables, else a longer name in its table.
[[nodiscard]] std::string advice_on_unknown_key(const std::string& name,
                                                std::span<const std::string> known);

/// On `text`, a quantity that does not fit the unit of its key.
[[nodiscard]] std::string advice_on_dimension(const SceneKey& key, const Quantity& quantity,
                                              const std::string& text);

}  // namespace reckon
