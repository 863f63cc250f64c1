// The committed responses are what `encounter fit` makes of the loops that they name, byte for byte.
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/control/scene/scene.h"
#include "core/shape/response/response.h"
#include "models/identify/response/loop_fit.h"
#include "models/response_file.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/measure/record_table.h"

namespace enc {
namespace {

constexpr double kLimit = 6e-3;
const std::string kResponses = tests::source_dir() + "/models/responses/";

double floor_of_rig() {
  return models::fit_floor(loop_of(models::load_rig(tests::source_dir() + "/models/rigs/sim.toml")));
}

// What run, export and fit do, in one process.
void expect_fitted(const std::string& scene, const std::string& ball, const std::string& response) {
  std::ifstream file(kResponses + response, std::ios::binary);
  const std::string committed((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ASSERT_FALSE(committed.empty());
  const models::Setup setup = models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "sim",
                                           {"truth.ball.set=" + ball});
  const models::LoopData loop = models::parse_loop(trial::table_of_run(setup, 1), scene + ".csv", kLimit);
  const models::LoopFit fit = models::fit_loop(loop, {kLimit, floor_of_rig(), kUnset});
  EXPECT_EQ(models::response_text(fit.response, fit.source), committed)
      << "if that is as it should be:\n  build/release/encounter run models/scenes/" << scene
      << ".toml --set truth.ball.set=" << ball
      << " --force --record out/a.encrec && build/release/encounter export out/a.encrec --force --csv "
         "out/a.csv && "
      << "build/release/encounter fit out/a.csv --force --out models/responses/" << response;
}

TEST(ResponseGoldenLong, TennisBallIsReproduced) { expect_fitted("rig_A", "nominal", "tennis_ball.toml"); }
TEST(ResponseGoldenLong, TennisBallOffItsAxisIsReproduced) {
  expect_fitted("rig_B", "nominal", "tennis_ball_B.toml");
}
TEST(ResponseGoldenLong, TennisBallBesideTheVerticalIsReproduced) {
  expect_fitted("rig_C", "nominal", "tennis_ball_C.toml");
}
TEST(ResponseGoldenLong, RegulationBallIsReproduced) {
  expect_fitted("rig_A", "regulation", "regulation_ball.toml");
}

// What the file says after reading, whichever model is felt: 12 +- 1 N where the true deflection first comes
// within 0.05 mm of the limit (sources/hand 3), and accepted with the fit's own floor although its
// coefficients are rounded.
TEST(ResponseGoldenLong, TennisBallFileIsAcceptedAndTwelveNewton) {
  const ResponseSpec spec = models::load_response(kResponses + "tennis_ball.toml");
  for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii}) {
    const Response ball(spec, floor_of_rig(), reversal);
    EXPECT_EQ(ball.limit(), kLimit);
    EXPECT_NEAR(ball.press(5.95e-3), 12.0, 1.0);
    EXPECT_GT(ball.largest_gap(), 1.0);  // a loop of about 19 % (sources/ball 4)
    EXPECT_LT(ball.largest_gap(), 2.5);
  }
}

// A regulation ball is four times as hard (sources/ball 3).
TEST(ResponseGoldenLong, RegulationBallFileIsAcceptedAndFiftyNewton) {
  const ResponseSpec spec = models::load_response(kResponses + "regulation_ball.toml");
  for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii})
    EXPECT_NEAR(Response(spec, floor_of_rig(), reversal).press(5.95e-3), 50.0, 6.0);
}

}  // namespace
}  // namespace enc
