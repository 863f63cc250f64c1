// Felt or not: thresholds and what is said of an error, worked by hand.
#include "benchmarks/verdict/verdict.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "benchmarks/report/report.h"
#include "core/base/error.h"
#include "tests/support/built.h"

namespace enc::bench {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kHeader =
    "figure,sign,kind,threshold,least,most,at,at_least,at_most,floor,unit,compares,source,confidence\n";

std::vector<Threshold> of(const std::string& rows) { return parse_thresholds(kHeader + rows, "t.csv"); }

std::string refused_rows(const std::string& rows) {
  try {
    (void)of(rows);
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing";
}

BenchResult result_of(const std::string& id, double twin, const char* unit, double paper = kUnset) {
  return {"b", "s", 0, 0, {{id, paper, twin, unit, Role::ours, kUnset, kUnset, ""}}};
}

TEST(Verdict, APatternStandsForAnyCharacters) {
  EXPECT_TRUE(matches("a.b", "a.b"));
  EXPECT_FALSE(matches("a.b", "a.bc"));
  EXPECT_FALSE(matches("a.bc", "a.b"));
  EXPECT_TRUE(matches("a.*", "a."));
  EXPECT_TRUE(matches("s.*mae_mm", "s.fused.mae_mm"));
  EXPECT_TRUE(matches("s.*mae_mm", "s.mae_mm"));
  EXPECT_FALSE(matches("s.*mae_mm", "s.mae_mm.x"));
  EXPECT_TRUE(matches("*.rmse.*.press", "i.rmse.rmse.A.press"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_FALSE(matches("", "a"));
}

TEST(Verdict, AnErrorIsFeltAboveTheRangeAndNotBelow) {
  const Threshold t = of("x,any,absolute,0.4,0.3,0.5,-,-,-,-,mm,a,b,c\n").front();
  EXPECT_EQ(felt(0.3, t), Felt::no);
  EXPECT_EQ(felt(-0.4, t), Felt::between);
  EXPECT_EQ(felt(0.5, t), Felt::between);
  EXPECT_EQ(felt(-0.51, t), Felt::yes);
  EXPECT_EQ(felt(kUnset, t), Felt::not_comparable);
}

// 7 % of 5 N is 0.35 N, 10 % of 12 N is 1.2 N, and 5 % of 1 N is less than the floor.
TEST(Verdict, AShareIsOfTheForceAtWhichTheErrorHappens) {
  const Threshold t = of("x,any,share,7,5,10,5,1,12,0.1,N,a,b,c\n").front();
  EXPECT_DOUBLE_EQ(t.value, 0.35);
  EXPECT_DOUBLE_EQ(t.least, 0.1);
  EXPECT_DOUBLE_EQ(t.most, 1.2);
  EXPECT_EQ(t.rule, "7 % (5 .. 10) of 5 N (1 .. 12), at least 0.1");
}

TEST(Verdict, EarlyAndLateHaveTheirOwnThresholds) {
  const std::vector<Threshold> two =
      of("lag,+,absolute,50,45,50,-,-,-,-,ms,late,b,c\nlag,-,absolute,15,15,45,-,-,-,-,ms,early,b,c\n");
  const auto one = [&](double lag) { return judged({result_of("lag", lag, "ms")}, two).front(); };
  EXPECT_EQ(one(30).threshold.compares, "late");
  EXPECT_EQ(one(30).felt, Felt::no);
  EXPECT_EQ(one(-30).threshold.compares, "early");
  EXPECT_EQ(one(-30).felt, Felt::between);
  EXPECT_DOUBLE_EQ(one(-30).over, 2.0);
}

TEST(Verdict, OfTheStrictestComparisonOnlyNotFeltFollows) {
  const Threshold t = of("x,any,strictest,0.4,0.3,0.5,-,-,-,-,mm,a,b,c\n").front();
  EXPECT_EQ(felt(0.2, t), Felt::no);
  EXPECT_EQ(felt(5.0, t), Felt::not_comparable);
}

TEST(Verdict, WhatHasNoThresholdIsNotThereAndWhatCannotBeComparedSaysSo) {
  const std::vector<Threshold> all = of("a.x,any,none,-,-,-,-,-,-,-,N,nobody has measured it,-,-\n");
  EXPECT_TRUE(judged({result_of("a.y", 1, "N")}, all).empty());
  EXPECT_TRUE(judged({result_of("a.x", 1, "mm")}, all).empty()) << "another unit is another quantity";
  EXPECT_TRUE(judged({result_of("a.x", kUnset, "N")}, all).empty());
  const std::vector<Judged> one = judged({result_of("a.x", 1, "N")}, all);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].felt, Felt::not_comparable);
  EXPECT_TRUE(verdict_plot(one).y_names.empty());
  EXPECT_EQ(verdict_line(one), "1 not comparable");
}

TEST(Verdict, ThePaperIsJudgedAsTheTwinIs) {
  const std::vector<Threshold> t = of("x.*,any,absolute,0.4,0.3,0.5,-,-,-,-,mm,tip beside tip,b,c\n");
  const std::vector<Judged> all = judged({result_of("x.1", 0.2, "mm", 0.8), result_of("x.2", 0.6, "mm")}, t);
  const Table table = verdict_table(all);
  EXPECT_THAT(table.rows[0],
              ElementsAre("x.1", "0.2", "mm", "0.4 (0.3 .. 0.5)", "0.5", "not felt", "0.8", "felt"));
  EXPECT_THAT(threshold_table(all).rows,
              ElementsAre(ElementsAre("x.*", "0.4 (0.3 .. 0.5)", "mm", "tip beside tip", "", "b", "c")));
  EXPECT_EQ(verdict_line(all), "1 not felt, 1 felt (x.2)");
  // One row for each threshold: its worst error.
  const Plot plot = verdict_plot(all);
  EXPECT_THAT(plot.y_names, ElementsAre("x.2"));
  EXPECT_THAT(plot.series[1].x, ElementsAre(testing::DoubleEq(1.5)));
}

TEST(Verdict, SaysWhatIsWrongWithTheThresholds) {
  EXPECT_EQ(refused_rows("x,any,absolute,1,1,1,-,-,-,-,mm,a,b,c\n"), "nothing");
  EXPECT_THAT(refused_rows("x,any,absolute,1,2,3,-,-,-,-,mm,a,b,c\n"),
              HasSubstr("row 1: expected 0 < least"));
  EXPECT_THAT(refused_rows("x,any,absolute,0,0,0,-,-,-,-,mm,a,b,c\n"), HasSubstr("expected 0 < least"));
  EXPECT_THAT(refused_rows("x,up,absolute,1,1,1,-,-,-,-,mm,a,b,c\n"), HasSubstr("sign 'up'; expected any"));
  EXPECT_THAT(refused_rows("x,any,share,7,5,10,-,1,12,0.1,N,a,b,c\n"), HasSubstr("expected a number"));
  EXPECT_THAT(refused_rows("x,any,sharp,1,1,1,-,-,-,-,mm,a,b,c\n"),
              HasSubstr("kind 'sharp'; expected absolute"));
}

// The shipped thresholds: each has a source, and the known figures meet the right one.
TEST(Verdict, TheShippedThresholdsAreComplete) {
  const std::vector<Threshold> all = load_thresholds(tests::source_dir() + "/models");
  for (const Threshold& t : all) {
    EXPECT_GT(t.compares.size(), 20U) << t.figure;
    EXPECT_TRUE(std::isnan(t.value) || t.source.size() > 10U) << t.figure;
  }
  const auto one = [&](const std::string& id, double twin, const char* unit) {
    const std::vector<Judged> j = judged({result_of(id, twin, unit)}, all);
    return j.empty() ? std::string("none") : std::string(felt_name(j.front().felt));
  };
  EXPECT_EQ(one("tracking.rmse.norm.0", 0.16, "mm"), "not felt");
  EXPECT_EQ(one("tracking.rmse.norm.40", 0.82, "mm"), "felt");
  EXPECT_EQ(one("tracking.from_20.rmse.norm.40", 0.82, "mm"), "none");
  EXPECT_EQ(one("synchrony.fused.mae_mm", 0.03, "mm"), "not felt");
  // There a lag above 0 is a view behind the haptics, which is told sooner than the other way round.
  EXPECT_EQ(one("synchrony.lag_ms", 40, "ms"), "in between");
  EXPECT_EQ(one("synchrony.lag_ms", -40, "ms"), "not felt");
  EXPECT_EQ(one("session.delay_ms.p50", 40, "ms"), "not felt");
  EXPECT_EQ(one("indentation.rmse.A.press", 0.09, "N"), "not felt");
  EXPECT_EQ(one("indentation.accuracy.rmse.A.press", 0.2, "N"), "in between");
  EXPECT_EQ(one("stiffness.error_percent.0.03.worst", 12, "%"), "in between");
  EXPECT_EQ(one("stiffness.error_percent.0.03.mean", 12, "%"), "none");
  EXPECT_EQ(one("deformation.contour.6.rms_mm", 2, "mm"), "not comparable");
  EXPECT_EQ(one("session.impact_N.p95", 2, "N"), "not comparable");
}

TEST(Verdict, StandsInEveryFormOfTheReport) {
  Report report;
  report.command = "./encounter bench";
  report.background.thresholds = of("x,any,absolute,0.4,0.3,0.5,-,-,-,-,mm,tip beside tip,b,c\n");
  add_result(report, result_of("x", 0.6, "mm"));
  const nlohmann::json json = nlohmann::json::parse(results_json(report));
  ASSERT_EQ(json["verdicts"].size(), 1U);
  EXPECT_EQ(json["verdicts"][0]["verdict"], "felt");
  EXPECT_DOUBLE_EQ(json["verdicts"][0]["over"], 1.5);
  EXPECT_TRUE(json["verdicts"][0]["paper"].is_null());
  EXPECT_THAT(report_html(report), AllOf(HasSubstr("<h2 id=\"verdict\">"), HasSubstr("tip beside tip")));
  EXPECT_THAT(report_markdown(report), HasSubstr("## Felt or not"));
}

}  // namespace
}  // namespace enc::bench
