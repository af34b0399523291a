// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/near_misses.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "reckon/core/error.hpp"
#include "reckon/scene/scene_reader.hpp"
#include "reckon/text/units.hpp"
#include "unit/scene/scene_text_fixture.hpp"

namespace reckon {
namespace {

TEST(NearMisses, NumbersOfOtherCountries) {
  EXPECT_EQ(advice_on_number("0,5"), "Decimals have a point: write 0.5.");
  EXPECT_EQ(advice_on_number("-2,65 g/cm^3"), "Decimals have a point: write -2.65 g/cm^3.");
  EXPECT_EQ(advice_on_number("1,000"),
            "Decimals have a point, and thousands no sign: write 1.000 or 1000.");
  EXPECT_EQ(advice_on_number("0,125"), "Decimals have a point: write 0.125.");
  EXPECT_EQ(advice_on_number("1.234,5"), "Decimals have a point: write 1234.5.");
  EXPECT_EQ(advice_on_number("1,234.5"), "Write 1234.5, without signs between the digits.");
  EXPECT_EQ(advice_on_number("1,000,000"), "Write 1000000, without signs between the digits.");
  EXPECT_EQ(advice_on_number("2 650"), "Write 2650, without signs between the digits.");
  EXPECT_EQ(advice_on_number("10'000"), "Write 10000, without signs between the digits.");
  for (const char* text : {"", "0.5", "5 mm", "mm", ",", "-", "1e5"}) {
    EXPECT_EQ(advice_on_number(text), "") << text;
  }
}

TEST(NearMisses, WholeNumbers) {
  EXPECT_EQ(advice_on_whole_number("1e5"), "Write 100000.");
  EXPECT_EQ(advice_on_whole_number("1E+3"), "Write 1000.");
  EXPECT_EQ(advice_on_whole_number("3.0"), "Write 3.");
  EXPECT_EQ(advice_on_whole_number("10k"), "Write 10000.");
  EXPECT_EQ(advice_on_whole_number("2M"), "Write 2000000.");
  EXPECT_EQ(advice_on_whole_number("1,000"), "Write 1000.");
  EXPECT_EQ(advice_on_whole_number("10 000"), "Write 10000.");
  EXPECT_EQ(advice_on_whole_number("2,5"), "Decimals have a point: write 2.5.");
  for (const char* text : {"2.5", "k", "", "many", "1e400", "nan", "inf", "1e30"}) {
    EXPECT_EQ(advice_on_whole_number(text), "") << text;
  }
}

TEST(NearMisses, Units) {
  EXPECT_EQ(advice_on_unit("m3"), "Write \"m^3\".");
  EXPECT_EQ(advice_on_unit("KN"), "Write \"kN\".");
  EXPECT_EQ(advice_on_unit("seconds"), "Write \"s\".");
  EXPECT_EQ(advice_on_unit("microns"), "Write \"um\".");
  EXPECT_EQ(advice_on_unit("furlong"), "");
  for (const char* text : {"0,5", "2 650", "5 m3", "5 kpa", "5 degrees"}) {
    try {
      (void)parse_quantity(text);
      ADD_FAILURE() << text << " was read";
    } catch (const Error& error) {
      EXPECT_NE(error.text().fix.find("rite "), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(parse_quantity("5 1/s").value,
            5);  // a blank before a digit of the unit is none between
}

TEST(NearMisses, LinesThatAreNotToml) {
  const std::string quote = "A number with a unit stands in quotation marks: write ";
  EXPECT_EQ(advice_on_toml_line("x = 0.2 mm"), quote + "\"0.2 mm\".");
  EXPECT_EQ(advice_on_toml_line("x = -0.2mm  # thick"), quote + "\"-0.2 mm\".");
  EXPECT_EQ(advice_on_toml_line("gravity = [0, 0, -9.81 m/s^2]"), quote + "\"-9.81 m/s^2\".");
  EXPECT_EQ(advice_on_toml_line("box = { low = [\"1 mm\", 20 mm, 0], high = 3 }"),
            quote + "\"20 mm\".");
  EXPECT_EQ(advice_on_toml_line("k = 1e9 N/m^3"), quote + "\"1e9 N/m^3\".");
  EXPECT_EQ(advice_on_toml_line("angle = 30deg"), quote + "\"30 deg\".");
  EXPECT_EQ(advice_on_toml_line("  10 mm,"), quote + "\"10 mm\".");
  EXPECT_EQ(advice_on_toml_line("friction = 0,5"), "Decimals have a point: write 0.5.");
  EXPECT_EQ(advice_on_toml_line("x = .5"), "Write 0.5.");
  EXPECT_EQ(advice_on_toml_line("x = -.5"), "Write -0.5.");
  EXPECT_EQ(advice_on_toml_line("x = 1."), "Write 1.0.");
  EXPECT_EQ(advice_on_toml_line("x = 0100"), "Write 100, without zeros in front.");
  EXPECT_EQ(advice_on_toml_line("x = True"), "Write true in small letters.");
  EXPECT_EQ(advice_on_toml_line("x = yes"), "Write true.");
  EXPECT_EQ(advice_on_toml_line("law = area"), "A text stands in quotation marks: write \"area\".");
  EXPECT_EQ(advice_on_toml_line("library = ../sand.h5"),
            "A text stands in quotation marks: write \"../sand.h5\".");
  EXPECT_EQ(advice_on_toml_line("x = tan(30)"),
            "A scene calculates nothing: write the result as a number.");
  EXPECT_EQ(advice_on_toml_line("x = 1/3"),
            "A scene calculates nothing: write the result as a number.");
  EXPECT_EQ(advice_on_toml_line("x = 20 // twenty"), "A comment begins with #.");
  EXPECT_EQ(advice_on_toml_line("x = 20;"), "Leave out the `;` at the end of the line.");
  EXPECT_EQ(advice_on_toml_line("x = [0, 0, \u22129.81]"), "Write a plain minus, -.");
  EXPECT_EQ(advice_on_toml_line("x = 2\u00a0650"), "Write plain blanks.");
  EXPECT_EQ(advice_on_toml_line("box = { low = [0, 0, 0], open_top = True }"),
            "Write true in small letters.");
  EXPECT_EQ(advice_on_toml_line("box = { open_top = yes, low = [0, 0, 0] }"), "Write true.");
  EXPECT_EQ(advice_on_toml_line("x ="), "Write a value behind the `=`.");
  EXPECT_EQ(advice_on_toml_line("position: [0, 0, 0]"),
            "A key and its value are joined by `=`: write `position = [0, 0, 0]`.");
  EXPECT_EQ(advice_on_toml_line("friction 0.5"),
            "A key and its value are joined by `=`: write `friction = 0.5`.");
  EXPECT_EQ(advice_on_toml_line("normal stiffness = 1"),
            "A key has no blanks: write `normal_stiffness`.");
  EXPECT_EQ(advice_on_toml_line("[[wall]"), "Write [[wall]].");
  EXPECT_EQ(advice_on_toml_line("[material"), "Write [material].");
  EXPECT_EQ(advice_on_toml_line("title = \"sand"),
            "A quotation mark is missing at the end of a text.");
  EXPECT_EQ(advice_on_toml_line("title = “sand”"), "Write straight quotation marks, \" or '.");
  for (const char* line :
       {"", "#", "damping = = 2", "]", "[", "\"", "=", "\\", "'\\", "{", "- 3"}) {
    (void)advice_on_toml_line(line);  // it ends, with any result
  }
}

/// The messages of `check` for lines below a valid scene.
class NearMissesInScenes : public testing::SceneTextTest {
 protected:
  [[nodiscard]] std::string said_of(const std::string& lines) const {
    return said_of_whole(sound + lines);
  }
  [[nodiscard]] std::string said_of_whole(const std::string& text) const {
    std::string said;
    for (const SceneFault& fault : read_scene_text(text, directory_).faults) {
      said += describe(fault, "") + '\n';
    }
    return said;
  }
};

TEST_F(NearMissesInScenes, AQuantityWithoutQuotationMarks) {
  EXPECT_EQ(said_of("membrane.spacing = 0.2 mm\n"),
            ":4:24: error while parsing key-value pair: expected a comment or whitespace, saw 'm'. "
            "A number with a unit stands in quotation marks: write \"0.2 mm\".\n");
}

TEST_F(NearMissesInScenes, SignsOfWordProcessors) {
  EXPECT_EQ(said_of("body.gravity = [0, 0, '\u22129.81\u00a0m\u00b7s^-2']\n"), "");
  EXPECT_EQ(said_of("material.density = '2\u202f650 kg/m^3'\n"),
            ":4:20: material.density: expected a number [kg/m^3], but \"2\u202f650 kg/m^3\" cannot "
            "be read. Write 2650 kg/m^3, without signs between the digits.\n");
}

TEST_F(NearMissesInScenes, TextsInOtherEncodingsAndWithBackslashes) {
  EXPECT_EQ(said_of("title = 'K\xf6rner'\n"),
            ":4:11: encountered invalid utf-8 sequence. Save the file as UTF-8.\n");
  EXPECT_EQ(said_of_whole(std::string{"\xff\xfex\0", 4}),
            ":1:1: this text is in UTF-16. Save it as UTF-8.\n");
  EXPECT_NE(said_of("title = \"C:\\sand\"\n").find("write /, or put the text between ' and '"),
            std::string::npos);
}

TEST_F(NearMissesInScenes, NamesOfPapersAndTables) {
  EXPECT_EQ(said_of("material.mu = 0.5\n"),
            ":4:10: material.mu: unknown key. Did you mean `friction`?\n");
  EXPECT_EQ(said_of("time.dt = 1e-6\n"), ":4:6: time.dt: unknown key. Did you mean `step`?\n");
  EXPECT_EQ(said_of("output.material = 'quartz'\n"),
            ":4:8: output.material: unknown key. `material` belongs at the top: write "
            "[material].\n");
}

TEST_F(NearMissesInScenes, MaterialAmongTheGrains) {
  const std::string grains =
      "contact.normal_stiffness = 1e9\ntime.steps = 10\n[[grains]]\nlibrary = 'sand.h5'\n"
      "place = [{ position = [0, 0, 0] }]\n";
  EXPECT_EQ(said_of_whole(grains + "density = 2650\nfriction = 0.5\n"),
            ":6:1: grains[0].density: unknown key. `density` belongs in [material].\n"
            ":7:1: grains[0].friction: unknown key. `friction` belongs in [material], [[wall]], "
            "[membrane] or [[stage]].\n");
}

TEST_F(NearMissesInScenes, NumbersInOtherForms) {
  EXPECT_EQ(said_of("material.friction = 0,5\n"),
            ":4:22: error while parsing key-value pair: expected a comment or whitespace, saw ','. "
            "Decimals have a point: write 0.5.\n");
  EXPECT_EQ(
      said_of("material.friction = '0,5'\n"),
      ":4:21: material.friction: expected a number, but \"0,5\" cannot be read. Decimals have "
      "a point: write 0.5.\n");
  EXPECT_EQ(
      said_of("body.gravity = [0, 0, -9,81]\n"),
      ":4:16: body.gravity: expected 3 numbers [x, y, z], found an array of 4. Commas separate "
      "numbers: decimals have a point.\n");
  EXPECT_EQ(
      said_of("body.gravity = -9.81\n"),
      ":4:16: body.gravity: expected 3 numbers [x, y, z], found a number. Write three numbers, "
      "for example [0, 0, -9.81].\n");
  EXPECT_EQ(said_of("output.history_interval = 1e5\n"),
            ":4:27: output.history_interval: expected a whole number, found a number. Write "
            "100000.\n");
  EXPECT_EQ(said_of("seed = '7'\n"),
            ":4:8: seed: expected a whole number, found a text. Write 7, without quotation "
            "marks.\n");
  EXPECT_EQ(said_of("output.sample = 'true'\n"),
            ":4:17: output.sample: expected true or false, found a text. Write true or false, "
            "without quotation marks.\n");
}

TEST_F(NearMissesInScenes, AnAngleForACoefficientOfFriction) {
  EXPECT_EQ(said_of("material.friction = '30 deg'\n"),
            ":4:21: material.friction: \"30 deg\" is in rad, but a number is needed. A coefficient "
            "of friction is the tangent of an angle: write 0.5774.\n");
  EXPECT_EQ(said_of("material.density = '2.65'\n"),
            ":4:20: material.density: \"2.65\" has no unit, but a number [kg/m^3] is needed. Write "
            "\"2.65 kg/m^3\".\n");
  EXPECT_EQ(
      said_of("material.density = '2.65 g'\n"),
      ":4:20: material.density: \"2.65 g\" is in kg, but a number [kg/m^3] is needed. Give it "
      "in kg/m^3.\n");
}

TEST_F(NearMissesInScenes, TwoWallsOfOneName) {
  const std::string wall =
      "[[wall]]\nname = 'side'\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n";
  EXPECT_EQ(said_of(wall + wall),
            ":8:1: wall[1].name: no two walls may have the same name. \"side\" names a wall above: "
            "write \"side2\", say.\n");
}

TEST_F(NearMissesInScenes, AStiffnessForHertz) {
  const std::string rest =
      "time.steps = 10\ngrains = [{ library = 'sand.h5', place = [{ position = [0, 0, 0] }] }]\n";
  EXPECT_EQ(
      said_of_whole("contact = { law = 'hertz', young_modulus = 7e10, normal_stiffness = 1e9 }\n" +
                    rest),
      ":1:50: contact.normal_stiffness: law `hertz` takes no stiffness but `young_modulus` and "
      "`poisson_ratio`. Write `young_modulus = \"70 GPa\"` and `poisson_ratio = 0.25`, say, "
      "instead of it; or choose the law `area`.\n");
  for (const char* stiffness : {"'1e9 N/m^3'", "'1e9 N/m'", "'stiff'"}) {
    const std::string said = said_of_whole(
        fmt::format("contact = {{ law = 'hertz', young_modulus = 7e10, normal_stiffness = {}, "
                    "shear_stiffness = 1 }}\n",
                    stiffness) +
        rest);
    EXPECT_NE(said.find("law `hertz` takes no stiffness"), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  }
}

TEST_F(NearMissesInScenes, AKeyThatIsTheEndOfALongerOne) {
  EXPECT_EQ(said_of("contact.stiffness = 1\n")
                .find(":4:9: contact.stiffness: unknown key. Did you "
                      "mean `normal_stiffness`?"),
            0U)
      << said_of("contact.stiffness = 1\n");
}

}  // namespace
}  // namespace reckon
