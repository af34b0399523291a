// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <new>
#include <string>

#include "reckon/core/failure_text.hpp"
#include "reckon/core/utf8.hpp"
#include "reckon/core/write_failure.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

TEST(TemporaryNames, AreThoseOfPendingFilesAlone) {
  const PendingFile pending{::testing::TempDir() + "run.json"};
  const std::string name = pending.temporary().filename().string();
  EXPECT_EQ(target_of_temporary(name), "run.json");
  for (const char* other : {"my.tmp", "run.json.tmp", "run.json.12.tmp", "run.json.1-.tmp",
                            "run.json.a-1.tmp", ".12-3.tmp", "run.json"}) {
    EXPECT_FALSE(target_of_temporary(other)) << other;
  }
}

TEST(ReadFile, TakesNoDeviceWhichMayHaveNoEnd) {
  EXPECT_THROW((void)read_file("/dev/zero"), Error);
  EXPECT_THROW((void)read_file(::testing::TempDir()), Error);
}

TEST(OwnFiles, AreReplacedAndOthersNot) {
  const std::filesystem::path file = testing::test_path();
  const auto is_refused = [&] {
    try {
      require_own_file(file, "name,size", "table of shapes");
    } catch (const Error& error) {
      EXPECT_NE(std::string{error.what()}.find("no table of shapes"), std::string::npos);
      return true;
    }
    return false;
  };
  EXPECT_FALSE(is_refused());  // nothing is there
  write_file(file, "");
  EXPECT_FALSE(is_refused());
  write_file(file, "name,size\na,1\n");
  EXPECT_FALSE(is_refused());
  write_file(file, "the only copy of something else\n");
  EXPECT_TRUE(is_refused());
  std::filesystem::remove(file);
}

TEST(WriteFailures, NameTheDiskAndTheCure) {
  const auto text = [](int error_number) {
    try {
      throw_write_failure("/tmp/nowhere/run.json", error_number);
    } catch (const MachineFailure& failure) {
      return std::string{failure.what()};
    } catch (const Error& error) {
      return std::string{"an input's error: "} + error.what();
    }
  };
  const std::string full = text(ENOSPC);
  EXPECT_EQ(full.find("/tmp/nowhere/run.json: cannot be written (No space left on device; the disk "
                      "at /"),
            0U)
      << full;
  EXPECT_NE(full.find(" free of "), std::string::npos) << full;
  EXPECT_NE(full.find("Make room there"), std::string::npos) << full;
  EXPECT_NE(text(EFBIG).find("ulimit -f"), std::string::npos);
  EXPECT_NE(text(EDQUOT).find("quota"), std::string::npos);
  EXPECT_EQ(text(EACCES).find("an input's error"), 0U) << "permissions are for the user to mend";
}

TEST(FailureText, SaysWhatAUserCanDo) {
  EXPECT_NE(failure_text(std::bad_alloc{}).problem.find("memory"), std::string::npos);
  EXPECT_TRUE(is_failure_of_machine(std::bad_alloc{}));
  EXPECT_TRUE(is_failure_of_machine(std::length_error{"vector"}));
  EXPECT_FALSE(is_failure_of_machine(std::logic_error{"a fault of ours"}));
  const std::filesystem::filesystem_error full{"cannot rename", "/tmp/a",
                                               std::make_error_code(std::errc::no_space_on_device)};
  EXPECT_TRUE(is_failure_of_machine(full));
  EXPECT_NE(failure_text(full).reason.find("No space left"), std::string::npos);
}

TEST(Utf8, IsAlwaysValidAndKeepsWhatIs) {
  for (const char* good : {"plain", "d\u00e9j\u00e0 vu", "\u6c99", "\U0001f3d6", ""}) {
    EXPECT_EQ(valid_utf8(good), good);
    EXPECT_EQ(printable(good), good);
  }
  const std::string mark = "\xef\xbf\xbd";
  EXPECT_EQ(valid_utf8("a\xff!"), "a" + mark + "!");
  EXPECT_EQ(valid_utf8("\xc3"), mark);                        // cut short
  EXPECT_EQ(valid_utf8("\xc0\xaf"), mark + mark);             // longer than need be
  EXPECT_EQ(valid_utf8("\xed\xa0\x80"), mark + mark + mark);  // a surrogate
}

TEST(Utf8, MessagesCannotSteerATerminal) {
  EXPECT_EQ(printable("a\x1b[2Jb\r\x07"), "a\\x1b[2Jb\\x0d\\x07");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\xc2\\x9b31m");                               // the same as one character
  EXPECT_EQ(printable("\xe2\x80\xae"), "\\xe2\\x80\\xae");  // text from right to left
  EXPECT_EQ(printable("one\n\ttwo \xff"), "one\n\ttwo \\xff");
}

}  // namespace
}  // namespace reckon
