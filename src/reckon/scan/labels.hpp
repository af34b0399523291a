// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "reckon/scan/blocks.hpp"
#include "reckon/scan/disk_volume.hpp"

namespace reckon {

/// Which necks between pieces of a watershed divide no grains.
struct NeckRules {
  /// Those wider than this share of the smaller piece: the depth of the pass over the depth where
  /// the shallower piece is deepest.
  double wide{0.95};
  /// With gray values: of those wider than `narrow` also those that are solid, because less than
  /// this share of the gray between void and the pieces' own solid is missing in the neck. Grains
  /// that only touch leave void there, even if blurred.
  double largest_void{0.03};
  double narrow{0.7};
  /// Pieces whose own solids differ by more than this share of the brighter one's step from void
  /// are different minerals, and are never joined.
  double other_mineral{0.3};
  double void_gray{0};
  double solid_gray{1};  ///< of pieces too small for their own value
};

/// Where two pieces were joined.
struct Waist {
  std::uint32_t label{0};  ///< of a piece; of the grain, once grains have their labels
  double width{0};         ///< over the smaller piece's, as in NeckRules
  VoxelDims voxel{};       ///< the deepest in the neck
};

/// The pieces that were joined.
struct JoinedPieces {
  std::vector<std::uint32_t> label;  ///< by piece: the lowest number of those joined to it
  std::uint32_t joined{0};           ///< pieces that were joined to others
  std::vector<Waist> waists;         ///< one for each join
};

/// Joins pieces that no neck divides, at the widest first. Takes a volume from its first layer to
/// its last, slab by slab.
class NeckJoiner {
 public:
  /// The first `layers` of what is given; one more layer, which is given again, has the faces
  /// between. `gray` as scanned, or null.
  void add(const LabelVolume& pieces, const GrayVolume& depth, const GrayVolume* gray,
           std::int32_t layers);
  [[nodiscard]] JoinedPieces join(const NeckRules& rules) const;

 private:
  struct Mean {
    double sum{0};
    std::uint64_t count{0};

    void add(double value) {
      sum += value;
      ++count;
    }
    [[nodiscard]] double value() const { return sum / static_cast<double>(count); }
  };
  struct Face {
    float depth{0};  // at its deepest
    VoxelDims place{};
    Mean gray;  // well inside the solid
  };
  struct Piece {
    float peak{0};
    Mean gray;  // well inside
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Face> faces_;
  std::vector<Piece> pieces_;
};

/// Gives labels consecutive numbers from 1 in the order of their first voxels.
class Renumbering {
 public:
  /// The next layers of a volume; layers may come again.
  void apply(LabelVolume& labels);
  [[nodiscard]] std::uint32_t count() const { return count_; }
  /// The new number of a label that was seen.
  [[nodiscard]] std::uint32_t number_of(std::uint32_t label) const { return number_[label]; }

 private:
  std::vector<std::uint32_t> number_;
  std::uint32_t count_{0};
};

/// A labelled grain's place in its volume.
struct LabelledGrain {
  VoxelDims low{0, 0, 0};   ///< least voxel along each axis
  VoxelDims high{0, 0, 0};  ///< largest
  std::uint64_t voxels{0};
  bool on_border{false};   ///< holds a voxel of the volume's outermost layers
  std::uint32_t given{0};  ///< its label in a volume of labels that was given; 0: none was
  std::uint32_t piece{1};  ///< which of that label's pieces, by falling size
};

/// The name of a grain with this label: from the given label, if there is one.
[[nodiscard]] std::string name_of(const LabelledGrain& grain, std::uint32_t label);

/// All grains; the one with label n is at n - 1.
[[nodiscard]] std::vector<LabelledGrain> measure_labels(const LabelsOnDisk& labels,
                                                        const Workspace& work);

/// Which grains become avatars.
struct GrainChoice {
  std::vector<std::uint32_t> kept;  ///< labels, ascending
  std::uint32_t on_border{0};       ///< dropped because the volume cuts them off
  std::uint32_t tiny{0};            ///< dropped because they have too few voxels
};
[[nodiscard]] GrainChoice choose_grains(const std::vector<LabelledGrain>& grains, bool keep_border,
                                        std::uint64_t fewest_voxels);

/// Labels grown into unlabelled voxels, layer by layer through faces, `layers` times. Where two
/// meet at once the lower number wins.
[[nodiscard]] LabelVolume grown(const LabelVolume& labels, int layers);

}  // namespace reckon
