// The judge of `bench extremes` reports wrong outputs, each fault does what its name says, and the short form
// of the benchmark passes.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "benchmarks/extremes/case.h"
#include "benchmarks/extremes/faults.h"
#include "benchmarks/kit/entry.h"
#include "tests/support/built.h"
#include "tests/support/twin.h"

namespace enc::bench::extremes {
namespace {

// Judges half a second of a shipped scene whose outputs are changed on one tick before the judge sees them.
Judge judged(const std::string& scene, const std::function<void(Outputs&)>& change) {
  Judge judge;
  trial::TrialOptions options{.seconds = 0.5};
  options.watch = [&](const trial::Glance& g) {
    Outputs out = g.out;
    if (g.tick.index == 300) change(out);
    judge.see({g.scene, g.tick, g.truth, g.in, out, g.simulated});
  };
  trial::Trial(models::load(test::scene_file(scene), "", {}), options).run();
  return judge;
}

TEST(Extremes, TheJudgeObjectsToACommandOfAMachine) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(judged("tennis_ball", [](Outputs&) {}).broken(), 0);
  for (const double x : {kUnset, kInf, 1e12})
    EXPECT_GT(judged("tennis_ball", [&](Outputs& out) { out.manipulator.tip.xyz[0] = x; }).broken(), 0) << x;
  EXPECT_GT(judged("tennis_ball", [](Outputs& out) { out.manipulator.tip.xyz[2] += 1e-6; }).broken(),
            0);  // 1 m/s2
  EXPECT_GT(judged("tennis_ball", [](Outputs& out) { out.deflection = -kInf; }).broken(), 0);
}

TEST(Extremes, TheJudgeObjectsToACommandOfAnArm) {
  EXPECT_EQ(judged("wall", [](Outputs&) {}).broken(), 0);
  EXPECT_GT(judged("wall", [](Outputs& out) { out.arm.force.xyz[1] = kUnset; }).broken(), 0);
  // The law stays below the peak on each tick; with the arm's weight one cycle may be above.
  EXPECT_EQ(judged("wall", [](Outputs& out) { out.force_unfiltered = Vec<'W'>(0, 0, 9.0); }).broken(), 1);
  EXPECT_EQ(judged("wall", [](Outputs& out) { out.arm.force = Vec<'R'>(0, 0, 20.0); }).broken(), 0);
}

TEST(Extremes, EachNumberOfTheInputsIsSpoiledAlone) {
  Inputs none;
  InputSpoiler count;
  fields(count, none);
  ASSERT_GT(count.seen, 60);
  for (const Junk junk : kJunk)
    for (int i = 0; i < count.seen; ++i) {
      Inputs in;
      InputSpoiler one{i, junk};
      fields(one, in);
      EXPECT_FALSE(one.name.empty()) << i;
      EXPECT_EQ(one.seen, count.seen);
    }
}

// Stamps of those of 500 packets, 8 ms apart, that arrive.
std::vector<std::int64_t> arrived(const Network::Faults& faults) {
  Network network(faults, 1);
  std::vector<std::int64_t> stamps;
  for (std::int64_t tick = 0; tick < 4000; ++tick) {
    Inputs in;
    in.tool.health = Health::ok;
    in.tool.t = Time(Duration(tick / 8 * 8'000'000));
    network(Time(Duration(tick * 1'000'000)), in);
    const std::int64_t stamp = in.tool.t.time_since_epoch().count();
    if (stamps.empty() || stamps.back() != stamp) stamps.push_back(stamp);
  }
  return stamps;
}

TEST(Extremes, TheNetworkLosesAndReordersAsOften) {
  EXPECT_EQ(arrived({}).size(), 500U);
  EXPECT_EQ(arrived({.twice = 1.0}), arrived({}));
  EXPECT_NEAR(static_cast<double>(arrived({.loss = 0.2}).size()), 400.0, 40.0);
  const auto late = arrived({.late = 0.3});
  EXPECT_FALSE(std::is_sorted(late.begin(), late.end()));
}

TEST(Extremes, TheShortFormHolds) {
  const auto all = benchmarks();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [](const Benchmark& b) { return std::string(b.name) == "extremes"; });
  ASSERT_NE(found, all.end());
  BenchContext context;
  context.models = tests::source_dir() + "/models";
  context.quick = true;
  const BenchResult result = result_of(*found, context);
  std::set<std::string> ids;
  for (const Figure& f : result.figures) {
    EXPECT_TRUE(f.ok()) << f.id << " is " << f.twin << ": " << f.note;
    EXPECT_TRUE(ids.insert(f.id).second) << f.id;
  }
  ASSERT_EQ(result.tables.size(), 1U);
  EXPECT_GT(result.tables.front().rows.size(), 25U);
}

}  // namespace
}  // namespace enc::bench::extremes
