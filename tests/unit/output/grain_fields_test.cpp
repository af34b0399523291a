// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/grain_fields.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "reckon/core/file.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/results/saved_fields.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

/// Two grains of one shape, the second one with a spin about z.
FieldsAtStep two_grains() {
  FieldsAtStep fields;
  fields.step = 7;
  fields.time = 0.5;
  for (const std::uint32_t id : {0U, 3U}) {
    GrainState grain;
    grain.id = GrainId{id};
    grain.shape = ShapeId{0};
    grain.position = {0.1 * id, 0, 0};
    grain.velocity = {0, 3, 4};
    grain.angular_velocity_body = {0, 0, 2.0 * id};
    fields.grains.push_back(grain);
  }
  fields.contacts = {{.grain = GrainId{0}, .partner = 3, .force = {-5, 0, 0}}};
  return fields;
}

std::vector<ShapeSummary> one_shape() {
  ShapeSummary shape;
  shape.outline.mass = {.volume = 2, .inertia = {1, 1, 1}};
  return {shape};
}

class GrainFields : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_.root() / "fields"); }
  void TearDown() override { std::filesystem::remove_all(folder_.root()); }

  [[nodiscard]] SavedFields written(const FieldsAtStep& fields,
                                    const std::vector<GrainField>& table) const {
    write_grain_points(folder_.root() / RunFolder::field_name("grains", 7), fields, one_shape(),
                       1000, table);
    return read_fields(folder_, 7, table);
  }
  static const SavedField* find(const SavedFields& fields, const std::string& name) {
    for (const SavedField& field : fields.shown) {
      if (field.name == name) return &field;
    }
    return nullptr;
  }

  RunFolder folder_{testing::test_path()};
};

/// An entry in the table is all that a new field needs: file, reading back and reference follow.
TEST_F(GrainFields, AnEntryInTheTableIsAFieldEverywhere) {
  std::vector<GrainField> table = grain_fields();
  table.push_back({.name = "energy_of_rotation",
                   .unit = "J",
                   .meaning = "kinetic energy of rotation",
                   .label = "Energy of rotation",
                   .values = [](const GrainAtStep& grain) {
                     const double spin = grain.state.angular_velocity_body.z;
                     const double inertia = grain.density * grain.shape.mass.inertia.z;
                     return std::array<double, 4>{0.5 * inertia * spin * spin};
                   }});
  const SavedFields fields = written(two_grains(), table);
  const SavedField* const added = find(fields, "energy_of_rotation");
  ASSERT_NE(added, nullptr);
  EXPECT_EQ(added->numbers, (std::vector<double>{0, 0.5 * 1000 * 36}));
  EXPECT_NE(grain_fields_markdown(table).find("| `energy_of_rotation` | J | 1 | kinetic energy of "
                                              "rotation |  | Energy of rotation | vertices |"),
            std::string::npos);
}

TEST_F(GrainFields, ComeBackAsTheyWere) {
  const SavedFields fields = written(two_grains(), grain_fields());
  ASSERT_NE(find(fields, "velocity"), nullptr);
  EXPECT_EQ(find(fields, "velocity")->numbers, (std::vector<double>{0, 3, 4, 0, 3, 4}));
  EXPECT_EQ(find(fields, "angular_velocity")->numbers, (std::vector<double>{0, 0, 0, 0, 0, 6}));
  EXPECT_EQ(find(fields, "contacts")->numbers, (std::vector<double>{1, 1}));
  EXPECT_EQ(find(fields, "contact_force")->numbers, (std::vector<double>{-5, 0, 0, 5, 0, 0}));
  EXPECT_EQ(find(fields, "mass")->numbers, (std::vector<double>{2000, 2000}));
  EXPECT_EQ(fields.grains[1].id, GrainId{3});
}

TEST_F(GrainFields, AreSavedWhereTheirConditionHolds) {
  FieldsAtStep fields = two_grains();
  EXPECT_EQ(find(written(fields, grain_fields()), "rank"), nullptr);
  fields.ranks = {4, 1};
  EXPECT_EQ(find(written(fields, grain_fields()), "rank")->numbers, (std::vector<double>{4, 1}));
}

TEST(GrainFieldsReference, ThePrintedReferenceIsTheCommittedPage) {
  EXPECT_EQ(read_file(RECKON_SOURCE_DIR "/docs/reference/fields.md"), grain_fields_markdown())
      << "run: reckon reference fields > docs/reference/fields.md";
}

}  // namespace
}  // namespace reckon
