// Files: nothing that is there or was read is written over, and no two runs write one.
#include "models/files.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using testing::HasSubstr;

class Files : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  static std::string refusal(const std::string& path, Existing existing) {
    try {
      OutFile(path, existing).write("new");
      return {};
    } catch (const Error& e) {
      return e.what();
    }
  }
  test::TemporaryFolder folder_;
};

TEST_F(Files, StandBesideTheirPlaceUntilTheyAreWhole) {
  {
    OutFile file(path("a"), Existing::keep);
    file.write("half");
    EXPECT_FALSE(fs::exists(path("a")));
    EXPECT_EQ(bytes_of(file.aside()), "half");
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  write_file(path("a"), "whole", Existing::keep);
  EXPECT_EQ(bytes_of(path("a")), "whole");
  EXPECT_FALSE(fs::exists(path("a.part")));
}

TEST_F(Files, WhatIsThereStaysUnlessItShallBeReplaced) {
  write_file(path("a"), "old", Existing::keep);
  EXPECT_THAT(refusal(path("a"), Existing::keep), HasSubstr("is there already; expected a new file"));
  EXPECT_EQ(bytes_of(path("a")), "old");
  write_file(path("a"), "new", Existing::replace);
  EXPECT_EQ(bytes_of(path("a")), "new");
}

// Who can write into the folder would else choose what is written over.
TEST_F(Files, ALinkIsNeverWrittenThrough) {
  write_file(path("theirs"), "theirs", Existing::keep);
  for (const Existing existing : {Existing::keep, Existing::replace})
    for (const char* target : {"theirs", "free"})
      for (const char* name : {"a", "a.part"}) {
        fs::create_symlink(path(target), path(name));
        EXPECT_THAT(refusal(path("a"), existing), HasSubstr("is a link"));
        EXPECT_TRUE(fs::is_symlink(path(name)));
        fs::remove(path(name));
        EXPECT_EQ(bytes_of(path("theirs")), "theirs");
        EXPECT_FALSE(fs::exists(path("free")) || fs::exists(path("a")) || fs::exists(path("a.part")));
      }
}

// With --force what is left of another run goes, and not what else has the same bytes.
TEST_F(Files, WhatAnotherNameHasTooIsNotWrittenOver) {
  write_file(path("theirs"), "theirs", Existing::keep);
  fs::create_hard_link(path("theirs"), path("a.part"));
  write_file(path("a"), "mine", Existing::replace);
  EXPECT_EQ(bytes_of(path("theirs")), "theirs");
  EXPECT_EQ(bytes_of(path("a")), "mine");
  ASSERT_EQ(mkfifo(path("b.part").c_str(), 0600), 0);
  EXPECT_THAT(refusal(path("b"), Existing::replace), HasSubstr("b.part: is no file of yours"));
}

// A link that takes the place of the file while it is written is put away, not followed.
TEST_F(Files, NorIsALinkThatAppearsMeanwhile) {
  write_file(path("theirs"), "theirs", Existing::keep);
  OutFile file(path("a"), Existing::replace);
  file.write("mine");
  fs::create_symlink(path("theirs"), path("a"));
  file.keep();
  EXPECT_FALSE(fs::is_symlink(path("a")));
  EXPECT_EQ(bytes_of(path("a")), "mine");
  EXPECT_EQ(bytes_of(path("theirs")), "theirs");
}

// Also what came there while it was written; then nothing of either is lost.
TEST_F(Files, WhatAppearsMeanwhileStays) {
  OutFile file(path("a"), Existing::keep);
  file.write("mine");
  write_file(path("b"), "yours", Existing::keep);
  fs::rename(path("b"), path("a"));
  EXPECT_THROW(file.keep(), Error);
  EXPECT_EQ(bytes_of(path("a")), "yours");
  EXPECT_EQ(bytes_of(path("a.part")), "mine");
}

TEST_F(Files, AnInputIsNeverAnOutput) {
  write_file(path("a"), "read", Existing::keep);
  std::string why;
  EXPECT_EQ(read_file(path("a"), 100, why), "read");
  fs::create_symlink(path("a"), path("link"));
  fs::create_hard_link(path("a"), path("hard"));
  for (const char* name : {"a", "link", "hard"})
    EXPECT_THAT(refusal(path(name), Existing::replace), HasSubstr("is read by this command")) << name;
  EXPECT_EQ(bytes_of(path("a")), "read");
}

TEST_F(Files, TwoDoNotWriteOne) {
  OutFile first(path("a"), Existing::replace);
  first.write("first");
  EXPECT_THAT(refusal(path("a"), Existing::replace), HasSubstr("another run is writing it"));
  first.keep();
  EXPECT_EQ(bytes_of(path("a")), "first");
  const OutFolder alone(path("out"));
  EXPECT_THROW(OutFolder(path("out")), Error);
}

TEST_F(Files, WhatARunLeftIsNotWrittenOver) {
  {
    OutFile file(path("a"), Existing::keep);
    file.spare();
    file.write("half");
  }
  EXPECT_THAT(refusal(path("a"), Existing::keep), HasSubstr("a.part: is left of a run that did not end"));
  EXPECT_EQ(bytes_of(path("a.part")), "half");
  write_file(path("a"), "x", Existing::replace);
  EXPECT_EQ(bytes_of(path("a")), "x");
}

TEST_F(Files, DevicesStayDevices) {
  write_file("/dev/null", "gone", Existing::keep);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(write_file("/dev/full", "x", Existing::keep), Error);
  EXPECT_THROW(write_file(folder_.path().string(), "x", Existing::replace), Error);
  EXPECT_THROW(write_file(path("none/a"), "x", Existing::replace), Error);
}

TEST_F(Files, WhatNeverEndsIsNotRead) {
  std::string why;
  EXPECT_EQ(read_file("/dev/zero", std::size_t{1} << 20U, why), "");
  EXPECT_EQ(why, "it is a device");
  why.clear();
  write_file(path("long"), std::string((std::size_t{1} << 20U) + 1, 'x'), Existing::keep);
  EXPECT_EQ(read_file(path("long"), std::size_t{1} << 20U, why), "");
  EXPECT_EQ(why, "it is longer than 1 MiB");
}

}  // namespace
}  // namespace enc::models
