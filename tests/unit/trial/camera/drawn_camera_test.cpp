// The twin's camera that draws in a thread of its own, beside a world that does not wait for it.
#include "trial/camera/drawn_camera.h"

#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace enc::trial {
namespace {

using Exposure = DrawnCamera::Exposure;

const sim::CameraModule kModule{[](const sim::StageSpec& spec) { return std::make_unique<sim::Stage>(spec); },
                                nullptr};

constexpr Duration kTick{1'000'000}, kPeriod{50'000'000};
Time at(double s) { return Time(from_seconds(s)); }

struct Camera {
  explicit Camera(Exposure exposure, Time stalls = Time::max(), Time back = Time::max())
      : drawn(
            kModule, spec(stalls, back), [this](Time) { return ++shown, sim::CameraScene{}; }, exposure) {}
  static sim::TwinCameraSpec spec(Time stalls, Time back) {
    sim::TwinCameraSpec of;
    of.stage.camera.width = 160;
    of.stage.camera.height = 120;
    of.stage.camera.left = of.stage.camera.right = pinhole(160, 120, 140.0);
    of.stage.camera.rate = 20.0;
    of.stalls = stalls;
    of.back = back;
    return of;
  }
  bool poll(Time now) {
    if (!drawn.poll(now, frame)) return false;
    ++(frame.health == Health::ok ? pictures : faults);
    return true;
  }
  // Polls until a picture has been drawn, each time by so much later.
  bool comes(Time now, Duration step = {}) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (; std::chrono::steady_clock::now() < until; now += step) {
      if (poll(now)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  int shown = 0, pictures = 0, faults = 0;
  Measurement<StereoFrame> frame;
  DrawnCamera drawn;
};

// The world's thread exposes while another thread fetches the picture and looks at it.
TEST(DrawnCamera, ShowsTheTimeOfItsExposureToAnotherThread) {
  Camera camera(Exposure::called);
  EXPECT_FALSE(camera.poll(at(1.0))) << "poll() exposes nothing";
  for (int i = 0; i < 5; ++i) {
    const Time exposed = Time{} + i * kPeriod, later = exposed + 3 * kTick;
    camera.drawn.expose(exposed);
    EXPECT_EQ(camera.shown, i + 1);
    std::thread looking([&] {
      ASSERT_TRUE(camera.comes(later));
      EXPECT_EQ(camera.frame.t, exposed);
      EXPECT_EQ(camera.frame.value.left.width, 160);
      camera.drawn.expose(exposed + kPeriod / 2);  // not due
      EXPECT_FALSE(camera.poll(later)) << "one picture for each exposure";
    });
    looking.join();
  }
  EXPECT_EQ(camera.pictures, 5);
}

// Its images may be in use until the next poll().
TEST(DrawnCamera, LeavesOutAnExposureUntilThePictureIsDoneWith) {
  Camera camera(Exposure::called);
  camera.drawn.expose(at(0.0));
  ASSERT_TRUE(camera.comes(at(0.01)));
  camera.drawn.expose(at(0.05));
  EXPECT_EQ(camera.shown, 1);
  EXPECT_FALSE(camera.poll(at(0.06)));
  camera.drawn.expose(at(0.1));
  EXPECT_EQ(camera.shown, 2);
}

TEST(DrawnCamera, AStallIsAFaultOnceAndItsEndALink) {
  Camera camera(Exposure::called, at(0.1), at(0.5));
  for (int i = 0; i < 2; ++i) {
    camera.drawn.expose(at(0.05 * i));
    ASSERT_TRUE(camera.comes(at(0.05 * i)));
    EXPECT_FALSE(camera.poll(at(0.05 * i)));
  }
  for (Time now = at(0.1); now < at(0.5); now += kTick) {
    camera.drawn.expose(now);
    EXPECT_EQ(camera.poll(now), now == at(0.251)) << "three periods after its beginning";
  }
  EXPECT_EQ(camera.shown, 2);
  EXPECT_EQ(camera.faults, 1);
  EXPECT_FALSE(camera.drawn.linked());
  camera.drawn.expose(at(0.5));
  ASSERT_TRUE(camera.comes(at(0.5)));
  EXPECT_TRUE(camera.drawn.linked());
  EXPECT_EQ(camera.frame.health, Health::ok);
}

TEST(DrawnCamera, PollExposesForAFakeAndWaitsInLockstep) {
  Camera later(Exposure::polled), at_once(Exposure::awaited);
  EXPECT_TRUE(at_once.poll(at(0.0)));
  EXPECT_EQ(at_once.frame.t, at(0.0));
  EXPECT_FALSE(at_once.poll(at(0.01)));
  EXPECT_FALSE(later.poll(at(0.0)));
  ASSERT_TRUE(later.comes(at(0.02)));
  EXPECT_EQ(later.frame.t, at(0.0));
  EXPECT_TRUE(at_once.poll(at(0.05)));
}

TEST(DrawnCamera, APictureFromBeforeTheWorldBeganAgainIsNotShown) {
  Camera camera(Exposure::polled);
  ASSERT_TRUE(camera.poll(at(1.0)) || camera.comes(at(1.01)));
  EXPECT_FALSE(camera.poll(at(1.05)));
  EXPECT_FALSE(camera.poll(at(0.0)));
  ASSERT_TRUE(camera.comes(at(0.001), kTick));
  EXPECT_LT(camera.frame.t, at(1.0));
}

}  // namespace
}  // namespace enc::trial
