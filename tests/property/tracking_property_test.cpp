// Tracked motion: predictions of random motions, and tools that the markers distinguish under a tracker's
// noise.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/control/track/markers.h"
#include "core/control/track/predict.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"

namespace enc {
namespace {

// ---- Predictions of random motions through a random tracker: always finite, better than holding for motions
// of a hand, and never far off.

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

// A tracker with equal noise along all axes observes the tool.
void observe(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, TipMotion& motion,
             bool calm = false) {
  enc::observe(rig, tool, t, tip, {rig.measurement_noise, rig.measurement_noise}, motion, calm);
}

struct Packet {
  Time exposed, due;
  Point<'W'> tip;
};
// Packets at 120 Hz, 5 to 25 ms late, a tenth lost, in random order, some twice.
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

// Unrelated poses at any stamps: the prediction stays near to them.
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
          // The speed limit of a leap bounds motions (predict.cpp), and so their predictions.
          ASSERT_LT((at - tip).norm(), 3.0) << seed << " " << i;
        }
      }
    }
}

// ---- Tools of scenes, measured by their markers with a tracker's noise: how often the core mistakes one
// tool for another, or markers for each other [VHMR 3.2].

using Markers = std::vector<Vec3>;

// Each marker geometry of every scene, once.
std::vector<Markers> shipped_tools() {
  std::vector<Markers> tools;
  for (const auto& entry : std::filesystem::directory_iterator(tests::source_dir() + "/models/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    for (const ToolSpec& tool : models::load(entry.path().string(), "", {}).scene.tools)
      if (!tool.markers.empty() && std::find(tools.begin(), tools.end(), tool.markers) == tools.end())
        tools.push_back(tool.markers);
  }
  return tools;
}

struct Confusion {
  std::int64_t looks = 0, turned = 0, none = 0;
  std::int64_t other = 0;  // mistaken for another tool
  [[nodiscard]] std::int64_t wrong() const { return turned + none + other; }
};

// Measures each tool at any place, in any orientation, its markers in any order; `noise` is the rms per axis,
// m.
Confusion confusion(const std::vector<Markers>& tools, double noise, int looks) {
  // A pose with a larger error has mistaken markers for each other.
  constexpr double kTurned = 10.0 * std::numbers::pi / 180.0;
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss;
  const auto normal = [&] { return gauss(random); };
  Confusion sum;
  for (std::size_t tool = 0; tool < tools.size(); ++tool)
    for (int i = 0; i < looks; ++i) {
      const Quat q = Quat(normal(), normal(), normal(), normal()).normalized();
      const Pose<'C', 'T'> X_CT(q, Vec3(0.2 * normal(), 0.2 * normal(), 1.0 + 0.1 * normal()));
      Markers seen;
      for (const Vec3& marker : tools[tool])
        seen.push_back((X_CT * Point<'T'>(marker)).e() + noise * Vec3(normal(), normal(), normal()));
      std::shuffle(seen.begin(), seen.end(), random);
      const RecognisedTool found = recognise(seen, tools);
      ++sum.looks;
      if (found.tool < 0)
        ++sum.none;
      else if (static_cast<std::size_t>(found.tool) != tool)
        ++sum.other;
      else if (found.X_CT.q().angularDistance(X_CT.q()) > kTurned)
        ++sum.turned;
    }
  return sum;
}

// The closest pair that a scene may name together: triangles that differ in one side, half at each end, so
// that the error of this one distance decides.
std::vector<Markers> just_apart() {
  const Vec3 a(-0.04, 0, 0), b(0.04, 0, 0), c(0.01, 0.12, 0), half(1e-5, 0, 0);
  std::vector<Markers> tools{{a, b, c}, {a, b, c}};
  while (alike(tools[0], tools[1])) {
    tools[1][0] -= half;
    tools[1][1] += half;
  }
  return tools;
}

TEST(ToolsProperty, NoShippedToolIsMistaken) {
  const std::vector<Markers> tools = shipped_tools();
  EXPECT_GE(tools.size(), 2U);
  EXPECT_EQ(confusion(tools, kMarkerNoise, 20'000).wrong(), 0);
  EXPECT_EQ(confusion(tools, 0.1e-3, 2'000).wrong(), 0);
}

// A scene may name two tools that are mistaken for each other once in a million looks (markers.h). Twice the
// noise makes that once in a hundred, by the tail of the normal distribution; the test counts this.
TEST(ToolsProperty, TheClosestPairThatASceneMayNameIsToldApart) {
  constexpr int kLooks = 50'000;
  const std::vector<Markers> two = just_apart();
  const Confusion closest = confusion(two, kMarkerNoise, kLooks);
  EXPECT_LE(static_cast<double>(closest.wrong()), 2.5e-5 * static_cast<double>(closest.looks));
  constexpr double kLoud = 2.0 * kMarkerNoise;
  const double tail = 0.5 * std::erfc(0.5 * kMarkersApart / (std::sqrt(2.0) * kLoud) / std::sqrt(2.0));
  const Confusion loud = confusion(two, kLoud, kLooks);
  const double ratio = static_cast<double>(loud.other) / static_cast<double>(loud.looks) / tail;
  EXPECT_GE(ratio, 0.85);  // three standard deviations of the count are 0.1
  EXPECT_LE(ratio, 1.15);
}

}  // namespace
}  // namespace enc
