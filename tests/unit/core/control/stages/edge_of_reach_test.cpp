// A tip that comes to the edge of the machine's reach inside of an object goes on along that edge.
#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

// Seed 24 of the session: the way to the tool leads through the inside of the ball, down to the shortest
// legs.
TEST(EdgeOfReach, IsLeftInsideOfAnObject) {
  TrialOptions options;
  options.seed = 24;
  options.seconds = 64.4;
  Trial trial(models::load(tests::source_dir() + "/models/scenes/session.toml", {}, {}), options);
  double lowest = 0.0;
  while (trial.tick())
    if (trial.now().index > 62'000) lowest = std::min(lowest, trial.truth().tip.xyz[2]);
  EXPECT_LT(lowest, -0.022) << "it was at the edge";
  EXPECT_LT((trial.truth().tip - trial.truth().tool_tip).norm(), 0.020) << "and is under the tool by now";
}

}  // namespace
}  // namespace enc::trial
