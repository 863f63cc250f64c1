// Decoders: what is whole comes out as it was, what is not is one line with the file's name.
#include "hw_drivers/images/files/image_file.h"

#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include "core/base/error.h"
#include "sim/picture/picture.h"
#include "tests/support/temporary_folder.h"

namespace enc::images {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

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
  const Image image = gradient(33, 21);
  const Image back = decoded(sim::png(image));
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

// Wherever it is cut. A PNG that lacks no more than its last mark is refused, too.
TEST(ImageFile, WhatIsCutOffIsRefused) {
  for (const std::string& whole : {sim::png(gradient(40, 30)), jpeg_of(gradient(40, 30))})
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 50)
      EXPECT_NE(refusal(whole.substr(0, size)), "") << size << " of " << whole.size();
  const std::string png = sim::png(gradient(40, 30));
  EXPECT_THAT(refusal(png.substr(0, png.size() / 2)), HasSubstr("is cut off"));
  const std::string jpeg = jpeg_of(gradient(40, 30));
  EXPECT_THAT(refusal(jpeg.substr(0, jpeg.size() / 2)), HasSubstr("is damaged or cut off"));
}

// Every byte of a PNG is under a checksum, but for those of its length fields, which lead astray.
TEST(ImageFile, ADamagedByteOfAPngIsFound) {
  const std::string whole = sim::png(gradient(40, 30));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    try {
      EXPECT_EQ(decoded(bytes).rgb, gradient(40, 30).rgb) << at;  // of no importance, or:
    } catch (const Error&) {
    }
  }
}

// A JPEG has no checksum: damage may pass as another picture, but never as a crash.
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

}  // namespace
}  // namespace enc::images
