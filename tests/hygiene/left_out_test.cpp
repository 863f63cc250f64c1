// The program that is built without vision (preset lean) runs what needs none, and says of the rest that it
// is not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

using testing::HasSubstr;

TEST(LeftOut, WithoutVisionTheProgramRunsWhatNeedsNoneAndRefusesTheRestInALine) {
  if (is_built("vision")) GTEST_SKIP() << "vision is built here";
  const Result ball = run_program({"run", shipped_scene("tennis_ball")}, kShipped);
  EXPECT_EQ(ball.code, 0) << ball.err;
  EXPECT_THAT(ball.out, HasSubstr("state hash"));
  const Result seen =
      run_program({"run", shipped_scene("plane"), "--set", "rig.tracker.driver=vision"}, kShipped);
  EXPECT_EQ(seen.code, 2);
  EXPECT_THAT(seen.err,
              HasSubstr("--set rig.tracker.driver=vision: there is no driver 'vision'; expected one of"));
  EXPECT_THAT(seen.err, HasSubstr("build it"));
  const Result images = run_program({"calibrate", "camera", "vishap", "--through-images"}, kShipped);
  EXPECT_EQ(images.code, 2);
  EXPECT_THAT(images.err, HasSubstr("there is no module 'vision'; build it"));
}

}  // namespace
}  // namespace enc::tests
