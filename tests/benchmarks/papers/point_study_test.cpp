// Point sets as files and the figures computed from them: averages, intervals, persistent noise, the wrong
// pair. Also the places of the guided procedure.
#include "trial/identify/camera/point_study.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmarks/registration/accuracy.h"
#include "core/base/error.h"
#include "core/base/rotation.h"

namespace enc::bench {
namespace {

using ::testing::HasSubstr;

const std::string kHeader = "camera_x_m,camera_y_m,camera_z_m,device_x_m,device_y_m,device_z_m,pair\n";

trial::RegistrationRig rig() {
  trial::RegistrationRig r;
  r.X_WC = {rotation_xyz(Vec3(-125.0, 0.0, 30.0) * M_PI / 180.0), Vec3(0.236, -0.426, 0.457)};
  return r;
}
trial::GuidedRun guided(const trial::RegistrationRig& r, std::size_t pairs, std::size_t frames,
                        std::uint64_t seed) {
  trial::KinematicArm arm(r.believed, r.arm);
  return trial::see_visits(
      trial::visit_places(arm, trial::places_of(r, pairs).visited, r.camera.rate, frames), r.X_WC, r.camera,
      seed);
}
std::string refused_point(const std::string& text) {
  try {
    (void)models::parse_points(text, "p.csv");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PointSet, AveragesTheFramesOfAPair) {
  const models::PointSet places =
      models::parse_points(kHeader +
                               "0,0,1,0,0,0,7\n1,0,1,1,0,0,2\n0,0,3,0,0,0,7\n0,1,1,0,1,0,3\n"
                               "0,0,2,0,0,1,4\n",
                           "p.csv");
  ASSERT_EQ(places.size(), 4U);
  EXPECT_EQ(places[0].number, 7);
  EXPECT_EQ(places[0].frames.size(), 2U);
  EXPECT_DOUBLE_EQ(places[0].average().camera.xyz[2], 2.0);
  EXPECT_DOUBLE_EQ(places[0].average(1).camera.xyz[2], 1.0);
}

TEST(PointSet, ThereAndBackAsText) {
  const trial::GuidedRun run = guided(rig(), 5, 3, 1);
  const models::PointSet read = models::parse_points(models::points_text(run.points), "p.csv");
  ASSERT_EQ(read.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t f = 0; f < 3; ++f)
      EXPECT_NEAR((read[i].frames[f].camera - run.points[i].frames[f].camera).norm(), 0.0, 1e-7);
}

TEST(PointSet, IsToldFromATrackersLog) {
  EXPECT_TRUE(models::is_point_set("# points\n\n" + kHeader));
  EXPECT_FALSE(models::is_point_set("time_s,tip_x_mm,tip_y_mm\n"));
  EXPECT_FALSE(models::is_point_set(""));
}

TEST(PointSet, RefusesWithThePlace) {
  const std::string three = "0,0,1,0,0,0,1\n0.1,0,1,0.1,0,0,2\n0,0.1,1,0,0.1,0,3\n";
  EXPECT_THAT(refused_point(kHeader + three),
              HasSubstr("p.csv:4:1: there are 3 pairs of points; expected at least 4"));
  EXPECT_THAT(refused_point(kHeader), HasSubstr("there are 0 pairs"));
  EXPECT_THAT(refused_point(kHeader + three + "0,0,nan,0,0,0.1,4\n"),
              HasSubstr("p.csv:5:5: 'camera_z_m' is 'nan'"));
  EXPECT_THAT(refused_point(kHeader + three + "0,0,1,0,0\n"), HasSubstr("p.csv:5:9: this row has 5 columns"));
  EXPECT_THAT(refused_point("camera_x_mm,camera_y_m,camera_z_m,device_x_m,device_y_m,device_z_m\n"),
              HasSubstr("p.csv:1:1: there is no column 'camera_x_m'"));
  EXPECT_THAT(refused_point(kHeader + three + "0,0,1100,0,0,100,4\n"),
              HasSubstr("p.csv:5:5: 1100 m is farther than 10 m"));
  EXPECT_THAT(refused_point(kHeader + three + "0,0,1.1,0,0,0.1,3.5\n"),
              HasSubstr("p.csv:5:17: 'pair' is '3.5'"));
  EXPECT_THAT(refused_point(kHeader + three + "0,0.1,1,0,0.11,0,3\n"),
              HasSubstr("p.csv:5:9: the device is 10 mm from"));
  EXPECT_THAT(
      refused_point(kHeader + "0,0,1,0,0,0,1\n0,0,1.1,0,0,0.1,2\n0,0,1.2,0,0,0.2,3\n0,0,1.3,0,0,0.3,4\n"),
      HasSubstr("p.csv:1:1: the camera's points lie on one line"));
  EXPECT_THAT(refused_point(kHeader + "0,0,1,0,0,0,1\n0,0,1,0,0,0,2\n0,0,1,0,0,0,3\n0,0,1,0,0,0,4\n"),
              HasSubstr("p.csv:1:1: the camera's points are all in one place"));
  EXPECT_THAT(refused_point(kHeader + three + "0,0,1.1,0,0,-0.1,4\n"),
              HasSubstr("p.csv:1:1: the points are mirror images"));
  EXPECT_THAT(
      refused_point(kHeader + "0,0,1,0,0,0,1\n0.3,0,1,0.1,0,0,2\n0,0.3,1,0,0.1,0,3\n0,0,1.3,0,0,0.1,4\n"),
      HasSubstr("the camera's points are 3 times as far apart"));
}

TEST(PointStudy, ItsIntervalsHoldTheTruth) {
  const trial::RegistrationRig r = rig();
  int held = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const trial::PointStudy study = trial::study_points(guided(r, 8, 5, seed).points, seed);
    const Eigen::AngleAxisd off(r.X_WC.q() * study.found.X_WC.q().conjugate());
    for (std::size_t a = 0; a < 3; ++a) {
      held += study.position[a].holds(r.X_WC.p()(static_cast<Eigen::Index>(a))) ? 1 : 0;
      held += study.turn[a].holds(off.angle() * off.axis()(static_cast<Eigen::Index>(a))) ? 1 : 0;
      all += 2;
    }
  }
  EXPECT_GE(held, all * 90 / 100);
}

TEST(PointStudy, TellsNoiseOfAFrameFromWhatStays) {
  trial::RegistrationRig r = rig();
  r.camera.standing = 0.2;
  const trial::PointStudy study = trial::study_points(guided(r, 40, 50, 1).points);
  // Compares lengths over all three axes: disparity causes nearly all of both.
  EXPECT_NEAR(study.standing.norm() / study.frame_noise.norm(), 0.2 / 0.2, 0.25);
  r.camera.standing = 0.0;
  const trial::PointStudy none = trial::study_points(guided(r, 40, 50, 1).points);
  EXPECT_LT(none.standing.norm(), 0.15 * none.frame_noise.norm());
}

TEST(PointStudy, NamesThePairThatIsWrong) {
  trial::GuidedRun run = guided(rig(), 10, 20, 1);
  for (models::PointPair& frame : run.points[6].frames) frame.device.xyz[1] += 0.01;
  const trial::PointStudy study = trial::study_points(run.points);
  EXPECT_EQ(study.worst, 6U);
  EXPECT_GT(study.worst_error, 0.008);
  EXPECT_GT(study.worst_error, 3.0 * study.usual_error);
}

TEST(PointStudy, MorePairsAndMoreFramesHelp) {
  const trial::PointStudy study = trial::study_points(guided(rig(), 16, 20, 1).points);
  const auto error = [&](std::size_t pairs, std::size_t frames) {
    for (const trial::FewerPoints& f : study.fewer)
      if (f.pairs == pairs && f.frames == frames) return f.error.median.norm();
    return kUnset;
  };
  EXPECT_LT(error(12, 20), error(4, 20));
  // Both errors contain the noise of the pairs that judge.
  EXPECT_LT(error(8, 20), 0.7 * error(8, 1));
  EXPECT_LT(error(8, 5), error(8, 1));
}

TEST(Guided, PlacesAreSeenReachedAndWellSpread) {
  const trial::RegistrationRig r = rig();
  const trial::RegistrationPlaces places = trial::places_of(r, 20);
  const Arm arm(r.believed);
  ASSERT_EQ(places.visited.size(), 20U);
  const sim::StereoPoints eyes(r.camera, 1);
  for (const Point<'W'>& p : places.visited) {
    PerJoint q{};
    EXPECT_TRUE(arm.inverse(trial::base_of(arm).inverse() * p, q));
    EXPECT_TRUE(eyes.project(r.X_WC.inverse() * p));
  }
  for (std::size_t i = 0; i < 20; ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT((places.visited[i] - places.visited[j]).norm(), 0.05);
  std::vector<models::PointPair> pairs;
  for (std::size_t i = 0; i < 4; ++i) {
    pairs.push_back({r.X_WC.inverse() * places.visited[i], places.visited[i]});
  }
  EXPECT_LT(models::register_points(pairs).condition, 3.0);
}

TEST(Guided, WithoutNoiseOnlyEncodersAreLeft) {
  trial::RegistrationRig r = rig();
  r.camera.matching = r.camera.pointing = r.camera.standing = r.camera.disparity_step = 0.0;
  const models::Registration coarse = models::register_points(models::averages(guided(r, 8, 1, 1).points));
  EXPECT_LT(coarse.rms, 0.03e-3);  // the arm's resolution
  r.arm.counts = {1e9, 1e9, 1e9};
  EXPECT_LT(models::register_points(models::averages(guided(r, 8, 1, 1).points)).rms, 1e-9);
}

}  // namespace
}  // namespace enc::bench
