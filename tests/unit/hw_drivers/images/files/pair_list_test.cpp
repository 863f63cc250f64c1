// Folders of stereo images: which file belongs to which, and what is missing, before anything runs.
#include "hw_drivers/images/files/pair_list.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
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

// Two pairs of each, as people and tools name them.
struct Naming {
  const char *left, *right;  // with a number for {}
};
class PairNaming : public PairFolder, public testing::WithParamInterface<Naming> {
 protected:
  static std::string numbered(std::string name, const char* number) {
    return name.replace(name.find("{}"), 2, number);
  }
};

TEST_P(PairNaming, SaysWhichImageBelongsToWhich) {
  for (const char* number : {"10", "9"})
    for (const char* name : {GetParam().left, GetParam().right}) put(numbered(name, number));
  ASSERT_EQ(layout_of(root()), Layout::pairs);
  const PairList list = list_pairs(root(), Layout::pairs);
  ASSERT_EQ(list.pairs.size(), 2U);
  EXPECT_EQ(list.pairs[0].left, path(numbered(GetParam().left, "9")));
  EXPECT_EQ(list.pairs[0].right, path(numbered(GetParam().right, "9")));
  EXPECT_EQ(list.pairs[1].left, path(numbered(GetParam().left, "10")));
  EXPECT_EQ(list.pairs[1].right, path(numbered(GetParam().right, "10")));
  EXPECT_EQ(list.words,
            numbered(GetParam().left, "9") + " with " + numbered(GetParam().right, "9") + ", and 1 more");
}

INSTANTIATE_TEST_SUITE_P(
    Folders, PairNaming,
    testing::Values(Naming{"Left/{}.png", "Right/{}.png"}, Naming{"LEFT/a{}.PNG", "RIGHT/a{}.png"},
                    Naming{"L/{}.png", "R/{}.png"}, Naming{"cam0/{}.png", "cam1/{}.png"},
                    Naming{"Cam1/{}.png", "Cam2/{}.png"}, Naming{"cam_left/{}.png", "cam_right/{}.png"},
                    Naming{"camera_0/{}.jpg", "camera_1/{}.png"}, Naming{"0/{}.png", "1/{}.png"},
                    Naming{"image_02/data/{}.png", "image_03/data/{}.png"},
                    Naming{"Left/L{}.png", "Right/R{}.png"}, Naming{"cam0/cam0_{}.png", "cam1/cam1_{}.png"},
                    Naming{"left/{}_left.png", "right/{}.png"},
                    Naming{"left/bright{}.png", "right/bright{}.png"}));
INSTANTIATE_TEST_SUITE_P(
    Files, PairNaming,
    testing::Values(Naming{"L{}.png", "R{}.png"}, Naming{"{}L.png", "{}R.png"},
                    Naming{"{}_l.png", "{}_r.png"}, Naming{"imgL{}.png", "imgR{}.png"},
                    Naming{"left_{}.png", "right_{}.png"}, Naming{"{}_left.png", "{}_right.png"},
                    Naming{"cam_left{}.png", "cam_right{}.png"}, Naming{"Left{}.PNG", "right{}.jpg"},
                    Naming{"cam0_{}.png", "cam1_{}.png"}, Naming{"{}_Camera1.png", "{}_Camera2.png"},
                    Naming{"left_hand_L{}.png", "left_hand_R{}.png"},
                    Naming{"right_hand_left{}.png", "right_hand_right{}.png"}));

TEST_F(PairFolder, WhatSaysNoSideIsSideBySide) {
  for (const char* name : {"bright1.png", "bright2.png", "cam0001.png", "cam0002.png", "level1.png"})
    put(name);
  EXPECT_EQ(layout_of(root()), Layout::side_by_side);
  EXPECT_EQ(list_pairs(root(), Layout::side_by_side).words,
            "the left and the right half of bright1.png, and 4 more");
}

TEST_F(PairFolder, CountsOfBothSidesAreToldWhereOneIsMissing) {
  for (const char* name : {"cam0/1.png", "cam0/2.png", "cam0/3.png", "cam1/1.png", "cam1/3.png"}) put(name);
  EXPECT_THAT(refusal(Layout::pairs), AllOf(StartsWith(path("cam0/2.png") + ": has no right image"),
                                            HasSubstr("3 left and 2 right images")));
}

TEST_F(PairFolder, OneSideAloneIsNoPairSideBySide) {
  put("L1.png"), put("L2.png");
  EXPECT_EQ(layout_of(root()), Layout::pairs);
  EXPECT_THAT(refusal(Layout::pairs),
              AllOf(StartsWith(path("L1.png") + ": has no right image"), HasSubstr("2 left and 0 right")));
}

TEST_F(PairFolder, WhatIsThereIsToldWhereNoPairsAre) {
  put("first/1.png"), put("first/2.png"), put("second/1.png");
  std::filesystem::create_directory(path("empty"));
  EXPECT_EQ(layout_of(root()), Layout::pairs);
  EXPECT_THAT(refusal(Layout::pairs),
              AllOf(HasSubstr("only the folders empty (0 images), first (2 images), second (1 image)"),
                    HasSubstr("expected left01.png and right01.png, or folders left and right")));
}

TEST_F(PairFolder, ALeftFolderWithoutARightOneIsTold) {
  put("Left/1.png");
  EXPECT_EQ(layout_of(root()), Layout::pairs);
  EXPECT_THAT(refusal(Layout::pairs), HasSubstr("only the folder Left (1 image)"));
}

TEST_F(PairFolder, ThreeCamerasAreNotTwo) {
  put("cam0/1.png"), put("cam1/1.png"), put("cam2/1.png");
  EXPECT_THAT(refusal(Layout::pairs),
              HasSubstr("several pairs of folders, such as cam0 and cam1, cam1 and cam2"));
}

TEST_F(PairFolder, ThreeCamerasOfOneFolderAreNotTwo) {
  put("cam0_1.png"), put("cam1_1.png"), put("cam2_1.png");
  EXPECT_THAT(refusal(Layout::pairs), HasSubstr("belongs to more than one image"));
}

TEST_F(PairFolder, ImagesOfNoSideAreCounted) {
  put("left1.png"), put("right1.png"), put("board.png", 3, 3);
  EXPECT_EQ(list_pairs(root(), Layout::pairs).words,
            "left1.png with right1.png; 1 image of no side left aside");
}

}  // namespace
}  // namespace enc::images
