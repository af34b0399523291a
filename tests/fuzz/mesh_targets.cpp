// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <exception>
#include <stdexcept>

#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/mesh_parts.hpp"
#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/mesh_repair.hpp"
#include "reckon/avatar/mesh_validation.hpp"
#include "reckon/core/error.hpp"
#include "targets.hpp"

namespace reckon::fuzz {
namespace {

using Corner = std::array<float, 3>;

constexpr std::array<Corner, 4> corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<std::array<std::uint8_t, 3>, 4> faces{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};  // a tetrahedron, seen from outside

template <class Number>
std::string bytes_of(Number number, std::endian order = std::endian::little) {
  std::string bytes(sizeof(Number), '\0');
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  for (std::size_t n = 0; n < raw.size(); ++n) {
    bytes[n] = raw[order == std::endian::native ? n : raw.size() - 1 - n];
  }
  return bytes;
}

std::string text_of(const Corner& corner) {
  return std::to_string(corner[0]) + " " + std::to_string(corner[1]) + " " +
         std::to_string(corner[2]);
}

std::string binary_stl() {
  std::string stl(80, ' ');
  stl += bytes_of(static_cast<std::uint32_t>(faces.size()));
  for (const auto& face : faces) {
    for (int n = 0; n < 3; ++n) stl += bytes_of(0.0F);
    for (const std::uint8_t corner : face) {
      for (const float x : corners[corner]) stl += bytes_of(x);
    }
    stl += bytes_of(std::uint16_t{0});
  }
  return stl;
}

std::string ascii_stl() {
  std::string stl = "solid tetrahedron\n";
  for (const auto& face : faces) {
    stl += "facet normal 0 0 0\n outer loop\n";
    for (const std::uint8_t corner : face) stl += "  vertex " + text_of(corners[corner]) + "\n";
    stl += " endloop\nendfacet\n";
  }
  return stl + "endsolid tetrahedron\n";
}

std::string obj(bool with_extras) {
  std::string text =
      with_extras ? "# tetrahedron\nmtllib a.mtl\nvn 0 0 1\nvt 0 0\no it\ns off\n" : "";
  for (const Corner& corner : corners) text += "v " + text_of(corner) + "\n";
  for (const auto& face : faces) {
    text += "f";
    for (const std::uint8_t corner : face) {
      // Indices count from 1, or back from the last vertex.
      text += with_extras ? " " + std::to_string(int{corner} - 4) + "/1/1"
                          : " " + std::to_string(int{corner} + 1);
    }
    text += "\n";
  }
  return text;
}

/// An L-shaped prism of polygons, with a corner on a straight side and a continued line.
std::string polygons_obj() {
  std::string text = "\xef\xbb\xbf# L\n";
  constexpr std::array<std::array<int, 2>, 7> outline{
      {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
  for (const int z : {0, 1}) {
    for (const auto& [x, y] : outline) {
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    }
  }
  text += "f 7 6 5 \\\n 4 3 2 1\nf 8 9 10 11 12 13 14\n";
  for (int c = 0; c < 7; ++c) {
    const int d = (c + 1) % 7;
    text += "f " + std::to_string(c + 1) + " " + std::to_string(d + 1) + " " +
            std::to_string(d + 8) + " " + std::to_string(c + 8) + "\n";
  }
  return text;
}

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment tetrahedron\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nproperty uchar red\nelement face 4\n"
         "property list uchar int vertex_indices\nend_header\n";
}

std::string ascii_ply() {
  std::string ply = ply_header("ascii");
  for (const Corner& corner : corners) ply += text_of(corner) + " 255\n";
  for (const auto& face : faces) {
    ply += "3";
    for (const std::uint8_t corner : face) ply += " " + std::to_string(corner);
    ply += "\n";
  }
  return ply;
}

std::string binary_ply(std::endian order) {
  std::string ply =
      ply_header(order == std::endian::little ? "binary_little_endian" : "binary_big_endian");
  for (const Corner& corner : corners) {
    for (const float x : corner) ply += bytes_of(x, order);
    ply += '\x7f';
  }
  for (const auto& face : faces) {
    ply += '\x03';
    for (const std::uint8_t corner : face) ply += bytes_of(std::int32_t{corner}, order);
  }
  return ply;
}

using Parser = TriangleMesh (*)(std::string_view, const std::string&);

/// Reads, checks and weighs a mesh, as `reckon grains` does. What passes must be a solid.
void weigh(const TriangleMesh& mesh) {
  require_closed_surface(mesh, "mesh");
  const SolidProperties solid = solid_properties(to_principal_frame(mesh));
  const double sum = solid.volume + solid.surface_area + norm(solid.centroid);
  if (!(solid.volume > 0) || !std::isfinite(sum)) {
    throw std::logic_error("accepted, but no solid of finite volume");
  }
}

void read(Parser parse, const std::string& input) {
  const TriangleMesh mesh = parse(input, "mesh");
  std::exception_ptr fault;
  try {
    weigh(mesh);
  } catch (const Error&) {
    fault = std::current_exception();
  }
  TriangleMesh repaired = mesh;
  (void)repair_mesh(repaired, "mesh").text();
  for (const SolidPart& part : separate_solids(repaired, "mesh")) {
    if (!part.fault) weigh(part.mesh);
  }
  if (fault) std::rethrow_exception(fault);
}

Target mesh_target(const std::string& name, Parser parse, std::vector<std::string> inputs) {
  return {.name = name,
          .valid_inputs = [inputs = std::move(inputs)] { return inputs; },
          .read = [parse](const std::string& input) { read(parse, input); },
          .cost = 2};
}

}  // namespace

Target stl_target() { return mesh_target("stl", parse_stl, {binary_stl(), ascii_stl()}); }

Target obj_target() {
  return mesh_target("obj", parse_obj, {obj(false), obj(true), polygons_obj()});
}

Target ply_target() {
  return mesh_target("ply", parse_ply,
                     {ascii_ply(), binary_ply(std::endian::little), binary_ply(std::endian::big)});
}

}  // namespace reckon::fuzz
