// The committed response of the ball is what its command computes, byte for byte.
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmarks/response_source.h"
#include "core/loop_model.h"
#include "core/response.h"
#include "models/scene_file.h"

namespace enc {
namespace {

TEST(ResponseGolden, TennisBallIsReproduced) {
  std::ifstream file(ENCOUNTER_SOURCE_DIR "/models/responses/tennis_ball.toml", std::ios::binary);
  const std::string committed((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ASSERT_FALSE(committed.empty());
  EXPECT_THAT(committed, testing::HasSubstr("SYNTHETIC"));
  EXPECT_EQ(bench::plant_response_text({}, 4e-3, 6e-3, LoopModel{}), committed);
}

// What the file says after reading: 12 +- 1 N where the true deflection first comes within 0.05 mm of the
// limit (decisions 6), and accepted with the fit's own floor although its coefficients are rounded.
TEST(ResponseGolden, TennisBallFileIsAcceptedAndTwelveNewton) {
  const ResponseSpec spec = models::load_response(ENCOUNTER_SOURCE_DIR "/models/responses/tennis_ball.toml");
  const Response ball(spec, bench::fit_floor(LoopModel{}));
  EXPECT_EQ(ball.limit(), 6e-3);
  EXPECT_NEAR(ball.press(5.95e-3), 12.0, 1.0);
  EXPECT_NEAR(ball.press(6e-3), 12.08, 0.01);
  EXPECT_NEAR(ball.release(6e-3), 11.63, 0.01);
  EXPECT_NEAR(ball.largest_gap(), 1.744, 0.001);
}

}  // namespace
}  // namespace enc
