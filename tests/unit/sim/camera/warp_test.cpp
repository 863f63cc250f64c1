// Lenses by hand and there and back; what a warp does to a drawing.
#include "sim/camera/warp.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc::sim {
namespace {

Lens bent() {
  Lens lens;
  lens.focal_x = 540.0;
  lens.focal_y = 538.0;
  lens.centre_x = 331.0;
  lens.centre_y = 235.5;
  lens.distortion = {-0.28, 0.09, 0.0011, -0.0007, -0.012};
  return lens;
}

// OpenCV's formula with (k1, k2, p1, p2, k3) worked out for one point.
TEST(Warp, DistortionByHand) {
  Lens lens;
  lens.distortion = {0.1, 0.02, 0.003, -0.004, 0.005};
  const auto [x, y] = distorted(lens, 0.3, -0.4);
  const double radial = 1.0 + 0.1 * 0.25 + 0.02 * 0.0625 + 0.005 * 0.015625;
  EXPECT_NEAR(x, 0.3 * radial + 2 * 0.003 * -0.12 + -0.004 * (0.25 + 2 * 0.09), 1e-15);
  EXPECT_NEAR(y, -0.4 * radial + 0.003 * (0.25 + 2 * 0.16) + 2 * -0.004 * -0.12, 1e-15);
}

TEST(Warp, ThereAndBack) {
  const Lens lens = bent();
  for (double y = -0.42; y <= 0.42; y += 0.06)
    for (double x = -0.58; x <= 0.58; x += 0.04) {
      const auto [u, v] = undistorted(lens, x, y);
      const auto [xx, yy] = distorted(lens, u, v);
      EXPECT_NEAR(xx, x, 1e-11);
      EXPECT_NEAR(yy, y, 1e-11);
    }
}

TEST(Warp, AStraightLensDrawsWhatItShows) {
  const Warp warp(Lens{}, 640, 480);
  EXPECT_FALSE(warp.bends());
  EXPECT_EQ(warp.width(), 640);
  EXPECT_EQ(warp.height(), 480);
  EXPECT_NEAR(warp.left(), -320.0 / 721.0, 1e-15);
  EXPECT_NEAR(warp.bottom(), 240.0 / 721.0, 1e-15);
  EXPECT_EQ(warp.nearest(3, 0), 479U * 640U + 3U);  // OpenGL's first row is the lowest
}

// A drawing whose colours are its own places on z = 1: the bent picture has the undistorted place of each
// pixel.
TEST(Warp, EachPixelComesFromItsDirection) {
  const Lens lens = bent();
  const Warp warp(lens, 640, 480);
  ASSERT_TRUE(warp.bends());
  std::vector<std::uint8_t> drawing(3 * static_cast<std::size_t>(warp.width() * warp.height()));
  const double span_x = warp.right() - warp.left(), span_y = warp.bottom() - warp.top();
  for (int y = 0; y < warp.height(); ++y)
    for (int x = 0; x < warp.width(); ++x) {
      std::uint8_t* p = drawing.data() + 3 * ((warp.height() - 1 - y) * warp.width() + x);
      p[0] = static_cast<std::uint8_t>(std::lround(255.0 * (x + 0.5) / warp.width()));
      p[1] = static_cast<std::uint8_t>(std::lround(255.0 * (y + 0.5) / warp.height()));
    }
  Image picture(640, 480);
  warp.colours(drawing.data(), picture);
  for (int y = 0; y < 480; y += 7)
    for (int x = 0; x < 640; x += 7) {
      const auto [u, v] =
          undistorted(lens, (x - lens.centre_x) / lens.focal_x, (y - lens.centre_y) / lens.focal_y);
      EXPECT_NEAR(picture.at(x, y)[0], 255.0 * (u - warp.left()) / span_x, 1.01);
      EXPECT_NEAR(picture.at(x, y)[1], 255.0 * (v - warp.top()) / span_y, 1.01);
      const std::size_t at = warp.nearest(x, y);
      EXPECT_NEAR(static_cast<double>(at % static_cast<std::size_t>(warp.width())) + 0.5,
                  (u - warp.left()) / span_x * warp.width(), 0.51);
    }
}

TEST(Warp, ALensThatFoldsThePictureIsRefused) {
  Lens lens;
  lens.distortion[0] = -2.5;
  EXPECT_THROW(Warp(lens, 640, 480), Error);
  lens.distortion[0] = kUnset;
  EXPECT_THROW(Warp(lens, 640, 480), Error);
}

}  // namespace
}  // namespace enc::sim
