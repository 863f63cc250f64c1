// The seam between the guided registration and any stereo camera, here with made-up cameras and finders. The
// file's name ends in _camera_test because it needs vision.
#include <gtest/gtest.h>

#include "trial/identify/camera/registration_rig.h"

namespace enc::trial {
namespace {

// A frame for each call, until it stalls.
class FakeCamera final : public StereoCamera {
 public:
  explicit FakeCamera(int frames) : frames_(frames) {}
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override {
    if (frames_-- <= 0) return false;
    newest = {{}, now, Health::ok};
    return true;
  }
  [[nodiscard]] bool linked() const noexcept override { return true; }
  [[nodiscard]] std::string describe() const override { return "made up"; }

 private:
  int frames_;
};

// Finds the ball a metre away in each frame but every `misses`-th.
class FakeFinder final : public BallFinder {
 public:
  explicit FakeFinder(int misses) : BallFinder({}, {}), misses_(misses) {}
  FoundBall find(const StereoFrame& /*frame*/) override {
    FoundBall ball;
    ball.loss = ++frames_ % misses_ == 0 ? BallLoss::no_circle : BallLoss::none;
    if (ball.found()) ball.centre = Point<'C'>(0, 0, 1);
    return ball;
  }

 private:
  int misses_, frames_ = 0;
};

PictureEyes eyes_with(int frames, int misses) {
  return {std::make_unique<FakeCamera>(frames), std::make_unique<FakeFinder>(misses), 20.0};
}

std::vector<TipVisit> visits(std::size_t places, std::size_t frames) {
  return std::vector<TipVisit>(
      places, {1.0, std::vector<TipStand>(frames, {Point<'W'>(0, 0, 0), Point<'W'>(0, 0, 0)})});
}

TEST(TipEyes, AFrameThatShowsNoBallIsLeftOut) {
  PictureEyes eyes = eyes_with(1000, 4);
  const GuidedRun run = see_visits(visits(3, 20), eyes, 0.5);
  EXPECT_EQ(run.unseen, 0U);
  EXPECT_EQ(run.seen, (std::vector<std::size_t>{15, 15, 15}));
  ASSERT_EQ(run.points.size(), 3U);
  EXPECT_EQ(run.points[0].frames.size(), 15U);
  EXPECT_EQ(eyes.loss(), BallLoss::no_circle);
}

TEST(TipEyes, APlaceOfTooFewFramesWasNotSeen) {
  PictureEyes eyes = eyes_with(29, 1000);  // stalls in the second place
  const GuidedRun run = see_visits(visits(3, 20), eyes, 0.5);
  EXPECT_EQ(run.seen, (std::vector<std::size_t>{20, 9, 0}));
  EXPECT_EQ(run.points.size(), 1U);
  EXPECT_EQ(run.unseen, 2U);
  EXPECT_EQ(eyes.loss(), BallLoss::no_frame);
}

TEST(TipEyes, TheBallIsWhereTheTipIs) {
  sim::CameraTruth camera{.ball_radius = 0.01};
  const Pose<'W', 'C'> X_WC(Quat::Identity(), Vec3(0, 0, -0.5));
  const std::vector<sim::Thing> things =
      ball_at_tip(X_WC, camera)({Point<'W'>(0.1, 0, 0), Point<'W'>(0.2, 0, 0)});
  ASSERT_EQ(things.size(), 1U);
  EXPECT_LT((things[0].at.e() - Vec3(0.1, 0, 0.5)).norm(), 1e-12);
  EXPECT_EQ(things[0].half.x(), 0.01);
  EXPECT_FLOAT_EQ(things[0].colour[0], 0.5F);
}

}  // namespace
}  // namespace enc::trial
