// The contract of every HapticArm: the twin's, and the drivers of devices. A new driver is one more entry of
// the table at the end.
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/conformance/arm/delta_bench.h"
#include "tests/conformance/arm/phantom_bench.h"
#include "tests/support/twin.h"

namespace enc::test {
namespace {

// An arm with its support and its clock.
struct ArmSupport {
  virtual ~ArmSupport() = default;
  virtual HapticArm& device() = 0;
  virtual Time next() = 0;    // a cycle passes; the time of the new one
  virtual bool exerts() = 0;  // the device exerts a force now
};

struct SimArmSupport final : ArmSupport {
  Twin twin{1, models::load(scene_file("wall"), "vishap", {})};
  HapticArm& device() override { return *twin.rig.arm; }
  Time next() override { return twin.rig.clock->next().t; }
  bool exerts() override { return twin.world->arm->state().torque != PerJoint{}; }
};

template <class Bench>
struct WiredArmSupport final : ArmSupport {
  Bench there;
  std::unique_ptr<HapticArm> driver = there.open();
  Duration begun = net::steady_now();
  HapticArm& device() override { return *driver; }
  Time next() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return Time(net::steady_now() - begun);
  }
  bool exerts() override { return there.force().norm() > 0.0; }
};

struct ArmEntry {
  const char* name;
  std::unique_ptr<ArmSupport> (*make)();
};

class HapticArmTest : public testing::TestWithParam<ArmEntry> {
 protected:
  // Reads and, with a force, commands like the loop until the condition holds; false: not within 3,000
  // cycles.
  template <class Condition>
  bool until(const Vec<'R'>* push, Condition condition) {
    for (int i = 0; i < 3000; ++i) {
      now_ = support_->next();
      sample_ = support_->device().read(now_);
      if (push != nullptr) support_->device().command(*push);
      if (condition()) return true;
    }
    return false;
  }
  bool pushes() {
    return until(&push_, [&] { return support_->exerts(); });
  }
  bool rests() {
    return until(nullptr, [&] { return !support_->exerts(); });
  }

  std::unique_ptr<ArmSupport> support_ = GetParam().make();
  Vec<'R'> push_{0.2, -0.1, 0.3};
  Time now_{};
  Measurement<ArmSample> sample_;
};

TEST_P(HapticArmTest, TimeNeverGoesBackAndAdvances) {
  Time before = Time{} - Duration(1'000'000'000);
  int newer = 0;
  EXPECT_TRUE(until(nullptr, [&] {
    EXPECT_GE(sample_.t, before);
    EXPECT_LE(sample_.t, now_);
    newer += sample_.t > before ? 1 : 0;
    before = sample_.t;
    return newer == 20;
  }));
}

TEST_P(HapticArmTest, TheTipFitsTheJointsAndTheAbility) {
  ASSERT_TRUE(until(nullptr, [&] { return sample_.health == Health::ok; }));
  const ArmAbility ability = support_->device().ability();
  const Arm arm(ability.machine);
  EXPECT_TRUE(arm.within_limits(sample_.value.joints));
  EXPECT_LT((arm.tip(sample_.value.joints) - sample_.value.tip).norm(), 1e-9);
  EXPECT_TRUE(sample_.value.velocity.finite());
  EXPECT_GT(ability.continuous, 0.0);
  EXPECT_GE(ability.peak, ability.continuous);
}

TEST_P(HapticArmTest, ReadingExertsNothing) {
  for (int i = 0; i < 50; ++i) {
    now_ = support_->next();
    static_cast<void>(support_->device().read(now_));
    EXPECT_FALSE(support_->exerts());
  }
}

TEST_P(HapticArmTest, ACommandExertsAndAStopEndsItTwice) {
  ASSERT_TRUE(pushes());
  support_->device().stop();
  EXPECT_TRUE(rests());
  support_->device().stop();
  EXPECT_TRUE(rests());
  EXPECT_TRUE(pushes()) << "anew";
  support_->device().stop();
}

TEST_P(HapticArmTest, WithoutACommandTheForceEnds) {
  ASSERT_TRUE(pushes());
  EXPECT_TRUE(rests());
  EXPECT_TRUE(pushes());
  support_->device().stop();
}

TEST_P(HapticArmTest, NotANumberIsRefusedAndSaid) {
  ASSERT_TRUE(pushes());
  ASSERT_EQ(sample_.health, Health::ok);
  support_->device().command(Vec<'R'>(0, kUnset, 0));
  EXPECT_EQ(support_->device().read(now_).health, Health::fault);
  support_->device().command(push_);
  EXPECT_EQ(support_->device().read(now_).health, Health::ok);
  support_->device().stop();
}

INSTANTIATE_TEST_SUITE_P(All, HapticArmTest,
                         testing::Values(ArmEntry{"sim",
                                                  []() -> std::unique_ptr<ArmSupport> {
                                                    return std::make_unique<SimArmSupport>();
                                                  }},
                                         ArmEntry{"phantom",
                                                  []() -> std::unique_ptr<ArmSupport> {
                                                    return std::make_unique<WiredArmSupport<PhantomBench>>();
                                                  }},
                                         ArmEntry{"forcedimension",
                                                  []() -> std::unique_ptr<ArmSupport> {
                                                    return std::make_unique<WiredArmSupport<DeltaBench>>();
                                                  }}),
                         [](const auto& entry) { return std::string(entry.param.name); });

}  // namespace
}  // namespace enc::test
