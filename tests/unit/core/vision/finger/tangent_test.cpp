// What a sphere's outline is in an image, and where a camera looks straight at it.
#include "core/vision/finger/tangent.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace enc {
namespace {

const RectifiedPair kAhead{721, 319.5, 239.5, 0.09, Mat3::Identity()};

// 12 mm of radius at 300 mm, in a corner: 29 px, and 2 px more from the image's middle outwards.
TEST(Tangent, ASpheresOutlineIsACircleRoundItsMiddle) {
  const Vec3 centre(0.11, -0.08, 0.30);
  const double radius = 0.012, distance = centre.norm();
  const Pixel middle{319.5 + 721 * centre.x() / centre.z(), 239.5 + 721 * centre.y() / centre.z()};
  const Tangent tangent(kAhead, middle);
  const Vec3 along = centre / distance, a = centre.unitOrthogonal(), b = along.cross(a);
  const double sine = radius / distance, cosine = std::sqrt(1.0 - sine * sine);
  double least = 1e9, most = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double angle = 0.02 * i * std::numbers::pi;
    // A ray that touches it.
    const Vec3 rim = cosine * along + sine * (std::cos(angle) * a + std::sin(angle) * b);
    const Pixel seen{319.5 + 721 * rim.x() / rim.z(), 239.5 + 721 * rim.y() / rim.z()};
    const Pixel flat = tangent.of(seen);
    EXPECT_NEAR(std::hypot(flat.column, flat.row), 721 * sine / cosine, 1e-9);
    const Pixel back = tangent.image(flat);
    EXPECT_NEAR(back.column, seen.column, 1e-9);
    EXPECT_NEAR(back.row, seen.row, 1e-9);
    const double in_image = std::hypot(seen.column - middle.column, seen.row - middle.row);
    least = std::min(least, in_image);
    most = std::max(most, in_image);
  }
  EXPECT_GT(most - least, 3.0);
}

TEST(Tangent, InTheMiddleItIsTheImage) {
  const Tangent tangent(kAhead, {319.5, 239.5});
  const Pixel flat = tangent.of({331.5, 230.5});
  EXPECT_NEAR(flat.column, 12.0, 1e-12);
  EXPECT_NEAR(flat.row, -9.0, 1e-12);
}

}  // namespace
}  // namespace enc
