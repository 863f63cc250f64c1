// How often a run held: the first three are said, and how many more there were.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/run/run_report.h"
#include "tests/support/built.h"

namespace enc::app {
namespace {

// The force sensor is at fault this many times, for 5 ms each.
struct Held {
  explicit Held(int times) {
    options.seconds = 0.05 + 0.01 * times;
    options.disturb = [times, tick = 0](Inputs& in) mutable {
      ++tick;
      if (tick % 10 < 5 && tick >= 10 && tick / 10 <= times) in.wrench.health = Health::fault;
    };
    trial::Trial trial(setup, options);
    result = trial.run();
    text = run_text({setup, trial.scene(), result, measured, strengths, certificates, asked});
  }
  [[nodiscard]] int lines(const std::string& begin) const {
    int count = 0;
    for (std::size_t at = text.find("\n" + begin); at != std::string::npos;
         at = text.find("\n" + begin, at + 1))
      ++count;
    return count;
  }

  models::Setup setup = models::load(tests::source_dir() + "/models/scenes/tennis_ball.toml", "sim");
  trial::TrialOptions options;
  trial::RunMeasures measured{setup, options};
  std::vector<trial::ArmStrength> strengths;
  std::vector<trial::Certified> certificates;
  RunOptions asked;
  trial::TrialResult result;
  std::string text;
};

TEST(HoldLines, TheFirstThreeAreSaidAndTheOthersCounted) {
  for (const auto& [times, more] : {std::pair{0, ""},
                                    {3, ""},
                                    {4, "\nhold        and 1 time more; 0.020 s in all\n"},
                                    {40, "\nhold        and 37 times more; 0.200 s in all\n"}}) {
    SCOPED_TRACE(times);
    const Held held(times);
    EXPECT_EQ(held.result.times_held, times);
    EXPECT_EQ(held.result.holds.size(), std::min<std::size_t>(16, static_cast<std::size_t>(times)));
    EXPECT_EQ(held.lines("hold        at "), std::min(3, times));
    EXPECT_EQ(held.lines("hold        and "), times > 3 ? 1 : 0);
    EXPECT_THAT(held.text, testing::HasSubstr(more));
  }
}

}  // namespace
}  // namespace enc::app
