// What a result says of its program, machine and time.
#include "trial/provenance/provenance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace enc::trial {
namespace {

using std::chrono::milliseconds;

TEST(Provenance, TimesAreUtcInIso8601) {
  const WallTime epoch{};
  EXPECT_EQ(time_text(epoch), "1970-01-01T00:00:00.000Z");
  const WallTime t{milliseconds(1'795'999'092'345)};
  EXPECT_EQ(time_text(t), "2026-11-30T00:38:12.345Z");
  EXPECT_EQ(day_text(t), "2026-11-30");
  EXPECT_EQ(day_text(t + std::chrono::hours(24)), "2026-12-01");
}

TEST(Provenance, OnlyARunOnTheWallClockSaysWhenItStarted) {
  const WallTime t{milliseconds(1'795'999'092'345)};
  const auto simulated = provenance_texts(t, false), real = provenance_texts(t, true);
  EXPECT_EQ(simulated.at("date"), "2026-11-30");
  EXPECT_FALSE(simulated.contains("started"));
  EXPECT_EQ(real.at("started"), "2026-11-30T00:38:12.345Z");
  for (const char* name : {"version", "commit", "commit_date", "machine"}) {
    EXPECT_FALSE(real.at(name).empty()) << name;
    EXPECT_EQ(real.at(name), simulated.at(name));
    EXPECT_EQ(real.at(name).find('\n'), std::string::npos);
  }
}

// A program that links no commit says so. So no test is linked anew for each commit.
TEST(Provenance, WithoutACommitItIsUnknown) {
  EXPECT_STREQ(built_commit().name, "unknown");
  EXPECT_THAT(program_words(), testing::MatchesRegex("Encounter [0-9.]+, commit unknown of unknown"));
}

}  // namespace
}  // namespace enc::trial
