// Pictures through the bytes of a camera and back.
#include "hw_drivers/v4l2/wire/pixels.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hw_drivers/v4l2/fake/encode.h"

namespace enc::v4l2 {
namespace {

// Slopes of all colours; `step` shifts them.
Image slopes(int width, int height, int step) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::uint8_t* rgb = image.at(x, y);
      rgb[0] = static_cast<std::uint8_t>(40 + 160 * x / width);
      rgb[1] = static_cast<std::uint8_t>(200 - 150 * y / height);
      rgb[2] = static_cast<std::uint8_t>(60 + 100 * x / width + step);
    }
  return image;
}
double rms_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  if (a.rgb.size() != b.rgb.size()) return 256.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::pow(1.0 * a.rgb[i] - b.rgb[i], 2.0);
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

TEST(V4l2Pixels, NamesOfFormats) {
  EXPECT_EQ(code_of(Pixels::yuyv), 0x56595559U);
  EXPECT_EQ(code_of(Pixels::mjpeg), 0x47504a4dU);
  EXPECT_EQ(text_of(code_of(Pixels::grey)), "GREY");
  EXPECT_EQ(text_of(0x20363159U), "Y16");
  EXPECT_EQ(text_of(0x00000001U), "????");
}

TEST(V4l2Pixels, BothSidesComeBack) {
  const Image left = slopes(64, 24, 0), right = slopes(64, 24, 40);
  const ImageView beside = right.view();
  Encoder encoder;
  Decoder decoder;
  Image l, r;
  for (const auto& [pixels, most] :
       {std::pair{Pixels::yuyv, 1.5}, {Pixels::mjpeg, 4.0}, {Pixels::rgb, 0.0}}) {
    const std::vector<std::uint8_t> bytes = encoder.encode(pixels, left.view(), &beside);
    const Raster raster{pixels, 128, 24, row_bytes(pixels, 128)};
    ASSERT_TRUE(decoder.halves(bytes, raster, l, r));
    EXPECT_LE(rms_difference(left, l), most) << word_of(pixels);
    EXPECT_LE(rms_difference(right, r), most) << word_of(pixels);
    const std::vector<std::uint8_t> alone = encoder.encode(pixels, left.view());
    ASSERT_TRUE(decoder.whole(alone, {pixels, 64, 24, row_bytes(pixels, 64)}, l));
    EXPECT_LE(rms_difference(left, l), most) << word_of(pixels);
  }
}

// Values of ITU-R BT.601: white, black, and the primary colours.
TEST(V4l2Pixels, YuyvIsBt601) {
  const std::vector<std::uint8_t> bytes{235, 128, 16,  128, 81, 90,  81, 240,
                                        145, 54,  145, 34,  41, 240, 41, 110};
  const std::vector<std::uint8_t> expected{255, 255, 255, 0, 0,   0, 255, 0, 0,   255, 0, 0,
                                           0,   255, 0,   0, 255, 0, 0,   0, 255, 0,   0, 255};
  Decoder decoder;
  Image image;
  ASSERT_TRUE(decoder.whole(bytes, {Pixels::yuyv, 8, 1, 16}, image));
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(image.rgb[i], expected[i], 1) << i;
}

TEST(V4l2Pixels, GreyWithAPaddedRow) {
  const std::vector<std::uint8_t> bytes{1, 2, 3, 4, 0, 0, 5, 6, 7, 8};
  Decoder decoder;
  Image left, right;
  ASSERT_TRUE(decoder.halves(bytes, {Pixels::grey, 4, 2, 6}, left, right));
  EXPECT_EQ(left.rgb, (std::vector<std::uint8_t>{1, 1, 1, 2, 2, 2, 5, 5, 5, 6, 6, 6}));
  EXPECT_EQ(right.rgb, (std::vector<std::uint8_t>{3, 3, 3, 4, 4, 4, 7, 7, 7, 8, 8, 8}));
}

TEST(V4l2Pixels, TooFewBytesAndDamageAreRefused) {
  const Image left = slopes(64, 24, 0);
  Encoder encoder;
  Decoder decoder;
  Image image, other;
  for (const Pixels pixels : {Pixels::yuyv, Pixels::mjpeg, Pixels::grey, Pixels::rgb}) {
    std::vector<std::uint8_t> bytes = encoder.encode(pixels, left.view());
    const Raster raster{pixels, 64, 24, row_bytes(pixels, 64)};
    ASSERT_TRUE(decoder.whole(bytes, raster, image));
    bytes.resize(bytes.size() / 2);
    EXPECT_FALSE(decoder.whole(bytes, raster, image)) << word_of(pixels);
    EXPECT_FALSE(decoder.halves({}, raster, image, other));
  }
  const std::vector<std::uint8_t> jpeg = encoder.encode(Pixels::mjpeg, left.view());
  EXPECT_FALSE(decoder.whole(jpeg, {Pixels::mjpeg, 128, 24, 0}, image));  // of another size
  EXPECT_FALSE(decoder.whole(jpeg, {Pixels::mjpeg, 0, 24, 0}, image));
  EXPECT_FALSE(decoder.whole(jpeg, {Pixels::yuyv, 63, 2, 126}, image));
}

}  // namespace
}  // namespace enc::v4l2
