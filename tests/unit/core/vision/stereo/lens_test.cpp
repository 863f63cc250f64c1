// The lens: by hand, there and back, and where it folds.
#include "core/vision/stereo/lens.h"

#include <cmath>

#include <gtest/gtest.h>

namespace enc {
namespace {

const Lens kBent{700, 710, 320, 240, {-0.25, 0.1, 0.001, -0.002, -0.02}};

// x = 0.3, y = -0.2, r2 = 0.13: radial = 1 - 0.0325 + 0.00169 - 0.00004394 = 0.96914606;
// x'' = 0.290743818 + 2 * 0.001 * -0.06 - 0.002 * (0.13 + 0.18) = 0.290003818,
// y'' = -0.193829212 + 0.001 * (0.13 + 0.08) + 2 * -0.002 * -0.06 = -0.193379212.
TEST(Lens, ProjectsAsWorkedByHand) {
  const Pixel p = project(kBent, {0.3, -0.2});
  EXPECT_NEAR(p.column, 320 + 700 * 0.290003818, 1e-6);
  EXPECT_NEAR(p.row, 240 + 710 * -0.193379212, 1e-6);
}

TEST(Lens, ComesBackFromEveryPixel) {
  for (int row = 0; row < 480; row += 53)
    for (int column = 0; column < 640; column += 61) {
      const Pixel p = project(kBent, ray_of(kBent, {column * 1.0, row * 1.0}));
      EXPECT_NEAR(p.column, column, 1e-8);
      EXPECT_NEAR(p.row, row, 1e-8);
    }
}

TEST(Lens, HasNoRayBeyondItsFold) {
  Lens folds;
  folds.distortion[0] = -1.0;  // r (1 - r^2) has its most, 0.385, at r = 0.577
  const double most = folds.focal_x * 0.3849;
  EXPECT_TRUE(std::isfinite(ray_of(folds, {folds.centre_x + 0.99 * most, folds.centre_y}).x));
  EXPECT_FALSE(std::isfinite(ray_of(folds, {folds.centre_x + 1.05 * most, folds.centre_y}).x));
}

}  // namespace
}  // namespace enc
