// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/hdf5_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/random.hpp"
#include "reckon/core/xxhash64.hpp"

namespace reckon {
namespace {

// Computed with the reference program, xxhsum -H1.
TEST(XxHash64, KnownAnswersHoweverTheTextIsCut) {
  const auto hash = [](std::string_view text, std::size_t piece) {
    XxHash64 hasher;
    for (std::size_t k = 0; k < text.size(); k += piece) hasher.update(text.substr(k, piece));
    return hasher.digest();
  };
  std::string thousand;
  for (int k = 0; k < 1000; ++k) thousand.push_back(static_cast<char>(33 + (k * 7) % 90));
  for (const std::size_t piece : {1UL, 7UL, 31UL, 32UL, 33UL, 1000UL}) {
    EXPECT_EQ(hash("", piece), 0xef46db3751d8e999);
    EXPECT_EQ(hash("abc", piece), 0x44bc2cf5ad770999);
    EXPECT_EQ(hash("The quick brown fox jumps over the lazy dog", piece), 0x0b242d361fda71bc);
    EXPECT_EQ(hash(thousand, piece), 0x2a73ce7fe6ddf4f1);
  }
}

class Hdf5File : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path{::testing::TempDir()} /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
    file_ = folder_ / "a.h5";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write_example() const {
    Hdf5Writer writer{file_, {"example", 3}};
    writer.write<double>("/deep/group/heights", {1, 2, 3, 4, 5, 6}, {3, 2}, "m");
    writer.create("/counts", Hdf5Number::uint32, {4}, "1");
    const std::vector<std::uint32_t> tail{8, 9};
    writer.write_rows<std::uint32_t>("/counts", 2, tail);
    writer.write<float>("/nothing", {}, {0, 3}, "m");
    writer.write_texts("/names", {"a", "", "longer name"});
    writer.write_note("title", "what it is");
    writer.finish();
  }

  std::filesystem::path folder_;
  std::filesystem::path file_;
};

TEST_F(Hdf5File, GivesBackWhatWasWritten) {
  write_example();
  const Hdf5Reader reader{file_, {"example", 3}};
  EXPECT_EQ(reader.version(), 3U);
  EXPECT_EQ(reader.read<double>("/deep/group/heights", {3, 2}),
            (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(reader.read<std::uint32_t>("/counts", {4}), (std::vector<std::uint32_t>{0, 0, 8, 9}));
  std::vector<double> row(2);
  reader.read_rows<double>("/deep/group/heights", 1, row);
  EXPECT_EQ(row, (std::vector<double>{3, 4}));
  EXPECT_TRUE(reader.read<float>("/nothing", {0, 3}).empty());
  EXPECT_EQ(reader.read_texts("/names", 3), (std::vector<std::string>{"a", "", "longer name"}));
  EXPECT_EQ(reader.read_note("title"), "what it is");
  EXPECT_TRUE(reader.has("/counts"));
  EXPECT_FALSE(reader.has("/missing"));
}

TEST_F(Hdf5File, RefusesToReadWhatIsNotThere) {
  write_example();
  const Hdf5Reader reader{file_, {"example", 3}};
  EXPECT_THROW((void)reader.read<double>("/missing", {3}), Error);
  EXPECT_THROW((void)reader.read<double>("/deep/group/heights", {6}), Error);
  EXPECT_THROW((void)reader.read<float>("/deep/group/heights", {3, 2}), Error);
  EXPECT_THROW((void)reader.read_texts("/counts", 4), Error);
  EXPECT_THROW((void)reader.read_texts("/names", 2), Error);
  EXPECT_THROW((void)reader.read_note("missing"), Error);
  std::vector<double> rows(4);
  EXPECT_THROW(reader.read_rows<double>("/deep/group/heights", 2, rows), Error);
  EXPECT_THROW(Hdf5Reader(file_, {"example", 2}), Error) << "the file is of a later version";
  EXPECT_THROW(Hdf5Reader(file_, {"other", 3}), Error);
  EXPECT_THROW(Hdf5Reader(folder_, {"example", 3}), Error);
  EXPECT_THROW(Hdf5Reader(folder_ / "missing", {"example", 3}), Error);
}

TEST_F(Hdf5File, EveryFlippedByteAndEveryCutIsNoticed) {
  write_example();
  const std::string good = read_file(file_);
  RandomStream random{1, RandomPurpose::other, 0};
  const auto expect_refused = [&](const std::string& bytes) {
    write_file(file_, bytes);
    EXPECT_THROW(Hdf5Reader(file_, {"example", 3}), Error);
  };
  const std::size_t seal_text = good.find('\0');
  for (int trial = 0; trial < 300; ++trial) {
    const double u = random.uniform();
    const std::size_t at =
        trial < 100 ? static_cast<std::size_t>(u * static_cast<double>(seal_text))
                    : 512 + static_cast<std::size_t>(u * static_cast<double>(good.size() - 512));
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << (trial % 8)));
    expect_refused(bad);
    expect_refused(good.substr(0, at));
  }
  expect_refused("");
  expect_refused(good + "x");
}

TEST_F(Hdf5File, EqualContentGivesEqualBytesAndAnUnfinishedFileLeavesNothing) {
  write_example();
  const std::string first = read_file(file_);
  write_example();
  EXPECT_EQ(read_file(file_), first);
  {
    Hdf5Writer writer{folder_ / "unfinished.h5", {"example", 3}};
    writer.write<double>("/a", {1}, {1}, "m");
    EXPECT_THROW(writer.write<double>("/b", {1, 2, 3}, {2}, "m"), Error);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator{folder_}, {}), 1);
}

}  // namespace
}  // namespace reckon
