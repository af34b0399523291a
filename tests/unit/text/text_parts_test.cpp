// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/text/human.hpp"
#include "reckon/text/json_writer.hpp"
#include "reckon/text/number_table.hpp"

namespace reckon {
namespace {

TEST(NumberTable, ReadsRows) {
  EXPECT_EQ(read_number_table_text("1 2 3\n# note\n4,5e-1,+6\r\n\n\n", 3, "f"),
            (std::vector<double>{1, 2, 3, 4, 0.5, 6}));
  EXPECT_TRUE(read_number_table_text("", 3, "f").empty());
  EXPECT_EQ(read_number_table_text("\xef\xbb\xbf"
                                   "1,2,3\n",
                                   3, "f"),
            (std::vector<double>{1, 2, 3}))
      << "behind a byte-order mark";
}

TEST(NumberTable, NamesTheLineAtFault) {
  const auto message = [](const char* text) -> std::string {
    try {
      (void)read_number_table_text(text, 3, "file.dat");
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message("1 2 3\n1 2\n"), "file.dat:2: has 2 numbers (3 are needed)");
  EXPECT_EQ(message("1 2 3 4\n"), "file.dat:1: has 4 numbers (3 are needed)");
  EXPECT_EQ(message("1 x 3\n"), "file.dat:1: \"x\" is not a finite number (number 2 of the line)");
  EXPECT_EQ(message("1 nan 3\n"),
            "file.dat:1: \"nan\" is not a finite number (number 2 of the line)");
  EXPECT_EQ(message("1 2 3\n\n1 2 3\n"), "file.dat:2: is an empty line between others");
}

TEST(JsonWriter, NestsAndEscapes) {
  JsonWriter json;
  json.begin_object();
  json.value("text", "a \"b\"\n\\");
  json.value("third", 1.0 / 3);
  json.value("none", std::numeric_limits<double>::infinity());
  json.value("yes", true);
  json.begin_array("list");
  json.begin_object();
  json.value("count", 3U);
  json.end();
  json.value("end");
  json.end();
  json.begin_object("empty");
  json.end();
  json.end();
  EXPECT_EQ(json.text(),
            "{\n"
            "  \"text\": \"a \\\"b\\\"\\u000a\\\\\",\n"
            "  \"third\": 0.3333333333333333,\n"
            "  \"none\": null,\n"
            "  \"yes\": true,\n"
            "  \"list\": [\n"
            "    {\n"
            "      \"count\": 3\n"
            "    },\n"
            "    \"end\"\n"
            "  ],\n"
            "  \"empty\": {}\n"
            "}\n");
}

TEST(Human, WordsForAShell) {
  EXPECT_EQ(shell_word("runs/settle-2.run"), "runs/settle-2.run");
  EXPECT_EQ(shell_word("Süß.run"), "Süß.run");
  EXPECT_EQ(shell_word("my sand.run"), "'my sand.run'");
  EXPECT_EQ(shell_word("$HOME"), "'$HOME'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(Human, Sizes) {
  EXPECT_EQ(human_bytes(999), "999 B");
  EXPECT_EQ(human_bytes(12345), "12.3 kB");
  EXPECT_EQ(human_bytes(999999), "1 MB");
  EXPECT_EQ(human_duration(0.42), "0.42 s");
  EXPECT_EQ(human_duration(200), "3 min 20 s");
  EXPECT_EQ(human_duration(7500), "2 h 05 min");
  EXPECT_EQ(human_duration(273600), "3 d 04 h");
  EXPECT_EQ(human_count(7), "7");
  EXPECT_EQ(human_count(123), "123");
  EXPECT_EQ(human_count(1234567), "1,234,567");
}

/// "0.001: too fast" beside "0.001: quasi-static" would say nothing.
TEST(HumanBeside, ShowsOnWhichSideOfALimitANumberLies) {
  EXPECT_EQ(human_beside(0.00042, 0.001), "0.00042");
  EXPECT_EQ(human_beside(0.00104, 0.001), "0.00104");
  EXPECT_EQ(human_beside(0.0010004, 0.001), "0.0010004");
  EXPECT_EQ(human_beside(0.001, 0.001), "0.001");
  EXPECT_EQ(human_beside(0.0347, 0.001), "0.035");
}

}  // namespace
}  // namespace reckon
