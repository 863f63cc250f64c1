// Two bare hands in view. While none is tracked, the fingertip with the best score is taken, ties as in step
// 10; from then on the one that is tracked, and never the other as long as it is seen.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/vision/finger_tracker.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

StereoRig two_wide() {
  StereoRig rig;
  rig.width = 320;
  rig.height = 240;
  rig.left = rig.right = {360.5, 360.5, 159.5, 119.5, {}};
  return rig;
}
using drawn::at_frame;

// The second hand before the first, pixel by pixel.
drawn::Pair pair_of(const drawn::HandAt& first, const drawn::HandAt& second, int seed) {
  drawn::Pair pair = drawn::pair_of(two_wide(), &first, static_cast<std::uint64_t>(seed));
  for (const Side side : {Side::left, Side::right}) {
    Image& image = side == Side::left ? pair.left : pair.right;
    Image other;
    Mask on(image.width, image.height);
    drawn::draw(two_wide(), side, &second, static_cast<std::uint64_t>(seed), 1.5, other, &on);
    for (std::size_t i = 0; i < on.on.size(); ++i)
      if (on.on[i] != 0) std::copy_n(other.rgb.data() + 3 * i, 3, image.rgb.data() + 3 * i);
  }
  return pair;
}

FingerTracker ready_for_two() {
  static const drawn::Pair kEmpty = drawn::pair_of(two_wide(), nullptr, 90);
  FingerTracker tracker(two_wide(), drawn::segmentation(), {}, {});
  (void)tracker.see(kEmpty.frame(), at_frame(-3));
  (void)tracker.see(kEmpty.frame(), at_frame(-2));
  return tracker;
}
drawn::HandAt palm_at(double x, double y, double z, double radius = 0.008) {
  drawn::HandAt hand;
  hand.tip = {x, y, z};
  hand.along = {0.2, -1, 0.1};
  hand.radius = radius;
  hand.palm = 0.0155;  // two whole fists would hide each other's finger
  hand.length = 0.090;
  return hand;
}
double off(const Finger& finger, const drawn::HandAt& hand) {
  return finger.tip.finite() ? (finger.tip.e() - hand.tip).norm() : 1.0;
}

// One finger moves at 200 mm/s across; from the fourth frame on another one is there: `aside` of the first
// one's place in frame 7, or going along with it. It is a little higher, so that it comes first in reading
// order.
void expect_kept(double aside, double radius, bool along) {
  FingerTracker tracker = ready_for_two();
  for (int i = 1; i <= 10; ++i) {
    const drawn::HandAt own = palm_at(-0.02 + 0.01 * i, 0.02, 0.45);
    const drawn::HandAt other = palm_at((along ? own.tip.x() : 0.05) + aside, 0.015, 0.45, radius);
    const drawn::Pair pair =
        i <= 3 ? drawn::pair_of(two_wide(), &own, static_cast<std::uint64_t>(i)) : pair_of(own, other, i);
    const Finger finger = tracker.see(pair.frame(), at_frame(i));
    ASSERT_EQ(finger.state, FingerState::seen) << "frame " << i << ", " << aside << ", " << radius;
    // A tip of 13 px in a mask of tiles of 5 px: 2 px are 2.5 mm here, and 0.4 px of disparity 3 mm.
    EXPECT_LT(off(finger, own), 6e-3) << "frame " << i << ", " << aside << ", " << radius;
  }
}

TEST(TwoHandsLong, FarApartTheTrackedOneIsKept) {
  for (const double radius : {0.007, 0.008, 0.009}) expect_kept(-0.16, radius, false);
}

TEST(TwoHandsLong, InPassingTheTrackedOneIsKept) {
  for (const double aside : {-0.08, 0.10}) expect_kept(aside, 0.009, false);
}

// 28 mm are 22 px: both are in the smallest window.
TEST(TwoHandsLong, SideBySideTheTrackedOneIsKept) {
  for (const double aside : {-0.028, 0.028})
    for (const double radius : {0.007, 0.008, 0.009}) expect_kept(aside, radius, true);
}

// The tracked finger leaves: another one that is farther than it could have come is not taken for it, but
// found anew once it is lost.
TEST(TwoHandsLong, TheOtherIsTakenOnlyOnceTheTrackedOneIsLost) {
  FingerTracker tracker = ready_for_two();
  const drawn::HandAt own = palm_at(0.175, 0.02, 0.45), other = palm_at(-0.09, 0.02, 0.45);
  for (int i = 1; i <= 4; ++i)
    ASSERT_EQ(tracker.see(pair_of(own, other, i).frame(), at_frame(i)).state, FingerState::seen) << i;
  const double side = off(tracker.see(pair_of(own, other, 5).frame(), at_frame(5)), own);
  const bool tracks_own = side < 0.03;
  const drawn::HandAt &tracked = tracks_own ? own : other, &left = tracks_own ? other : own;
  Finger finger;
  int i = 6;
  for (; i <= 16; ++i) {
    finger =
        tracker.see(drawn::pair_of(two_wide(), &left, static_cast<std::uint64_t>(i)).frame(), at_frame(i));
    if (finger.state == FingerState::seen) break;
    if (!finger.tip.finite()) continue;
    EXPECT_LT(off(finger, tracked), 0.02) << i;  // foreseen, where it was
  }
  EXPECT_GE(i, 6 + TrackSpec{}.full_frame_after);
  EXPECT_EQ(finger.state, FingerState::seen);
  EXPECT_LT(off(finger, left), 6e-3);
  EXPECT_LT(finger.velocity.e().norm(), 0.2);  // of a new one: it did not fly over
}

// Two alike: one of them is taken, never a place between them, and the same again and again.
TEST(TwoHandsLong, AtFirstOneOfThemIsTaken) {
  const drawn::HandAt one = palm_at(0.06, 0.0, 0.45), two = palm_at(-0.04, 0.02, 0.45);
  FingerTracker tracker = ready_for_two(), again = ready_for_two();
  const drawn::Pair pair = pair_of(one, two, 1);
  const Finger finger = tracker.see(pair.frame(), at_frame(1));
  ASSERT_EQ(finger.state, FingerState::seen);
  EXPECT_LT(std::min(off(finger, one), off(finger, two)), 6e-3);
  EXPECT_EQ(again.see(pair.frame(), at_frame(1)).tip.e(), finger.tip.e());
  const drawn::HandAt& taken = off(finger, one) < off(finger, two) ? one : two;
  for (int i = 2; i <= 6; ++i)
    EXPECT_LT(off(tracker.see(pair_of(one, two, i).frame(), at_frame(i)), taken), 6e-3) << i;
}

// A finger upright, its cap's middle at (column, row).
void draw_upright(Mask& mask, int column, int row) {
  for (int y = row - 10; y < mask.height; ++y)
    for (int x = column - 10; x <= column + 10; ++x) {
      const int dx = x - column, dy = std::min(y - row, 0);
      if (dx * dx + dy * dy <= 100) mask.row(y)[x] = 255;
    }
}
Fingertip tip_in(const Mask& mask) {
  // So long a lens that nothing is seen aslant; R / B is 0.008 / 0.09.
  const RectifiedPair flat{1e6, 119.5, 119.5, 0.09, Mat3::Identity()};
  FingertipFinder finder({}, flat, 40.0, mask.width, mask.height);
  DisparityMap map(mask.width, mask.height);
  map.fill(112.5F);  // r = 10 px
  return finder.find(mask, map, mask.whole());
}

// Of the finder alone: the best score; of equal ones the first pixel in reading order.
TEST(TwoHandsLong, TheBestScoreIsTakenAndTiesAreInReadingOrder) {
  Mask level(240, 240), higher(240, 240);
  draw_upright(level, 70, 90);
  draw_upright(level, 170, 90);
  EXPECT_NEAR(tip_in(level).column, 70.0, 1.0);
  draw_upright(higher, 70, 90);
  draw_upright(higher, 170, 80);
  EXPECT_NEAR(tip_in(higher).column, 170.0, 1.0);
  for (int y = 60; y < 200; y += 4) higher.row(y)[168] = higher.row(y + 1)[173] = 0;  // flaws of the first
  EXPECT_NEAR(tip_in(higher).column, 70.0, 1.0);
}

// One passes before the other: one of the two is told, or none.
TEST(TwoHandsLong, HandsThatTouchOrHideEachOtherAreNoHarm) {
  FingerTracker tracker = ready_for_two();
  for (int i = 1; i <= 8; ++i) {
    drawn::HandAt one = palm_at(0.04, 0.02, 0.45), two = palm_at(0.09 - 0.012 * i, 0.02, 0.42);
    one.fist = two.fist = true;
    const Finger finger = tracker.see(pair_of(one, two, i).frame(), at_frame(i));
    if (finger.state != FingerState::seen) continue;
    EXPECT_TRUE(finger.tip.finite()) << i;
    EXPECT_LT(std::min(off(finger, one), off(finger, two)), 0.03) << i;
  }
}

}  // namespace
}  // namespace enc
