// The twin of the machine's position loop against its equation, and a person against what a hand has.
#include "sim/plants/hexapod_plant.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/scenes.h"
#include "trial/trial.h"

namespace enc {
namespace {

// Of second order: x = 1 - exp(-z w t) (cos u t + z w / u sin u t), u = w sqrt(1 - z^2).
double step_response(double servo, double damping, double t) {
  const double w = 2.0 * std::numbers::pi * servo, u = w * std::sqrt(1.0 - damping * damping);
  return 1.0 - std::exp(-damping * w * t) * (std::cos(u * t) + damping * w / u * std::sin(u * t));
}

TEST(HexapodPlant, AServoIsAsSlowAsItsEquationHoweverFastItIs) {
  for (const double servo : {15.0, 60.0, 300.0}) {
    sim::HexapodTruth truth;
    truth.servo = servo;
    truth.delay_cycles = 0;
    truth.speed = truth.acceleration = 1e6;
    truth.step = truth.repeatability = 0.0;
    sim::HexapodPlant machine(truth, 1);
    const Pose<'R', 'H'> from = machine.true_pose();
    machine.command({from.q(), Vec3(from.p() + Vec3(1e-3, 0, 0))});
    double worst = 0.0;
    for (int tick = 1; tick <= 100; ++tick) {
      machine.begin_cycle();
      machine.move(1e-3);
      const double moved = (machine.true_pose().p() - from.p()).x() / 1e-3;
      worst = std::max(worst, std::abs(moved - step_response(servo, truth.damping, 1e-3 * tick)));
    }
    EXPECT_LT(worst, 0.07) << servo << " Hz";
  }
}

// Something that does not give way is pressed with what a hand has, not with its spring times the way.
TEST(User, PushesNoHarderThanAHandDoes) {
  trial::TrialOptions options;
  options.seconds = 6.0;
  models::Setup setup = models::load(tests::source_dir() + "/models/scenes/plane.toml", "",
                                     {"user.depth_mm=400", "truth.hand.strength_N=20"});
  trial::Trial trial(std::move(setup), options);
  double most = 0.0;
  while (trial.tick())
    if (trial.outputs().mode == Mode::contact) most = std::max(most, trial.truth().contact_force.norm());
  EXPECT_GT(most, 10.0);
  EXPECT_LT(most, 30.0);  // and the weight of the tool, and the impact
}

}  // namespace
}  // namespace enc
