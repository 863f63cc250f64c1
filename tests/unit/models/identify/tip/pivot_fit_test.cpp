// Pivot calibration by hand: exact poses, a constant bias, a slip, what is refused; and its log as a file.
#include "models/identify/tip/pivot_fit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "models/identify/tip/pivot_doubts.h"
#include "models/identify/tip/pivot_log.h"

namespace enc {
namespace {

using models::PivotFit;
using models::PivotPose;
using testing::AllOf;
using testing::HasSubstr;

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
    const PivotFit fit = models::fit_pivot(swung(kDegree * sides));
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
    const Quat q = rotation_xyz(kDegree * Vec3(x, y, 0));
    poses.push_back({0.02 * i, {q, Vec3(kDimple - q * kTip)}});
  }
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_NEAR(fit.least_turned.e().cwiseAbs().x(), 1.0, 1e-6);
  EXPECT_NEAR(fit.swing[0], 10 * kDegree, 1e-6);  // x, by the turning about y
  EXPECT_LT(fit.swing[1], fit.swing[2]);
  EXPECT_LT((fit.point().e() - kTip).norm(), 1e-12);
}

// The tip hangs on differences alone; where the camera is believed to be moves the dimple.
TEST(PivotFit, AConstantBiasMovesTheDimpleAndNotTheTip) {
  const Vec3 bias(0.0779e-3, 0.0659e-3, 0.1192e-3);
  std::vector<PivotPose> poses = swung(kDegree * Vec3(30, 30, 0));
  for (PivotPose& pose : poses)
    for (std::size_t a = 0; a < 3; ++a) pose.X_CT.xyz[a] += bias(static_cast<Eigen::Index>(a));
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_LT((fit.point().e() - kTip).norm(), 1e-12);
  EXPECT_LT((fit.dimple.e() - kDimple - bias).norm(), 1e-12);
}

// 16.5 s about x and 3.5 s about y, in which the tip is out of its dimple: too few to be refused as a slip.
TEST(PivotFit, TheSwingOfWhatIsLeftHasToTellTheTip) {
  std::vector<PivotPose> poses;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.02 * i, angle = 30 * kDegree * std::sin(3.0 * t);
    const bool out = t >= 16.5;
    const Quat q = rotation_xyz(out ? Vec3(0, angle, 0) : Vec3(angle, 0, 0));
    const Vec3 noise = 0.05e-3 * Vec3(i % 7 - 3, i % 5 - 2, i % 11 - 5);
    poses.push_back({t, {q, Vec3(kDimple - q * kTip + noise + (out ? Vec3(0, 0, 0.03) : Vec3::Zero()))}});
  }
  EXPECT_THAT(
      refusal_of(poses),
      AllOf(testing::ContainsRegex("one axis alone, \\[1.00, -?0.00, -?0.00\\] in T, without the 17[0-9] "
                                   "poses that lie apart and are left out: this direction"),
            HasSubstr("turned by 0.0 deg rms"), HasSubstr("with the tip in its dimple")));
}

// Half of the turning about y is in poses that are left out.
TEST(PivotFit, TellsTheSwingOfWhatIsLeft) {
  std::vector<PivotPose> poses;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.02 * i, angle = 25 * kDegree * std::sin(3.0 * t);
    const bool out = t >= 17.0;
    const Quat q = rotation_xyz(t >= 13.5 ? Vec3(0, angle, 0) : Vec3(angle, 0, 0));
    poses.push_back({t, {q, Vec3(kDimple - q * kTip + (out ? Vec3(0, 0, 0.03) : Vec3::Zero()))}});
  }
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_EQ(fit.outliers, 150U);
  poses.resize(850);
  const PivotFit left = models::fit_pivot(poses);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(fit.swing[k], left.swing[k], 0.1 * kDegree);
  EXPECT_LT((fit.point().e() - kTip).norm(), 1e-9);
}

// One turn about y, of 0.4 s, in 20 s about x: nothing says how wrong it is.
TEST(PivotFit, OneShortTurnHasNoInterval) {
  std::vector<PivotPose> poses;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.02 * i;
    const bool aside = t >= 10.0 && t < 10.4;
    const Quat q = rotation_xyz(kDegree * Vec3(30 * std::sin(3.0 * t), aside ? 60 : 0, 0));
    poses.push_back({t, {q, Vec3(kDimple - q * kTip)}});
  }
  EXPECT_THAT(refusal_of(poses), AllOf(HasSubstr("how well the log tells the tip along x is not known"),
                                       HasSubstr("expected turns that last; swing the tool")));
}

// A tip that slips out for a tenth of the time by 5 mm, and poses that are nowhere.
TEST(PivotFit, ASlipIsLeftOutAndCounted) {
  std::vector<PivotPose> poses = swung(kDegree * Vec3(30, 30, 0));
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
    const Quat q = rotation_xyz(kDegree * Vec3(i % 2 == 0 ? 25 : -25, i / 2 % 2 == 0 ? 25 : -25, 7 * i));
    poses.push_back({static_cast<double>(i), {q, Vec3(kDimple - q * kTip)}});
  }
  EXPECT_LT((models::fit_pivot(poses).point().e() - kTip).norm(), 1e-12);
}

TEST(PivotFit, TellsWhatItWeighedPosesWith) {
  std::vector<PivotPose> poses;
  for (int i = 0; i < 100; ++i) {
    const double phase = 0.7 * i * i;  // unlike the one before and the one after
    const Quat q = rotation_xyz(25 * kDegree * Vec3(std::sin(phase), std::cos(1.9 * phase), 0));
    poses.push_back({static_cast<double>(i), {q, Vec3(kDimple - q * kTip)}});
  }
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_LT((fit.point().e() - kTip).norm(), 1e-12);
  EXPECT_FALSE(fit.neighbours);
  EXPECT_TRUE(models::fit_pivot(swung(kDegree * Vec3(30, 30, 0))).neighbours);
}

// At rest for so long, with a tenth of the noise, and then swung; and 30 mm off for the last `slip` seconds.
std::vector<PivotPose> rested(double rest, double slip = 0.0) {
  std::vector<PivotPose> poses;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.02 * i, moved = std::max(0.0, t - rest);
    const Quat q = rotation_xyz(30 * kDegree * Vec3(std::sin(3.0 * moved), std::sin(2.0 * moved), 0));
    const Vec3 noise = (t < rest ? 1e-5 : 1e-4) * Vec3(i % 7 - 3, i % 5 - 2, i % 11 - 5);
    const Vec3 off(0, 0, t >= 20.0 - slip ? 0.03 : 0.0);
    poses.push_back({t, {q, Vec3(kDimple - q * kTip + noise + off)}});
  }
  return poses;
}

TEST(PivotFit, AToolAtRestDoesNotThrowOutItsSwing) {
  const PivotFit fit = models::fit_pivot(rested(15.0));
  EXPECT_EQ(fit.outliers, 0U);
  EXPECT_LT((fit.point().e() - kTip).norm(), 0.2e-3);
  EXPECT_NEAR(fit.rested, 15.0, 0.1);
  EXPECT_NEAR(fit.turned, 5.0, 0.1);
}

TEST(PivotFit, RefusesALogThatIsMostlyRest) {
  EXPECT_THAT(
      refusal_of(rested(17.0)),
      AllOf(testing::ContainsRegex("rested for most of the log: it turned for (2.9|3)[0-9]* s of 20 s"),
            HasSubstr("expected at least 4 s; swing it about its tip for longer")));
  // 3 s are 15 % of the log, and 30 % of what turns.
  EXPECT_THAT(refusal_of(rested(10.0, 3.0)),
              AllOf(HasSubstr("the tip did not stay"), HasSubstr("30 % more")));
}

TEST(PivotFit, CountsTheTimeOfPosesAlone) {
  const Vec3 both = kDegree * Vec3(30, 30, 0);
  EXPECT_THAT(refusal_of(swung(both, 196)), HasSubstr("are of 3.9 s; expected at least 4 s; record longer"));
  EXPECT_EQ(refusal_of(swung(both, 206)), "accepted");
  std::vector<PivotPose> poses = swung(both, 102);
  for (std::size_t i = 51; i < poses.size(); ++i) poses[i].time += 100.0;
  EXPECT_THAT(refusal_of(poses),
              HasSubstr("are of 2 s, without the gaps in them, which are 100 s; expected at "
                        "least 4 s of poses; record longer, with the markers in view"));
}

TEST(PivotFit, RefusesWhatDoesNotTellTheTip) {
  const Vec3 both = kDegree * Vec3(30, 30, 0);
  EXPECT_THAT(refusal_of(swung(both, 29)), HasSubstr("there are 29 poses of the tool; expected at least 30"));
  EXPECT_THAT(refusal_of(swung(both, 100)), HasSubstr("are of 1.98 s; expected at least 4 s"));
  EXPECT_THAT(refusal_of(swung(kDegree * Vec3(0.5, 0.5, 0.5))),
              AllOf(HasSubstr("the tool hardly turned: no direction of it by more than 0.5"),
                    HasSubstr("expected at least 5 deg of each; swing it")));
  EXPECT_THAT(refusal_of(swung(kDegree * Vec3(0, 30, 0))),
              AllOf(HasSubstr("about one axis alone, [0.00, 1.00, 0.00] in T"),
                    HasSubstr("this direction turned by 0.0 deg rms"), HasSubstr("second axis")));
  EXPECT_THAT(refusal_of(swung(kDegree * Vec3(5, 30, 0))),
              HasSubstr("about one axis alone, [0.02, 1.00, 0.00]"));
  EXPECT_EQ(refusal_of(swung(kDegree * Vec3(10, 30, 0))), "accepted");
  std::vector<PivotPose> poses = swung(both);
  poses[7].X_CT.xyz[1] = kUnset;
  EXPECT_THAT(refusal_of(poses), HasSubstr("pose 8 is none"));
  poses = swung(both);
  poses[9].time = poses[8].time;
  EXPECT_THAT(refusal_of(poses), HasSubstr("pose 10 is none, or not later"));
}

TEST(PivotFit, RefusesATipThatDidNotStay) {
  std::vector<PivotPose> poses = swung(kDegree * Vec3(30, 30, 0));
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].X_CT.xyz[0] += 0.05 * static_cast<double>(i) / static_cast<double>(poses.size());
  EXPECT_THAT(refusal_of(poses), AllOf(testing::ContainsRegex("it wandered by up to [23][0-9.]+ mm"),
                                       HasSubstr("expected at most 2 mm rms and 20 %")));
  poses = swung(kDegree * Vec3(30, 30, 0));
  for (std::size_t i = 0; i < 150; ++i) poses[i].X_CT.xyz[0] += 0.03;
  EXPECT_THAT(refusal_of(poses), AllOf(HasSubstr("it wandered by up to 30 mm"), HasSubstr("30 % more")));
}

// A reference in the dimple is the origin of all poses: a tool of 0.4 m is no inverted one, and one of 1.1 m
// is doubted and not refused.
TEST(PivotDoubts, AFrameWithItsOriginAtTheDimpleIsNotInverted) {
  const auto of_length = [](double more, const Vec3& dimple) {
    std::vector<PivotPose> poses = swung(kDegree * Vec3(30, 30, 0));
    for (PivotPose& pose : poses)
      pose.X_CT = {pose.X_CT.q(), Vec3(pose.X_CT.p() + pose.X_CT.q() * Vec3(0, 0, more) - kDimple + dimple)};
    return models::doubt_of_direction(models::fit_pivot(poses));
  };
  const Vec3 at_origin(0, 0, 0.002), near_it(0, 0, 0.1);
  EXPECT_FALSE(of_length(0.28, at_origin).doubted);
  EXPECT_TRUE(of_length(0.28, near_it).doubted);
  EXPECT_TRUE(of_length(1.0, at_origin).doubted);
  EXPECT_FALSE(of_length(1.0, at_origin).sure);
  EXPECT_TRUE(of_length(1.0, near_it).sure);
  EXPECT_THAT(
      of_length(1.0, at_origin).text,
      HasSubstr("inverted? If the origin of the poses is at the dimple, all is well; if not, then the tip"));
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

TEST(PivotLog, RefusesANameThatIsNotUtf8) {
  const auto read = [](const std::string& tool) -> std::string {
    try {
      return models::parse_pivot_log(kPoseHead + "0.0," + tool + ",1,2,3,0,0,0,1\n", "p.csv").tool;
    } catch (const Error& error) {
      return error.what();
    }
  };
  for (const char* good : {"pen",
                           "Pr\xC3\xBC"
                           "fspitze",
                           "\xE2\x82\xAC", "\xF0\x9F\x96\x8A", "\xED\x9F\xBF"})
    EXPECT_EQ(read(good), good);
  // Latin-1, one that is cut, too long, a surrogate, beyond the last: one that no text has.
  for (const char* bad : {"Pr\xFC"
                          "fspitze",
                          "\xE2\x82", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80",
                          "\xF0\x8F\xBF\xBF"})
    EXPECT_EQ(read(bad),
              "p.csv:2:5: the tool's name is not UTF-8; expected UTF-8; save the log as UTF-8, or "
              "rename it");
}

TEST(PivotLog, DoubtsMetresInColumnsOfMillimetres) {
  models::PivotLog log;
  log.poses = swung(kDegree * Vec3(30, 30, 0));
  EXPECT_FALSE(models::looks_like_metres(log, models::fit_pivot(log.poses)));
  for (PivotPose& pose : log.poses)
    for (double& x : pose.X_CT.xyz) x *= 1e-3;
  EXPECT_TRUE(models::looks_like_metres(log, models::fit_pivot(log.poses)));
  // A tool whose markers' origin is at its tip, a metre from the tracker.
  for (PivotPose& pose : log.poses) pose.X_CT.xyz[2] += 1.0;
  EXPECT_FALSE(models::looks_like_metres(log, models::fit_pivot(log.poses)));
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
