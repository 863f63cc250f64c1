// Absolute orientation by hand: four corners turned a quarter, what is refused, and the way back from a
// rotation to the angles of a file.
#include "models/identify/camera/register.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/rotation.h"

namespace enc {
namespace {

using testing::HasSubstr;

constexpr double kQuarter = M_PI / 2;

// Seen by a camera at `p` that is turned by `angles`.
std::vector<models::PointPair> pairs_of(const std::vector<Vec3>& camera, const Vec3& angles, const Vec3& p) {
  const Pose<'W', 'C'> X_WC(rotation_xyz(angles), p);
  std::vector<models::PointPair> pairs;
  for (const Vec3& c : camera) pairs.push_back({Point<'C'>(c), X_WC * Point<'C'>(c)});
  return pairs;
}
const std::vector<Vec3> kCorner{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};

std::string refusal(const std::vector<models::PointPair>& pairs) {
  try {
    (void)models::register_points(pairs);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Register, AQuarterTurnByHand) {
  // About z: x becomes y, y becomes -x.
  const std::vector<models::PointPair> pairs{{{0.1, 0, 0}, {1.0, 2.1, 3.0}},
                                             {{0, 0.1, 0}, {0.9, 2.0, 3.0}},
                                             {{0, 0, 0.1}, {1.0, 2.0, 3.1}},
                                             {{0, 0, 0}, {1.0, 2.0, 3.0}}};
  const models::Registration found = models::register_points(pairs);
  EXPECT_NEAR((found.X_WC.p() - Vec3(1, 2, 3)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((angles_xyz(found.X_WC.q()) - Vec3(0, 0, kQuarter)).norm(), 0.0, 1e-12);
  EXPECT_LT(found.rms, 1e-12);
  EXPECT_NEAR(found.scale, 1.0, 1e-12);
}

TEST(Register, TellsWhatIsLeftOverAlongEachAxis) {
  // An error of +-e along z at four corners of a square that neither a turn nor a shift can follow.
  constexpr double e = 0.001;
  std::vector<models::PointPair> pairs =
      pairs_of({{0.1, 0.1, 0}, {-0.1, 0.1, 0}, {-0.1, -0.1, 0}, {0.1, -0.1, 0}}, {0, 0, 0}, {0, 0, 0});
  for (std::size_t i = 0; i < 4; ++i) pairs[i].device.xyz[2] += i % 2 == 0 ? e : -e;
  const models::Registration found = models::register_points(pairs);
  EXPECT_NEAR(found.mean_error.z(), e, 1e-12);
  EXPECT_NEAR(found.rms_error.z(), e, 1e-12);
  EXPECT_NEAR(found.rms_error.head<2>().norm(), 0.0, 1e-12);
  EXPECT_NEAR(found.rms, e, 1e-12);
}

TEST(Register, ConditionOfAPlateAndOfARod) {
  // A square: about the longest axis (any in the plane) half of what is known about the normal.
  const auto square =
      pairs_of({{0.1, 0.1, 0}, {-0.1, 0.1, 0}, {-0.1, -0.1, 0}, {0.1, -0.1, 0}}, {0.3, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(models::register_points(square).condition, std::sqrt(2.0), 1e-9);
  // A rod of 100 mm either way, 10 mm wide either way: sqrt((100^2 + 10^2) / 10^2) = sqrt(101).
  const auto rod =
      pairs_of({{0.1, 0.01, 0}, {-0.1, 0.01, 0}, {-0.1, -0.01, 0}, {0.1, -0.01, 0}}, {0, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(models::register_points(rod).condition, std::sqrt(101.0), 1e-6);
}

TEST(Register, PointsInAPlaneAreEnough) {
  const Vec3 angles(0.4, -1.1, 2.5);
  const auto pairs = pairs_of({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.1, 0.2, 0}}, angles, {0.3, 0, -1});
  const models::Registration found = models::register_points(pairs);
  EXPECT_NEAR(found.X_WC.q().angularDistance(rotation_xyz(angles)), 0.0, 1e-9);
  EXPECT_LT(found.rms, 1e-12);
}

TEST(Register, AMirrorImageStaysARotationAndIsTold) {
  std::vector<models::PointPair> pairs = pairs_of(kCorner, {0.1, 0.2, 0.3}, {0, 0, 0.5});
  for (models::PointPair& pair : pairs) pair.device.xyz[1] *= -1.0;
  const models::Registration found = models::register_points(pairs);
  EXPECT_NEAR(found.X_WC.q().toRotationMatrix().determinant(), 1.0, 1e-12);
  EXPECT_GT(found.rms, 0.01);
  EXPECT_LT(found.mirror_rms, 1e-7);
  // And a set that is none says so.
  const models::Registration right = models::register_points(pairs_of(kCorner, {0.1, 0.2, 0.3}, {0, 0, 0.5}));
  EXPECT_GT(right.mirror_rms, 0.01);
}

TEST(Register, TellsThatOneSetIsLarger) {
  std::vector<models::PointPair> pairs = pairs_of(kCorner, {0, 0, 1}, {0, 0, 0});
  for (models::PointPair& pair : pairs)
    for (double& x : pair.camera.xyz) x *= 1.02;
  EXPECT_NEAR(models::register_points(pairs).scale, 1.02, 1e-12);
}

TEST(Register, RefusesWhatDoesNotFixAPose) {
  const Vec3 turn(0.1, 0.2, 0.3), p(0, 0, 0.6);
  EXPECT_THAT(refusal({}), HasSubstr("there are 0 pairs"));
  EXPECT_THAT(refusal(pairs_of({kCorner[0], kCorner[1], kCorner[2]}, turn, p)),
              HasSubstr("there are 3 pairs of points; expected at least 4"));
  const Vec3 along(0.03, -0.02, 0.05);
  EXPECT_THAT(refusal(pairs_of({0 * along, 1 * along, 2 * along, 5 * along}, turn, p)),
              HasSubstr("points lie on one line"));
  const Vec3 one(0.1, 0.2, 0.3);
  EXPECT_THAT(refusal(pairs_of({one, one, one, one}, turn, p)), HasSubstr("all in one place"));
  std::vector<models::PointPair> bad = pairs_of(kCorner, turn, p);
  bad[2].device.xyz[0] = kUnset;
  EXPECT_THAT(refusal(bad), HasSubstr("not a finite number"));
  bad[2].device.xyz[0] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(bad), HasSubstr("not a finite number"));
  // The device on a line and the camera, by its noise, a little off it: still a line.
  std::vector<models::PointPair> line = pairs_of({0 * along, 1 * along, 2 * along, 5 * along}, turn, p);
  line[1].camera.xyz[0] += 0.02;
  EXPECT_THAT(refusal(line), HasSubstr("the device's points lie on one line"));
  // Three are enough for who asks for three.
  EXPECT_NO_THROW((void)models::register_points(pairs_of({kCorner[0], kCorner[1], kCorner[2]}, turn, p), 3));
}

TEST(Rotation, AnglesOfAFileThereAndBack) {
  for (const Vec3& angles : {Vec3(0, 0, 0), Vec3(0.5, -0.7, 2.9), Vec3(-2.18, 0, 0.52), Vec3(3.0, 1.5, -3.0)})
    EXPECT_NEAR((angles_xyz(rotation_xyz(angles)) - angles).norm(), 0.0, 1e-12);
  for (const double y : {kQuarter, -kQuarter}) {
    const Quat q = rotation_xyz({0.4, y, 0.3});
    EXPECT_NEAR(rotation_xyz(angles_xyz(q)).angularDistance(q), 0.0, 1e-7);
    EXPECT_EQ(angles_xyz(q).z(), 0.0);
  }
}

}  // namespace
}  // namespace enc
