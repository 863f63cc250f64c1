// A percentile is printed where there are enough values for it, and the largest value always.
#include "app/run/percentiles.h"

#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/run/run_report.h"
#include "tests/support/built.h"

namespace enc::app {
namespace {

std::string of(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), 1.0);
  return text_of(percentiles_of(values), 1.0, 0, 0);
}

TEST(Percentiles, NeedAValueBeyondThem) {
  EXPECT_EQ(of(0), "none");
  EXPECT_EQ(of(1), "max 1");
  EXPECT_EQ(of(2), "p50 1, max 2");
  EXPECT_EQ(of(99), "p50 50, max 99");
  EXPECT_EQ(of(100), "p50 50, p99 99, max 100");
  EXPECT_EQ(of(999), "p50 500, p99 989, max 999");
  EXPECT_EQ(of(1000), "p50 500, p99 990, p99.9 999, max 1000");
}

TEST(Percentiles, AreKnownOnBothSides) {
  for (const auto& [share, count] :
       {std::pair{0.5, 2U}, {0.95, 20U}, {0.05, 20U}, {0.975, 40U}, {0.99, 100U}, {0.999, 1000U}}) {
    EXPECT_TRUE(models::has_percentile(count, share)) << share;
    EXPECT_FALSE(models::has_percentile(count - 1, share)) << share;
  }
  EXPECT_TRUE(models::has_percentile(1, 1.0));
  EXPECT_TRUE(models::has_percentile(1, 0.0));
  EXPECT_FALSE(models::has_percentile(0, 1.0));
}

// Text and JSON of a run of so many ticks.
std::pair<std::string, nlohmann::json> reports_of(double ticks) {
  const models::Setup setup = models::load(tests::source_dir() + "/models/scenes/plane.toml", "sim");
  trial::TrialOptions options;
  options.seconds = 1e-3 * (ticks - 1.0);
  trial::RunMeasures measured{setup, options};
  trial::Trial trial(setup, options);
  const trial::TrialResult result = trial.run();
  const std::vector<trial::ArmStrength> strengths;
  const std::vector<trial::Certified> certificates;
  const RunOptions asked;
  const RunReport report{setup, trial.scene(), result, measured, strengths, certificates, asked};
  return {run_text(report), nlohmann::json::parse(run_json(report))};
}

TEST(Percentiles, OfAShortRunAreLeftOutOfTextAndJson) {
  const auto [text, json] = reports_of(60);
  EXPECT_THAT(text, ::testing::ContainsRegex("\ntick        step\\(\\) p50 [0-9.]+, max [0-9.]+ us\n"));
  const nlohmann::json& step = json.at("step_ns");
  EXPECT_TRUE(step.at("p50").is_number());
  EXPECT_TRUE(step.at("p99").is_null());
  EXPECT_TRUE(step.at("p99_9").is_null());
  EXPECT_TRUE(step.at("max").is_number());
}

TEST(Percentiles, OfALongRunAreAllThere) {
  const auto [text, json] = reports_of(1000);
  EXPECT_THAT(text,
              ::testing::ContainsRegex(
                  "\ntick        step\\(\\) p50 [0-9.]+, p99 [0-9.]+, p99.9 [0-9.]+, max [0-9.]+ us\n"));
  EXPECT_TRUE(json.at("step_ns").at("p99_9").is_number());
}

}  // namespace
}  // namespace enc::app
