// Tools by their markers: which one it is, how it stands, and which cannot be told apart.
#include "core/control/track/markers.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace enc {
namespace {

using Markers = std::vector<Vec3>;

// Those that ship (models/scenes/session.toml).
const Markers kStylus{{0, 0, 0}, {0.052, 0, 0}, {0, 0.041, 0}, {-0.017, -0.030, 0.012}};
const Markers kProbe{{0, 0, 0}, {0.061, 0, 0}, {0, 0.034, 0}, {-0.025, -0.022, 0.008}};
const std::vector<Markers> kBoth{kStylus, kProbe};

struct Drawn {
  explicit Drawn(std::uint64_t seed) : random(seed) {}
  double normal() { return normal_(random); }
  Pose<'C', 'T'> pose() {
    const Quat q = Quat(normal(), normal(), normal(), normal()).normalized();
    return {q, Vec3(0.2 * normal(), 0.2 * normal(), 1.0 + 0.1 * normal())};
  }
  // As a tracker sees them, in any order.
  Markers seen(const Markers& tool, const Pose<'C', 'T'>& X_CT, double noise) {
    Markers all;
    for (const Vec3& marker : tool)
      all.push_back((X_CT * Point<'T'>(marker)).e() + noise * Vec3(normal(), normal(), normal()));
    std::shuffle(all.begin(), all.end(), random);
    return all;
  }
  std::mt19937_64 random;
  std::normal_distribution<double> normal_;
};

TEST(Markers, AToolIsRecognisedWithItsPoseInWhateverOrderTheyAreSeen) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Drawn drawn(seed);
    const auto which = static_cast<std::size_t>(seed % 2);
    const Pose<'C', 'T'> X_CT = drawn.pose();
    const RecognisedTool found = recognise(drawn.seen(kBoth[which], X_CT, 0.0), kBoth);
    ASSERT_EQ(found.tool, static_cast<std::int32_t>(which)) << seed;
    EXPECT_LT((found.X_CT.p() - X_CT.p()).norm(), 1e-12);
    EXPECT_LT(found.X_CT.q().angularDistance(X_CT.q()), 1e-7);
    EXPECT_LT(found.rms, 1e-12);
  }
}

// At 0.3 mm on each axis of each marker no tool is missed or taken for the other.
TEST(Markers, NoiseOfATrackerConfusesNone) {
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
    Drawn drawn(seed);
    const auto which = static_cast<std::size_t>(seed % 2);
    wrong += recognise(drawn.seen(kBoth[which], drawn.pose(), 0.3e-3), kBoth).tool == static_cast<int>(which)
                 ? 0
                 : 1;
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Markers, WhatIsNoneOfThemIsNotRecognised) {
  Drawn drawn(1);
  Markers other = kStylus;
  other[1].x() += 2 * kMarkersApart;
  EXPECT_EQ(recognise(drawn.seen(other, drawn.pose(), 0.0), kBoth).tool, -1);
  Markers three(kStylus.begin(), kStylus.begin() + 3);
  EXPECT_EQ(recognise(three, kBoth).tool, -1) << "one is hidden";
  EXPECT_EQ(recognise({}, kBoth).tool, -1);
  EXPECT_EQ(recognise(Markers(17, Vec3::Zero()), kBoth).tool, -1);
}

// A mirror image has the same distances: it fits badly, and is refused where a scene names both.
TEST(Markers, AMirrorImageIsAlikeAndFitsBadly) {
  Markers mirrored = kStylus;
  for (Vec3& marker : mirrored) marker.z() = -marker.z();
  EXPECT_TRUE(alike(kStylus, mirrored));
  EXPECT_FALSE(alike(kStylus, kProbe));
  const std::vector<Markers> hands{kStylus, mirrored};
  Drawn drawn(3);
  for (const int which : {0, 1})
    EXPECT_EQ(recognise(drawn.seen(hands[static_cast<std::size_t>(which)], drawn.pose(), 0.0), hands).tool,
              which);
}

// Alone it is not taken for the tool either: its best fit is 4.9 mm off the stylus, 3.3 mm off the probe.
TEST(Markers, AMirrorImageAloneIsNone) {
  for (const Markers& tool : kBoth) {
    Markers mirrored = tool;
    for (Vec3& marker : mirrored) marker.x() = -marker.x();
    ASSERT_TRUE(alike(tool, mirrored));
    for (std::uint64_t seed = 1; seed <= 2'000; ++seed) {
      Drawn drawn(seed);
      EXPECT_EQ(recognise(drawn.seen(mirrored, drawn.pose(), kMarkerNoise), kBoth).tool, -1) << seed;
    }
  }
}

// Each distance is off by less than 4 mm, and so is each marker: by 5 % of its way to the middle, 1.8 mm rms.
TEST(Markers, AToolOfWhichAllDistancesAreALittleOffIsNone) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& marker : kStylus) middle += marker / static_cast<double>(kStylus.size());
  const auto grown = [&](double by) {
    Markers all = kStylus;
    for (Vec3& marker : all) marker += by * (marker - middle);
    return all;
  };
  Drawn drawn(2);
  ASSERT_TRUE(alike(kStylus, grown(0.05)));
  EXPECT_EQ(recognise(drawn.seen(grown(0.05), drawn.pose(), 0.0), kBoth).tool, -1);
  const RecognisedTool near = recognise(drawn.seen(grown(0.04), drawn.pose(), 0.0), kBoth);
  EXPECT_EQ(near.tool, 0);
  EXPECT_LT(near.rms, kWorstFit);
}

TEST(Markers, AToolThatLooksTheSameInAnotherOrderHasTwoPoses) {
  EXPECT_FALSE(has_two_poses(kStylus));
  EXPECT_FALSE(has_two_poses(kProbe));
  const double side = 0.05;
  EXPECT_TRUE(has_two_poses(Markers{{0, 0, 0}, {side, 0, 0}, {0, side, 0}})) << "its legs are alike";
  EXPECT_TRUE(has_two_poses(Markers{{0, 0, 0}, {side, 0, 0}, {0, side + 0.9 * kMarkersApart, 0}}));
  EXPECT_FALSE(has_two_poses(Markers{{0, 0, 0}, {side, 0, 0}, {0, side + 1.1 * kMarkersApart, 0}}));
}

// As many as a scene may have, all within 3 mm: there are 16! orders, and two are enough.
TEST(Markers, ManyThatLookAlikeAreFoundAtOnce) {
  Drawn drawn(5);
  Markers many;
  for (std::size_t i = 0; i < kMostMarkers; ++i)
    many.emplace_back(1e-3 * std::cos(0.4 * static_cast<double>(i)),
                      1e-3 * std::sin(0.4 * static_cast<double>(i)), 0);
  EXPECT_TRUE(has_two_poses(many));
  EXPECT_TRUE(alike(many, drawn.seen(many, drawn.pose(), 0.0)));
}

}  // namespace
}  // namespace enc
