// Tools that scenes name, seen by their markers with a tracker's noise: how often one is taken for another,
// or its markers for each other [VHMR 3.2].
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/control/track/markers.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"

namespace enc {
namespace {

using Markers = std::vector<Vec3>;

// Each geometry of every scene once.
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
  std::int64_t other = 0;  // taken for another tool
  [[nodiscard]] std::int64_t wrong() const { return turned + none + other; }
};

// Looks at each tool anywhere, any way up, its markers in any order; `noise` is the rms of an axis, m.
Confusion confusion(const std::vector<Markers>& tools, double noise, int looks) {
  // A pose that is farther off has mistaken markers for each other.
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

// The closest pair that a scene may name together: triangles of which one side is longer, half at each end,
// so that the error of this one distance decides.
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

// A scene may name two tools that are taken for each other once in a million looks (markers.h). Twice the
// noise makes that once in a hundred, by the tail of the normal distribution; here this is counted.
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
