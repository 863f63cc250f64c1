// A whole tick of every shipped scene, as `run` has it: the twin and its physics, the core, safety, what
// every run counts and judges. After a tenth of a second it asks nothing of the heap, takes no lock, makes no
// system call but to sleep and to read the clock, and has all its memory in place.
#include <cstdint>

#include <gtest/gtest.h>
#include <sys/syscall.h>

#include "tests/hygiene/tick_run.h"
#include "tests/support/temporary_folder.h"

namespace enc::test {
namespace {

TEST_P(Tick, AsksForNothing) {
  count_scene({.scene = GetParam()},
              [](const Told& told) { EXPECT_EQ(told.tally.all(), 0) << words(told.tally); });
}
INSTANTIATE_TEST_SUITE_P(Shipped, Tick, testing::ValuesIn(scenes(false)),
                         [](const auto& scene) { return scene.param; });

// A clock that keeps wall time sleeps and reads it.
TEST_F(AnyTick, OnlySleepsAtAPace) {
  Case asked{.scene = "plane", .most = 2000};
  asked.options.pace = 10.0;
  const Told told = without_chance(asked);
  ASSERT_EQ(told.error, "");
  EXPECT_EQ(told.tally.all(), 0) << words(told.tally);
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
}

// A record is written in pieces of 64 KiB, each with one call.
TEST_F(AnyTick, OnlyWritesItsRecord) {
  const TemporaryFolder folder;
  const Told told = without_chance({.scene = "plane", .record = folder.file("a.encrec"), .most = 5000});
  ASSERT_EQ(told.error, "");
  EXPECT_EQ(told.tally[Offence::system_call], told.tally.all()) << words(told.tally);
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
  EXPECT_EQ(told.tally.calls[SYS_write], told.tally.all()) << words(told.tally);
  EXPECT_GT(told.tally.all(), 0);
  EXPECT_LE(static_cast<double>(told.tally.all()), told.extra / 60e3);
}

}  // namespace
}  // namespace enc::test
