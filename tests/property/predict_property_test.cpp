// Predictions of random motions through a random tracker: always finite, better than holding where a hand
// moves as hands do, and never far off.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/control/track/predict.h"

namespace enc {
namespace {

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}

// Waves below 1.5 Hz along each axis.
struct Motion {
  static constexpr int kWaves = 4;
  std::array<std::array<Vec3, kWaves>, 3> waves;  // amplitude m, rad/s, phase
  explicit Motion(Random& random) {
    for (auto& axis : waves)
      for (Vec3& wave : axis)
        wave = {between(random, 1e-3, 10e-3), 2.0 * std::numbers::pi * between(random, 0.1, 1.5),
                between(random, 0.0, 6.3)};
  }
  [[nodiscard]] Vec3 at(double t) const {
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      for (const Vec3& wave : waves[static_cast<std::size_t>(i)])
        p(i) += wave(0) * std::sin(wave(1) * t + wave(2));
    return p;
  }
};

// By a tracker that knows all ways alike.
void observe(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, TipMotion& motion,
             bool calm = false) {
  enc::observe(rig, tool, t, tip, {rig.measurement_noise, rig.measurement_noise}, motion, calm);
}

struct Packet {
  Time exposed, due;
  Point<'W'> tip;
};
// 120 Hz, 5 to 25 ms late, a tenth lost, in no order, some twice.
std::vector<Packet> packets_of(const Motion& motion, Random& random, double noise) {
  std::normal_distribution<> normal(0.0, noise);
  std::vector<Packet> packets;
  for (int i = 0; i < 600; ++i) {
    if (between(random, 0.0, 1.0) < 0.1) continue;
    const Time exposed(Duration(static_cast<std::int64_t>(i * 1e9 / 120.0)));
    const Vec3 error(normal(random), normal(random), normal(random));
    const Point<'W'> tip(Vec3(motion.at(seconds(exposed.time_since_epoch())) + error));
    for (int copies = i % 5 == 0 ? 2 : 1; copies > 0; --copies)
      packets.push_back({exposed, exposed + from_seconds(between(random, 0.005, 0.025)), tip});
  }
  std::sort(packets.begin(), packets.end(), [](const Packet& a, const Packet& b) { return a.due < b.due; });
  return packets;
}

// RMS distance to the truth after the first second, m.
double error_of(Prediction prediction, const Motion& motion, const std::vector<Packet>& packets) {
  TrackerRig rig;
  rig.prediction = prediction;
  TipMotion state;
  std::size_t next = 0;
  double sum = 0.0;
  int n = 0;
  for (Time now{}; now < Time(from_seconds(5.0)); now += Duration(1'000'000)) {
    for (; next < packets.size() && packets[next].due <= now; ++next)
      if (state.tool < 0 || packets[next].exposed > state.t)
        observe(rig, 0, packets[next].exposed, packets[next].tip, state);
    if (state.tool < 0) continue;
    const Point<'W'> tip = predict(rig, state, now);
    EXPECT_TRUE(tip.finite());
    if (now < Time(from_seconds(1.0))) continue;
    sum += (tip.e() - motion.at(seconds(now.time_since_epoch()))).squaredNorm();
    ++n;
  }
  EXPECT_TRUE(state.across.xx >= 0.0 && state.across.vv >= 0.0 && state.across.aa >= 0.0);
  return std::sqrt(sum / n);
}

TEST(PredictProperty, BetterThanHoldingWhereAHandMovesAsHandsDo) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const Motion motion(random);
    const std::vector<Packet> packets = packets_of(motion, random, 0.015e-3);
    const double held = error_of(Prediction::hold, motion, packets);
    EXPECT_LT(error_of(Prediction::constant_velocity, motion, packets), 0.5 * held) << seed;
    EXPECT_LT(error_of(Prediction::constant_acceleration, motion, packets), 0.3 * held) << seed;
  }
}

// Poses that have nothing to do with each other, at any stamps: the answer stays near to them.
TEST(PredictProperty, NeverFarFromWhatWasSeen) {
  for (const Prediction prediction : {Prediction::constant_velocity, Prediction::constant_acceleration})
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      Random random(seed);
      TrackerRig rig;
      rig.prediction = prediction;
      TipMotion state;
      Time exposed{};
      for (int i = 0; i < 500; ++i) {
        exposed += from_seconds(between(random, 1e-4, i % 50 == 0 ? 0.4 : 0.03));
        const Point<'W'> tip(between(random, -2.0, 2.0), between(random, -2.0, 2.0),
                             between(random, -2.0, 2.0));
        const Time now = exposed + from_seconds(between(random, 0.0, 0.06));
        observe(rig, 0, exposed, tip, state);
        for (const double later : {0.0, 0.02, 0.1, 1.0}) {
          const Point<'W'> at = predict(rig, state, now + from_seconds(later));
          ASSERT_TRUE(at.finite());
          // What passes for a motion is bounded by the speed of a leap (predict.cpp), and so is what is made
          // of it.
          ASSERT_LT((at - tip).norm(), 3.0) << seed << " " << i;
        }
      }
    }
}

}  // namespace
}  // namespace enc
