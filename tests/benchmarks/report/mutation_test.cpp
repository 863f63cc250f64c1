// The mutation run: a toy benchmark whose bounds survive or go red, mutants that are refused, and the tables
// of the benchmarks that ship. Also the parameters that reach a benchmark.
#include "benchmarks/commands/mutation.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::bench {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

void run_toy(Bench& bench) {
  const bool wrong = bench.context.mutated("wrong_sign");
  const double radius = bench.setup().scene.objects.front().radius;
  bench.figure("error.max", wrong ? 3.0 : 0.5, "mm", at_most(1.0));
  bench.figure("size.value", radius * 1e3, "mm", between(30.0, 36.0));
  bench.figure("blind.value", 1.0, "", at_least(0.0));
  bench.figure("lost.value", wrong ? kUnset : 1.0, "", at_least(0.0));
  bench.figure("plain.value", 1.0, "");
}
constexpr Benchmark kToy{"toy", "tennis_ball", "for these tests", run_toy};

BenchContext context_here() {
  BenchContext context;
  context.models = tests::source_dir() + "/models";
  return context;
}

const Mutant kSign{.what = "sign", .changes = {"wrong_sign"}, .kills = {"error.max"}};
const Mutant kLarge{.what = "large ball", .set = {"object.ball.radius_mm=50"}, .kills = {"size.*"}};

std::string why_refused(const Mutant& mutant) {
  try {
    (void)mutate(kToy, std::vector{mutant}, context_here());
  } catch (const Error& e) {
    return e.what();
  }
  return "not refused";
}

TEST(Mutation, NamesTheMutantOfEachBoundAndTheSurvivors) {
  const MutationResult result = mutate(kToy, std::vector{kSign, kLarge}, context_here());
  ASSERT_EQ(result.bounds.size(), 4U) << "a figure without bounds counts";
  EXPECT_EQ(result.bounds[0].mutant, "sign");
  EXPECT_EQ(result.bounds[0].value, 3.0);
  EXPECT_EQ(result.bounds[1].mutant, "large ball");
  EXPECT_EQ(result.bounds[2].mutant, "");
  EXPECT_EQ(result.bounds[3].mutant, "") << "a figure without a value is not judged by its bound";
  EXPECT_EQ(result.survivors(), 2U);
  EXPECT_THAT(result.faults, IsEmpty());
  EXPECT_FALSE(result.ok());
  EXPECT_THAT(result.mutants, ElementsAre("sign", "large ball"));
}

TEST(Mutation, ABoundThatIsClaimedAndStaysGreenIsAFault) {
  Mutant claims = kSign;
  claims.kills.emplace_back("blind.value");
  const MutationResult result = mutate(kToy, std::vector{claims}, context_here());
  EXPECT_THAT(result.faults, ElementsAre("mutant 'sign' leaves toy.blind.value green: 1"));
  EXPECT_FALSE(result.ok());
}

TEST(Mutation, ABoundOfTheDefaultFormThatNoRunJudgesIsAFault) {
  MutationOptions options;
  options.expected = {"toy.error.p95", "toy.other.max"};
  options.wanted = [](const Figure& f) { return f.id == "toy.error.max"; };
  const MutationResult result = mutate(kToy, std::vector{kSign, kLarge}, context_here(), options);
  EXPECT_EQ(result.mutants.size(), 1U) << "a mutant that claims no wanted bound has run";
  EXPECT_THAT(result.faults, ElementsAre("toy.other.max was not judged: no mutant runs its form"));
}

TEST(Mutation, AMutantThatCannotBeMeantIsRefused) {
  EXPECT_THAT(why_refused({.what = "m", .changes = {"wrong_sign"}, .kills = {"eror.max"}}),
              HasSubstr("mutant 'm' of toy: unknown bound 'eror.max'; did you mean 'error.max'?"));
  EXPECT_THAT(why_refused({.what = "m", .changes = {"wrong_sign"}, .kills = {"plain.value"}}),
              HasSubstr("unknown bound 'plain.value'"));
  EXPECT_THAT(why_refused({.what = "m", .kills = {"error.max"}}), HasSubstr("it changes nothing"));
  EXPECT_THAT(why_refused({.what = "m", .changes = {"wrong_sign"}}), HasSubstr("it claims no bound"));
  EXPECT_THAT(why_refused({.what = "m", .changes = {"other"}, .kills = {"error.max"}}),
              HasSubstr("the benchmark does not ask for the change other"));
  EXPECT_THAT(why_refused({.what = "m", .set = {"truth.bal.wall_mm=1"}, .kills = {"size.value"}}),
              HasSubstr("toy reads no parameter 'truth.bal.wall_mm'"));
}

TEST(Mutation, AStarIsOneToken) {
  EXPECT_TRUE(fits_id("contour.*.rms_mm", "contour.2.rms_mm"));
  EXPECT_TRUE(fits_id("contour.2.rms_mm", "contour.2.rms_mm"));
  EXPECT_FALSE(fits_id("contour.*", "contour.2.rms_mm"));
  EXPECT_FALSE(fits_id("contour.2", "contour.20"));
}

// The issue of the order: at most 60 mutants, which together take 25 minutes on two cores.
TEST(Mutation, TheMutantsThatShipAreFew) {
  std::size_t mutants = 0;
  for (const Benchmark& benchmark : benchmarks()) {
    const auto all = mutants_of(benchmark.name);
    mutants += all.size();
    for (const Mutant& mutant : all)
      EXPECT_NO_THROW(check_settings(benchmark, context_here().models, mutant.set)) << benchmark.name;
  }
  EXPECT_LE(mutants, 60U);
}

TEST(Mutation, TheCommandNamesTheMutantOfEachBound) {
  const tests::Result r = tests::run_program({"bench", "--mutate", "deformation.contour.2.rms_mm"});
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("deformation.contour.2.rms_mm"), HasSubstr(" -> "),
                           HasSubstr("1 bounds, 1 red under a mutant, 0 survived")));
}

// ---- Parameters that reach a benchmark.

std::string setting_refused(const Benchmark& benchmark, const std::string& setting) {
  try {
    check_settings(benchmark, context_here().models, {setting});
  } catch (const Error& e) {
    return e.what();
  }
  return "not refused";
}

// Every name that a scene of the benchmark knows and the benchmark does not read, and one that does not
// exist.
TEST(Reads, EachBenchmarkRefusesANameThatItWouldIgnore) {
  const std::string models = context_here().models;
  for (const Benchmark& benchmark : benchmarks()) {
    const std::vector<std::string> scenes = scenes_read(benchmark, models),
                                   names = names_read(benchmark, models);
    if (scenes.empty()) continue;
    ASSERT_FALSE(names.empty()) << benchmark.name;
    EXPECT_THAT(setting_refused(benchmark, "truth.no_such_name=1"),
                AllOf(HasSubstr("--set truth.no_such_name=1: "), HasSubstr(benchmark.name),
                      HasSubstr("the closest is '")))
        << benchmark.name;
    EXPECT_EQ(setting_refused(benchmark, names.front() + "=1"), "not refused") << benchmark.name;
    const std::set<std::string> read(names.begin(), names.end());
    for (const std::string& scene : scenes) {
      const std::string file = models + "/scenes/" + scene + ".toml";
      if (scene == "vishap") continue;  // a rig
      for (const models::Parameter& p : models::parameters(models::load(file, {})))
        if (!read.contains(p.name)) {
          ASSERT_THAT(setting_refused(benchmark, p.name + "=1"), HasSubstr("reads no parameter"))
              << benchmark.name;
        }
    }
  }
}

// A setting that the benchmark holds reaches none of its runs: it is refused at the end, not ignored.
TEST(Reads, ASettingThatNoRunUsesIsRefused) {
  const auto held = [](Bench& bench) { (void)bench.setup({}, {"object.ball.radius_mm=30"}); };
  const Benchmark holds{"holds", "tennis_ball", "for these tests", +held};
  BenchContext context = context_here();
  context.set = {"object.ball.radius_mm=31"};
  try {
    (void)result_of(holds, context);
    ADD_FAILURE() << "not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("no run of holds uses this parameter"));
  }
  context.set = {"object.ball.limit_mm=5"};
  EXPECT_NO_THROW((void)result_of(holds, context));
}

// Of several scenes each gets the settings that it knows.
TEST(Reads, ASettingReachesTheScenesThatKnowIt) {
  BenchContext context = context_here();
  context.benchmark = "impact";
  context.set = {"object.wall.position_mm=[0,0,1]", "user.approach_from_mm=33"};
  EXPECT_THAT(settings_for(context, "wall"),
              ElementsAre("object.wall.position_mm=[0,0,1]", "user.approach_from_mm=33"));
  EXPECT_THAT(settings_for(context, "tennis_ball"), ElementsAre("user.approach_from_mm=33"));
  EXPECT_THROW((void)settings_for(context, "keypad"), std::logic_error) << "its Reads does not name it";
}

// The small benchmarks name each parameter that they read: changing one changes a figure.
TEST(Reads, WhatDeformationReadsChangesItsFigures) {
  const auto all = benchmarks();
  const auto deformation = std::find_if(
      all.begin(), all.end(), [](const Benchmark& b) { return std::string(b.name) == "deformation"; });
  ASSERT_NE(deformation, all.end());
  BenchContext context = context_here();
  context.quick = true;
  const BenchResult before = result_of(*deformation, context);
  context.set = {"object.ball.radius_mm=40"};
  const BenchResult after = result_of(*deformation, context);
  EXPECT_NE(before.figures.front().twin, after.figures.front().twin);
}

}  // namespace
}  // namespace enc::bench
