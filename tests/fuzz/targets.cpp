// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "targets.hpp"

#include <utility>

#include "target.hpp"

namespace reckon::fuzz {

std::vector<Target> all_targets() {
  std::vector<Target> all{scene_target(),
                          stl_target(),
                          obj_target(),
                          ply_target(),
                          spherical_harmonics_target(),
                          degree_table_target(),
                          legacy_morphology_target(),
                          legacy_shape_target(),
                          legacy_positions_target(),
                          legacy_rotations_target(),
                          level_set_text_target(),
                          shape_library_target(),
                          checkpoint_target(),
                          fields_target(),
                          membrane_target(),
                          history_target(),
                          number_table_target(),
                          placement_target(),
                          volume_npy_target(),
                          volume_raw_target()};
  for (Target& target : image_targets()) all.push_back(std::move(target));
  return all;
}

}  // namespace reckon::fuzz
