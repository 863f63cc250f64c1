// The report: what it says about a figure, that text cannot break it, and that its plots are right. Felt or
// not: thresholds and verdicts on errors, computed by hand. Values printed in the papers.
#include "benchmarks/report/report.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "benchmarks/report/plot.h"
#include "benchmarks/tracking/table1.h"
#include "benchmarks/verdict/reference.h"
#include "benchmarks/verdict/verdict.h"
#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::bench {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string refused_table(const char* text) {
  try {
    const Reference table = Reference::parse(text, "t.csv");
    (void)table.number(table.row({{"a", "1"}}), "b");
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing";
}

TEST(Reference, ReadsCellsByTheirNames) {
  const Reference t = Reference::parse("# from\n# page 3\nspeed,axis,e_mm\n0,x,0.5\n20,y,1.5\r\n", "t.csv");
  EXPECT_EQ(t.rows(), 2U);
  EXPECT_EQ(t.source(), "from page 3");
  EXPECT_EQ(t.number(t.row({{"speed", "20"}, {"axis", "y"}}), "e_mm"), 1.5);
}

TEST(Reference, SaysWhatIsWrong) {
  EXPECT_EQ(refused_table("a,b\n1,2\n"), "nothing");
  EXPECT_THAT(refused_table("a,b\n1\n"), testing::StartsWith("t.csv:2:1: 1 cells; expected 2"));
  EXPECT_THAT(refused_table("a,b\n"), testing::HasSubstr("no rows"));
  EXPECT_THAT(refused_table("a,b\n1,x\n"), testing::HasSubstr("expected a number"));
  EXPECT_THAT(refused_table("a,b\n2,1\n"), testing::HasSubstr("no row with a '1'"));
  EXPECT_THAT(refused_table("a,c\n1,1\n"), testing::HasSubstr("no column 'b'"));
}

// The norms follow from their components, except the one that the paper has wrong.
TEST(Reference, TableOneAddsUp) {
  const tracking::Table1 paper =
      tracking::table1_of(Reference::load(tests::source_dir() + "/models", "table1.csv"));
  for (std::size_t s = 0; s < 3; ++s) {
    std::array<tracking::Cell, 4> column = paper[s];
    fill_norm(column);
    EXPECT_NEAR(column[3].rmse, paper[s][3].rmse, 0.0002e-3);
    EXPECT_NEAR(column[3].mae, paper[s][3].mae, s == 0 ? 0.0011e-3 : 0.0002e-3);
  }
}

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
  EXPECT_EQ(felt(0.3, t), Perception::no);
  EXPECT_EQ(felt(-0.4, t), Perception::between);
  EXPECT_EQ(felt(0.5, t), Perception::between);
  EXPECT_EQ(felt(-0.51, t), Perception::yes);
  EXPECT_EQ(felt(kUnset, t), Perception::not_comparable);
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
  EXPECT_EQ(one(30).felt, Perception::no);
  EXPECT_EQ(one(-30).threshold.compares, "early");
  EXPECT_EQ(one(-30).felt, Perception::between);
  EXPECT_DOUBLE_EQ(one(-30).over, 2.0);
}

TEST(Verdict, OfTheStrictestComparisonOnlyNotFeltFollows) {
  const Threshold t = of("x,any,strictest,0.4,0.3,0.5,-,-,-,-,mm,a,b,c\n").front();
  EXPECT_EQ(felt(0.2, t), Perception::no);
  EXPECT_EQ(felt(5.0, t), Perception::not_comparable);
}

TEST(Verdict, WhatHasNoThresholdIsNotThereAndWhatCannotBeComparedSaysSo) {
  const std::vector<Threshold> all = of("a.x,any,none,-,-,-,-,-,-,-,N,nobody has measured it,-,-\n");
  EXPECT_TRUE(judged({result_of("a.y", 1, "N")}, all).empty());
  EXPECT_TRUE(judged({result_of("a.x", 1, "mm")}, all).empty()) << "another unit is another quantity";
  EXPECT_TRUE(judged({result_of("a.x", kUnset, "N")}, all).empty());
  const std::vector<FigureVerdict> one = judged({result_of("a.x", 1, "N")}, all);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].felt, Perception::not_comparable);
  EXPECT_TRUE(verdict_plot(one).y_names.empty());
  EXPECT_EQ(verdict_line(one), "1 not comparable");
}

TEST(Verdict, ThePaperIsJudgedAsTheTwinIs) {
  const std::vector<Threshold> t = of("x.*,any,absolute,0.4,0.3,0.5,-,-,-,-,mm,tip beside tip,b,c\n");
  const std::vector<FigureVerdict> all =
      judged({result_of("x.1", 0.2, "mm", 0.8), result_of("x.2", 0.6, "mm")}, t);
  const Table table = verdict_table(all);
  EXPECT_THAT(table.rows[0],
              ElementsAre("x.1", "0.2", "mm", "0.4 (0.3 .. 0.5)", "0.5", "not felt", "0.8", "felt"));
  EXPECT_THAT(threshold_table(all).rows,
              ElementsAre(ElementsAre("x.*", "0.4 (0.3 .. 0.5)", "mm", "tip beside tip", "", "b", "c")));
  EXPECT_EQ(verdict_line(all), "1 not felt, 1 felt (x.2)");
  // The plot has one row for each threshold, with its worst error.
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
    const std::vector<FigureVerdict> j = judged({result_of(id, twin, unit)}, all);
    return j.empty() ? std::string("none") : std::string(felt_name(j.front().felt));
  };
  EXPECT_EQ(one("tracking.rmse.norm.0", 0.16, "mm"), "not felt");
  EXPECT_EQ(one("tracking.rmse.norm.40", 0.82, "mm"), "felt");
  EXPECT_EQ(one("tracking.from_20.rmse.norm.40", 0.82, "mm"), "none");
  EXPECT_EQ(one("synchrony.fused.mae_mm", 0.03, "mm"), "not felt");
  // A lag above 0 is a view behind the haptics, which people notice sooner than the reverse.
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

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t i = text.find(what); i != std::string::npos; i = text.find(what, i + 1)) ++n;
  return n;
}

Plot small_plot() {
  return {"press.demo",
          "It's <b> & more",
          "x (mm)",
          "y (N)",
          false,
          false,
          {{"twin", {1, 2, 3, 4}, {1, kUnset, 3, 5}, {0.5, kUnset, 2, 4}, {2, kUnset, 4, 6}, Mark::both},
           {"paper", {1, 4}, {1.5, 4.5}, {}, {}, Mark::points, true}},
          "What <i>to see</i>."};
}

// One calibrated figure within bounds, one predicted figure out of bounds, one of ours.
Report small_report() {
  Report report{"./encounter bench press --set 'a=<1>'", 7, {"a=<1>"}, {"press", "speed"}};
  report.background.contradictions = contradictions(tests::source_dir() + "/models");
  BenchResult result{"press", "tennis_ball", 2.5, 10.0, {}};
  result.figures = {{"press.a.mean", 0.2, 0.25, "mm", Role::calibrated, 0.1, 0.3, "a | b <c>", 0.24, 0.26},
                    {"press.b.max", 0.5, 0.4, "mm", Role::predicted, 0.45, kUnset, ""},
                    {"press.c.max", kUnset, 3.0, "N", Role::ours, kUnset, kUnset, ""}};
  result.figures.front().values = {0.24, 0.26};
  result.tables = {{"press.rows", "Rows", {"name", "value (mm)"}, {{"x, \"y\"", "1"}, {"z", "2"}}}};
  result.plots = {small_plot()};
  result.pictures = {{"press.seen", "Seen", "What the camera sees.", "Many"}};
  add_result(report, std::move(result));
  return report;
}

// Sets a PATH without gnuplot.
class NoGnuplot {
 public:
  NoGnuplot() : before_(std::getenv("PATH")) { setenv("PATH", "/nowhere", 1); }
  ~NoGnuplot() { setenv("PATH", before_.c_str(), 1); }
  NoGnuplot(const NoGnuplot&) = delete;
  NoGnuplot& operator=(const NoGnuplot&) = delete;

 private:
  const std::string before_;
};

TEST(ReportTable, GivesDifferenceIntervalAndVerdictOfAFigure) {
  const Table table = figure_table(small_report().results.front());
  EXPECT_THAT(table.columns, ElementsAre("figure", "holds", "paper", "twin", "unit", "bounds", "difference",
                                         "difference (%)", "least .. most", "role", "note"));
  EXPECT_THAT(table.rows[0], ElementsAre("press.a.mean", "yes", "0.2", "0.25", "mm", "0.1 .. 0.3", "+0.05",
                                         "+25.0", "0.24 .. 0.26", "calibrated", "a | b <c>"));
  EXPECT_THAT(table.rows[1], ElementsAre("press.b.max", "NO", "0.5", "0.4", "mm", "at least 0.45", "-0.1",
                                         "-20.0", "", "predicted", ""));
  EXPECT_THAT(table.rows[2], ElementsAre("press.c.max", "yes", "", "3", "N", "", "", "", "", "ours", ""));
}

TEST(ReportTable, LeavesOutColumnsInWhichNothingStands) {
  BenchResult result{
      "press", "tennis_ball", 1, 1, {{"press.c.max", kUnset, 3.0, "N", Role::ours, kUnset, kUnset, ""}}};
  EXPECT_THAT(figure_table(result).columns, ElementsAre("figure", "holds", "twin", "unit", "role"));
}

TEST(ReportTable, AFigureWithoutAValueDoesNotHold) {
  BenchResult result{
      "press", "tennis_ball", 1, 1, {{"press.c.max", 1.0, kUnset, "N", Role::ours, kUnset, kUnset, ""}}};
  const Table table = figure_table(result);
  EXPECT_THAT(table.rows[0], AllOf(Contains("absent"), Contains("NO")));
}

// On a real machine the ground truth is unknown: a figure that needs it is absent, which is no failure.
TEST(ReportTable, AFigureThatNobodyCanKnowIsAbsentAndNoFailure) {
  Report report = small_report();
  BenchResult& result = report.results.front();
  Figure absent{"press.d.max", kUnset, kUnset, "N", Role::ours, kUnset, kUnset, "of the truth alone"};
  EXPECT_FALSE(absent.ok());
  absent.absent = true;
  EXPECT_TRUE(absent.ok());
  result.figures.push_back(absent);
  const std::vector<std::string> row = figure_table(result).rows.back();
  EXPECT_THAT(row, AllOf(Contains("absent"), Not(Contains("NO")), Not(Contains("yes"))));
  EXPECT_THAT(report_html(report),
              AllOf(HasSubstr("data-column=\"twin\">absent</td>"), HasSubstr("1 out of bounds: press.b")));
  EXPECT_THAT(report_markdown(report), HasSubstr("| press.d.max |  |  | absent |"));
  EXPECT_THAT(role_table(report).rows.back(), ElementsAre("ours", "2", "1", "0", "0", "all others"));
  const auto json = nlohmann::json::parse(results_json(report));
  EXPECT_TRUE(json["benchmarks"][0]["figures"][3]["twin"].is_null());
  EXPECT_EQ(json["benchmarks"][0]["figures"][3]["ok"], true);
}

TEST(ReportProvenance, SaysFromWhichCommitAndWhen) {
  Report report = small_report();
  report.started = trial::WallTime(std::chrono::milliseconds(1'795'999'092'345));
  const auto json = nlohmann::json::parse(results_json(report));
  EXPECT_EQ(json["commit"], trial::built_commit().name);
  EXPECT_EQ(json["commit_date"], trial::built_commit().day);
  EXPECT_EQ(json["date"], "2026-11-30");
  EXPECT_EQ(json["started"], "2026-11-30T00:38:12.345Z");
  for (const std::string& text : {report_markdown(report), report_html(report)})
    EXPECT_THAT(text, AllOf(HasSubstr(", commit "), HasSubstr("2026-11-30T00:38:12.345Z")));
}

TEST(ReportTable, CountsWhatIsCalibratedAndWhatPredicted) {
  const Table table = role_table(small_report());
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("calibrated", "1", "1", "1", "0", "press.a.mean"),
                                      ElementsAre("predicted", "1", "0", "1", "0", "press.b.max"),
                                      ElementsAre("ours", "1", "1", "0", "0", "all others")));
}

TEST(ReportTable, ListsWhatIsPredictedBoundedAndThePapers) {
  Report report = small_report();
  EXPECT_THAT(predicted_table(report).rows,
              ElementsAre(ElementsAre("press.b.max", "0.5", "0.4", "mm", "at least 0.45", "", "")));
  std::vector<Figure>& figures = report.results.front().figures;
  figures[1].low = 0.3;
  figures[1].high = 0.45;
  const Table table = predicted_table(report);
  EXPECT_THAT(table.rows,
              ElementsAre(ElementsAre("press.b.max", "0.5", "0.4", "mm", "0.3 .. 0.45", "-0.1", "")));
  EXPECT_THAT(table.note, HasSubstr("1 figures, of which 1 miss the paper"));
  figures[1].low = figures[1].high = kUnset;
  EXPECT_TRUE(predicted_table(report).rows.empty());
}

// The bound holds, and it excludes the paper's value.
TEST(ReportTable, AFigureWhoseBoundsExcludeThePaperMissesIt) {
  Report report = small_report();
  Figure& f = report.results.front().figures.front();
  EXPECT_FALSE(misses(f));
  f.low = 0.24;
  EXPECT_TRUE(f.ok() && misses(f));
  EXPECT_EQ(figure_table(report.results.front()).rows[0][1], "yes, misses");
  EXPECT_THAT(role_table(report).rows[0],
              ElementsAre("calibrated", "1", "1", "1", "1", "press.a.mean (misses)"));
  EXPECT_THAT(report_html(report), HasSubstr("1 miss the paper: press.a.mean"));
  const auto json = nlohmann::json::parse(results_json(report));
  EXPECT_NEAR(json["benchmarks"][0]["figures"][0]["misses_by"], 0.05, 1e-12);
  EXPECT_TRUE(json["benchmarks"][0]["figures"][1]["misses_by"].is_null());
  f.twin = kUnset;
  EXPECT_FALSE(misses(f));
}

TEST(ReportHtml, IsOnePageWithItsPicturesAndWithoutScriptsOrLinksOut) {
  const std::string page = report_html(small_report());
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  EXPECT_EQ(count_of(page, "<svg"), 1U);
  EXPECT_EQ(count_of(page, "<?xml"), 0U);
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_EQ(count_of(page, "src="), 1U);
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,TWFueQ==\""));
  EXPECT_THAT(page, Not(HasSubstr("href=\"http")));
  EXPECT_THAT(page, HasSubstr("Missing: speed"));
  EXPECT_LT(page.find("<svg"), page.find("<table"));
}

TEST(ReportHtml, SaysFirstWhatDoesNotHold) {
  EXPECT_THAT(report_html(small_report()),
              HasSubstr("<dd>3, 2 of them with bounds; 1 out of bounds: press.b.max</dd>"));
}

TEST(ReportHtml, PlotsWithThePaperInThemComeFirst) {
  Report report = small_report();
  report.results[0].plots.insert(report.results[0].plots.begin(), small_plot());
  report.results[0].plots[0].id = "press.alone";
  report.results[0].plots[0].series.pop_back();
  const std::vector<const Plot*> plots = ordered_plots(report);
  ASSERT_EQ(plots.size(), 2U);
  EXPECT_EQ(plots[0]->id, "press.demo");
  EXPECT_EQ(plots[1]->id, "press.alone");
}

TEST(ReportHtml, TextIsText) {
  const std::string page = report_html(small_report());
  EXPECT_THAT(page, HasSubstr("a | b &lt;c&gt;"));
  EXPECT_THAT(page, HasSubstr("--set &#39;a=&lt;1&gt;&#39;"));
  EXPECT_THAT(page, HasSubstr("What &lt;i&gt;to see&lt;/i&gt;."));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
  EXPECT_THAT(page, Not(HasSubstr("<i>")));
}

TEST(ReportMarkdown, TextDoesNotBreakTheTable) {
  const std::string text = report_markdown(small_report());
  EXPECT_THAT(text, HasSubstr("| press.a.mean | yes | 0.2 | 0.25 | mm | 0.1 .. 0.3 | +0.05 | +25.0 | 0.24 .. "
                              "0.26 | calibrated | a \\| b &lt;c> |"));
  EXPECT_THAT(text, HasSubstr("(press.demo.svg)"));
  EXPECT_THAT(text, HasSubstr("- **Missing**: speed\n"));
  EXPECT_THAT(text, HasSubstr("Table 2, indentation A, release"));
}

// The form that other programs read [sources/choices 4], plus our additions.
TEST(ReportJson, KeepsItsForm) {
  const auto json = nlohmann::json::parse(results_json(small_report()));
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["missing"], nlohmann::json({"speed"}));
  EXPECT_EQ(json["contradictions"].size(), 6U);
  ASSERT_EQ(json["benchmarks"].size(), 1U);
  EXPECT_EQ(json["benchmarks"][0]["run_time_s"], 2.5);
  const auto& first = json["benchmarks"][0]["figures"][0];
  EXPECT_EQ(first["id"], "press.a.mean");
  EXPECT_EQ(first["paper"], 0.2);
  EXPECT_EQ(first["twin"], 0.25);
  EXPECT_EQ(first["role"], "calibrated");
  EXPECT_EQ(first["low"], 0.1);
  EXPECT_EQ(first["high"], 0.3);
  EXPECT_EQ(first["ok"], true);
  EXPECT_EQ(first["least"], 0.24);
  EXPECT_EQ(first["values"], nlohmann::json({0.24, 0.26}));
  const auto& second = json["benchmarks"][0]["figures"][1];
  EXPECT_TRUE(second["high"].is_null());
  EXPECT_EQ(second["values"], nlohmann::json::array());
  EXPECT_EQ(second["ok"], false);
  EXPECT_TRUE(json["benchmarks"][0]["figures"][2]["paper"].is_null());
}

TEST(ReportFiles, AreAllThereAndNothingElse) {
  const test::TemporaryFolder folder;
  write_report(folder.file("out"), small_report());
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path() / "out"))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("REPORT.md", "report.html", "results.json", "press.csv",
                                                     "press.rows.csv", "press.demo.plot.csv",
                                                     "press.demo.svg", "press.seen.png"));
  EXPECT_EQ(bytes_of(folder.path() / "out/press.rows.csv"), "name,value (mm)\n\"x, \"\"y\"\"\",1\nz,2\n");
  EXPECT_EQ(bytes_of(folder.path() / "out/press.demo.plot.csv"),
            "series,paper,x,y,low,high\ntwin,0,1,1,0.5,2\ntwin,0,2,,,\ntwin,0,3,3,2,4\ntwin,0,4,5,4,6\n"
            "paper,1,1,1.5,,\npaper,1,4,4.5,,\n");
}

TEST(ReportFiles, WithoutGnuplotTheTablesStillCome) {
  const NoGnuplot none;
  const test::TemporaryFolder folder;
  const Report report = small_report();
  EXPECT_THAT(report.not_drawn, HasSubstr("gnuplot-nox"));
  write_report(folder.file("out"), report);
  EXPECT_FALSE(fs::exists(folder.path() / "out/press.demo.svg"));
  EXPECT_TRUE(fs::exists(folder.path() / "out/press.demo.plot.csv"));
  const std::string page = bytes_of(folder.path() / "out/report.html");
  EXPECT_THAT(page, AllOf(HasSubstr("gnuplot-nox"), HasSubstr("press.a.mean"), Not(HasSubstr("<svg"))));
  EXPECT_THAT(bytes_of(folder.path() / "out/REPORT.md"), Not(HasSubstr("(press.demo.svg)")));
}

TEST(ReportFiles, AFolderThatCannotBeMadeIsRefused) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.file("file")) << "x";
  EXPECT_THROW(write_report(folder.file("file/out"), small_report()), Error);
}

TEST(Plot, GivesTheDataWithItsGapsAndTheBarsOfWhatVaries) {
  const std::string script = plot_script(small_plot());
  EXPECT_THAT(script, HasSubstr("$d0 << EOD\n1 1 0.5 2\n2 NaN NaN NaN\n3 3 2 4\n4 5 4 6\nEOD\n"));
  EXPECT_THAT(script, HasSubstr("$d0 using 1:3:(0):($4-$3) with vectors heads"));
  EXPECT_THAT(script, Not(HasSubstr("$d1 using 1:3")));  // the paper's values have no interval
  EXPECT_THAT(script, HasSubstr("$d1 using 1:2 with points lc rgb '#000000' pt 6"));
}

TEST(Plot, TextIsNeverACommand) {
  Plot plot = small_plot();
  plot.title = "'; system('touch gone')\nquit `id`";
  EXPECT_THAT(plot_script(plot), HasSubstr("set title '''; system(''touch gone'') quit `id`'\n"));
}

TEST(Plot, WhatALogarithmicAxisCannotShowIsAGapAndABarEndsAtTheEdge) {
  Plot plot = small_plot();
  plot.log_y = true;
  plot.series[0].y = {-1, 0, 3, 5};
  plot.series[0].low = {-2, -1, -1, 4};
  EXPECT_THAT(plot_script(plot), HasSubstr("1 NaN 1.5 2\n2 NaN 1.5 NaN\n3 3 1.5 4\n4 5 4 6\n"));
}

TEST(Plot, WhatFailedStandsAtTheUpperEdgeInTheColourOfItsSeries) {
  Plot plot = small_plot();
  plot.series.insert(plot.series.begin() + 1, {"unstable", {5, 6}, {kUnset, kUnset}, {}, {}, Mark::crosses});
  EXPECT_THAT(plot_script(plot),
              HasSubstr("$d1 using 1:(0.975) axes x1y2 with points lc rgb '#0072B2' pt 2"));
}

TEST(Plot, BarsOfOnePlaceStandSideBySide) {
  Plot plot{
      "press.bars",
      "",
      "",
      "",
      false,
      false,
      {{"paper", {0, 1}, {1, 2}, {}, {}, Mark::bars, true}, {"twin", {0, 1}, {1, 2}, {}, {}, Mark::bars}},
      "",
      {"x", "norm"}};
  const std::string script = plot_script(plot);
  EXPECT_THAT(script, HasSubstr("set xtics ('x' 0, 'norm' 1)"));
  EXPECT_THAT(script, HasSubstr("set boxwidth 0.4\n"));
  EXPECT_THAT(script, HasSubstr("-0.2 1 NaN NaN\n0.8 2 NaN NaN\n"));
  EXPECT_THAT(script, HasSubstr("0.2 1 NaN NaN\n1.2 2 NaN NaN\n"));

  Plot crowded = plot;
  for (int i = 0; i < 8; ++i) crowded.x_names.emplace_back("a long name");
  EXPECT_THAT(plot_script(crowded), HasSubstr("set xtics rotate by 30 right ('x' 0"));
}

// Gnuplot accepts every kind of mark, gaps, all failed, and an empty plot.
TEST(Plot, IsDrawn) {
  std::vector<Plot> plots{small_plot(), {"press.none", "", "", "", true, true, {}}};
  for (const Mark mark : {Mark::line, Mark::points, Mark::both, Mark::bars, Mark::band, Mark::crosses})
    for (const bool paper : {false, true}) {
      Plot plot = small_plot();
      plot.series[0].mark = mark;
      plot.series[0].paper = paper;
      plots.push_back(plot);
      plot.log_x = plot.log_y = true;
      plot.equal = true;
      plots.push_back(plot);
      plot.series.pop_back();
      plot.series[0].y = {kUnset, kUnset, kUnset, kUnset};
      plots.push_back(plot);
    }
  for (const Plot& plot : plots) {
    const Drawing drawing = draw(plot);
    EXPECT_EQ(drawing.why_not, "") << plot_script(plot);
    EXPECT_THAT(drawing.svg, HasSubstr("</svg>"));
  }
}

// Small multiples share one legend; a name looks alike in each panel, and fields end half-way to their
// neighbours.
TEST(Plot, PanelsShareAxesLegendAndLooks) {
  Plot plot{.id = "press.map", .title = "map", .x_label = "x", .y_label = "y", .log_y = true};
  plot.panels = {"one plot a", "two", "three"};
  plot.columns = 2;
  plot.x_names = {"0", "1"};
  for (std::size_t panel = 0; panel < 3; ++panel) {
    plot.series.push_back({.name = "rests", .x = {0, 1}, .y = {1, 100}, .mark = Mark::cells, .panel = panel});
    if (panel != 1) plot.series.push_back({.name = "first", .x = {0, 1}, .y = {1, 9}, .panel = panel});
    plot.series.push_back({.name = "second", .x = {0, 1}, .y = {2, 8}, .panel = panel});
  }
  const std::string script = plot_script(plot);
  EXPECT_THAT(script, HasSubstr("0 1 -0.5 0.5 0.1 10\n1 100 0.5 1.5 10 1000\n"));
  std::size_t looks = 0;  // a line in each panel and one in the legend
  for (std::size_t at = 0; (at = script.find("lc rgb '#D55E00'", at)) != std::string::npos; ++at) ++looks;
  EXPECT_EQ(looks, 4U);
  const Drawing drawing = draw(plot);
  EXPECT_EQ(drawing.why_not, "") << script;
  for (const char* text : {"one plot a", "three", "second"}) EXPECT_THAT(drawing.svg, HasSubstr(text));
  EXPECT_THAT(plot_csv(plot), StartsWith("panel,series,paper,x,y,low,high\none plot a,rests,0,0,1,,\n"));
}

TEST(Plot, InAPageNoTwoDrawingsShareAName) {
  const std::string svg = draw(small_plot()).svg;
  const std::string page = svg_for_page(svg, "press.demo");
  EXPECT_THAT(page, StartsWith("<svg"));
  EXPECT_THAT(page, Not(HasSubstr("='gpPt")));
  EXPECT_THAT(page, Not(HasSubstr("#gpPt")));
  EXPECT_THAT(page, HasSubstr("id='press_demo_gpPt6'"));
  EXPECT_THAT(page, HasSubstr("#press_demo_gpPt6"));
}

TEST(Contradictions, AreFoundInThePrintedNumbers) {
  const std::vector<Contradiction> all = contradictions(tests::source_dir() + "/models");
  std::vector<std::string> ids;
  for (const Contradiction& c : all) ids.push_back(c.id);
  // Table 1 has six norms and Table 2 six cells; only these are wrong.
  ASSERT_THAT(ids, ElementsAre("table1.MAE.norm.0", "table2.A.release", "table2.B.release", "fig14.item10",
                               "vishap.step5", "vishap.step7"));
  EXPECT_EQ(all[0].found, "their norm is 0.1569 mm");
  EXPECT_THAT(all[0].printed, HasSubstr("0.1579"));
  EXPECT_THAT(all[1].found, AllOf(HasSubstr("impossible"), HasSubstr("2.42 times")));
  // 2 (0.0056 / 0.1370)^2 = 0.334 %; 0.1370^2 / (2 0.0056) = 1.68 N
  EXPECT_THAT(all[2].found, AllOf(HasSubstr("0.33 %"), HasSubstr("1.7 N"), HasSubstr("|mean error|")));
  EXPECT_EQ(all[3].found, "these answers have the mean 6.0");
  EXPECT_THAT(all[4].found, HasSubstr("chooses nothing"));
  EXPECT_THAT(all[5].found, HasSubstr("always less than 2 r2"));
}

}  // namespace
}  // namespace enc::bench
