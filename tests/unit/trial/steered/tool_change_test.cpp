// A steered hand lays its tool on the tray, takes the other one, and back.
#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

class SteeredToolChange : public testing::Test {
 protected:
  // Runs the scene; `change` at these ticks. Gives the held tool at the end of each second.
  std::vector<std::int32_t> held(const std::string& scene, int seconds, const std::vector<std::int64_t>& at) {
    TrialOptions options;
    options.seconds = seconds;
    options.steer = [&](std::int64_t tick) -> std::optional<HandWord> {
      if (tick == 0) return HandWord{Point<'W'>(0, 0, 0.06)};
      if (std::find(at.begin(), at.end(), tick) == at.end()) return {};
      return HandWord{{}, true};
    };
    Trial trial(models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", {}, {}), options);
    std::vector<std::int32_t> tools;
    while (trial.tick()) {
      if (trial.result().ticks % 1000 == 0) tools.push_back(trial.truth().tool);
      farthest_ = std::max(farthest_, trial.truth().hand_force.norm());
      tip_ = trial.truth().tool_tip;
    }
    return tools;
  }
  double farthest_ = 0.0;  // N, most force of the hand
  Point<'W'> tip_;
};

TEST_F(SteeredToolChange, GoesToTheOtherToolAndBack) {
  const auto tools = held("session", 9, {1000, 5000});
  ASSERT_GE(tools.size(), 9U);
  EXPECT_EQ(tools[0], 0);
  EXPECT_EQ(tools[3], 1) << "after three seconds";
  EXPECT_EQ(tools[7], 0);
  EXPECT_NEAR((tip_ - Point<'W'>(0, 0, 0.06)).norm(), 0.0, 0.002) << "back where it was told to be";
  EXPECT_LT(farthest_, 15.0) << "nothing jerks";
}

TEST_F(SteeredToolChange, NothingHappensWithOneTool) {
  for (const std::int32_t tool : held("tennis_ball", 3, {1000})) EXPECT_EQ(tool, 0);
}

}  // namespace
}  // namespace enc::trial
