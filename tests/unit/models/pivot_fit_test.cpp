// Pivot calibration by hand: exact poses, a constant bias, a slip, what is refused; and its log as a file.
#include "models/fit/pivot/pivot_fit.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/rotation.h"
#include "models/fit/pivot/pivot_log.h"

namespace enc {
namespace {

using models::PivotFit;
using models::PivotPose;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kDeg = M_PI / 180.0;
const Vec3 kTip(0.003, -0.002, -0.120), kDimple(0.1, -0.9, 0.6);  // in T and in C, m

// `count` poses at 50 Hz that swing to either side by these angles about x, y and z.
std::vector<PivotPose> swung(const Vec3& sides, int count = 500) {
  std::vector<PivotPose> poses;
  for (int i = 0; i < count; ++i) {
    const double t = 0.02 * i;
    const Vec3 phase(std::sin(3.0 * t), std::sin(2.0 * t + 1.0), std::sin(2.5 * t + 2.0));
    const Quat q = rotation_xyz(sides.cwiseProduct(phase));
    poses.push_back({t, {q, Vec3(kDimple - q * kTip)}});
  }
  return poses;
}

std::string refusal_of(const std::vector<PivotPose>& poses) {
  try {
    (void)models::fit_pivot(poses);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PivotFit, ExactPosesGiveTheTip) {
  for (const Vec3& sides : {Vec3(30, 30, 0), Vec3(30, 0, 30), Vec3(20, 20, 170)}) {
    const PivotFit fit = models::fit_pivot(swung(kDeg * sides));
    EXPECT_LT((fit.point().e() - kTip).norm(), 1e-12);
    EXPECT_LT((fit.dimple.e() - kDimple).norm(), 1e-12);
    EXPECT_LT(fit.most, 1e-12);
    EXPECT_LT(fit.wander, 1e-12);
    EXPECT_EQ(fit.outliers, 0U);
    for (const models::Interval& axis : fit.tip) EXPECT_LT(axis.half, 1e-12);
  }
}

TEST(PivotFit, TellsByHowMuchTheDirectionsTurned) {
  // Half of the time 20 deg to one side about x and half to the other, and likewise 10 deg about y.
  std::vector<PivotPose> poses;
  for (int i = 0; i < 400; ++i) {
    const double x = i % 2 == 0 ? 20 : -20, y = i / 2 % 2 == 0 ? 10 : -10;
    const Quat q = rotation_xyz(kDeg * Vec3(x, y, 0));
    poses.push_back({0.02 * i, {q, Vec3(kDimple - q * kTip)}});
  }
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_NEAR(fit.least_turned.e().cwiseAbs().x(), 1.0, 1e-6);
  EXPECT_NEAR(fit.swing[0], 10 * kDeg, 1e-6);  // x, by the turning about y
  EXPECT_LT(fit.swing[1], fit.swing[2]);
  EXPECT_LT((fit.point().e() - kTip).norm(), 1e-12);
}

// The tip hangs on differences alone; where the camera is believed to be moves the dimple.
TEST(PivotFit, AConstantBiasMovesTheDimpleAndNotTheTip) {
  const Vec3 bias(0.0779e-3, 0.0659e-3, 0.1192e-3);
  std::vector<PivotPose> poses = swung(kDeg * Vec3(30, 30, 0));
  for (PivotPose& pose : poses)
    for (std::size_t a = 0; a < 3; ++a) pose.X_CT.xyz[a] += bias(static_cast<Eigen::Index>(a));
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_LT((fit.point().e() - kTip).norm(), 1e-12);
  EXPECT_LT((fit.dimple.e() - kDimple - bias).norm(), 1e-12);
}

// A tip that slips out for a tenth of the time by 5 mm, and poses that are nowhere.
TEST(PivotFit, ASlipIsLeftOutAndCounted) {
  std::vector<PivotPose> poses = swung(kDeg * Vec3(30, 30, 0));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].X_CT.xyz[i % 3] += 0.05e-3 * static_cast<double>(i % 7) - 0.15e-3;
    if (i >= 200 && i < 250) poses[i].X_CT.xyz[2] += 5e-3;
    if (i % 100 == 33) poses[i].X_CT.xyz[0] += 0.2;
  }
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_EQ(fit.outliers, 54U);  // one of the five is within the slip
  EXPECT_LT((fit.point().e() - kTip).norm(), 0.05e-3);
  EXPECT_NEAR(fit.wander, 5e-3, 0.3e-3);
  EXPECT_LT(fit.most, 0.3e-3);
}

// Poses of every second: a neighbour tells nothing of their turning.
TEST(PivotFit, PosesThatAreFarApartDo) {
  std::vector<PivotPose> poses;
  for (int i = 0; i < 40; ++i) {
    const Quat q = rotation_xyz(kDeg * Vec3(i % 2 == 0 ? 25 : -25, i / 2 % 2 == 0 ? 25 : -25, 7 * i));
    poses.push_back({static_cast<double>(i), {q, Vec3(kDimple - q * kTip)}});
  }
  EXPECT_LT((models::fit_pivot(poses).point().e() - kTip).norm(), 1e-12);
}

TEST(PivotFit, RefusesWhatDoesNotTellTheTip) {
  const Vec3 both = kDeg * Vec3(30, 30, 0);
  EXPECT_THAT(refusal_of(swung(both, 29)), HasSubstr("there are 29 poses of the tool; expected at least 30"));
  EXPECT_THAT(refusal_of(swung(both, 100)), HasSubstr("are of 1.98 s; expected at least 4 s"));
  EXPECT_THAT(refusal_of(swung(kDeg * Vec3(0.5, 0.5, 0.5))),
              AllOf(HasSubstr("the tool hardly turned: no direction of it by more than 0.5"),
                    HasSubstr("expected at least 5 deg of each; swing it")));
  EXPECT_THAT(refusal_of(swung(kDeg * Vec3(0, 30, 0))),
              AllOf(HasSubstr("about one axis alone, [0.00, 1.00, 0.00] in T"),
                    HasSubstr("this direction turned by 0.0 deg rms"), HasSubstr("second axis")));
  EXPECT_THAT(refusal_of(swung(kDeg * Vec3(5, 30, 0))),
              HasSubstr("about one axis alone, [0.02, 1.00, 0.00]"));
  EXPECT_EQ(refusal_of(swung(kDeg * Vec3(10, 30, 0))), "accepted");
  std::vector<PivotPose> poses = swung(both);
  poses[7].X_CT.xyz[1] = kUnset;
  EXPECT_THAT(refusal_of(poses), HasSubstr("pose 8 is none"));
  poses = swung(both);
  poses[9].time = poses[8].time;
  EXPECT_THAT(refusal_of(poses), HasSubstr("pose 10 is none, or not later"));
}

TEST(PivotFit, RefusesATipThatDidNotStay) {
  std::vector<PivotPose> poses = swung(kDeg * Vec3(30, 30, 0));
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].X_CT.xyz[0] += 0.05 * static_cast<double>(i) / static_cast<double>(poses.size());
  EXPECT_THAT(refusal_of(poses), AllOf(testing::ContainsRegex("it wandered by up to [23][0-9.]+ mm"),
                                       HasSubstr("expected at most 2 mm rms and 20 %")));
  poses = swung(kDeg * Vec3(30, 30, 0));
  for (std::size_t i = 0; i < 150; ++i) poses[i].X_CT.xyz[0] += 0.03;
  EXPECT_THAT(refusal_of(poses), AllOf(HasSubstr("it wandered by up to 30 mm"), HasSubstr("30 % more")));
}

const std::string kPoseHead = "time_s,tool,tool_x_mm,tool_y_mm,tool_z_mm,tool_qx,tool_qy,tool_qz,tool_qw\n";

TEST(PivotLog, ReadsPosesAndLeavesOutWhatIsNoNews) {
  const models::PivotLog log = models::parse_pivot_log("# a tool\n" + kPoseHead +
                                                           "0.0,pen,1,2,3,0,0,0,1\n"
                                                           "0.1,,,,,,,,\n"
                                                           "0.2,pen,1,2,3,0,0,0,1\n"
                                                           "0.3,pen,1,2,3,0,0.6,0,0.8003\n",
                                                       "p.csv");
  EXPECT_EQ(log.tool, "pen");
  EXPECT_EQ(log.line, 2U);
  ASSERT_EQ(log.poses.size(), 2U);
  EXPECT_EQ(log.poses[1].time, 0.3);
  EXPECT_EQ(log.poses[1].X_CT.xyz, (std::array<double, 3>{0.001, 0.002, 0.003}));
  EXPECT_NEAR(log.poses[1].X_CT.xyzw[1], 0.6, 1e-3);
  EXPECT_TRUE(log.poses[1].X_CT.valid());
}

TEST(PivotLog, TakesTheMarkersWhereTheToolIsItsTip) {
  const models::PivotLog log = models::parse_pivot_log(
      "time_s,tip_x_mm,tool_x_mm,tool_y_mm,tool_z_mm,markers_x_mm,markers_y_mm,markers_z_mm,markers_qx,"
      "markers_qy,markers_qz,markers_qw\n0,9,9,9,9,1,2,3,0,0,0,1\n",
      "p.csv");
  ASSERT_EQ(log.poses.size(), 1U);
  EXPECT_EQ(log.tool, "");
  EXPECT_EQ(log.poses[0].X_CT.xyz, (std::array<double, 3>{0.001, 0.002, 0.003}));
}

TEST(PivotLog, IsToldByItsHeader) {
  EXPECT_TRUE(models::is_pivot_log(kPoseHead));
  EXPECT_TRUE(models::is_pivot_log("# a tool\r\n\r\ntime_s,markers_x_mm\r\n"));
  EXPECT_FALSE(models::is_pivot_log("time_s,tip_x_mm,tool_x_mm,markers_x_mm\n"));
  EXPECT_FALSE(models::is_pivot_log("time_s,tool_x_mm\n0,tool_qx\n"));
  EXPECT_FALSE(models::is_pivot_log("# tool_qx\n"));
  EXPECT_FALSE(models::is_pivot_log(""));
}

}  // namespace
}  // namespace enc
