// `encounter calibrate tracker` on 100 seeded logs: what was put in comes out, and the intervals hold it.
#include <algorithm>

#include <gtest/gtest.h>

#include "benchmarks/tracking/forensics.h"
#include "tests/support/built.h"

namespace enc::bench::tracking {
namespace {

double figure(const BenchResult& result, const std::string& id) {
  const auto found = std::find_if(result.figures.begin(), result.figures.end(),
                                  [&](const Figure& f) { return f.id == "tracking.forensics." + id; });
  return found == result.figures.end() ? kUnset : found->twin;
}

TEST(Forensics, FindsWhatWasPutInto100Logs) {
  BenchContext context;
  context.models = tests::source_dir() + "/models";
  BenchResult result;
  add_forensics(context, result);
  EXPECT_GE(figure(result, "latency.percent"), 95.0) << "within 1 ms";
  EXPECT_GE(figure(result, "bias.percent"), 95.0) << "all axes within 0.01 mm";
  // 95 % intervals of 100 and of 300 numbers: fewer than 88 and 91 % happen once in 1000 times.
  EXPECT_GE(figure(result, "latency_interval.percent"), 88.0);
  EXPECT_GE(figure(result, "bias_interval.percent"), 91.0);
  for (const Figure& f : result.figures) EXPECT_TRUE(f.ok()) << f.id << " " << f.twin;
  ASSERT_EQ(result.plots.size(), 1U);
  EXPECT_EQ(result.plots[0].series[1].x.size(), 100U);
}

// Each parameter alone: the latency put in moves what is found by as much, a bias and a noise do not.
TEST(Forensics, OnlyLatencyMovesLatency) {
  LogSpec spec;
  const auto found = [&](const LogSpec& s) { return models::fit_latency(made_log(s, 7).log); };
  const models::LatencyFit before = found(spec);
  LogSpec later = spec;
  later.tracker.latency += 0.005;
  EXPECT_NEAR(found(later).latency.value - before.latency.value, 0.005, 0.3e-3);
  LogSpec off = spec;
  off.tracker.bias.x() += 0.2e-3;
  EXPECT_NEAR(found(off).latency.value, before.latency.value, 0.05e-3);
  EXPECT_NEAR(found(off).axes[0].bias.value - before.axes[0].bias.value, 0.2e-3, 1e-6);
  LogSpec noisy = spec;
  noisy.tracker.noise = Vec3::Constant(0.05e-3);
  EXPECT_NEAR(found(noisy).latency.value, before.latency.value, 0.4e-3);
  EXPECT_NEAR(found(noisy).axes[1].noise, 0.05e-3, 0.003e-3);
  LogSpec lossy = spec;
  lossy.tracker.loss = 0.2;
  EXPECT_NEAR(found(lossy).latency.value, before.latency.value, 0.4e-3);
}

TEST(Forensics, TrueStampsAreFoundTrue) {
  LogSpec spec;
  spec.stamps = true;
  const MadeLog made = made_log(spec, 11);
  const models::LatencyFit fit = models::fit_latency(made.log);
  EXPECT_NEAR(fit.stamp_error.value, 0.0, 0.1e-3);
  EXPECT_NEAR(fit.stamp_age.value, made.latency, 0.3e-3);
}

}  // namespace
}  // namespace enc::bench::tracking
