// The runner of the tests themselves.
#include "tests/support/run_program.h"

#include <gtest/gtest.h>

namespace enc::models {
namespace {

TEST(RunProgram, reports_output_code_and_time) {
  const tests::Result r =
      tests::run({"sh", "-c", "echo out; echo $GREETING >&2; exit 3"}, {{"GREETING", "hello"}});
  EXPECT_EQ(r.code, 3);
  EXPECT_EQ(r.out, "out\n");
  EXPECT_EQ(r.err, "hello\n");
  EXPECT_GT(r.seconds, 0.0);
}

TEST(RunProgram, takes_much_output_and_kills_what_does_not_end) {
  EXPECT_EQ(tests::run({"sh", "-c", "head -c 1000000 /dev/zero; head -c 1000000 /dev/zero >&2"}).out.size(),
            1000000U);
  const tests::Result slow = tests::run({"sleep", "10"}, {}, 0.2);
  EXPECT_EQ(slow.code, 137);
  EXPECT_LT(slow.seconds, 5.0);
  EXPECT_EQ(tests::run({"/nonexistent/program"}).code, 127);
}

}  // namespace
}  // namespace enc::models
