// The arm out of an image that is painted by hand, and objects in its place: by what is believed alone.
#include "core/vision/augment/augmented_view.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/machine/arm_shape.h"
#include "core/vision/augment/part_mask.h"
#include "core/vision/stereo/triangulate.h"

namespace enc {
namespace {

constexpr int kWidth = 320, kHeight = 240;
const std::array<std::uint8_t, 3> kRoom{90, 110, 120}, kMetal{30, 32, 36}, kSkin{205, 150, 118};

// A camera that looks down on the arm from 0.6 m above W: its x along that of W, its y against.
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

struct Painted {
  Image image{kWidth, kHeight};
  Mask device{kWidth, kHeight};  // what of it moves
  // The room, the arm where it truly is, and a square of skin, in that order.
  Painted(const AugmentedSpec& truth, const PerJoint& q, const Region& skin = {}) {
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

// Share of the device that is the room in `removed`.
double gone(const Painted& painted, const Image& removed) {
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
  for (int i = 0; i < 3; ++i) view.see(Painted(truth, kAtRest).image.view(), at(kAtRest));
}

TEST(AugmentedView, TheArmIsGoneAndTheHandBeforeItStays) {
  const AugmentedSpec s = spec();
  AugmentedView view(s, {});
  learn(view, s);
  const Region hand{110, 80, 150, 120};  // over the upper arm
  const Painted painted(s, kMoved, hand);
  EXPECT_TRUE(Painted(s, kMoved).device.at(130, 88));
  view.see(painted.image.view(), at(kMoved));
  EXPECT_EQ(gone(painted, view.removed()), 1.0);
  for (int y = hand.y0 + 2; y < hand.y1 - 2; ++y)
    for (int x = hand.x0 + 2; x < hand.x1 - 2; ++x) ASSERT_TRUE(is(view.removed(), x, y, kSkin)) << x << y;
  EXPECT_TRUE(is(view.removed(), 5, 5, kRoom));
}

// Where the arm stood while the background was learned the background is of the first frames without it.
TEST(AugmentedView, TheBackgroundIsCompletedWhereTheArmStood) {
  const AugmentedSpec s = spec();
  AugmentedView view(s, {});
  learn(view, s);
  const Triplet elbow = seen_at(Rectifier(s.camera).pair(),
                                s.X_WC.inverse() * (s.X_WR * Point<'R'>(0.09, 0, 0)));  // on the upper arm
  const int x = static_cast<int>(elbow.column), y = static_cast<int>(elbow.row);
  EXPECT_FALSE(view.known().at(x, y));
  for (int i = 0; i < 3; ++i) view.see(Painted(s, kMoved).image.view(), at(kMoved));
  EXPECT_TRUE(view.known().at(x, y));
}

// Nothing but belief says where the arm is: what it has wrong is wrong in the picture.
TEST(AugmentedView, AWrongBeliefMovesWhatIsReplaced) {
  const AugmentedSpec truth = spec();
  AugmentedSpec off = truth;
  off.X_WC = {Quat(truth.X_WC.q()), truth.X_WC.origin() + Vec<'W'>(0, 0.03, 0)};  // 15 px
  AugmentedSpec bent = truth;
  bent.arm->phantom.l1 -= 0.05;
  for (const AugmentedSpec& believed : {off, bent}) {
    AugmentedView view(believed, {});
    learn(view, truth);
    const Painted painted(truth, kMoved);
    view.see(painted.image.view(), at(kMoved));
    EXPECT_LT(gone(painted, view.removed()), 0.9);
  }
  AugmentedView view(truth, {});
  learn(view, truth);
  view.see(Painted(truth, kMoved).image.view(), at(kAtRest));  // and by the joints that it is told
  EXPECT_LT(gone(Painted(truth, kMoved), view.removed()), 0.7);
}

TEST(AugmentedView, AWallIsDrawnWhereItStandsAndTheHandCoversIt) {
  const AugmentedSpec s = spec();
  const std::array<Object, 1> wall{kWall};
  AugmentedView view(s, wall);
  learn(view, s);
  const Region hand{150, 100, 190, 140};
  view.see(Painted(s, kMoved, hand).image.view(), at(kMoved));
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
  // A finger that is known to be far below the wall is seen through it.
  AugmentedMoment moment = at(kMoved);
  moment.finger = Point<'C'>(0, 0, 0.7);
  view.see(Painted(s, kMoved, hand).image.view(), moment);
  EXPECT_TRUE(drawn(170, 120));
  // And an object that was pushed is where it is now.
  moment = at(kMoved);
  moment.moved = {Vec<'W'>(0.04, 0, 0)};
  view.see(Painted(s, kMoved).image.view(), moment);
  EXPECT_FALSE(drawn(131, 91));
  EXPECT_TRUE(drawn(205, 91));
}

TEST(AugmentedView, AnotherSizeIsRefused) {
  AugmentedView view(spec(), {});
  const Image image(10, 10);
  EXPECT_THROW(view.see(image.view(), {}), Error);
}

}  // namespace
}  // namespace enc
