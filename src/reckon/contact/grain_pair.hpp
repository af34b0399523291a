// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "reckon/contact/grain_contacts.hpp"
#include "reckon/contact/pair_kernel.hpp"
#include "reckon/contact/sphere_contact.hpp"

namespace reckon {

/// Adds what one master does to its slave to what their pair does.
inline void add_directed(PairForce& pair, const DirectedForce& directed, bool master_is_b) {
  pair.force_on_a += master_is_b ? -directed.force : directed.force;
  pair.moment_a += master_is_b ? directed.moment_slave : directed.moment_master;
  pair.moment_b += master_is_b ? directed.moment_master : directed.moment_slave;
  pair.deepest = std::max(pair.deepest, directed.deepest);
  pair.elastic += directed.elastic;
  pair.friction += directed.friction;
  pair.dashpot += directed.dashpot;
  pair.stiffness += static_cast<float>(directed.stiffness);
  pair.damping += static_cast<float>(directed.damping);
  pair.touching += directed.touching;
}

/// Calls body(master_is_b, weight) for each way in which a pair is looked at.
template <class Body>
void for_each_master(MasterRule rule, const GrainFrame& a, const GrainFrame& b, Body&& body) {
  switch (rule) {
    case MasterRule::lower_id:
      body(false, 1.0);
      break;
    case MasterRule::smaller:
      body(b.shape->bounding_radius < a.shape->bounding_radius, 1.0);
      break;
    case MasterRule::both: {
      if (are_spheres(a, b)) return body(false, 1.0);  // both ways are the same
      const double sum = a.shape->mean_node_area + b.shape->mean_node_area;
      body(false, b.shape->mean_node_area / sum);
      body(true, a.shape->mean_node_area / sum);
      break;
    }
  }
}

}  // namespace reckon
