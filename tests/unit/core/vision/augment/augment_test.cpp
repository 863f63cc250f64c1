// The arm is removed from a painted image, and objects are drawn in its place, from the believed poses alone.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/machine/arm_shape.h"
#include "core/vision/augment/augmented_view.h"
#include "core/vision/augment/view_parts.h"
#include "core/vision/stereo/rectify.h"

namespace enc::augment {
namespace {

constexpr int kWidth = 320, kHeight = 240;
const std::array<std::uint8_t, 3> kRoom{90, 110, 120}, kMetal{30, 32, 36}, kSkin{205, 150, 118};

// A camera that looks down on the arm from 0.6 m above W: its x runs along that of W, its y against.
AugmentedSpec spec() {
  AugmentedSpec s;
  s.camera.width = kWidth;
  s.camera.height = kHeight;
  s.camera.left = s.camera.right = pinhole(kWidth, kHeight, 300.0);
  s.segmentation.background_frames = 3;
  s.segmentation.model = {0.385, 0.06};  // rad, of kSkin
  s.arm = ArmMachine{};
  s.prop = Vec3(0.03, 0.03, 0.002);
  s.X_WR = Pose<'W', 'R'>(Quat::Identity(), Vec3(-Arm(*s.arm).tip({}).e()));
  s.X_WC = Pose<'W', 'C'>(Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX())), Vec3(0, 0, 0.6));
  return s;
}

const Object kWall{Surface(Plane{}), Pose<'W', 'O'>::identity(), {}};

constexpr std::size_t kStanding = 3;  // parts of a PHANToM's shape: its base

struct PaintedView {
  Image image{kWidth, kHeight};
  Mask device{kWidth, kHeight};  // its moving part
  // The room, the arm at its true pose, and a square of skin, in that order.
  PaintedView(const AugmentedSpec& truth, const PerJoint& q, const Region& skin = {}) {
    const RectifiedPair pair = Rectifier(truth.camera).pair();
    Mask all(kWidth, kHeight);
    const auto parts = arm_shape(*truth.arm, q, truth.X_WR);
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (Mask* mask : {&all, &device})
        if (mask == &all || i >= kStanding) augment::cover(pair, truth.X_WC.inverse(), parts[i], 0.0, *mask);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const auto& ink = skin.contains(x, y) ? kSkin : all.at(x, y) ? kMetal : kRoom;
        std::copy(ink.begin(), ink.end(), image.at(x, y));
        if (skin.contains(x, y)) device.row(y)[x] = 0;
      }
  }
};

bool is(const Image& image, int x, int y, const std::array<std::uint8_t, 3>& ink) {
  return std::equal(ink.begin(), ink.end(), image.view().at(x, y));
}

// Share of the device's pixels that show the room in `removed`.
double gone(const PaintedView& painted, const Image& removed) {
  int all = 0, away = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!painted.device.at(x, y)) continue;
      ++all;
      away += is(removed, x, y, kRoom) ? 1 : 0;
    }
  return static_cast<double>(away) / all;
}

AugmentedMoment at(const PerJoint& joints) {
  AugmentedMoment moment;
  moment.joints = joints;
  return moment;
}

const PerJoint kAtRest{0, 0, 0}, kMoved{0.5, 0.2, 0.3};

void learn(AugmentedView& view, const AugmentedSpec& truth) {
  for (int i = 0; i < 3; ++i) view.see(PaintedView(truth, kAtRest).image.view(), at(kAtRest));
}

TEST(AugmentedView, TheArmIsGoneAndTheHandBeforeItStays) {
  const AugmentedSpec s = spec();
  AugmentedView view(s, {});
  learn(view, s);
  const Region hand{110, 80, 150, 120};  // over the upper arm
  const PaintedView painted(s, kMoved, hand);
  EXPECT_TRUE(PaintedView(s, kMoved).device.at(130, 88));
  view.see(painted.image.view(), at(kMoved));
  EXPECT_EQ(gone(painted, view.removed()), 1.0);
  for (int y = hand.y0 + 2; y < hand.y1 - 2; ++y)
    for (int x = hand.x0 + 2; x < hand.x1 - 2; ++x) ASSERT_TRUE(is(view.removed(), x, y, kSkin)) << x << y;
  EXPECT_TRUE(is(view.removed(), 5, 5, kRoom));
}

// The background behind the arm's first pose comes from the first frames that show it free.
TEST(AugmentedView, TheBackgroundIsCompletedWhereTheArmStood) {
  const AugmentedSpec s = spec();
  AugmentedView view(s, {});
  learn(view, s);
  const Triplet elbow = seen_at(Rectifier(s.camera).pair(),
                                s.X_WC.inverse() * (s.X_WR * Point<'R'>(0.09, 0, 0)));  // on the upper arm
  const int x = static_cast<int>(elbow.column), y = static_cast<int>(elbow.row);
  EXPECT_FALSE(view.known().at(x, y));
  for (int i = 0; i < 3; ++i) view.see(PaintedView(s, kMoved).image.view(), at(kMoved));
  EXPECT_TRUE(view.known().at(x, y));
}

// The believed pose alone places the arm: its errors appear in the picture.
TEST(AugmentedView, AWrongBeliefMovesWhatIsReplaced) {
  const AugmentedSpec truth = spec();
  AugmentedSpec off = truth;
  off.X_WC = {Quat(truth.X_WC.q()), truth.X_WC.origin() + Vec<'W'>(0, 0.03, 0)};  // 15 px
  AugmentedSpec bent = truth;
  bent.arm->phantom.l1 -= 0.05;
  for (const AugmentedSpec& believed : {off, bent}) {
    AugmentedView view(believed, {});
    learn(view, truth);
    const PaintedView painted(truth, kMoved);
    view.see(painted.image.view(), at(kMoved));
    EXPECT_LT(gone(painted, view.removed()), 0.9);
  }
  AugmentedView view(truth, {});
  learn(view, truth);
  view.see(PaintedView(truth, kMoved).image.view(), at(kAtRest));  // the believed joints place it, too
  EXPECT_LT(gone(PaintedView(truth, kMoved), view.removed()), 0.7);
}

TEST(AugmentedView, AWallIsDrawnWhereItStandsAndTheHandCoversIt) {
  const AugmentedSpec s = spec();
  const std::array<Object, 1> wall{kWall};
  AugmentedView view(s, wall);
  learn(view, s);
  const Region hand{150, 100, 190, 140};
  view.see(PaintedView(s, kMoved, hand).image.view(), at(kMoved));
  // 0.12 m at 0.6 m are 60 px: its corners are 30 px beside the middle.
  const auto drawn = [&](int x, int y) {
    return !std::equal(view.augmented().view().at(x, y), view.augmented().view().at(x, y) + 3,
                       view.removed().view().at(x, y));
  };
  EXPECT_TRUE(drawn(131, 91));
  EXPECT_FALSE(drawn(128, 91));
  EXPECT_TRUE(drawn(148, 148));
  EXPECT_FALSE(drawn(148, 151));
  EXPECT_FALSE(drawn(170, 120));  // the hand
  // A finger known to be far below the wall is visible through it.
  AugmentedMoment moment = at(kMoved);
  moment.finger = Point<'C'>(0, 0, 0.7);
  view.see(PaintedView(s, kMoved, hand).image.view(), moment);
  EXPECT_TRUE(drawn(170, 120));
  // A pushed object is drawn at its present place.
  moment = at(kMoved);
  moment.moved = {Vec<'W'>(0.04, 0, 0)};
  view.see(PaintedView(s, kMoved).image.view(), moment);
  EXPECT_FALSE(drawn(131, 91));
  EXPECT_TRUE(drawn(205, 91));
}

TEST(AugmentedView, AnotherSizeIsRefused) {
  AugmentedView view(spec(), {});
  const Image image(10, 10);
  EXPECT_THROW(view.see(image.view(), {}), Error);
}

// A background that is completed over time.

Image grey(std::uint8_t level) {
  Image image(8, 4);
  std::fill(image.rgb.begin(), image.rgb.end(), level);
  return image;
}

Mask column(int x) {
  Mask mask(8, 4);
  for (int y = 0; x >= 0 && y < 4; ++y) mask.row(y)[x] = 255;
  return mask;
}

TEST(CleanBackground, WhatIsCoveredIsLearnedWhenItIsUncovered) {
  CleanBackground background(8, 4, 3);
  for (const int level : {99, 100, 102})
    background.add(grey(static_cast<std::uint8_t>(level)).view(), column(5));
  EXPECT_FALSE(background.known().at(5, 2));
  EXPECT_TRUE(background.known().at(4, 2));
  EXPECT_EQ(background.image().view().at(4, 2)[0], 100);  // (99 + 100 + 102) / 3
  for (int i = 0; i < 3; ++i) background.add(grey(60).view(), column(-1));
  EXPECT_TRUE(background.known().at(5, 2));
  EXPECT_EQ(background.image().view().at(5, 2)[1], 60);
  EXPECT_EQ(background.image().view().at(4, 2)[1], 100);  // once learned it stays
}

TEST(CleanBackground, WhatMovesDoesNotGetIn) {
  CleanBackground background(8, 4, 3);
  for (const int level : {50, 50, 200, 50, 50}) {
    background.add(grey(static_cast<std::uint8_t>(level)).view(), column(-1));
    EXPECT_FALSE(background.known().at(0, 0));
  }
  background.add(grey(50).view(), column(-1));
  EXPECT_TRUE(background.known().at(0, 0));
  EXPECT_EQ(background.image().view().at(0, 0)[2], 50);
}

// Between 10 and 40, three pixels apart: nearer to the 10, weights 1 : 1/4 in the row; no column is known.
TEST(CleanBackground, AGapGoesOnFromItsSides) {
  CleanBackground background(8, 4, 1);
  Image image = grey(10);
  Mask gap = column(3);
  for (int y = 0; y < 4; ++y) {
    gap.row(y)[4] = 255;
    std::fill_n(image.at(5, y), 9, std::uint8_t{40});
  }
  background.add(image.view(), gap);
  EXPECT_EQ(background.image().view().at(3, 1)[0], 16);
  EXPECT_EQ(background.image().view().at(4, 1)[0], 34);
  EXPECT_FALSE(background.known().at(3, 1));
}

// Virtual objects as triangles, and their visibility.

const RectifiedPair kPair{500.0, 159.5, 119.5, 0.1, Mat3::Identity()};

Pose<'C', 'O'> facing(double z) { return {Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX())), Vec3(0, 0, z)}; }

TEST(Facets, EachShapeIsAsLargeAsItIs) {
  const auto reach = [](const Surface& surface) {
    Vec3 most = Vec3::Zero();
    for (const Point<'O'>& corner : facets_of(surface).corners) most = most.cwiseMax(corner.e().cwiseAbs());
    return most;
  };
  EXPECT_LT((reach(Surface(Plane{})) - Vec3(0.06, 0.06, 0)).norm(), 1e-12);
  EXPECT_LT((reach(Surface(Sphere{0.04})) - Vec3(0.04, 0.04, 0.04)).norm(), 1e-12);
  EXPECT_LT((reach(Surface(Button{0.02, 0.03, 0.05})) - Vec3(0.01, 0.015, 0.05)).norm(), 1e-12);
}

TEST(Facets, TheNearestSurfaceIsSeenAndItsDepthIsExact) {
  DepthPicture seen(320, 240);
  draw(facets_of(Surface(Sphere{0.04})), kPair, facing(0.5), seen);
  draw(facets_of(Surface(Plane{})), kPair, facing(0.5), seen);  // through its middle
  const auto depth = [&](int x, int y) {
    return static_cast<double>(seen.depth[static_cast<std::size_t>(y * 320 + x)]);
  };
  EXPECT_NEAR(depth(160, 120), 0.46, 1e-3);
  EXPECT_NEAR(depth(160 + 55, 120), 0.50, 1e-6);  // beside the ball
  EXPECT_TRUE(std::isinf(depth(160 + 70, 120)));  // and beside the patch
  const auto covered =
      std::count_if(seen.depth.begin(), seen.depth.end(), [](float d) { return std::isfinite(d); });
  EXPECT_NEAR(static_cast<double>(covered), 120.0 * 120.0, 250.0);
}

TEST(Facets, WhatIsNotInFrontIsNotDrawn) {
  DepthPicture seen(320, 240);
  draw(facets_of(Surface(Plane{})), kPair, facing(-0.5), seen);
  draw(facets_of(Surface(Sphere{0.04})), kPair, facing(-0.05), seen);
  for (int i = 0; i < 320 * 240; i += 97) EXPECT_TRUE(std::isinf(seen.depth[static_cast<std::size_t>(i)]));
}

// Outlines of an arm's parts against known areas.

const RectifiedPair kWidePair{500.0, 319.5, 239.5, 0.1, Mat3::Identity()};
const Pose<'C', 'W'> kSame(Quat::Identity(), Vec3(0, 0, 0));  // W is where C is

double pixels(const ArmPart& part, double margin, Mask* mask = nullptr) {
  Mask own(640, 480);
  Mask& m = mask != nullptr ? *mask : own;
  cover(kWidePair, kSame, part, margin, m);
  return static_cast<double>(std::count(m.on.begin(), m.on.end(), std::uint8_t{255}));
}

TEST(PartMask, ABallIsADiscOfItsOutline) {
  const ArmPart ball{
      PartForm::capsule, Material::metal, Point<'W'>(0, 0, 0.5), Mat3::Identity(), {0.05, 0.05, 0}};
  // Rays touch a ball of r at the distance d where sin is r / d: px of radius f r / sqrt(d^2 - r^2).
  const double r = 500.0 * 0.05 / std::sqrt(0.25 - 0.0025);
  EXPECT_NEAR(pixels(ball, 0.0), M_PI * r * r, 0.02 * M_PI * r * r);
  EXPECT_NEAR(pixels(ball, 5.0), M_PI * (r + 5) * (r + 5), 0.02 * M_PI * (r + 5) * (r + 5));
}

TEST(PartMask, ABoxAndARodAreAsLargeAsTheyAre) {
  const ArmPart plate{
      PartForm::box, Material::plate, Point<'W'>(0.01, 0, 0.5), Mat3::Identity(), {0.04, 0.02, 1e-6}};
  EXPECT_NEAR(pixels(plate, 0.0), 80.0 * 40.0, 130.0);
  EXPECT_NEAR(pixels(plate, 3.0), 86.0 * 46.0, 150.0);
  const Mat3 along_x = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX()).toRotationMatrix();
  const ArmPart rod{
      PartForm::cylinder, Material::metal, Point<'W'>(0, 0, 0.5), along_x, {0.004, 0.004, 0.06}};
  EXPECT_NEAR(pixels(rod, 0.0), 120.0 * 8.0, 70.0);
}

TEST(PartMask, WhatIsOutsideOrBehindIsCut) {
  const Mat3 axes = Mat3::Identity();
  EXPECT_EQ(pixels({PartForm::box, Material::plate, Point<'W'>(0, 0, -0.5), axes, {0.1, 0.1, 0.1}}, 3.0),
            0.0);
  EXPECT_EQ(pixels({PartForm::box, Material::plate, Point<'W'>(5, 0, 0.5), axes, {0.1, 0.1, 0.1}}, 3.0), 0.0);
  const double all = pixels({PartForm::box, Material::plate, Point<'W'>(0, 0, 0.5), axes, {9, 9, 0.1}}, 3.0);
  EXPECT_EQ(all, 640.0 * 480.0);
}

}  // namespace
}  // namespace enc::augment
