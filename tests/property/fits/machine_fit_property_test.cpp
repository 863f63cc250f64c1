// Fits from a machine that stands in many poses: the load of its force sensor and the place of its tracker.
// Over seeds, with the errors of real devices, each number lies within its stated interval.
#include <array>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "core/machine/arm.h"
#include "models/identify/rig/machine_fit.h"
#include "models/identify/rig/turn.h"
#include "sim/truth/random.h"
#include "tests/support/error_of.h"

namespace enc::tests {
namespace {

using models::EyeStand;
using models::WeightStand;
using testing::HasSubstr;

Vec3 anywhere(sim::Stream& random, double size) {
  Vec3 v;
  for (double& x : v) x = size * (2.0 * random.uniform() - 1.0);
  return v;
}

// Poses of the machine: tilted up to 10 degrees to each side, turned up to 20, spread over the workspace.
std::vector<Pose<'W', 'H'>> stood(sim::Stream& random, std::size_t count = 24) {
  std::vector<Pose<'W', 'H'>> all;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 angles = anywhere(random, 1.0).cwiseProduct(kDegree * Vec3(10, 10, 20));
    all.emplace_back(rotation_xyz(angles), anywhere(random, 0.02));
  }
  return all;
}

struct Sensor {
  Pose<'H', 'F'> X_HF;
  double mass = 0.96;
  Vec3 zero{0.5, -0.3, 0.4};
  double noise = 0.001, walk = 0.002;  // N of a stand's mean, N / sqrt(s)
  Vec3 middle{0.004, -0.002, 0.06};
};

// Stands 5 s apart; `zero` ends at its value in the last stand.
std::vector<WeightStand> weighed(Sensor& sensor, sim::Stream& random, std::size_t count = 24) {
  std::vector<WeightStand> all;
  for (const Pose<'W', 'H'>& X_WH : stood(random, count)) {
    const double time = 5.0 * static_cast<double>(all.size());
    if (!all.empty()) sensor.zero += sensor.walk * std::sqrt(5.0) * random.normal3();
    const Pose<'W', 'F'> X_WF = X_WH * sensor.X_HF;
    const Vec3 weight = X_WF.q().conjugate() * Vec3(0, 0, -sensor.mass * kStandardGravity);
    const Vec3 force = weight + sensor.zero + sensor.noise * random.normal3();
    const Vec3 torque = sensor.middle.cross(weight) + 5e-5 * random.normal3();
    all.push_back({time, X_WH, {Vec<'F'>(force), Vec<'F'>(torque)}});
  }
  return all;
}

// The sensor is turned by up to 2 degrees, or mounted in any orientation.
struct Mounting {
  const char* name;
  double most;  // rad
};

// Over all numbers of all cases 99 % must hold: twice as many misses fail.
struct PooledCoverage {
  double held = 0.0, all = 0.0;
  template <std::size_t n>
  void add(const std::array<int, n>& counts, int of) {
    for (const int one : counts) held += one;
    all += static_cast<double>(n) * of;
  }
  [[nodiscard]] double share() const { return held / all; }
};
constexpr double kLeastPooled = 0.98;

TEST(WeightFit, FindsWeightZeroAndTurnWithinItsIntervals) {
  PooledCoverage pooled;
  for (const Mounting& mounting : {Mounting{"nearly as believed", 2.0 * kDegree}, {"any way round", M_PI}})
    for (const double walk : {0.0, 0.002, 0.008}) {
      std::array<int, 7> held{};
      double widest = 0.0;
      for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        sim::Stream random(seed, "weight");
        Sensor sensor;
        sensor.X_HF = {models::turn_by(anywhere(random, mounting.most / std::sqrt(3.0))), Vec3(0, 0, -0.127)};
        sensor.mass = 0.7 + 0.5 * random.uniform();
        sensor.walk = walk;
        const std::vector<WeightStand> stands = weighed(sensor, random);
        const models::WeightFit fit = models::fit_weight(stands);
        held[0] += fit.mass.holds(sensor.mass);
        // About F's axes: the fitted R_FH is exp(turn) times the true one.
        const Vec3 off = models::turn_of(fit.R_HF.conjugate() * sensor.X_HF.q());
        for (Eigen::Index a = 0; a < 3; ++a) {
          held[static_cast<std::size_t>(1 + a)] +=
              std::abs(fit.zero.value(a) - sensor.zero(a)) <= fit.zero.half(a);
          held[static_cast<std::size_t>(4 + a)] += std::abs(off(a)) <= fit.turn_half(a);
        }
        widest = std::max(widest, fit.mass.half);
        EXPECT_LT((fit.middle.e() - sensor.middle).norm(), 2e-3);
      }
      EXPECT_THAT(held, testing::Each(testing::Ge(95))) << mounting.name << ", walk " << walk;
      EXPECT_LT(widest, walk <= 0.002 ? 0.02 : 0.05) << "an interval that holds everything tells nothing";
      pooled.add(held, 100);
    }
  EXPECT_GT(pooled.share(), kLeastPooled);
}

TEST(WeightFit, IsExactWithoutErrors) {
  sim::Stream random(1, "exact");
  Sensor sensor{{rotation_xyz(kDegree * Vec3(10, -20, 80)), Vec3(0, 0, 0)}};
  sensor.noise = sensor.walk = 0.0;
  const models::WeightFit fit = models::fit_weight(weighed(sensor, random));
  EXPECT_NEAR(fit.mass.value, sensor.mass, 1e-9);
  EXPECT_LT((fit.zero.value - sensor.zero).norm(), 1e-8);
  EXPECT_LT(fit.R_HF.angularDistance(sensor.X_HF.q()), 1e-9);
}

TEST(WeightFit, RefusesWhatIsNoWeight) {
  sim::Stream random(1, "touched");
  Sensor sensor{{Quat::Identity(), Vec3(0, 0, 0)}};
  std::vector<WeightStand> upright = weighed(sensor, random);
  for (WeightStand& stand : upright) stand.X_WH = {Quat::Identity(), Vec3(stand.X_WH.p())};
  const auto refused = [](const std::vector<WeightStand>& stands) -> std::string {
    return test::error_of([&] { (void)models::fit_weight(stands); });
  };
  EXPECT_THAT(refused(upright), HasSubstr("turned too little"));
  std::vector<WeightStand> touched = weighed(sensor, random);
  for (std::size_t i = 5; i < 9; ++i) touched[i].wrench.force = touched[i].wrench.force + Vec<'F'>(0, 0, -3);
  EXPECT_THAT(refused(touched), HasSubstr("see that nothing touches the tool"));
  std::vector<WeightStand> pounds = weighed(sensor, random);
  for (WeightStand& stand : pounds) {
    Vec3 one = stand.wrench.force.e();
    one.x() *= 4.448;
    stand.wrench.force = Vec<'F'>(one);
  }
  EXPECT_THAT(refused(pounds), HasSubstr("does not turn as a weight does"));
  touched.resize(5);
  EXPECT_THAT(refused(touched), HasSubstr("5 stands"));
}

// A wrong sign, unit or cable: a turn and a zero compensate nearly all of it.
TEST(WeightFit, RefusesASensorWithAWrongAxis) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    for (const Vec3& wrong : {Vec3(1, 1, -1), Vec3(-1, 1, 1), Vec3(1, -1, 1), Vec3(-1, -1, -1), Vec3(1, 1, 0),
                              Vec3(1, 1, 4.448), Vec3(1, 1, 0.2248)}) {
      sim::Stream random(seed, "axis");
      Sensor sensor{{models::turn_by(anywhere(random, 0.02)), Vec3(0, 0, -0.127)}};
      std::vector<WeightStand> stands = weighed(sensor, random);
      for (WeightStand& stand : stands)
        stand.wrench.force = Vec<'F'>(Vec3(stand.wrench.force.e().cwiseProduct(wrong)));
      EXPECT_THROW((void)models::fit_weight(stands), Error) << wrong.transpose() << ", seed " << seed;
    }
}

struct RigTruth {
  Pose<'W', 'C'> X_WC;
  Pose<'H', 'T'> X_HT{rotation_xyz(kDegree * Vec3(3, -4, 100)), Vec3(0.002, -0.001, 0.12)};
  double place = 5e-6, turn = 2e-5;  // m, rad: rms of a stand's mean
};

std::vector<EyeStand> watched(const RigTruth& seen, sim::Stream& random, std::size_t count = 24) {
  std::vector<EyeStand> all;
  for (const Pose<'W', 'H'>& X_WH : stood(random, count)) {
    const Pose<'C', 'T'> X_CT = seen.X_WC.inverse() * X_WH * seen.X_HT;
    all.push_back({X_WH,
                   {(models::turn_by(seen.turn * random.normal3()) * X_CT.q()).normalized(),
                    Vec3(X_CT.p() + seen.place * random.normal3())}});
  }
  return all;
}

TEST(HandEyeFit, FindsTheTrackerWithinItsIntervals) {
  PooledCoverage pooled;
  for (const std::size_t count : {std::size_t{12}, std::size_t{24}})
    for (const double turn : {0.0, 2e-5, 2e-3}) {
      std::array<int, 12> held{};
      double widest = 0.0;
      for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        sim::Stream random(seed, "hand-eye");
        RigTruth seen{{models::turn_by(anywhere(random, M_PI / std::sqrt(3.0))), anywhere(random, 1.5)}};
        seen.turn = turn;
        const models::HandEyeFit fit = models::fit_hand_eye(watched(seen, random, count));
        const Vec3 turned = models::turn_of(seen.X_WC.q() * fit.X_WC.q().conjugate());
        const Vec3 moved = seen.X_WC.p() - fit.X_WC.p();
        const Vec3 tip = seen.X_HT.inverse().p() - fit.tip.value;
        // The error of a pose measured at W's origin.
        const Vec3 origin = (fit.X_WC * (seen.X_WC.inverse() * Point<'W'>(0, 0, 0))).e();
        const auto tally = [&](std::size_t first, const Vec3& error, const Vec3& half) {
          for (std::size_t a = 0; a < 3; ++a)
            held[first + a] +=
                std::abs(error(static_cast<Eigen::Index>(a))) <= half(static_cast<Eigen::Index>(a));
        };
        tally(0, turned, fit.turn_half);
        tally(3, moved, fit.place_half);
        tally(6, tip, fit.tip.half);
        tally(9, origin, fit.origin_half);
        widest = std::max(widest, fit.origin_half.maxCoeff());
      }
      EXPECT_THAT(held, testing::Each(testing::Ge(193))) << count << " stands, turns to " << turn;
      EXPECT_LT(widest, count == 24 ? 50e-6 : 200e-6) << "an interval that holds everything tells nothing";
      pooled.add(held, 200);
    }
  EXPECT_GT(pooled.share(), kLeastPooled);
}

TEST(HandEyeFit, IsExactWithoutErrors) {
  sim::Stream random(1, "exact");
  RigTruth seen{{rotation_xyz(kDegree * Vec3(170, 30, -60)), Vec3(0.1, -0.9, 0.6)}};
  seen.place = seen.turn = 0.0;
  const models::HandEyeFit fit = models::fit_hand_eye(watched(seen, random));
  EXPECT_LT((fit.X_WC.p() - seen.X_WC.p()).norm(), 1e-9);
  EXPECT_LT(fit.X_WC.q().angularDistance(seen.X_WC.q()), 1e-9);
  EXPECT_LT((fit.X_HT.p() - seen.X_HT.p()).norm(), 1e-9);
}

TEST(HandEyeFit, RefusesTurnsAboutOneAxisAndToolsThatSlip) {
  sim::Stream random(1, "one axis");
  const RigTruth seen{{rotation_xyz(kDegree * Vec3(0, 30, 0)), Vec3(0.1, -0.9, 0.6)}};
  const auto refused = [](const std::vector<EyeStand>& stands) -> std::string {
    return test::error_of([&] { (void)models::fit_hand_eye(stands); });
  };
  std::vector<EyeStand> about_z = watched(seen, random);
  for (EyeStand& stand : about_z) {
    const Vec3 turn = models::turn_of(stand.X_WH.q());
    stand.X_WH = {models::turn_by(Vec3(0, 0, turn.z())), Vec3(stand.X_WH.p())};
    stand.X_CT = seen.X_WC.inverse() * stand.X_WH * seen.X_HT;
  }
  EXPECT_THAT(refused(about_z), HasSubstr("about one axis alone"));
  std::vector<EyeStand> slipped = watched(seen, random);
  for (std::size_t i = 12; i < slipped.size(); ++i)
    slipped[i].X_CT = {slipped[i].X_CT.q(), Vec3(slipped[i].X_CT.p() + Vec3(0, 0.02, 0))};
  EXPECT_THAT(refused(slipped), HasSubstr("do not tell the same motion"));
  slipped.resize(5);
  EXPECT_THAT(refused(slipped), HasSubstr("in 5 stands"));
}

// Both places compensate the scale error: the residual is a fifth of a millimetre for each percent.
TEST(HandEyeFit, RefusesATrackerWhoseLengthsAreNotTheMachines) {
  const RigTruth seen{{rotation_xyz(kDegree * Vec3(0, 30, 0)), Vec3(0.1, -0.9, 0.6)}};
  const auto scaled = [&](std::uint64_t seed, double scale) -> std::string {
    sim::Stream random(seed, "scale");
    std::vector<EyeStand> stands = watched(seen, random);
    for (EyeStand& stand : stands) stand.X_CT = {Quat(stand.X_CT.q()), Vec3(scale * stand.X_CT.p())};
    return test::error_of([&] { (void)models::fit_hand_eye(stands); });
  };
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    EXPECT_THAT(scaled(seed, 1.01), testing::ContainsRegex("lengths are (0.9|1.0). .- 0.0.")) << seed;
    EXPECT_THAT(scaled(seed, 0.99), testing::ContainsRegex("lengths are -(0.9|1.0). .- 0.0.")) << seed;
    EXPECT_EQ(scaled(seed, 1.002), "") << seed;
  }
}

}  // namespace
}  // namespace enc::tests
