// What the core believes and what is true are separate numbers: a wrong belief gives exactly the error that
// it must.
#include <cstdlib>

#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc {
namespace {

models::Setup still_setup() {
  models::Setup setup = models::load(tests::source_dir() + "/models/scenes/plane.toml", "sim");
  setup.twin.tracker.bias = setup.twin.tracker.noise = Vec3::Zero();
  setup.twin.tracker.marker_noise = 0.0;
  setup.twin.force.zero = setup.twin.force.drift = setup.twin.force.noise = 0.0;
  setup.twin.hand.tremor = setup.twin.hand.drift = 0.0;  // the hand stands still while it waits: 0.6 s
  return setup;
}

struct Offsets {
  Vec3 tool_error;  // believed minus true position of the tool's tip, in W
  Vec3 force;       // sensor reading at rest, in F
};

Offsets offsets_of(const models::Setup& setup) {
  Offsets seen{Vec3::Constant(kUnset), Vec3::Constant(kUnset)};
  trial::TrialOptions options;
  options.seconds = 0.55;
  options.watch = [&](const trial::Glance& g) {
    if (g.in.tool.health == Health::ok) seen.tool_error = g.out.view.tip.e() - g.truth.tool_tip.e();
    if (g.in.wrench.health == Health::ok) seen.force = g.in.wrench.value.force.e();
  };
  trial::Trial trial(setup, options);
  trial.run();
  return seen;
}

TEST(Calibration, RightBeliefsGiveNoError) {
  const Offsets seen = offsets_of(still_setup());
  EXPECT_LT(seen.tool_error.norm(), 1e-6) << seen.tool_error.transpose();
  // Weight of 0.91 kg: 8.924 N down, in steps of 0.025 N.
  EXPECT_NEAR(seen.force.z(), -8.925, 0.0126);
  EXPECT_NEAR(seen.force.head<2>().norm(), 0.0, 0.0126);
}

TEST(Calibration, ACameraThatStandsElsewhereShiftsTheToolByAsMuchTheOtherWay) {
  // p_believed = X_WC' X_WC^-1 p_true with X_WC = X_WC' shifted by s: p_true - s.
  models::Setup setup = still_setup();
  setup.twin.frames.W_C.position += Vec3(0.001, -0.002, 0.003);
  EXPECT_LT((offsets_of(setup).tool_error - Vec3(-0.001, 0.002, -0.003)).norm(), 1e-6);
}

TEST(Calibration, ASensorThatIsTurnedReadsItsWeightAlongAnotherAxis) {
  // F turned by 90 degrees about y: its x axis points along -z of W, so the weight is along +x.
  models::Setup setup = still_setup();
  setup.twin.frames.H_F.rotation = Vec3(0, M_PI / 2, 0);
  const Offsets seen = offsets_of(setup);
  EXPECT_NEAR(seen.force.x(), 8.925, 0.0126) << seen.force.transpose();
  EXPECT_NEAR(seen.force.z(), 0.0, 0.0126);
}

TEST(Calibration, AMachineThatIsTurnedGoesAlongItsOwnAxes) {
  // Turned by 0.02 rad about z of W, H still on W's origin at zero: 10 mm along x of R are (10 cos, 10 sin)
  // mm in W.
  models::Setup setup = still_setup();
  setup.scene.user.reset();
  setup.scene.tracker.reset();
  setup.twin.hexapod.turned = Vec3(0, 0, 0.02);
  trial::Trial trial(setup, {});
  sim::World& world = trial.world();
  EXPECT_LT(world.truth().tip.e().norm(), 1e-12);
  const Vec3 zero = world.machine->machine().zero().p();
  for (int i = 0; i < 2000; ++i) {
    world.machine->command(Pose<'R', 'H'>(Quat::Identity(), Vec3(zero + Vec3(0.010, 0, 0))));
    world.advance();
  }
  const Vec3 expected(0.010 * std::cos(0.02), 0.010 * std::sin(0.02), 0.0);
  EXPECT_LT((world.truth().tip.e() - expected).norm(), 2e-6)
      << world.truth().tip.e().transpose();  // 3 um steps
}

}  // namespace
}  // namespace enc
