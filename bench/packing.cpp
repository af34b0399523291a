// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "packing.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include "reckon/avatar/generator.hpp"
#include "reckon/core/random.hpp"
#include "reckon/neighbor/pair_list.hpp"
#include "reckon/output/checkpoint_tables.hpp"
#include "reckon/simulation/fill_region.hpp"

namespace reckon::bench {
namespace {

constexpr std::uint64_t seed = 12;

std::vector<Wall> closed_box(const Vec3& low, const Vec3& high, const Material& material) {
  std::vector<Wall> walls;
  const char* const names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      Vec3 normal;
      normal[axis] = side;
      walls.push_back({std::string{names[axis]} + (side > 0 ? "-" : "+"),
                       PlaneSurface{side > 0 ? low : high, normal},
                       material.law,
                       0.0,
                       false,
                       {}});
    }
  }
  return walls;
}

struct Cell {
  Vec3 low;
  double side;
};

/// A cubic lattice in scattered order, so that sizes mix.
std::vector<Cell> scattered_lattice(int cells_per_edge, double side) {
  std::vector<Cell> cells;
  for (int k = 0; k < cells_per_edge; ++k) {
    for (int j = 0; j < cells_per_edge; ++j) {
      for (int i = 0; i < cells_per_edge; ++i) {
        cells.push_back({side * Vec3{double(i), double(j), double(k)}, side});
      }
    }
  }
  RandomStream random{seed, RandomPurpose::placement, 0};
  for (std::size_t n = cells.size(); n > 1; --n) {
    std::swap(cells[n - 1], cells[static_cast<std::size_t>(random.uniform() * double(n))]);
  }
  return cells;
}

/// Puts each grain in a cell that holds its bounding sphere, largest first; a cell is cut into
/// eight as long as the grain fits into one of them. False when cells run out.
bool fill_cells(std::vector<Cell> cells, const std::vector<std::uint32_t>& by_size,
                std::span<const ShapeView> shapes, std::vector<GrainState>& grains) {
  for (const std::uint32_t s : by_size) {
    if (cells.empty()) return false;
    Cell cell = cells.back();
    cells.pop_back();
    while (cell.side / 2 > 2.05 * shapes[s].bounding_radius) {
      const double half = cell.side / 2;
      for (int c = 1; c < 8; ++c) {
        cells.push_back(
            {cell.low + half * Vec3{double(c & 1), double(c >> 1 & 1), double(c >> 2)}, half});
      }
      cell.side = half;
    }
    grains[s].position = cell.low + 0.5 * cell.side * Vec3{1, 1, 1};
  }
  return true;
}

/// One grain per shape, bounding spheres apart, in a cube from the origin; returns its edge.
double place_apart(std::span<const ShapeView> shapes, std::vector<GrainState>& grains) {
  std::vector<std::uint32_t> by_size(shapes.size());
  std::iota(by_size.begin(), by_size.end(), 0U);
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint32_t s, std::uint32_t t) {
    return shapes[s].bounding_radius > shapes[t].bounding_radius;
  });
  grains.resize(shapes.size());
  for (const std::uint32_t s : by_size) {
    grains[s].id = GrainId{s};
    grains[s].shape = ShapeId{s};
    grains[s].orientation = random_orientation(seed, grains[s].id);
  }
  const double side = 2.1 * shapes[by_size[0]].bounding_radius;
  int cells_per_edge = 1;
  while (!fill_cells(scattered_lattice(cells_per_edge, side), by_size, shapes, grains)) {
    ++cells_per_edge;
  }
  return side * cells_per_edge;
}

/// Grains of one place get neighbouring ids, as generators and scanners number them.
void number_by_place(std::vector<GrainState>& grains, double cell) {
  std::vector<std::uint32_t> order(grains.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t g) {
    const Vec3& p = grains[g].position;
    std::uint64_t code = 0;
    for (int bit = 20; bit >= 0; --bit) {
      for (const double x : {p.z, p.y, p.x}) {
        code = code << 1 | (static_cast<std::uint64_t>(std::max(x / cell, 0.0)) >> bit & 1);
      }
    }
    return code;
  };
  std::stable_sort(order.begin(), order.end(), [&](auto s, auto t) { return key(s) < key(t); });
  for (std::uint32_t n = 0; n < order.size(); ++n) grains[order[n]].id = GrainId{n};
  std::sort(grains.begin(), grains.end(),
            [](const GrainState& a, const GrainState& b) { return a.id < b.id; });
}

/// Of one grain of each [m^3].
double total_volume(std::span<const ShapeView> shapes) {
  double sum = 0;
  for (const ShapeView& shape : shapes) sum += shape.mass.volume;
  return sum;
}

}  // namespace

ShapeStore make_shapes(const std::vector<GrainKind>& kinds, std::uint32_t distinct,
                       ShapeStorage storage, std::uint32_t copies) {
  const auto forms = std::make_shared<ShapeLibrary>();
  std::vector<std::size_t> form_of;  // by shape
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const GrainKind& kind = kinds[k];
    GrainStatistics statistics;
    statistics.median_diameter = kind.diameter;
    statistics.log_deviation = 0.1;
    ShapeResolution resolution;
    resolution.voxels_per_diameter = kind.voxels_per_diameter;
    resolution.node_count = kind.nodes;
    resolution.storage = storage;
    const std::size_t first = forms->size();
    for (std::uint32_t n = 0; n < kind.count; ++n) {
      if (n < distinct) {
        forms->push_back(build_shape(generate_grain(statistics, seed, k * 1000 + n), resolution,
                                     "grain", SurfaceKind::curved));
      }
      form_of.push_back(first + n % distinct);
    }
  }
  const std::size_t once = form_of.size();
  while (form_of.size() < copies * once) form_of.push_back(form_of[form_of.size() - once]);
  if (storage == ShapeStorage::full) {
    auto shapes = std::make_shared<ShapeLibrary>();
    for (const std::size_t form : form_of) shapes->push_back((*forms)[form]);
    return ShapeStore{std::move(shapes)};
  }
  std::vector<ShapeOutline> outlines;
  outlines.reserve(form_of.size());
  for (const std::size_t form : form_of) outlines.push_back(outline_of((*forms)[form]));
  return ShapeStore{Communicator{}, std::move(outlines),
                    [forms, form_of](ShapeId s) { return (*forms)[form_of[s.get()]]; }};
}

double wall_pressure(const Measurement& now, const Vec3& size) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double area = size[(axis + 1) % 3] * size[(axis + 2) % 3];
    for (int side = 0; side < 2; ++side) {
      sum += std::abs(now.wall_force[2 * static_cast<std::size_t>(axis) +
                                     static_cast<std::size_t>(side)][axis]) /
             area;
    }
  }
  return sum / 6;
}

namespace {

/// The columns of walk_grain() as a sequence of fields: calls `transfer` with each.
template <class Transfer>
struct FieldColumns {
  Transfer transfer;

  void id(const char* /*name*/, auto& value) const { transfer(value); }
  void flag(const char* /*name*/, auto& value) const { transfer(value); }
  void quaternion(const char* /*name*/, auto& value) const { transfer(value); }
  void vector(const char* /*name*/, const char* /*unit*/, auto& value) const { transfer(value); }
  void number(const char* /*name*/, const char* /*unit*/, auto& value) const { transfer(value); }
  [[nodiscard]] static bool has_since(unsigned /*version*/) { return true; }
};

/// Calls `transfer` with each field of each grain. A whole grain has undefined bytes between its
/// fields, which would make two files of the same packing differ.
template <class Grains, class Transfer>
void visit_fields(Grains& grains, const Transfer& transfer) {
  const FieldColumns<Transfer> columns{transfer};
  for (auto& grain : grains) walk_grain(columns, grain);
}

/// Bytes of one grain in a file.
std::uint64_t bytes_of_fields() {
  std::vector<GrainState> one(1);
  std::uint64_t bytes = 0;
  visit_fields(one, [&](const auto& field) { bytes += sizeof field; });
  return bytes;
}

/// The head of the file of a packing without its contacts, in the machine's own byte order. The
/// grains follow. The file fits the shapes that it was made of, by builds whose grains are laid out
/// alike.
struct PackingFile {
  std::uint64_t grain_bytes{bytes_of_fields()};
  double volume;  // of all shapes
  Vec3 low;
  Vec3 high;
  double pressure;

  explicit PackingFile(const Packing& packing)
      : volume{total_volume(packing.setup.shapes.views())},
        low{packing.low},
        high{packing.high},
        pressure{packing.pressure} {}
};

/// False, and the packing as it was, when there is none that fits.
bool read_packing(const std::string& path, Packing& packing) {
  std::ifstream file{path, std::ios::binary};
  const PackingFile wanted{packing};
  PackingFile head{packing};
  std::vector<GrainState> grains(packing.setup.shapes.views().size());
  file.read(reinterpret_cast<char*>(&head), sizeof head);
  visit_fields(grains,
               [&](auto& field) { file.read(reinterpret_cast<char*>(&field), sizeof field); });
  if (!file || head.grain_bytes != wanted.grain_bytes || head.volume != wanted.volume) return false;
  packing.state.grains = std::move(grains);
  packing.low = head.low;
  packing.high = head.high;
  packing.pressure = head.pressure;
  return true;
}

void write_packing(const std::string& path, const Packing& packing) {
  const PackingFile head{packing};
  std::ofstream file{path, std::ios::binary};
  file.write(reinterpret_cast<const char*>(&head), sizeof head);
  visit_fields(packing.state.grains, [&](const auto& field) {
    file.write(reinterpret_cast<const char*>(&field), sizeof field);
  });
}

}  // namespace

Packing squeeze(ShapeStore shapes, const Material& material, double pressure, double time_step,
                double skin, const std::string& file) {
  Packing packing;
  packing.setup.shapes = std::move(shapes);
  packing.setup.density = material.density;
  packing.setup.contact = {material.law, material.friction, material.master};
  packing.setup.time_step = time_step;
  packing.setup.skin = skin;
  if (!file.empty() && read_packing(file, packing)) {
    packing.setup.walls = closed_box(packing.low, packing.high, material);
    return packing;
  }
  const double edge = place_apart(packing.setup.shapes.views(), packing.state.grains);
  double smallest = edge;
  for (const ShapeView& shape : packing.setup.shapes.views()) {
    smallest = std::min(smallest, shape.bounding_radius);
  }
  number_by_place(packing.state.grains, 2 * smallest);
  packing.high = {edge, edge, edge};
  packing.setup.contact.friction = 0;
  packing.setup.damping = 0.03 / time_step;
  const auto settle = [&](int steps) {
    packing.setup.walls = closed_box(packing.low, packing.high, material);
    packing.state.step = 0;
    Simulation simulation{packing.setup, packing.state};
    for (int n = 0; n < steps; ++n) simulation.step();
    packing.state = simulation.state();
    packing.pressure = wall_pressure(simulation.measure(), packing.high - packing.low);
  };
  // Space itself shrinks, by less once the walls are felt, and the grains make room in between. A
  // pressure counts when it is still there after they had time to.
  double factor = 0.993;
  while (packing.pressure < pressure) {
    const Vec3 middle = 0.5 * (packing.low + packing.high);
    const auto shrink = [&](Vec3& p) { p = middle + factor * (p - middle); };
    shrink(packing.low);
    shrink(packing.high);
    for (GrainState& grain : packing.state.grains) shrink(grain.position);
    settle(60);
    if (packing.pressure >= pressure) settle(150);
    const double share = packing.pressure / pressure;
    factor = share < 0.005 ? 0.993 : share < 0.3 ? 0.998 : 0.9995;
  }
  packing.setup.contact.friction = material.friction;
  settle(600);
  if (!file.empty()) write_packing(file, packing);
  return packing;
}

void repeat(Packing& packing, int copies, std::size_t count) {
  const Vec3 size = packing.high - packing.low;
  const std::vector<GrainState> block = packing.state.grains;
  packing.state.grains.clear();
  for (int n = 0; n < copies * copies * copies; ++n) {
    const int row = n / copies;
    const int layer = row / copies;
    const Vec3 place{double(n % copies), double(row % copies), double(layer)};
    for (GrainState grain : block) {
      if (packing.state.grains.size() == count) break;
      grain.position += hadamard(place, size);
      grain.id = GrainId{static_cast<std::uint32_t>(packing.state.grains.size())};
      packing.state.grains.push_back(grain);
    }
  }
  packing.high = packing.low + static_cast<double>(copies) * size;
  packing.state.pair_springs.clear();
  packing.state.wall_springs.clear();
  for (Wall& wall : packing.setup.walls) {
    auto& plane = std::get<PlaneSurface>(wall.surface);
    for (int axis = 0; axis < 3; ++axis) {
      if (plane.normal_unit[axis] < 0) plane.point[axis] = packing.high[axis];
    }
  }
}

}  // namespace reckon::bench
