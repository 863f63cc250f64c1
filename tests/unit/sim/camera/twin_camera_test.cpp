// The twin's camera draws when an exposure is due, looks at the hand of that time, and falls silent when
// told.
#include "sim/camera/twin_camera.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc::sim {
namespace {

constexpr Duration kTick{1'000'000};

TwinCameraSpec spec() {
  TwinCameraSpec s;
  s.stage.camera.width = 160;
  s.stage.camera.height = 120;
  s.stage.camera.left = s.stage.camera.right = {180, 180, 79.5, 59.5, {}};
  s.stage.camera.rate = 30.0;
  return s;
}

Shown moving(Time exposed) {
  Shown shown;
  shown.hand = true;
  shown.pose = {{0.1 * seconds(exposed.time_since_epoch()), 0, 0.4}, {0, -1, 0}, 0};
  return shown;
}

TEST(TwinCamera, DrawsAtItsRateAndLooksAtThatTime) {
  std::vector<Time> asked;
  TwinCamera camera(spec(), [&](Time exposed) {
    asked.push_back(exposed);
    return moving(exposed);
  });
  Stamped<StereoFrame> frame;
  std::vector<Time> stamps;
  for (int i = 0; i <= 200; ++i)
    if (camera.poll(Time(i * kTick), frame)) {
      EXPECT_EQ(frame.health, Health::ok);
      EXPECT_EQ(frame.value.left.width, 160);
      stamps.push_back(frame.t);
    }
  EXPECT_EQ(stamps, asked);
  ASSERT_EQ(stamps.size(), 7U);                      // 0, 1/30 .. 6/30 s
  EXPECT_EQ(stamps[1], Time(Duration(34'000'000)));  // the first tick after: then the hand was there
  EXPECT_EQ(camera.drawn(), 7U);

  // The same as the stage's own, of the pose at the exposure.
  Stage stage(spec().stage);
  const Shown then = moving(stamps.back());
  Image left, right;
  stage.draw(&then.pose, then.look, then.light, 7, left, right);
  EXPECT_TRUE(std::equal(left.rgb.begin(), left.rgb.end(), frame.value.left.rgb));
  EXPECT_TRUE(std::equal(right.rgb.begin(), right.rgb.end(), frame.value.right.rgb));
}

TEST(TwinCamera, WhatWasMissedIsNeverDrawn) {
  TwinCamera camera(spec(), moving);
  Stamped<StereoFrame> frame;
  EXPECT_TRUE(camera.poll(Time(from_seconds(0.95)), frame));
  EXPECT_EQ(frame.t, Time(from_seconds(0.95)));
  EXPECT_EQ(camera.drawn(), 1U);
  EXPECT_FALSE(camera.poll(Time(from_seconds(0.96)), frame));
}

TEST(TwinCamera, ASilentOneSaysItOnce) {
  TwinCameraSpec stalling = spec();
  stalling.stalls = Time(from_seconds(0.3));
  TwinCamera camera(stalling, moving);
  Stamped<StereoFrame> frame;
  int faults = 0;
  Time fault_at{};
  for (int i = 0; i <= 1000; ++i)
    if (camera.poll(Time(i * kTick), frame) && frame.health == Health::fault) {
      ++faults;
      fault_at = Time(i * kTick);
    }
  EXPECT_EQ(faults, 1);
  EXPECT_FALSE(camera.linked());
  EXPECT_LT(frame.t, stalling.stalls);
  EXPECT_NEAR(age(fault_at, frame.t), 0.1, 0.002);  // three periods
  EXPECT_EQ(frame.value.left.width, 160);
}

// Not the link's own doing that it is believed again: who resumes asks whether it is there.
TEST(TwinCamera, OneThatComesBackIsLinkedAgain) {
  TwinCameraSpec away = spec();
  away.stalls = Time(from_seconds(0.3));
  away.back = Time(from_seconds(0.6));
  TwinCamera camera(away, moving);
  Stamped<StereoFrame> frame;
  std::vector<double> lost;  // ms
  std::uint64_t drawn = 0;
  for (int i = 0; i <= 1000; ++i) {
    camera.poll(Time(i * kTick), frame);
    if (!camera.linked()) lost.push_back(i);
    const bool drew = std::exchange(drawn, camera.drawn()) != camera.drawn();
    EXPECT_FALSE(drew && i > 300 && i < 600) << i;
  }
  ASSERT_FALSE(lost.empty());
  EXPECT_NEAR(lost.front(), 367, 2.0);  // the last one was at 267
  EXPECT_NEAR(lost.back(), 599, 1.0);
  EXPECT_EQ(frame.health, Health::ok);
  EXPECT_EQ(camera.drawn(), 9U + 13U);
}

TEST(TwinCamera, LeftAndRightAreExchangedFromThenOn) {
  TwinCameraSpec swapping = spec();
  swapping.swaps = Time(from_seconds(0.05));
  TwinCamera camera(spec(), moving), other(swapping, moving);
  Stamped<StereoFrame> right_way, frame;
  const auto same = [](const ImageView& a, const ImageView& b) {
    return std::equal(a.rgb, a.rgb + 3 * a.width * a.height, b.rgb);
  };
  for (int i = 0; i <= 100; ++i) {
    if (!camera.poll(Time(i * kTick), right_way)) continue;
    ASSERT_TRUE(other.poll(Time(i * kTick), frame));
    EXPECT_EQ(same(frame.value.left, right_way.value.left), i < 50) << i;
    EXPECT_EQ(same(frame.value.left, right_way.value.right), i >= 50) << i;
  }
}

TEST(TwinCamera, WhoCannotBeLookedAtIsAFault) {
  TwinCamera camera(spec(), [](Time exposed) -> Shown {
    if (exposed > Time(from_seconds(0.1))) throw Error("gone");
    return moving(exposed);
  });
  Stamped<StereoFrame> frame;
  for (int i = 0; i <= 400; ++i) camera.poll(Time(i * kTick), frame);
  EXPECT_EQ(frame.health, Health::fault);
  EXPECT_FALSE(camera.linked());
  EXPECT_EQ(camera.remarks(), std::vector<std::string>{"the twin's camera draws no more: gone"});
}

TEST(TwinCamera, BadSpecsAreRefused) {
  TwinCameraSpec bad = spec();
  bad.stage.camera.rate = 0.0;
  EXPECT_THROW(TwinCamera(bad, moving), Error);
  EXPECT_THROW(TwinCamera(spec(), nullptr), Error);
}

}  // namespace
}  // namespace enc::sim
