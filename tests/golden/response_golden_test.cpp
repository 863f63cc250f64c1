// The committed responses are what `encounter fit` makes of the loops that they name, byte for byte.
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmarks/response_source.h"
#include "core/response.h"
#include "core/scene.h"
#include "models/loop_fit.h"
#include "models/response_file.h"
#include "models/scene_file.h"

namespace enc {
namespace {

constexpr double kLimit = 6e-3;
const std::string kResponses = ENCOUNTER_SOURCE_DIR "/models/responses/";

double floor_of_rig() {
  return models::fit_floor(loop_of(models::load_rig(ENCOUNTER_SOURCE_DIR "/models/rigs/sim.toml")));
}

void expect_fitted(const std::string& csv, const std::string& loop_name, const std::string& response) {
  std::ifstream file(kResponses + response, std::ios::binary);
  const std::string committed((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ASSERT_FALSE(committed.empty());
  const models::LoopFit fit = models::fit_loop(models::parse_loop(csv, loop_name, kLimit), loop_name,
                                               {kLimit, floor_of_rig(), kUnset});
  EXPECT_EQ(models::response_text(fit.response, fit.source), committed);
}

// The ball without a rig around it. With the rig: the CSV text of a run of rig_A takes this loop's place.
TEST(ResponseGolden, TennisBallIsReproduced) {
  expect_fitted(bench::plant_loop_csv({}, 4e-3, kLimit), "tennis_ball_loop.csv", "tennis_ball.toml");
}
TEST(ResponseGolden, RegulationBallIsReproduced) {
  expect_fitted(bench::plant_loop_csv(bench::regulation_ball(), 4e-3, kLimit), "regulation_ball_loop.csv",
                "regulation_ball.toml");
}

// What the file says after reading, whichever model is felt: 12 +- 1 N where the true deflection first comes
// within 0.05 mm of the limit (decisions 6), and accepted with the fit's own floor although its coefficients
// are rounded.
TEST(ResponseGolden, TennisBallFileIsAcceptedAndTwelveNewton) {
  const ResponseSpec spec = models::load_response(kResponses + "tennis_ball.toml");
  for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii}) {
    const Response ball(spec, floor_of_rig(), reversal);
    EXPECT_EQ(ball.limit(), kLimit);
    EXPECT_NEAR(ball.press(5.95e-3), 12.0, 1.0);
    EXPECT_NEAR(ball.press(6e-3), 12.08, 0.15);
    EXPECT_NEAR(ball.largest_gap(), 1.74, 0.05);
  }
}

// A regulation ball is four times as hard (parameters 4.3).
TEST(ResponseGolden, RegulationBallFileIsAcceptedAndFiftyNewton) {
  const ResponseSpec spec = models::load_response(kResponses + "regulation_ball.toml");
  for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii})
    EXPECT_NEAR(Response(spec, floor_of_rig(), reversal).press(6e-3), 50.0, 6.0);
}

}  // namespace
}  // namespace enc
