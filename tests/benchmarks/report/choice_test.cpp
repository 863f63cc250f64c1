// What the words after `bench` name.
#include "benchmarks/report/choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/built.h"

namespace enc::bench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

std::vector<std::string> names_of(const std::vector<Choice>& choices) {
  std::vector<std::string> names;
  for (const Choice& c : choices) names.emplace_back(c.benchmark->name);
  return names;
}

std::string refusal(const std::vector<std::string>& words) {
  try {
    (void)chosen(words);
  } catch (const Error& e) {
    return e.what();
  }
  return "not refused";
}

TEST(Choice, NoWordsAreAllBenchmarks) { EXPECT_EQ(chosen({}).size(), benchmarks().size()); }

TEST(Choice, IsInTheOrderNamedAndEachOnce) {
  EXPECT_THAT(names_of(chosen({"speed", "dent", "speed"})), ElementsAre("speed", "dent"));
}

TEST(Choice, IdsOfOneBenchmarkComeTogetherAndTheWholeWins) {
  const std::vector<Choice> ids = chosen({"press.restore", "dent", "press.outside.max"});
  ASSERT_THAT(names_of(ids), ElementsAre("press", "dent"));
  EXPECT_THAT(ids[0].ids, ElementsAre("press.restore", "press.outside.max"));
  EXPECT_THAT(ids[1].ids, IsEmpty());
  EXPECT_THAT(chosen({"press.restore", "press"}).front().ids, IsEmpty());
  EXPECT_THAT(chosen({"press", "press.restore"}).front().ids, IsEmpty());
}

TEST(Choice, AnIdIsWholeTokens) {
  const Choice choice = chosen({"encounter.miss.10"}).front();
  const auto figure = [](const char* id) {
    return Figure{id, kUnset, 1.0, "", Role::ours, kUnset, kUnset, ""};
  };
  EXPECT_TRUE(wanted(choice, figure("encounter.miss.10.max")));
  EXPECT_TRUE(wanted(choice, figure("encounter.miss.10")));
  EXPECT_FALSE(wanted(choice, figure("encounter.miss.100.max")));
  EXPECT_FALSE(wanted(choice, figure("encounter.miss.20.max")));
}

// 4.1, 2 and 4.2 to 5 of the paper; what this program has of it.
TEST(Choice, ThePaperIsInItsOwnOrder) {
  std::vector<std::string> order;
  for (const std::string& name : names_of(chosen({"paper-2020"})))
    if (name == "tracking" || name == "stiffness" || name == "workspace") order.push_back(name);
  EXPECT_THAT(order, ElementsAre("tracking", "stiffness", "workspace"));
}

TEST(Choice, WhatDoesNotExistIsRefusedWithTheNearest) {
  EXPECT_THAT(refusal({"pres.restore.max"}), HasSubstr("unknown benchmark 'pres'; did you mean 'press'?"));
  EXPECT_THAT(refusal({"paper-2021"}), HasSubstr("'paper-2020'"));
  EXPECT_THAT(refusal({""}), HasSubstr("unknown benchmark"));
  BenchResult result{
      "press", "", 0, 0, {{"press.restore.max", kUnset, 1.0, "", Role::ours, kUnset, kUnset, ""}}};
  EXPECT_NO_THROW(check_ids(chosen({"press.restore"}).front(), result));
  EXPECT_NO_THROW(check_ids(chosen({"press"}).front(), result));
  try {
    check_ids(chosen({"press.restor.max"}).front(), result);
    FAIL() << "not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("unknown figure 'press.restor.max'; did you mean 'press.restore.max'?"));
  }
}

// Nothing is passed over in silence: what --set cannot change refuses it, by name.
TEST(Choice, WhatReadsNoSceneTakesNoSettings) {
  const std::string models = tests::source_dir() + "/models";
  std::vector<std::string> left;
  EXPECT_THAT(names_of(settable(chosen({"press", "registration"}), true, models, left)),
              ElementsAre("press", "registration"));
  try {
    (void)settable(chosen({"press", "nearest", "impact.peak"}), true, models, left);
    ADD_FAILURE() << "not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("--set: nearest, impact read no scene"));
  }
  left.clear();
  const std::size_t kept = settable(chosen({}), false, models, left).size();
  EXPECT_EQ(kept + left.size(), benchmarks().size());
  EXPECT_THAT(left, IsSupersetOf({"footprint", "impact", "nearest"}));
}

// Over devices only what needs no truth can be measured; what was named is not passed over.
TEST(Choice, OverTheDevicesOfARigOnlyThoseThatCan) {
  EXPECT_THAT(names_of(over_devices(chosen({}), false)), ElementsAre("stiffness", "tracking"));
  EXPECT_THAT(names_of(over_devices(chosen({"tracking.rig", "stiffness"}), true)),
              ElementsAre("tracking", "stiffness"));
  try {
    (void)over_devices(chosen({"press", "tracking", "dent"}), true);
    ADD_FAILURE() << "not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(),
                HasSubstr("--rig: press, dent measure in the twin alone; expected stiffness or tracking"));
  }
}

}  // namespace
}  // namespace enc::bench
