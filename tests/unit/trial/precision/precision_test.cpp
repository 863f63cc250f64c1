// Error against run time: the hand is the same whatever the step, and the cheapest setting is the cheapest.
#include "trial/precision/precision.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/check/advise.h"
#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

models::Setup setup_of(const std::string& scene, const std::vector<std::string>& set = {}) {
  return models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "", set);
}

std::vector<Vec3> tool_path(const std::string& scene, const std::vector<std::string>& set, double seconds) {
  std::vector<Vec3> path;
  TrialOptions options;
  options.seconds = seconds;
  options.watch = [&](const Glance& glance) { path.push_back(glance.truth.tool_tip.e()); };
  (void)Trial(setup_of(scene, set), options).run();
  return path;
}

// Tremor, drift and plan: 0.15 mm rms of drift that was drawn at each step made another hand of each.
TEST(Precision, AHandIsTheSameWhateverTheStep) {
  for (const char* scene : {"tennis_ball", "session"}) {
    const std::vector<Vec3> coarse = tool_path(scene, {}, 1.5);
    for (const char* step : {"500", "250", "100"}) {
      const std::vector<Vec3> fine = tool_path(scene, {std::string("truth.world.timestep_us=") + step}, 1.5);
      ASSERT_EQ(fine.size(), coarse.size());
      double most = 0.0;
      for (std::size_t i = 0; i < fine.size(); ++i) most = std::max(most, (fine[i] - coarse[i]).norm());
      EXPECT_LT(most, 0.12e-3) << "m, " << scene << " at " << step << " us";
      EXPECT_GT(most, 0.0);
    }
  }
}

TEST(Precision, QuantitiesThatAreNoNumbersAreNoSmallError) {
  using All = std::vector<double>;
  const All truth{-2.0, 0.5, 0.0};
  EXPECT_DOUBLE_EQ(apart(All{-2.0, 0.5, 0.0}, truth), 0.0);
  EXPECT_DOUBLE_EQ(apart(All{-1.5, 0.5, 0.8}, truth), 0.4);
  EXPECT_TRUE(std::isnan(apart(All{-2.0, kUnset, 0.0}, truth)));
  EXPECT_TRUE(std::isnan(apart(All{-2.0, 0.5, INFINITY}, truth)));
  EXPECT_TRUE(std::isnan(apart(All{-2.0, 0.5}, truth)));
  EXPECT_TRUE(std::isnan(apart(All{0.0, 0.0}, All{0.0, 0.0})));
}

PrecisionPoint point(const char* integrator, double step, double error, double cpu, bool shipped = false) {
  PrecisionPoint made{integrator, step};
  made.error = made.least_error = error;
  made.way = made.least_way = 1e-6;
  made.cpu = cpu;
  made.shipped = shipped;
  return made;
}
Precision made() {
  Precision all;
  all.table = "truth.world";
  all.converged = point("rk4", 20e-6, kUnset, 0.5);
  all.second = point("implicitfast", 10e-6, 0.01, 0.3);
  all.seconds = 12.0;
  all.touched = 5000;
  all.points = {point("implicitfast", 1e-3, 0.08, 0.0050), point("implicitfast", 0.5e-3, 0.04, 0.0090),
                point("rk4", 1e-3, 0.03, 0.0130, true), point("discrete", 1e-3, 0.06, 0.0052),
                point("euler", 1e-3, kUnset, kUnset)};
  all.points.back().failure = "diverged at tick 7";
  return all;
}

TEST(Precision, TheCheapestThatHolds) {
  const std::vector<PrecisionPoint> points = made().points;
  ASSERT_NE(cheapest(points, {0.05}), nullptr);
  EXPECT_EQ(cheapest(points, {0.05})->step, 0.5e-3);
  EXPECT_EQ(cheapest(points, {0.035})->integrator, "rk4");
  EXPECT_EQ(cheapest(points, {0.1})->integrator, "discrete") << "as dear as the cheapest, and errs less";
  EXPECT_EQ(cheapest(points, {0.02}), nullptr);
  EXPECT_EQ(next_cheaper(points, points[2])->step, 0.5e-3);
  EXPECT_EQ(next_cheaper(points, points[1])->integrator, "discrete");
  EXPECT_EQ(next_cheaper(points, points[0]), nullptr);
}

TEST(Precision, AdviceNamesTheSettingAndTheFloor) {
  using testing::AllOf;
  using testing::HasSubstr;
  using testing::Not;
  EXPECT_THAT(
      app::advice_text(made(), {0.05}),
      AllOf(HasSubstr("--set truth.world.timestep_us=500 --set truth.world.integrator=implicitfast"),
            HasSubstr("errs by 0.0400 N, allowed 0.05 N"), HasSubstr("floor about 0.0100 N"),
            HasSubstr("failed: diverged at tick 7"), HasSubstr("the next cheaper, discrete at 1000 us")));
  EXPECT_THAT(app::advice_text(made(), {0.03}), HasSubstr("as it is"));
  EXPECT_THAT(app::advice_text(made(), {0.012}), HasSubstr("none of these"));
  // Two converged runs differ by the floor: so may a third one from them.
  EXPECT_THAT(app::advice_text(made(), {0.051}),
              AllOf(HasSubstr("by another converged run 0.0300 to 0.0500 N"), Not(HasSubstr("may be more"))));
  EXPECT_THAT(app::advice_text(made(), {0.045}),
              HasSubstr("by another converged run 0.0300 to 0.0500 N: that may be more than allowed"));
  EXPECT_THAT(app::advice_text(made(), {0.0199}), HasSubstr("none of these errs by less than 0.0199 N"));
  EXPECT_NO_THROW(app::refuse_below_floor(made(), {0.012}));
  EXPECT_THROW(app::refuse_below_floor(made(), {0.005}), Error);
  Precision lucky = made();
  lucky.points[2].error = 0.004;
  EXPECT_NO_THROW(app::refuse_below_floor(lucky, {0.005})) << "a point holds it";
}

// 1 um by the force's own setting, 4 um by all others.
TEST(Precision, AdviceOfThePath) {
  Precision all = made();
  for (PrecisionPoint& one : all.points) one.way = one.least_way = one.integrator == "rk4" ? 1e-6 : 4e-6;
  EXPECT_EQ(cheapest(all.points, {kUnset, 2e-6})->integrator, "rk4");
  EXPECT_EQ(cheapest(all.points, {0.1, 2e-6})->integrator, "rk4") << "both must hold";
  EXPECT_EQ(cheapest(all.points, {0.02, 2e-6}), nullptr) << "both must hold";
  EXPECT_NE(cheapest(all.points, {kUnset, 5e-6})->integrator, "rk4");
  EXPECT_THAT(app::advice_text(all, {kUnset, 1.5e-6}),
              testing::AllOf(testing::HasSubstr("errs by 1.00 um, allowed 1.5 um"),
                             testing::HasSubstr("that may be more than allowed")));
  EXPECT_THAT(app::advice_text(all, {0.05, 2.5e-6}), testing::HasSubstr("errs by 0.0300 N and 1.00 um"));
  all.second.way = 2e-6;
  EXPECT_THROW(app::refuse_below_floor(all, {kUnset, 0.5e-6}), Error);
}

TEST(Precision, ASceneWithoutAHandIsRefused) {
  const SetupWith tracking = [](const std::vector<std::string>& set) { return setup_of("tracking", set); };
  EXPECT_THROW((void)precision_of(tracking, {}), Error);
}

// A short press of a plane: what ships errs no more than two converged runs and a count of the sensor.
TEST(PrecisionLong, ThePlaneHoldsAtWhatShips) {
  PrecisionOptions options;
  options.seconds = 5.0;
  options.cpu = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  options.rounds = 1;
  const Precision all =
      precision_of([](const std::vector<std::string>& set) { return setup_of("plane", set); }, options);
  ASSERT_EQ(all.points.size(), 16U);
  const auto shipped =
      std::find_if(all.points.begin(), all.points.end(), [](const auto& one) { return one.shipped; });
  ASSERT_NE(shipped, all.points.end());
  EXPECT_GT(all.touched, 500);
  EXPECT_LT(shipped->error, 0.06) << "N";
  EXPECT_GT(shipped->error, 0.0);
  EXPECT_LT(shipped->cpu * 8.0, all.converged.cpu) << "in one run";
}

// A period that has no end in decimals, and what ships is no part of it that the grid has.
TEST(Precision, AnyHapticRateIsTakenAndWhatShipsIsAPoint) {
  PrecisionOptions options;
  options.seconds = 4.0;
  options.cpu = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  options.rounds = 1;
  options.grid = {{"implicitfast"}, {1}};
  options.converged = 10;
  const Precision all = precision_of(
      [](const std::vector<std::string>& set) {
        std::vector<std::string> own{"rig.loop.rate_hz=1500", "truth.world.timestep_us=222.22222222222223"};
        own.insert(own.end(), set.begin(), set.end());
        return setup_of("plane", own);
      },
      options);
  ASSERT_EQ(all.points.size(), 2U);
  EXPECT_FALSE(all.points[0].shipped);
  EXPECT_TRUE(all.points[1].shipped);
  EXPECT_NEAR(all.points[1].step * 4500.0, 1.0, 1e-9);
  for (const PrecisionPoint& point : all.points) EXPECT_EQ(point.failure, "");
  EXPECT_DOUBLE_EQ(all.tick * 1500.0, 1.0);
}

}  // namespace
}  // namespace enc::trial
