// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/domain/shape_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "reckon/core/error.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

class ShapeStoreTest : public ::testing::Test {
 protected:
  ShapeLibrary shapes_{testing::sphere(1.0, 50), testing::bumpy_grain(0.8, 60, 12),
                       testing::box({0.8, 0.5, 0.6}, 4, 0.1)};
  std::vector<std::uint32_t> reads_;  // in the order in which they came

  ShapeStore store() {
    std::vector<ShapeOutline> outlines;
    for (const Shape& shape : shapes_) outlines.push_back(outline_of(shape));
    return {Communicator{}, outlines, [this](ShapeId id) {
              reads_.push_back(id.get());
              return shapes_[id.get()];
            }};
  }
  void expect_whole(const ShapeView& view, const Shape& shape) const {
    const ShapeView whole{shape};
    for (std::int32_t k = 0; k + 1 < whole.level_set.dims[2]; ++k) {
      for (std::int32_t j = 0; j + 1 < whole.level_set.dims[1]; ++j) {
        for (std::int32_t i = 0; i + 1 < whole.level_set.dims[0]; ++i) {
          ASSERT_EQ(view.level_set.corners(i, j, k), whole.level_set.corners(i, j, k));
        }
      }
    }
    ASSERT_EQ(view.nodes.size(), whole.nodes.size());
    for (std::size_t n = 0; n < whole.nodes.size(); ++n) {
      EXPECT_EQ(view.nodes.position(n), whole.nodes.position(n));
      EXPECT_EQ(view.nodes.area[n], whole.nodes.area[n]);
    }
    ASSERT_EQ(view.clusters.size(), whole.clusters.size());
    for (std::size_t c = 0; c < view.clusters.size(); ++c) {
      EXPECT_EQ(view.clusters[c].center_body, whole.clusters[c].center_body);
      EXPECT_EQ(view.clusters[c].count, whole.clusters[c].count);
    }
    EXPECT_EQ(view.level_set.dims, whole.level_set.dims);
    EXPECT_EQ(view.level_set.origin_body, whole.level_set.origin_body);
  }
};

TEST_F(ShapeStoreTest, KeepsABandOfAShapeThatIsStoredAsOne) {
  const std::uint64_t full = outline_of(shapes_[1]).memory();
  round_to_band(shapes_[1]);
  const std::uint64_t band = outline_of(shapes_[1]).memory();
  ShapeStore shapes = store();
  shapes.require({false, true, true});
  expect_whole(shapes.views()[1], shapes_[1]);
  expect_whole(shapes.views()[2], shapes_[2]);
  EXPECT_TRUE(shapes.views()[1].level_set.values.empty());
  EXPECT_LT(band, full);
  EXPECT_LT(shapes.resident_bytes(), band + outline_of(shapes_[2]).memory() + 2 * 6 * 64);
}

TEST_F(ShapeStoreTest, ReadsAShapeWhenItIsFirstNeededAndNeverAgain) {
  ShapeStore shapes = store();
  EXPECT_EQ(shapes.resident_bytes(), 0U);
  EXPECT_EQ(shapes.views()[2].mass.volume, shapes_[2].mass.volume);
  EXPECT_TRUE(shapes.views()[2].nodes.size() == 0);
  shapes.require({false, false, true});
  const ShapeView* const place = &shapes.views()[2];
  shapes.require({true, false, true});
  EXPECT_EQ(reads_, (std::vector<std::uint32_t>{2, 0}));
  EXPECT_EQ(&shapes.views()[2], place);
  expect_whole(shapes.views()[2], shapes_[2]);
  expect_whole(shapes.views()[0], shapes_[0]);
  EXPECT_TRUE(shapes.views()[1].nodes.size() == 0);
  EXPECT_EQ(shapes.resident_shapes(), 2U);
  const std::uint64_t least = outline_of(shapes_[0]).memory() + outline_of(shapes_[2]).memory();
  EXPECT_GE(shapes.resident_bytes(), least);
  EXPECT_LT(shapes.resident_bytes(), least + 2 * 6 * 64);
}

TEST_F(ShapeStoreTest, AShapeThatChangedUnderwayIsRefused) {
  ShapeStore shapes = store();
  shapes_[1].nodes.x.pop_back();
  EXPECT_THROW(shapes.require({false, true, false}), Error);
  shapes_[1].nodes.x.push_back(0);
  shapes.require({false, true, false});  // a failed reading leaves nothing half done
  expect_whole(shapes.views()[1], shapes_[1]);
}

TEST_F(ShapeStoreTest, ALibraryInMemoryIsWholeAtOnce) {
  ShapeStore shapes{std::make_shared<const ShapeLibrary>(shapes_)};
  shapes.require({true, true, true});
  for (std::size_t s = 0; s < shapes_.size(); ++s) expect_whole(shapes.views()[s], shapes_[s]);
}

}  // namespace
}  // namespace reckon
