// A tracker's log and the tip of a tool that pivots: reading, fit, and refusals with the place in one line.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "models/identify/tip/pivot_fit.h"
#include "models/identify/tip/pivot_log.h"
#include "models/identify/tracker/tracker_log.h"
#include "tests/support/refusal.h"

namespace enc::models {
namespace {

using models::PivotFit, models::PivotPose;
using testing::AllOf, testing::HasSubstr;

const std::string kHead = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_mm\n";

// Rows from `first` to `last`, one each ms, and a packet each `every` rows, each slightly different.
std::string rows(int first, int last, int every = 10, int step = 1) {
  std::string text;
  for (int n = first; n < last; n += step) {
    text += fmt::format("{:.3f},{:.3f},0,0,", n * 1e-3, n * 1e-3);
    text += n % every == 0 ? fmt::format("{:.3f},0.1,{:.6f}\n", n * 1e-3 - 0.02, n * 1e-6) : ",,\n";
  }
  return text;
}

TEST(TrackerLog, ReadsRowsAndPackets) {
  const TrackerLog log = parse_tracker_log("# a rig\n" + kHead + rows(0, 200), "l.csv");
  EXPECT_EQ(log.time.size(), 200U);
  ASSERT_EQ(log.packets.size(), 20U);
  EXPECT_NEAR(log.period, 1e-3, 1e-9);
  EXPECT_NEAR(log.packet_period, 10e-3, 1e-9);
  EXPECT_FALSE(log.repeated);
  EXPECT_NEAR(log.tip[100].x(), 0.1e-3, 1e-12);
  EXPECT_NEAR(log.packets[1].tool.x(), -0.01e-3, 1e-12);
  EXPECT_DOUBLE_EQ(log.packets[1].time, 0.010);
  EXPECT_TRUE(std::isnan(log.packets[1].stamp));
}

TEST(TrackerLog, ARepeatedValueIsNoNews) {
  std::string text = kHead;
  for (int n = 0; n < 300; ++n) text += fmt::format("{:.3f},0,0,0,{},0,0\n", n * 1e-3, n / 10);
  const TrackerLog log = parse_tracker_log(text, "l.csv");
  EXPECT_TRUE(log.repeated);
  ASSERT_EQ(log.packets.size(), 30U);
  EXPECT_DOUBLE_EQ(log.packets[1].time, 0.010);
}

TEST(TrackerLog, TakesStampsAndInterpolatesTheTip) {
  std::string text = "tool_time_s,other," + kHead;
  for (int n = 0; n < 300; ++n)
    text +=
        fmt::format("{},text,{:.3f},{},0,0,{}\n", n % 10 == 0 ? fmt::format("{:.4f}", n * 1e-3 - 0.012) : "",
                    n * 1e-3, n, n % 10 == 0 ? fmt::format("{},0,0", n) : ",,");
  const TrackerLog log = parse_tracker_log(text, "l.csv");
  EXPECT_NEAR(log.packets[3].stamp, 0.018, 1e-12);
  const TipPath path(log);
  EXPECT_NEAR(path.position(0.1005).x(), 100.5e-3, 1e-12);
  EXPECT_NEAR(path.velocity(0.1505).x(), 1.0, 1e-9);
  EXPECT_FALSE(path.knows(0.001));
  EXPECT_TRUE(path.knows(0.150));
}

// A loop on a busy computer loses a cycle now and then: the tip moves on in a straight line meanwhile.
TEST(TrackerLog, AFewLostRowsAreInterpolatedAndCounted) {
  const TrackerLog log = parse_tracker_log(kHead + rows(0, 100) + rows(101, 150) + rows(210, 300), "l.csv");
  EXPECT_EQ(log.time.size(), 239U);
  EXPECT_THAT(log.notes, testing::Contains(HasSubstr("61 rows are missing, at 2 places of up to 61 ms")));
  EXPECT_NEAR(log.period, 1e-3, 1e-9);
  const TipPath path(log);
  for (const double t : {0.0995, 0.1, 0.120, 0.149, 0.18, 0.2095, 0.25}) {
    EXPECT_TRUE(path.knows(t)) << t;
    EXPECT_NEAR(path.position(t).x(), t * 1e-3, 1e-12) << t;
  }
}

// The tip moves by 1 mm in each row; its stamps are 4 ms before the rows, and each stands in two of them.
TEST(TrackerLog, TheTipIsWhereItWasAtItsOwnStamp) {
  std::string text = "tip_time_s," + kHead;
  for (int n = 0; n < 300; ++n) {
    const int said = n / 2 * 2;
    const bool lost = n > 120 && n <= 270;  // no packet: the last one stays
    text += fmt::format("{:.3f},{:.3f},{},0,0,{}\n", (lost ? 120 : said) * 1e-3 - 4e-3, n * 1e-3,
                        lost ? 120 : said, n % 10 == 0 ? fmt::format("{},0,0", n) : ",,");
  }
  const TipPath path(parse_tracker_log(text, "l.csv"));
  for (const double t : {0.050, 0.0605, 0.0811}) {
    EXPECT_TRUE(path.knows(t)) << t;
    EXPECT_NEAR(path.position(t).x(), t + 4e-3, 1e-9) << t;
    EXPECT_NEAR(path.velocity(t).x(), 1.0, 1e-9) << t;
  }
  EXPECT_FALSE(path.knows(0.2));
  EXPECT_TRUE(path.knows(0.285));
}

std::string refused_log(const std::string& csv, double rate = kUnset) {
  return test::refusal([&] { (void)parse_tracker_log(csv, "l.csv", rate); });
}

TEST(TrackerLog, RefusesWithThePlaceInOneLine) {
  const std::string good = kHead + rows(0, 200);
  const std::string row = "0.200,0.2,0,0,0.1,0,0\n";
  std::string two_rates = kHead + rows(0, 5000, 10) + rows(5000, 12000, 40);
  struct Case {
    std::string csv;
    const char* begins;
    const char* says;
  };
  const std::vector<Case> cases{
      {"", "l.csv:1:1:", "there is no column 'time_s'"},
      {"time_s,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_m\n",
       "l.csv:1:1:", "multiply 'tool_z_m' by 1000 and call it 'tool_z_mm'"},
      {good + "0.200,0.2,0,0,nan,0,0\n", "l.csv:202:15:", "'tool_x_mm' is 'nan'"},
      {good + "0.200,0.2,0,zero,,,\n", "l.csv:202:13:", "'tip_z_mm' is 'zero'"},
      {good + "0.200,,0,0,,,\n", "l.csv:202:7:", "'tip_x_mm' is ''"},
      {good + "0.200,0.2,0,0,1,,1\n", "l.csv:202:17:", "'tool_y_mm' is ''"},
      {good + "0.200,0.2,0,0,1e300,0,0\n", "l.csv:202:15:", "farther than 10 m"},
      {good + "0.200,1e999,0,0,,,\n", "l.csv:202:7:", "finite"},
      {good + "0.199,0.2,0,0,,,\n", "l.csv:202:1:", "repeats"},
      {good + "0.100,0.2,0,0,,,\n", "l.csv:202:1:", "does not come after 0.199"},
      {good + "0.200,0.2\n", "l.csv:202:7:", "2 columns; expected 7"},
      {good + rows(300, 400), "l.csv:202:1:", "rows are missing from 0.199 to 0.3 s"},
      {good + "0.2016,0.2,0,0,,,\n", "l.csv:202:1:", "rows are missing from 0.199 to 0.2016 s"},
      {"tip_time_s," + kHead + "5,0.000,0,0,0,,,\n", "l.csv:2:1:", "the tip's stamp 5 is 5 s from the row's"},
      {good + rows(200, 1000, 10, 2), "l.csv:", "expected one rate"},
      {kHead + rows(0, 9), "l.csv:10:1:", "there are 9 rows; expected at least 10"},
      {kHead + rows(0, 50), "l.csv:51:1:", "there are 5 packets"},
      {kHead + rows(0, 500) + rows(500, 2000, 1500) + rows(2000, 3000),
       "l.csv:", "no packet of the tool came"},
      {two_rates, "l.csv:", "packets a second"},
  };
  for (const Case& c : cases) {
    const std::string what = refused_log(c.csv);
    EXPECT_EQ(what.rfind(c.begins, 0), 0U) << what;
    EXPECT_THAT(what, HasSubstr(c.says));
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
  EXPECT_THAT(refused_log(good, 500.0), HasSubstr("the rows come at 1000 Hz; expected 500 Hz"));
  EXPECT_EQ(refused_log(good, 1000.0), "");
}

// Pivot calibration by hand: exact poses, a constant bias, a slip, refusals; and its log as a file.

const Vec3 kTip(0.003, -0.002, -0.120), kDimple(0.1, -0.9, 0.6);  // tip in T and dimple in C, m

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
  return test::refusal([&] { (void)models::fit_pivot(poses); });
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
  // Half of the time 20 deg to one side about x and half to the opposite side, and 10 deg about y in the same
  // way.
  std::vector<PivotPose> poses;
  for (int i = 0; i < 400; ++i) {
    const double x = i % 2 == 0 ? 20 : -20, y = i / 2 % 2 == 0 ? 10 : -10;
    const Quat q = rotation_xyz(kDegree * Vec3(x, y, 0));
    poses.push_back({0.02 * i, {q, Vec3(kDimple - q * kTip)}});
  }
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_NEAR(fit.least_turned.e().cwiseAbs().x(), 1.0, 1e-6);
  EXPECT_NEAR(fit.swing[0], 10 * kDegree, 1e-6);  // x, from the turning about y
  EXPECT_LT(fit.swing[1], fit.swing[2]);
  EXPECT_LT((fit.point().e() - kTip).norm(), 1e-12);
}

// The tip depends on differences alone; the believed place of the camera moves the dimple.
TEST(PivotFit, AConstantBiasMovesTheDimpleAndNotTheTip) {
  const Vec3 bias(0.0779e-3, 0.0659e-3, 0.1192e-3);
  std::vector<PivotPose> poses = swung(kDegree * Vec3(30, 30, 0));
  for (PivotPose& pose : poses)
    for (std::size_t a = 0; a < 3; ++a) pose.X_CT.xyz[a] += bias(static_cast<Eigen::Index>(a));
  const PivotFit fit = models::fit_pivot(poses);
  EXPECT_LT((fit.point().e() - kTip).norm(), 1e-12);
  EXPECT_LT((fit.dimple.e() - kDimple - bias).norm(), 1e-12);
}

// 16.5 s about x and 3.5 s about y, in which the tip is out of its dimple: too few poses to count as a slip.
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

// One turn about y, of 0.4 s, in 20 s about x: its error is unknown.
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

// A tip that slips out by 5 mm for a tenth of the time, and poses without a position.
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

// One pose a second: a neighbour gives no information about their turning.
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

// The tool rests for this long, with a tenth of the noise, then swings, and is 30 mm off for the last `slip`
// seconds.
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
  // 3 s are 15 % of the log, and 30 % of its turning part.
  EXPECT_THAT(refusal_of(rested(10.0, 3.0)),
              AllOf(HasSubstr("the tip did not stay"), HasSubstr("30 % more")));
}

TEST(PivotFit, CountsTheTimeOfPosesAlone) {
  const Vec3 both = kDegree * Vec3(30, 30, 0);
  EXPECT_THAT(refusal_of(swung(both, 196)), HasSubstr("are of 3.9 s; expected at least 4 s; record longer"));
  EXPECT_EQ(refusal_of(swung(both, 206)), "");
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
  EXPECT_EQ(refusal_of(swung(kDegree * Vec3(10, 30, 0))), "");
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

// A reference in the dimple is the origin of all poses: a tool of 0.4 m is not inverted, and one of 1.1 m
// gives a warning and no refusal.
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
  // Latin-1, a cut one, too long, a surrogate, beyond the last, and one that occurs in no text.
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
}  // namespace enc::models
