// The ideal predictor of reaches: what it makes of an even way, and what an arm can make of that.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "benchmarks/reaching/ideal.h"

namespace enc::bench::reaching {
namespace {

// A first movement of 180 mm that is seen until 75 ms before the touch, every 50 ms and 50 ms late.
SeenReach seen_reach() {
  SeenReach reach;
  const Vec3 from(-0.06, 0.02, 0.17), to(0.0, 0.0, -0.01);
  const double begins = 0.1, takes = 0.6;
  const auto share = [&](double t) {
    const double s = std::clamp((t - begins) / takes, 0.0, 1.0);
    return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
  };
  const auto at = [&](double t) { return Vec3(from + share(t) * (to - from)); };
  double met = begins;
  while (at(met).z() > 0.0) met += 1e-4;
  reach.met = met;
  reach.where = at(met).head<2>();
  for (double t = met - 0.075 - 6 * 0.05; t < met - 0.05; t += 0.05)
    reach.pictures.push_back({at(t), t, t + 0.05});
  return reach;
}

TEST(ReachIdeal, FindsWhereAReachTouchesThatIsToldWhen) {
  const SeenReach reach = seen_reach();
  const Ideal ideal = ideal_place({}, reach, reach.met, reach.met);
  EXPECT_LT((ideal.place - reach.where).norm(), 4e-3);  // the newest picture is 75 ms old
  EXPECT_GT(ideal.within, 0.1);
  EXPECT_LT(ideal.within, 1.0);
}

TEST(ReachIdeal, AnArmIsSomewhereBetweenThePlacesOfTwoPictures) {
  const SeenReach reach = seen_reach();
  const Eigen::Vector2d best = ideal_place({}, reach, reach.met, reach.met).place;
  const Eigen::Vector2d anywhere = ideal_carried({}, reach, 1e6), still = ideal_carried({}, reach, 1e-9);
  const double fourth = reach.pictures[reach.pictures.size() - 4].told;
  EXPECT_LT((anywhere - best).norm(), 1e-9);
  EXPECT_LT((still - ideal_place({}, reach, fourth, reach.met).place).norm(), 1e-9);
  EXPECT_GT((still - best).norm(), 1e-6);
  // A picture of no use in time: what is told at the touch moves nothing.
  SeenReach late = reach;
  late.pictures.back().told = reach.met;
  const Eigen::Vector2d before = ideal_place({}, reach, reach.pictures.back().told - 1e-3, reach.met).place;
  EXPECT_LT((ideal_carried({}, late, 1e6) - before).norm(), 1e-9);
}

// Not told when it touches; with any acceleration the prop is where the mean of what is still to come is.
TEST(ReachIdeal, AnArmFollowsWhatIsStillToCome) {
  const SeenReach reach = seen_reach();
  const std::vector<IdealCourse> courses = ideal_courses({}, reach);
  ASSERT_EQ(courses.size(), 4U);
  const double soon = 0.01;
  const Eigen::Vector2d goal = courses.back().mean(reach.met, soon);
  EXPECT_LT((ideal_followed(courses, reach.met, 1e5, soon) - goal).norm(), 0.2e-3);
  EXPECT_LT((goal - reach.where).norm(), 5e-3);
  const Eigen::Vector2d first = courses.front().mean(courses.front().told, soon);
  EXPECT_LT((ideal_followed(courses, reach.met, 1e-9, soon) - first).norm(), 1e-6);
  // Where it would touch then is what is told for that time.
  const double then = courses.back().told + 2 * IdealCourse::kEach;
  EXPECT_LT((courses.back().then[2].place - ideal_place({}, reach, courses.back().told, then).place).norm(),
            1e-12);
}

}  // namespace
}  // namespace enc::bench::reaching
