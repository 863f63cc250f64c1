// Folders of stereo images: which file belongs to which, and what is missing, before anything runs.
#include "hw_drivers/images/files/pair_list.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/picture/picture.h"
#include "tests/support/temporary_folder.h"

namespace enc::images {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class PairFolder : public testing::Test {
 protected:
  void put(const std::string& name, int width = 8, int height = 4, std::uint8_t grey = 0) const {
    Image image(width, height);
    image.rgb.assign(image.rgb.size(), grey);
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << sim::png(image);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] std::string root() const { return folder_.path().string(); }
  [[nodiscard]] std::string refusal(Layout layout) const {
    try {
      static_cast<void>(list_pairs(root(), layout));
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), testing::Not(HasSubstr("\n")));
      return e.what();
    }
    return {};
  }
  test::TemporaryFolder folder_;
};

TEST_F(PairFolder, PairsInNaturalOrder) {
  for (const char* name :
       {"left10.png", "right10.png", "left9.png", "right9.png", "left08.png", "right08.png"})
    put(name);
  put("chessboard.png", 3, 3);  // of no side: not asked
  const PairList list = list_pairs(root(), Layout::pairs);
  ASSERT_EQ(list.pairs.size(), 3U);
  EXPECT_EQ(list.pairs[0].left, path("left08.png"));
  EXPECT_EQ(list.pairs[1].right, path("right9.png"));
  EXPECT_EQ(list.pairs[2].left, path("left10.png"));
  EXPECT_EQ(list.size, (ImageSize{8, 4}));
  EXPECT_EQ(layout_of(root()), Layout::pairs);
}

TEST_F(PairFolder, SubfoldersWithTheWordOrWithout) {
  for (const char* name : {"left/a1.png", "right/a1.png", "left/left_2.png", "right/right_2.png"}) put(name);
  const PairList list = list_pairs(root(), Layout::pairs);
  ASSERT_EQ(list.pairs.size(), 2U);
  EXPECT_EQ(list.pairs[0].left, path("left/left_2.png"));
  EXPECT_EQ(list.pairs[1].right, path("right/a1.png"));
  EXPECT_EQ(layout_of(root()), Layout::pairs);
}

TEST_F(PairFolder, SideBySideIsSplitInTheMiddle) {
  put("1.png", 8, 4);
  put("2.png", 8, 4);
  EXPECT_EQ(layout_of(root()), Layout::side_by_side);
  PairReader reader(list_pairs(root(), Layout::side_by_side));
  EXPECT_EQ(reader.list().size, (ImageSize{4, 4}));
  Image both(4, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) both.at(x, y)[1] = static_cast<std::uint8_t>(10 * y + x);
  ImagePair halves;
  split(both.view(), halves);
  EXPECT_EQ(halves.left.at(1, 1)[1], 11);
  EXPECT_EQ(halves.right.at(0, 1)[1], 12);
  EXPECT_EQ(halves.right.at(1, 0)[1], 3);
  ImagePair read;
  reader.read(1, read);
  EXPECT_EQ(read.right.width, 4);
}

TEST_F(PairFolder, WhatIsMissingIsNamed) {
  put("left01.png"), put("right01.png"), put("left02.png");
  EXPECT_THAT(refusal(Layout::pairs), AllOf(StartsWith(path("left02.png")), HasSubstr("has no right image")));
  std::filesystem::rename(path("left02.png"), path("right02.png"));
  EXPECT_THAT(refusal(Layout::pairs), AllOf(StartsWith(path("right02.png")), HasSubstr("has no left image")));
}

TEST_F(PairFolder, AnotherSizeIsNamed) {
  put("left01.png"), put("right01.png"), put("left02.png"), put("right02.png", 8, 5);
  EXPECT_THAT(refusal(Layout::pairs), AllOf(StartsWith(path("right02.png")), HasSubstr("is 8 x 5 px"),
                                            HasSubstr("expected 8 x 4 as " + path("left01.png"))));
}

TEST_F(PairFolder, AnEmptyFolderNoFolderAndAnOddWidth) {
  EXPECT_THAT(refusal(Layout::pairs), HasSubstr("has no pairs of images"));
  EXPECT_THAT(refusal(Layout::side_by_side), HasSubstr("has no images"));
  put("1.png", 7, 4);
  EXPECT_THAT(refusal(Layout::side_by_side), HasSubstr("is 7 px wide; expected two images side by side"));
  EXPECT_THROW(static_cast<void>(list_pairs(path("none"), Layout::pairs)), Error);
}

TEST_F(PairFolder, WhatIsNoImageIsFoundBeforeItIsNeeded) {
  put("left01.png"), put("right01.png"), put("right02.png");
  std::ofstream(path("left02.png")) << "these are words";
  EXPECT_THAT(refusal(Layout::pairs),
              AllOf(StartsWith(path("left02.png")), HasSubstr("neither PNG nor JPEG")));
}

TEST_F(PairFolder, TwoThatWouldBeTheSame) {
  put("left01.png"), put("right01.png"), put("left01.jpg");
  EXPECT_THAT(refusal(Layout::pairs), HasSubstr("is the same image by its name"));
}

}  // namespace
}  // namespace enc::images
