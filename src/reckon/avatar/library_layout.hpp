// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "reckon/core/hdf5_file.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon::library_layout {

// The names of the datasets of a shape library; library_file.hpp has the picture.

// 2 added sphere_radius, 3 bands, 4 provenance and sieve_size
inline const Hdf5Kind library_kind{"shape library", 4};

/// The scalar fields of a shape, each a dataset of one row per shape.
struct ScalarField {
  const char* name;
  const char* unit;
  double& (*of)(Shape&);
};
inline constexpr std::array scalar_fields{
    ScalarField{"/shape/spacing", "m", [](Shape& s) -> double& { return s.level_set.spacing; }},
    ScalarField{"/shape/volume", "m^3", [](Shape& s) -> double& { return s.mass.volume; }},
    ScalarField{"/shape/bounding_radius", "m",
                [](Shape& s) -> double& { return s.bounding_radius; }},
    ScalarField{"/shape/lipschitz", "1", [](Shape& s) -> double& { return s.lipschitz; }},
    ScalarField{"/descriptor/length", "m",
                [](Shape& s) -> double& { return s.descriptors.length; }},
    ScalarField{"/descriptor/width", "m", [](Shape& s) -> double& { return s.descriptors.width; }},
    ScalarField{"/descriptor/thickness", "m",
                [](Shape& s) -> double& { return s.descriptors.thickness; }},
    ScalarField{"/descriptor/surface_area", "m^2",
                [](Shape& s) -> double& { return s.descriptors.surface_area; }},
    ScalarField{"/descriptor/equivalent_diameter", "m",
                [](Shape& s) -> double& { return s.descriptors.equivalent_diameter; }},
    ScalarField{"/descriptor/elongation", "1",
                [](Shape& s) -> double& { return s.descriptors.elongation; }},
    ScalarField{"/descriptor/flatness", "1",
                [](Shape& s) -> double& { return s.descriptors.flatness; }},
    ScalarField{"/descriptor/sphericity", "1",
                [](Shape& s) -> double& { return s.descriptors.sphericity; }},
    ScalarField{"/descriptor/convexity", "1",
                [](Shape& s) -> double& { return s.descriptors.convexity; }},
    ScalarField{"/descriptor/roundness", "1",
                [](Shape& s) -> double& { return s.descriptors.roundness; }},
};

inline constexpr const char* sphere_radius_field = "/shape/sphere_radius";
inline constexpr const char* sieve_size_field = "/descriptor/sieve_size";
inline constexpr const char* values_field = "/grid/values";
inline constexpr const char* band_field = "/grid/band";
inline constexpr const char* program_field = "/provenance/program";
inline constexpr const char* command_field = "/provenance/command";
inline constexpr const char* source_field = "/provenance/source";
inline constexpr const char* source_bytes_field = "/provenance/source_bytes";
inline constexpr const char* source_hash_field = "/provenance/source_xxh64";

struct VectorField {
  const char* name;
  const char* unit;
  Vec3& (*of)(Shape&);
};
inline constexpr std::array vector_fields{
    VectorField{"/shape/origin", "m", [](Shape& s) -> Vec3& { return s.level_set.origin_body; }},
    VectorField{"/shape/inertia", "m^5", [](Shape& s) -> Vec3& { return s.mass.inertia; }},
};

struct NodeField {
  const char* name;
  const char* unit;
  std::vector<double> SurfaceNodes::*values;
};
inline constexpr std::array node_fields{NodeField{"/node/x", "m", &SurfaceNodes::x},
                                        NodeField{"/node/y", "m", &SurfaceNodes::y},
                                        NodeField{"/node/z", "m", &SurfaceNodes::z},
                                        NodeField{"/node/area", "m^2", &SurfaceNodes::area}};

}  // namespace reckon::library_layout
