// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "reckon/boundary/wall.hpp"
#include "reckon/contact/contact_counters.hpp"
#include "reckon/contact/touch.hpp"
#include "reckon/contact/verlet_node_list.hpp"
#include "reckon/grains/grain_frame.hpp"

namespace reckon {

/// The nodes of one grain that are near one wall: what NearList is for two grains. A wall's
/// distance has slope one, so it is a clearance as it stands. The path length is that of the grain
/// plus that of the wall.
class NearWall {
 public:
  /// As NearList::find_touches; the same bits as find_wall_touches.
  double find_touches(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                      double path_length, std::vector<Touch>& touches, ContactCounters& counters);

  void prefetch() const { list_.prefetch(); }
  /// Memory held, besides the object.
  [[nodiscard]] std::size_t bytes() const { return list_.bytes(); }

 private:
  struct Grain {
    double radius{0};  // bounding [m]
  };
  struct Pose {
    Vec3 offset;  // the grain's centre from the wall's displacement [m]
    Mat3 rotation;
  };
  struct Node {
    Vec3 place_body;  // [m]
    double area{0};   // [m^2]
    NodeIndex node{0};
  };

  [[nodiscard]] bool still_complete(const Pose& pose, double path_length, double margin);
  void make(const GrainFrame& grain, const Wall& wall, const Pose& pose, double path_length,
            double margin, ContactCounters& counters);

  VerletNodeList<Grain, Pose, Node> list_;
};

/// The plain finder: every node of the grain, in order, against the wall.
void find_wall_touches(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                       std::vector<Touch>& touches);

/// Signed distance from a wall where it stands now [m].
[[nodiscard]] double distance(const Wall& wall, const WallPose& pose, const Vec3& point);

}  // namespace reckon
