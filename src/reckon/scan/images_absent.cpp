// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/error.hpp"
#include "reckon/scan/image_filters.hpp"

namespace reckon {

bool has_ct_component() { return false; }

void require_ct_component() {
  throw Error{{.place = {},
               .problem = "this program was built without its component ct",
               .reason = "it needs the Insight Toolkit to work on volumes",
               .fix = "Install libinsighttoolkit5-dev and build anew; cmake says whether it was "
                      "found."}};
}

namespace {

template <class Result>
Result absent() {
  require_ct_component();
  return Result{};
}

}  // namespace

GrayVolume curvature_diffused(const GrayVolume&, double, double) { return absent<GrayVolume>(); }
GrayVolume median_filtered(const GrayVolume&) { return absent<GrayVolume>(); }
double otsu_threshold(std::span<const std::uint64_t>, double, double) { return absent<double>(); }
MaskVolume holes_filled(const MaskVolume&) { return absent<MaskVolume>(); }
MaskVolume opened(const MaskVolume&, std::uint32_t) { return absent<MaskVolume>(); }
GrayVolume depth_in_solid(const MaskVolume&) { return absent<GrayVolume>(); }
LabelVolume split_at_necks(const GrayVolume&, double) { return absent<LabelVolume>(); }
void write_png(const std::filesystem::path&, std::int32_t, std::int32_t,
               const std::vector<std::uint8_t>&) {
  require_ct_component();
}

}  // namespace reckon
