// Decoders return the image of a complete file. For a damaged file they give one line with its name.
#include "tests/support/files.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <png.h>
#include <turbojpeg.h>

#include "core/base/error.h"
#include "hw_drivers/images/files/image_file.h"
#include "hw_drivers/images/files/pair_list.h"
#include "sim/picture/picture.h"
#include "tests/support/refusal.h"

namespace enc::images {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not, testing::StartsWith;

Image gradient(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.at(x, y)[0] = static_cast<std::uint8_t>(3 * x);
      image.at(x, y)[1] = static_cast<std::uint8_t>(5 * y);
      image.at(x, y)[2] = static_cast<std::uint8_t>(x + y);
    }
  return image;
}

std::string jpeg_of(const Image& image, int format = TJPF_RGB, int samples = TJSAMP_444) {
  const tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  tjCompress2(handle, image.rgb.data(), image.width, 0, image.height, format, &bytes, &size, samples, 95, 0);
  std::string text(reinterpret_cast<char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(handle);
  return text;
}

std::string grey_png(int width, int height, png_uint_32 format, std::size_t bytes_each) {
  png_image out{};
  out.version = PNG_IMAGE_VERSION;
  out.width = static_cast<png_uint_32>(width);
  out.height = static_cast<png_uint_32>(height);
  out.format = format;
  const std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height) * bytes_each, 77);
  png_alloc_size_t size = 1U << 16U;
  std::string bytes(size, '\0');
  png_image_write_to_memory(&out, bytes.data(), &size, 0, pixels.data(), 0, nullptr);
  bytes.resize(size);
  return bytes;
}

Image decoded(const std::string& bytes) {
  Image image;
  decode_image(bytes, "x.png", image);
  return image;
}

std::string refusal(const std::string& bytes) {
  try {
    decoded(bytes);
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(StartsWith("x.png: "), Not(HasSubstr("\n"))));
    return e.what();
  }
  return {};
}

TEST(ImageFile, APngComesBackToTheBit) {
  const Image image = gradient(33, 21), back = decoded(sim::png(image));
  EXPECT_EQ(back.width, 33);
  EXPECT_EQ(back.height, 21);
  EXPECT_EQ(back.rgb, image.rgb);
}

TEST(ImageFile, AJpegComesBackNearlyAndAlwaysTheSame) {
  const Image image = gradient(48, 32);
  const std::string bytes = jpeg_of(image);
  const Image back = decoded(bytes);
  ASSERT_EQ(back.rgb.size(), image.rgb.size());
  for (std::size_t i = 0; i < back.rgb.size(); ++i) ASSERT_NEAR(back.rgb[i], image.rgb[i], 8) << i;
  EXPECT_EQ(decoded(bytes).rgb, back.rgb);
}

TEST(ImageFile, GreyBecomesRgbAndWhatIsTransparentLiesOnBlack) {
  const Image grey = decoded(grey_png(4, 3, PNG_FORMAT_GRAY, 1));
  EXPECT_THAT(grey.rgb, testing::Each(77));
  EXPECT_EQ(grey.rgb.size(), 36U);
  const Image clear = decoded(grey_png(4, 3, PNG_FORMAT_RGBA, 4));  // 77 of 255 opaque
  EXPECT_THAT(clear.rgb, testing::Each(testing::Lt(77)));
  Image sheet(16, 8);
  sheet.rgb.assign(sheet.rgb.size(), 120);
  const std::string jpeg = jpeg_of(sheet, TJPF_GRAY, TJSAMP_GRAY);
  const Image from_jpeg = decoded(jpeg);
  EXPECT_EQ(from_jpeg.width, 16);
  EXPECT_THAT(from_jpeg.rgb, testing::Each(testing::AllOf(testing::Ge(119), testing::Le(121))));
}

TEST(ImageFile, AnImageOfOnePixelIsAnImage) {
  EXPECT_EQ(decoded(sim::png(gradient(1, 1))).rgb.size(), 3U);
  EXPECT_EQ(decoded(jpeg_of(gradient(1, 1))).rgb.size(), 3U);
}

// The file may end anywhere. The decoder also refuses a PNG that lacks only its last mark.
TEST(ImageFile, WhatIsCutOffIsRefused) {
  for (const std::string& whole : {sim::png(gradient(40, 30)), jpeg_of(gradient(40, 30))})
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 50)
      EXPECT_NE(refusal(whole.substr(0, size)), "") << size << " of " << whole.size();
  const std::string png = sim::png(gradient(40, 30));
  EXPECT_THAT(refusal(png.substr(0, png.size() / 2)), HasSubstr("is cut off"));
  const std::string jpeg = jpeg_of(gradient(40, 30));
  EXPECT_THAT(refusal(jpeg.substr(0, jpeg.size() / 2)), HasSubstr("is damaged or cut off"));
}

// A checksum covers every byte of a PNG except its length fields, which mislead the reader.
TEST(ImageFile, ADamagedByteOfAPngIsFound) {
  const std::string whole = sim::png(gradient(40, 30));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    try {
      EXPECT_EQ(decoded(bytes).rgb, gradient(40, 30).rgb) << at;  // an unimportant byte, or:
    } catch (const Error&) {
    }
  }
}

// A JPEG has no checksum: damage may pass as another picture, but must never crash.
TEST(ImageFile, DamagedJpegsEndInAPictureOrInALine) {
  const std::string whole = jpeg_of(gradient(40, 30));
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ flip);
      try {
        const Image image = decoded(bytes);
        EXPECT_EQ(image.rgb.size(), 3U * static_cast<std::size_t>(image.width * image.height));
      } catch (const Error& e) {
        EXPECT_THAT(e.what(), StartsWith("x.png: "));
      }
    }
}

TEST(ImageFile, WhatIsNoImageIsRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal("GIF89a"), HasSubstr("neither PNG nor JPEG"));
  std::string huge = sim::png(gradient(8, 8));
  huge[18] = 0x7f;  // width 32520
  EXPECT_THAT(refusal(huge), AllOf(HasSubstr("32520 x 8 px"), HasSubstr("make it smaller")));
}

TEST(ImageFile, TheSizeIsReadFromTheHeader) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.file("a.png"), std::ios::binary) << sim::png(gradient(33, 21)).substr(0, 60);
  std::ofstream(folder.file("a.jpg"), std::ios::binary) << jpeg_of(gradient(48, 32)).substr(0, 640);
  EXPECT_EQ(image_size(folder.file("a.png")), (ImageSize{33, 21}));
  EXPECT_EQ(image_size(folder.file("a.jpg")), (ImageSize{48, 32}));
  EXPECT_THROW(static_cast<void>(image_size(folder.file("none.png"))), Error);
  EXPECT_THROW(static_cast<void>(image_size(folder.path().string())), Error);
}

TEST(ImageFile, NamesOfImages) {
  EXPECT_TRUE(is_image_name("A.PNG") && is_image_name("a.jpeg") && is_image_name("b.Jpg"));
  EXPECT_FALSE(is_image_name("a.bmp") || is_image_name("png") || is_image_name("a.png.part"));
}

// Folders of stereo images: the pairing of files and the missing files, before anything runs.

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
    return test::refusal([&] { (void)list_pairs(root(), layout); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(PairFolder, PairsInNaturalOrder) {
  for (const char* name :
       {"left10.png", "right10.png", "left9.png", "right9.png", "left08.png", "right08.png"})
    put(name);
  put("chessboard.png", 3, 3);  // no side in its name: ignored
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

// Two pairs for each naming style of people and tools.
struct Naming {
  const char *left, *right;  // patterns with a number for {}
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
