// Which devices a trial is made of: the twin where a slot is simulated, drivers where the rig names them, and
// no simulated world where nothing asks for one.
#include "trial/assemble.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "app/modules.h"
#include "core/error.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

const std::vector<std::string> kSample{"rig.manipulator.driver=\"sample\"", "rig.force.driver=\"sample\""};

models::Setup scene(const std::string& name, const std::vector<std::string>& set = {}) {
  return models::load(ENCOUNTER_SOURCE_DIR "/models/scenes/" + name + ".toml", {}, set);
}

class Assemble : public testing::Test {
 protected:
  Assemble() { setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1); }
  ~Assemble() override { unsetenv("ENCOUNTER_MODULES"); }
  static TrialOptions options() {
    TrialOptions options;
    options.drivers = app::load_module;
    options.seconds = 0.05;
    return options;
  }
};

TEST_F(Assemble, SlotsAreThoseThatTheSceneNames) {
  const Slots all = slots_of(scene("tennis_ball"));
  EXPECT_TRUE(all.simulated);
  EXPECT_FALSE(all.real);
  const Slots mixed = slots_of(scene("tennis_ball", kSample));
  EXPECT_TRUE(mixed.simulated);
  EXPECT_TRUE(mixed.real);
  // A probe needs neither tracker nor display, so what drives those does not count.
  const Slots real = slots_of(scene("rig_A", kSample));
  EXPECT_FALSE(real.simulated);
  EXPECT_TRUE(real.real);
}

TEST_F(Assemble, WithoutASimulatedSlotThereIsNoWorldAndTimeIsTheWalls) {
  int looks = 0;
  TrialOptions made = options();
  made.watch = [&](const Glance& glance) {
    ++looks;
    EXPECT_FALSE(glance.truth.tip.finite());
    EXPECT_FALSE(glance.truth.tool_tip.finite());
  };
  Trial trial(scene("rig_A", kSample), made);
  EXPECT_FALSE(trial.has_world());
  const TrialResult result = trial.run();
  EXPECT_EQ(result.ticks, 51);
  EXPECT_EQ(looks, 51);
  EXPECT_GE(result.wall, 0.05);
  EXPECT_EQ(trial.now().index, 50);
  EXPECT_EQ(result.diverged_at, -1);
}

TEST_F(Assemble, OneSimulatedSlotBringsTheWorld) {
  Trial trial(scene("tennis_ball", kSample), options());
  EXPECT_TRUE(trial.has_world());
  const TrialResult result = trial.run();
  EXPECT_EQ(result.ticks, 51);
  EXPECT_GE(result.wall, 0.05);  // real devices live in wall time
  EXPECT_TRUE(trial.truth().tip.finite());
}

TEST_F(Assemble, ARealDeviceKeepsWallPace) {
  TrialOptions fast = options();
  fast.pace = 10.0;
  EXPECT_THROW(Trial(scene("tennis_ball", kSample), fast), Error);
}

// The sample machine is at the next read where it was told to be: dry, it is never told.
TEST_F(Assemble, OnlyAnArmedMachineIsSentCommands) {
  const auto moved = [](bool armed) {
    TrialOptions made = options();
    made.armed = armed;
    made.law = [](const Scene& s, const Tick&, const Inputs&, State&, Outputs& out) {
      const Pose<'R', 'H'> zero = s.reach.machine.zero();
      out.tip = {zero.q(), Vec3(zero.p() + Vec3(0, 0, 1e-3))};
    };
    Trial trial(scene("rig_A", kSample), made);
    trial.run();
    return (trial.inputs().tip.value.X_RH.p() - trial.scene().reach.machine.zero().p()).norm();
  };
  EXPECT_EQ(moved(false), 0.0);
  EXPECT_NEAR(moved(true), 1e-3, 1e-9);
}

TEST_F(Assemble, WithoutDriversEverythingIsSimulated) {
  TrialOptions made;
  made.seconds = 0.01;
  for (const char* name : {"tennis_ball", "rig_A"}) {
    Trial trial(scene(name, kSample), made);
    EXPECT_TRUE(trial.has_world()) << name;
    EXPECT_EQ(trial.run().ticks, 11) << name;
  }
}

}  // namespace
}  // namespace enc::trial
