// The twin's camera draws when an exposure is due, shows the hand of that time, and falls silent on request.
#include "sim/camera/twin_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/frames.h"
#include "core/base/rotation.h"
#include "core/vision/augment/view_parts.h"
#include "sim/camera/sensor.h"
#include "sim/camera/stage.h"
#include "trial/assemble/vision.h"

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

CameraScene moving(Time exposed) {
  CameraScene shown;
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
  Measurement<StereoFrame> frame;
  std::vector<Time> stamps;
  for (int i = 0; i <= 200; ++i)
    if (camera.poll(Time(i * kTick), frame)) {
      EXPECT_EQ(frame.health, Health::ok);
      EXPECT_EQ(frame.value.left.width, 160);
      stamps.push_back(frame.t);
    }
  EXPECT_EQ(stamps, asked);
  ASSERT_EQ(stamps.size(), 7U);                      // 0, 1/30 .. 6/30 s
  EXPECT_EQ(stamps[1], Time(Duration(34'000'000)));  // the first tick after: the hand was there at that time
  EXPECT_EQ(camera.drawn(), 7U);

  // Equal to the stage's own image, for the pose at the exposure.
  Stage stage(spec().stage);
  const CameraScene then = moving(stamps.back());
  Image left, right;
  stage.draw(&then.pose, then.look, then.light, 7, left, right);
  EXPECT_TRUE(std::equal(left.rgb.begin(), left.rgb.end(), frame.value.left.rgb));
  EXPECT_TRUE(std::equal(right.rgb.begin(), right.rgb.end(), frame.value.right.rgb));
}

TEST(TwinCamera, WhatWasMissedIsNeverDrawn) {
  TwinCamera camera(spec(), moving);
  Measurement<StereoFrame> frame;
  EXPECT_TRUE(camera.poll(Time(from_seconds(0.95)), frame));
  EXPECT_EQ(frame.t, Time(from_seconds(0.95)));
  EXPECT_EQ(camera.drawn(), 1U);
  EXPECT_FALSE(camera.poll(Time(from_seconds(0.96)), frame));
}

TEST(TwinCamera, ASilentOneSaysItOnce) {
  TwinCameraSpec stalling = spec();
  stalling.stalls = Time(from_seconds(0.3));
  TwinCamera camera(stalling, moving);
  Measurement<StereoFrame> frame;
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

// The link does not clear the fault by itself: the caller that resumes checks whether the camera is there.
TEST(TwinCamera, OneThatComesBackIsLinkedAgain) {
  TwinCameraSpec away = spec();
  away.stalls = Time(from_seconds(0.3));
  away.back = Time(from_seconds(0.6));
  TwinCamera camera(away, moving);
  Measurement<StereoFrame> frame;
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
  Measurement<StereoFrame> right_way, frame;
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
  TwinCamera camera(spec(), [](Time exposed) -> CameraScene {
    if (exposed > Time(from_seconds(0.1))) throw Error("gone");
    return moving(exposed);
  });
  Measurement<StereoFrame> frame;
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

// Noise of a sensor: of the requested size, equal for equal frames, cut at 0 and 255.

Image grey(std::uint8_t value) {
  Image image(320, 240);
  std::fill(image.rgb.begin(), image.rgb.end(), value);
  return image;
}

TEST(SensorNoise, RmsAndMeanAreThoseAsked) {
  for (const double rms : {0.2, 0.7, 1.5, 4.0}) {
    const SensorNoise noise(rms, 7);
    double sum = 0.0, squares = 0.0, neighbours = 0.0, count = 0.0;
    for (std::uint64_t frame = 0; frame < 10; ++frame) {
      Image image = grey(128);
      noise.add(image, frame, 0);
      for (std::size_t i = 0; i < image.rgb.size(); ++i, ++count) {
        const double d = image.rgb[i] - 128.0;
        sum += d;
        squares += d * d;
        if (i > 0) neighbours += d * (image.rgb[i - 1] - 128.0);
      }
    }
    EXPECT_NEAR(std::sqrt(squares / count), rms, 0.01 * rms);
    EXPECT_NEAR(sum / count, 0.0, 0.01 * rms);
    EXPECT_NEAR(neighbours / squares, 0.0, 0.01);
  }
}

TEST(SensorNoise, TheSameForTheSameFrameAndEye) {
  const SensorNoise noise(1.5, 7), again(1.5, 7), other(1.5, 8);
  const auto bits = [](const SensorNoise& n, std::uint64_t frame, std::uint64_t eye) {
    Image image = grey(100);
    n.add(image, frame, eye);
    return image.rgb;
  };
  EXPECT_EQ(bits(noise, 3, 1), bits(again, 3, 1));
  EXPECT_NE(bits(noise, 3, 1), bits(noise, 3, 0));
  EXPECT_NE(bits(noise, 3, 1), bits(noise, 4, 1));
  EXPECT_NE(bits(noise, 3, 1), bits(other, 3, 1));
  EXPECT_NE(bits(noise, 3, 1), bits(noise, 4, 0));
}

TEST(SensorNoise, IsCutWhereASensorEnds) {
  const SensorNoise noise(8.0, 1);
  Image dark = grey(0), bright = grey(255);
  noise.add(dark, 1, 0);
  noise.add(bright, 1, 0);
  for (const std::uint8_t v : dark.rgb) EXPECT_LT(v, 100);
  for (const std::uint8_t v : bright.rgb) EXPECT_GT(v, 155);
  Image still = grey(9);
  SensorNoise(0.0, 1).add(still, 1, 0);
  EXPECT_EQ(still.rgb, grey(9).rgb);
  EXPECT_THROW(SensorNoise(-1.0, 1), Error);
  EXPECT_THROW(SensorNoise(kUnset, 1), Error);
}

// Lenses by hand and there and back; the effect of a warp on a drawing.

Lens bent() {
  Lens lens;
  lens.focal_x = 540.0;
  lens.focal_y = 538.0;
  lens.centre_x = 331.0;
  lens.centre_y = 235.5;
  lens.distortion = {-0.28, 0.09, 0.0011, -0.0007, -0.012};
  return lens;
}

// OpenCV's formula with (k1, k2, p1, p2, k3) worked out for one point.
TEST(Warp, DistortionByHand) {
  Lens lens{.distortion = {0.1, 0.02, 0.003, -0.004, 0.005}};
  const auto [x, y] = distorted(lens, 0.3, -0.4);
  const double radial = 1.0 + 0.1 * 0.25 + 0.02 * 0.0625 + 0.005 * 0.015625;
  EXPECT_NEAR(x, 0.3 * radial + 2 * 0.003 * -0.12 + -0.004 * (0.25 + 2 * 0.09), 1e-15);
  EXPECT_NEAR(y, -0.4 * radial + 0.003 * (0.25 + 2 * 0.16) + 2 * -0.004 * -0.12, 1e-15);
}

TEST(Warp, ThereAndBack) {
  const Lens lens = bent();
  for (double y = -0.42; y <= 0.42; y += 0.06)
    for (double x = -0.58; x <= 0.58; x += 0.04) {
      const auto [u, v] = undistorted(lens, x, y);
      const auto [xx, yy] = distorted(lens, u, v);
      EXPECT_NEAR(xx, x, 1e-11);
      EXPECT_NEAR(yy, y, 1e-11);
    }
}

TEST(Warp, AStraightLensDrawsWhatItShows) {
  const Warp warp(Lens{}, 640, 480);
  EXPECT_FALSE(warp.bends());
  EXPECT_EQ(warp.width(), 640);
  EXPECT_EQ(warp.height(), 480);
  EXPECT_NEAR(warp.left(), -320.0 / 721.0, 1e-15);
  EXPECT_NEAR(warp.bottom(), 240.0 / 721.0, 1e-15);
  EXPECT_EQ(warp.nearest(3, 0), 479U * 640U + 3U);  // OpenGL's first row is the lowest
}

// A drawing whose colours are its own places on z = 1: the bent picture shows each pixel's undistorted place.
TEST(Warp, EachPixelComesFromItsDirection) {
  const Lens lens = bent();
  const Warp warp(lens, 640, 480);
  ASSERT_TRUE(warp.bends());
  std::vector<std::uint8_t> drawing(3 * static_cast<std::size_t>(warp.width() * warp.height()));
  const double span_x = warp.right() - warp.left(), span_y = warp.bottom() - warp.top();
  for (int y = 0; y < warp.height(); ++y)
    for (int x = 0; x < warp.width(); ++x) {
      std::uint8_t* p = drawing.data() + 3 * ((warp.height() - 1 - y) * warp.width() + x);
      p[0] = static_cast<std::uint8_t>(std::lround(255.0 * (x + 0.5) / warp.width()));
      p[1] = static_cast<std::uint8_t>(std::lround(255.0 * (y + 0.5) / warp.height()));
    }
  Image picture(640, 480);
  warp.colours(drawing.data(), picture);
  for (int y = 0; y < 480; y += 7)
    for (int x = 0; x < 640; x += 7) {
      const auto [u, v] =
          undistorted(lens, (x - lens.centre_x) / lens.focal_x, (y - lens.centre_y) / lens.focal_y);
      EXPECT_NEAR(picture.at(x, y)[0], 255.0 * (u - warp.left()) / span_x, 1.01);
      EXPECT_NEAR(picture.at(x, y)[1], 255.0 * (v - warp.top()) / span_y, 1.01);
      const std::size_t at = warp.nearest(x, y);
      EXPECT_NEAR(static_cast<double>(at % static_cast<std::size_t>(warp.width())) + 0.5,
                  (u - warp.left()) / span_x * warp.width(), 0.51);
    }
}

TEST(Warp, ALensThatFoldsThePictureIsRefused) {
  Lens lens;
  lens.distortion[0] = -2.5;
  EXPECT_THROW(Warp(lens, 640, 480), Error);
  lens.distortion[0] = kUnset;
  EXPECT_THROW(Warp(lens, 640, 480), Error);
}

// The twin draws an arm at the place of its shape, and a correct belief of that shape covers it.

const Pose<'W', 'C'> kCamera(rotation_xyz({-2.18, 0.0, 0.52}), Vec3(0.236, -0.426, 0.457));

TEST(ArmInView, IsWhereItsShapeSays) {
  sim::StageSpec spec;
  spec.sensor.noise = 0.0;
  sim::Stage stage(spec);
  Image left, right;
  sim::PixelTruth truth;
  const Arm arm{ArmMachine{}};
  const Pose<'W', 'R'> X_WR(Quat::Identity(), Vec3(-arm.tip({}).e()));
  const RectifiedPair pair = Rectifier(spec.camera).pair();
  for (const PerJoint& q : {PerJoint{0, 0, 0}, PerJoint{0.3, 0.2, -0.1}, PerJoint{-0.4, -0.1, 0.3}}) {
    std::vector<ArmPart> parts = arm_shape(arm.machine(), q, X_WR);
    parts.push_back(
        prop_shape({0.03, 0.03, 0.002}, X_WR * arm.tip(q), rotation_z_to(Vec3(0.2, 0.1, 1).normalized())));
    sim::CameraScene shown;
    for (const ArmPart& part : parts) shown.things.push_back(trial::thing_of(part, kCamera.inverse()));
    stage.draw(shown, 0, left, right, &truth);
    const auto share_in = [&](const Pose<'C', 'W'>& X_CW, double margin, double& beyond) {
      Mask mask(640, 480);
      for (const ArmPart& part : parts) augment::cover(pair, X_CW, part, margin, mask);
      int both = 0, drawn = 0, covered = 0;
      for (std::size_t i = 0; i < mask.on.size(); ++i) {
        both += mask.on[i] != 0 && truth.things.on[i] != 0 ? 1 : 0;
        drawn += truth.things.on[i] != 0 ? 1 : 0;
        covered += mask.on[i] != 0 ? 1 : 0;
      }
      EXPECT_GT(drawn, 5000);
      beyond = static_cast<double>(covered - both) / drawn;
      return static_cast<double>(both) / drawn;
    };
    double beyond = 0.0;
    EXPECT_GT(share_in(kCamera.inverse(), 0.0, beyond), 0.985);  // an edge is half a pixel off
    EXPECT_LT(beyond, 0.015);
    EXPECT_EQ(share_in(kCamera.inverse(), 1.5, beyond), 1.0);
    // The camera is believed 5 mm beside its place: 5 px.
    const Pose<'W', 'C'> off = kCamera * Pose<'C', 'C'>(Quat::Identity(), Vec3(0.005, 0, 0));
    EXPECT_LT(share_in(off.inverse(), 0.0, beyond), 0.95);
  }
}

}  // namespace
}  // namespace enc::sim
