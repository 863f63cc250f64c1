// Whole runs with faults of the twin's camera: the core never acts on old data, and each fault ends with its
// cause.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/devices/module.h"
#include "core/vision/vision_module.h"
#include "core/vision/vision_tracker.h"
#include "sim/camera/twin_camera.h"
#include "tests/support/twin.h"
#include "tests/unit/trial/runs.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

// The modules' devices, without loading a module.
const ModuleInfo& modules(const std::string& name) {
  static const VisionModule vision{
      [](std::unique_ptr<StereoCamera> camera, const StereoRig& rig, const VisionRig& v, Release release) {
        return std::unique_ptr<PoseTracker>(std::make_unique<VisionTracker>(
            std::move(camera), rig,
            FingerTracker(rig, v.segmentation, v.fingertip, v.track, v.match, v.search), release));
      }};
  static const sim::CameraModule camera{
      nullptr,
      [](const sim::TwinCameraSpec& spec, sim::Show show) {
        return std::unique_ptr<StereoCamera>(std::make_unique<sim::TwinCamera>(spec, std::move(show)));
      },
      nullptr};
  static const ModuleInfo eyes{.name = "vision", .vision = &vision};
  static const ModuleInfo twin{.name = "camera", .camera = &camera};
  return name == "vision" ? eyes : twin;
}

// One press that lasts from about 2.1 s to 5.3 s, in images of a quarter of the pixels.
models::Setup press(const std::vector<std::string>& more) {
  std::vector<std::string> set{"user.approach_mm_s=[100]", "user.press_s=2", "user.release_s=1",
                               "user.rest_s=0.5"};
  const std::vector<std::string> small = test::quarter_size();
  set.insert(set.end(), small.begin(), small.end());
  set.insert(set.end(), more.begin(), more.end());
  return test::shipped("camera/wall", set);
}

struct FaultResponse {
  double oldest = 0.0;         // s, greatest age of a finger that the core acts on
  double first_hold = kUnset;  // s
  double force_in_hold = 0.0;  // N, force of the law
  bool contact = false, contact_after = false;
  std::uint32_t why = 0;
};

class CameraFaults : public testing::Test {
 protected:
  static constexpr double kFrom = 3.5;  // s: the middle of the press
  FaultResponse seen;
  std::unique_ptr<Trial> trial;
  void begin(const std::vector<std::string>& set) {
    TrialOptions options{.drivers = modules};
    options.watch = [this](const Glance& g) { look(g); };
    trial = std::make_unique<Trial>(press(set), options);
  }
  void look(const Glance& g) {
    const double now = seconds(g.tick.t.time_since_epoch());
    if (g.out.mode == Mode::hold) {
      if (std::isnan(seen.first_hold)) seen.first_hold = now;
      seen.why |= g.out.why & kHoldReasons;
      seen.force_in_hold = std::max(seen.force_in_hold, g.out.force.norm());
      return;
    }
    if (g.out.mode == Mode::follow || g.out.mode == Mode::contact)
      seen.oldest = std::max(seen.oldest, age(g.tick.t, g.in.tool.t));
    seen.contact = seen.contact || g.out.mode == Mode::contact;
    seen.contact_after = seen.contact_after || (g.out.mode == Mode::contact && now > kFrom + 1.0);
  }
  void until(double s) {
    while (seconds(trial->now().t.time_since_epoch()) < s && trial->tick()) {
    }
  }
  void end() {
    while (trial->tick()) {
    }
  }
};

// Two missing frames are no loss: the next frame continues.
TEST_F(CameraFaults, AShortStallIsNotFelt) {
  begin({"truth.camera.stalls_at_s=3.5", "truth.camera.back_at_s=3.6"});
  end();
  EXPECT_TRUE(std::isnan(seen.first_hold)) << seen.first_hold << " " << why_text(seen.why);
  EXPECT_TRUE(seen.contact_after);
  EXPECT_TRUE(trial->gate().links().empty());
  EXPECT_LT(seen.oldest, 0.3);
  EXPECT_EQ(trial->outputs().mode, Mode::away);
}

// A lost link stays unused until somebody resumes it.
TEST_F(CameraFaults, ALostLinkHoldsUntilItIsResumed) {
  begin({"truth.camera.stalls_at_s=3.5", "truth.camera.back_at_s=4.0"});
  until(4.4);
  EXPECT_TRUE(seen.contact);
  EXPECT_NEAR(seen.first_hold, 3.45 + 0.15, 0.01);
  EXPECT_TRUE((seen.why & kTrackerFault) != 0) << why_text(seen.why);
  EXPECT_EQ(trial->outputs().mode, Mode::hold) << "it is back, and nobody has said so";
  EXPECT_EQ(seen.force_in_hold, 0.0);
  trial->resume();
  until(4.45);
  EXPECT_NE(trial->outputs().mode, Mode::hold) << why_text(trial->outputs().why);
  end();
  EXPECT_TRUE(seen.contact_after);
  EXPECT_LT(seen.oldest, 0.3);
  EXPECT_EQ(trial->outputs().mode, Mode::away);
  EXPECT_EQ(trial->gate().links().size(), 1U);
}

// The frames arrive without information: the finger ages, and vision finds it again in correct frames.
TEST_F(CameraFaults, ExchangedImagesHoldAFingerThatTouches) {
  begin({"truth.camera.swapped_at_s=3.5"});
  end();
  EXPECT_TRUE(seen.contact);
  EXPECT_NEAR(seen.first_hold, 3.45 + 0.3, 0.02) << "lost_age_ms after the last frame that was right";
  EXPECT_TRUE((seen.why & kToolLost) != 0) << why_text(seen.why);
  EXPECT_EQ(seen.force_in_hold, 0.0);
  EXPECT_LE(seen.oldest, 0.3 + 1e-9);
  EXPECT_EQ(trial->outputs().mode, Mode::hold);
}

TEST_F(CameraFaults, ImagesThatAreExchangedFromTheStartMoveNothing) {
  begin({"truth.camera.swapped_at_s=0"});
  end();
  EXPECT_FALSE(seen.contact);
  EXPECT_EQ(trial->outputs().contacts, 0);
  EXPECT_EQ(trial->outputs().mode, Mode::away);
}

}  // namespace
}  // namespace enc::trial
