// Whatever is mixed of the tennis ball's three responses can be rendered: monotone, passive, not softer than
// its parts.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/control/scene/scene.h"
#include "core/shape/response/response.h"
#include "models/directions/directions.h"
#include "models/identify/response/response_fit.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"

namespace enc::models {
namespace {

const std::string kModels = tests::source_dir() + "/models";
constexpr double kLimit = 6e-3;

class DirectionsProperty : public testing::Test {
 protected:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11U) * 0x1p-53;
  }
  PressWay any_way() { return {uniform(0.0, 0.4), uniform(0.0, 0.4)}; }
  ResponseSpec any_mixture() { return mixed(parts_, weights(directions_, any_way())); }

  std::vector<Direction> directions_ = load_directions(kModels + "/directions/tennis_ball_any.toml");
  std::vector<ResponseSpec> parts_{load_response(kModels + "/responses/tennis_ball.toml"),
                                   load_response(kModels + "/responses/tennis_ball_B.toml"),
                                   load_response(kModels + "/responses/tennis_ball_C.toml")};
  double floor_ = fit_floor(loop_of(load_rig(kModels + "/rigs/sim.toml")));
  std::mt19937_64 random_{20};
};

TEST_F(DirectionsProperty, EveryMixtureIsAcceptedWithTheFloorOfItsParts) {
  for (int n = 0; n < 50; ++n) {
    const ResponseSpec mixture = any_mixture();
    for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii})
      EXPECT_NO_THROW(static_cast<void>(Response(mixture, floor_, reversal)));
  }
}

TEST_F(DirectionsProperty, NoDirectionIsStifferOrSofterThanAllOfItsParts) {
  for (int n = 0; n < 50; ++n) {
    const Response mixture(any_mixture(), 0.0);
    const double d = uniform(0.1e-3, kLimit);
    double least = INFINITY, most = -INFINITY;
    for (const ResponseSpec& part : parts_) {
      const double force = Response(part, 0.0).press(d);
      least = std::min(least, force);
      most = std::max(most, force);
    }
    EXPECT_GE(mixture.press(d), least - 1e-9);
    EXPECT_LE(mixture.press(d), most + 1e-9);
  }
}

// A closed path of deflection, cycled twice before, yields no energy.
TEST_F(DirectionsProperty, NoClosedPathYieldsEnergy) {
  for (int n = 0; n < 40; ++n) {
    const Response response(any_mixture(), 0.0,
                            n % 2 == 0 ? Reversal::prandtl_ishlinskii : Reversal::energy_stop);
    std::vector<double> turns(4);
    for (double& turn : turns) turn = uniform(0.0, kLimit);
    ResponseState state;
    double at = turns.back(), force = response.force(state, at), work = 0.0;
    for (int cycle = 0; cycle < 3; ++cycle) {
      work = 0.0;
      for (const double turn : turns) {
        constexpr int kSteps = 600;
        const double from = at;
        for (int i = 1; i <= kSteps; ++i) {
          const double to = from + (turn - from) * i / kSteps;
          const double now = response.force(state, to);
          work += 0.5 * (force + now) * (to - at);
          at = to;
          force = now;
        }
      }
    }
    EXPECT_GE(work, -1e-6) << n;  // J
  }
}

// Near directions have near weights: a user who wanders a little feels no step.
TEST_F(DirectionsProperty, WeightsFollowTheDirectionContinuously) {
  for (int n = 0; n < 200; ++n) {
    const PressWay way = any_way();
    const std::vector<double> here = weights(directions_, way);
    const std::vector<double> there = weights(directions_, {way.location + 1e-4, way.slant - 1e-4});
    for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(here[i], there[i], 0.01);
  }
}

}  // namespace
}  // namespace enc::models
