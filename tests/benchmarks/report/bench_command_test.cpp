// `bench` as a person calls it: its arguments, its refusals and the output of a stopped run. Also which
// figures of a run differ from those in the repository.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "benchmarks/commands/committed_results.h"
#include "benchmarks/report/choice.h"
#include "core/base/error.h"
#include "models/student.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::bench {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::StartsWith;
using tests::module_folder;
using tests::program_file;
using tests::Result;
using tests::run;
using tests::run_program;

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

// Sections 4.1, 2 and 4.2 to 5 of the paper, as far as this program reproduces them.
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

// Benchmarks that --set cannot change refuse it by name instead of ignoring it.
TEST(Choice, WhatReadsNoSceneTakesNoSettings) {
  const std::string models = tests::source_dir() + "/models";
  const std::vector<std::string> rate{"rig.loop.rate_hz=1000"};
  std::vector<std::string> left;
  EXPECT_THAT(names_of(settable(chosen({"press", "registration"}), rate, true, models, left)),
              ElementsAre("press", "registration"));
  try {
    (void)settable(chosen({"press", "nearest", "footprint.wall"}), rate, true, models, left);
    ADD_FAILURE() << "not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("--set: nearest, footprint read no scene"));
  }
  left.clear();
  const std::size_t kept = settable(chosen({}), rate, false, models, left).size();
  EXPECT_EQ(kept + left.size(), benchmarks().size());
  EXPECT_THAT(left, IsSupersetOf({"footprint", "deformation", "nearest"}));
}

// Over devices only benchmarks that need no ground truth can run; the command refuses a named one that
// cannot.
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

const CommittedResults& kept() {
  static const CommittedResults kAll = CommittedResults::parse(
      "# Figures.\nid,unit,value,least,most,low,high,commit\n"
      "x.median,N,2,1.5,2.5,,,1a2b3c4\n"
      "x.single,N,2,,,,,1a2b3c4\n"
      "x.rounding,px,8e-15,,,,0.5,1a2b3c4\n"
      "x.none,N,,,,,,1a2b3c4\n",
      "figures.csv");
  return kAll;
}
Figure figure_of(const std::string& id, double value) {
  Figure figure;
  figure.id = id;
  figure.twin = value;
  return figure;
}
bool differs(const std::string& id, double value, double least = kUnset, double most = kUnset,
             double high = kUnset) {
  Figure figure = figure_of(id, value);
  figure.high = high;
  figure.least = least;
  figure.most = most;
  return kept().differs(figure);
}

TEST(Committed, WithinTheSpreadOfEitherRunNothingDiffers) {
  EXPECT_FALSE(differs("x.median", 2.4)) << "of the file";
  EXPECT_TRUE(differs("x.median", 2.6));
  EXPECT_FALSE(differs("x.median", 2.6, 1.9, 3.0)) << "of this run";
  EXPECT_TRUE(differs("x.median", 2.6, 2.55, 2.65));
}

TEST(Committed, ASingleValueDiffersByMoreThanItsFourDigits) {
  EXPECT_FALSE(differs("x.single", 2.001));
  EXPECT_TRUE(differs("x.single", 2.01));
  EXPECT_FALSE(differs("x.rounding", 3e-15, kUnset, kUnset, 0.5)) << "far below its bound";
}

TEST(Committed, AValueThatIsNewlyThereOrGoneDiffers) {
  EXPECT_TRUE(differs("x.none", 1.0));
  EXPECT_FALSE(differs("x.none", kUnset));
  EXPECT_TRUE(differs("x.single", kUnset));
}

TEST(Committed, WhatHasNoCounterpartAndWhatHangsOnTheMachineNeverDiffers) {
  EXPECT_FALSE(differs("x.new", 1.0));
  Figure cost = figure_of("x.single", 20.0);
  cost.cost = true;
  EXPECT_FALSE(kept().differs(cost));
  Figure absent = figure_of("x.single", kUnset);
  absent.absent = true;
  EXPECT_FALSE(kept().differs(absent));
}

using Json = nlohmann::json;

TEST(Bench, ListSaysWhatThereIs) {
  const Result r = run_program({"bench", "--list"});
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.out, AllOf(HasSubstr("\nencounter "), HasSubstr("\npaper-2020 "), HasSubstr("\nspeed ")));
}

// A refusal is one line, and no benchmark runs.
std::string refused(std::vector<std::string> words) {
  words.insert(words.begin(), "bench");
  const Result r = run_program(words);
  EXPECT_EQ(r.code, 2) << r.err;
  EXPECT_EQ(r.out, "") << "something ran";
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  EXPECT_THAT(r.err, testing::StartsWith("encounter: "));
  return r.err;
}

// The counterpart of Footprint.TheProgramHoldsNoBenchmark: this file must contain the name.
TEST(Bench, TheModuleHoldsThem) {
  std::ifstream in(module_folder() + "/encounter_bench.so", std::ios::binary);
  const std::string module((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(module.find("3enc5bench"), std::string::npos);
}

// A user's own driver folder does not hide the modules of the program.
TEST(Bench, IsFoundWhereverDriversAre) {
  const Result r = run_program({"bench", "--list"}, {{"ENCOUNTER_MODULES", "/nowhere"}});
  EXPECT_EQ(r.code, 0) << r.err;
}

TEST(Bench, WhatIsWrongIsSaidBeforeAnythingRuns) {
  EXPECT_THAT(refused({"encountr"}), AllOf(HasSubstr("'encountr'"), HasSubstr("encounter")));
  EXPECT_THAT(refused({"encounter", "--repeats=-1"}), HasSubstr("--repeats"));
  EXPECT_THAT(refused({"encounter", "--repeats=0"}), HasSubstr("--repeats"));
  EXPECT_THAT(refused({"encounter", "--repeats=1", "--set", "user.dpth_mm=1"}), HasSubstr("depth_mm"));
  EXPECT_THAT(refused({"nearest", "--quick", "--set", "rig.vision.tile_px=3"}),
              HasSubstr("--set: nearest reads no scene that it could change"));
  EXPECT_THAT(
      refused({"deformation", "--set", "truth.ball.wall_mm=9"}),
      HasSubstr("deformation reads no parameter 'truth.ball.wall_mm'; expected one that it reads; the "
                "closest is 'object.ball.radius_mm'"));
  EXPECT_THAT(refused({"deformation", "--json"}), HasSubstr("--mutate"));
  EXPECT_THAT(refused({"deformation", "--mutate", "--quick"}), HasSubstr("--quick has no meaning"));
}

// A file stands in place of the folder. The command reports this before the benchmark runs, because its
// minutes would be lost.
TEST(Bench, AFolderThatCannotBeWrittenIsSaidBeforeAnythingRuns) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "file").string();
  std::ofstream(file) << "";
  EXPECT_THAT(refused({"encounter", "--repeats=1", "--out", file + "/results"}),
              HasSubstr(file + "/results"));
}

TEST(Bench, AnUnknownNameIsAnsweredWithTheNearest) {
  const Result r = run_program({"bench", "dent", "strcture"});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(r.out, "");
  EXPECT_THAT(r.err, HasSubstr("unknown benchmark 'strcture'; did you mean 'structure'?"));
}

TEST(Bench, AnUnknownFigureIsAnsweredWithTheNearest) {
  const Result r = run_program({"bench", "dent.volume_chang.2mm", "--quick"});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(r.out, "");
  EXPECT_THAT(r.err, AllOf(HasSubstr("unknown figure 'dent.volume_chang.2mm'"),
                           HasSubstr("'dent.volume_change.2mm.value'")));
}

TEST(Bench, AFigureIsPrintedAlone) {
  const Result r = run_program({"bench", "dent.volume_change", "--quick"});
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("dent.volume_change.6mm.value"), Not(HasSubstr("contact_error"))));
}

TEST(Bench, QuickAndFullExcludeEachOther) {
  EXPECT_EQ(run_program({"bench", "dent", "--quick", "--full"}).code, 2);
}

TEST(Bench, AFolderThatCannotBeWrittenIsRefusedBeforeTheRun) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.file("file")) << "x";
  const Result r = run_program({"bench", "dent", "--quick", "--out", folder.file("file/out")});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(r.out, "");
  EXPECT_THAT(r.err, HasSubstr("file/out: cannot be made"));
}

TEST(Bench, AFolderOfOtherThingsStaysAsItIs) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.file("REPORT.md")) << "mine";
  const std::vector<std::string> args{"bench", "dent.volume_change", "--quick", "--out",
                                      folder.path().string()};
  const Result r = run_program(args);
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, AllOf(HasSubstr("holds other files"), HasSubstr("--force")));
  EXPECT_EQ(bytes_of(folder.path() / "REPORT.md"), "mine");
  std::vector<std::string> forced = args;
  forced.emplace_back("--force");
  EXPECT_EQ(run_program(forced).code, 0);
  EXPECT_EQ(run_program(args).code, 0);  // a folder of its own now
}

TEST(Bench, WithoutGnuplotItSaysSoInOneLine) {
  const test::TemporaryFolder folder;
  const Result r =
      run_program({"bench", "encounter", "--repeats=1", "--out", folder.file("out")}, {{"PATH", "/nowhere"}});
  EXPECT_THAT(r.err, HasSubstr("encounter: not drawn: gnuplot is missing"));
  EXPECT_THAT(bytes_of(folder.path() / "out/encounter.csv"), HasSubstr("encounter.miss.10.median"));
}

// The line of a figure that has a value for each seed agrees with the values in results.json.
TEST(Bench, RepeatsPrintTheirStatistics) {
  const test::TemporaryFolder folder;
  const Result r = run_program({"bench", "encounter", "--repeats=3", "--out", folder.file("out")});
  const auto json = nlohmann::json::parse(bytes_of(folder.path() / "out/results.json"));
  const auto& figures = json["benchmarks"][0]["figures"];
  const auto figure = std::find_if(figures.begin(), figures.end(),
                                   [](const auto& one) { return one["id"] == "encounter.miss.10.median"; });
  ASSERT_NE(figure, figures.end());
  const auto values = (*figure)["values"].get<std::vector<double>>();
  ASSERT_EQ(values.size(), 3U);
  EXPECT_EQ(*std::min_element(values.begin(), values.end()), (*figure)["least"].get<double>());
  const double mean = (values[0] + values[1] + values[2]) / 3.0;
  double squares = 0.0;
  for (const double x : values) squares += (x - mean) * (x - mean);
  const double sd = std::sqrt(squares / 2.0), half = models::student(2.0) * sd / std::sqrt(3.0);
  EXPECT_THAT(r.out,
              HasSubstr(fmt::format("\n    n 3, mean {:.4g}, SD {:.3g}, 95 % interval {:.4g} to {:.4g}\n",
                                    mean, sd, mean - half, mean + half)));
  EXPECT_EQ(run_program({"bench", "encounter", "--repeats=1"}).out.find("    n "), std::string::npos);
}

// The same seed gives the same figures to the last digit, also on all cores; an override changes them.
TEST(Bench, FiguresFollowFromSeedAndOverridesAlone) {
  const test::TemporaryFolder folder;
  const auto figures = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"bench", "encounter", "--repeats=1", "--out", folder.file("out")});
    run_program(more);
    return bytes_of(folder.path() / "out/encounter.csv") + bytes_of(folder.path() / "out/encounter.miss.svg");
  };
  const std::string first = figures({});
  EXPECT_THAT(first, HasSubstr("</svg>"));
  EXPECT_EQ(figures({}), first);
  EXPECT_NE(figures({"--seed", "2"}), first);
  EXPECT_NE(figures({"--set", "truth.tracker.bias_mm=[0,0,0.3]"}), first);
  EXPECT_THAT(bytes_of(folder.path() / "out/report.html"), HasSubstr("truth.tracker.bias_mm=[0,0,0.3]"));
}

// A busy machine must not put a figure out of bounds: durations are bounded only as ratios.
TEST(Bench, NoTimeOfTheMachineIsBounded) {
  const test::TemporaryFolder folder;
  const Result r = run_program(
      {"bench", "speed", "switching", "gravity", "nearest", "--quick", "--out", folder.file("out")});
  EXPECT_THAT(r.code, AnyOf(0, 1)) << r.err;
  const Json json = Json::parse(bytes_of(folder.path() / "out/results.json"));
  int times = 0;
  for (const Json& benchmark : json["benchmarks"])
    for (const Json& figure : benchmark["figures"]) {
      if (figure["unit"] != "us" && figure["unit"] != "ns") continue;
      ++times;
      EXPECT_TRUE(figure["low"].is_null() && figure["high"].is_null()) << figure["id"];
    }
  EXPECT_GT(times, 5);
}

// The last line names what failed, because the rest may have scrolled away.
TEST(Bench, WhatFellShortIsNamedAtTheEnd) {
  const Result r = run_program({"bench", "encounter", "--repeats=1", "--set", "truth.hexapod.servo_hz=1e-6"});
  EXPECT_EQ(r.code, 1) << r.err;
  const std::string last = r.out.substr(r.out.rfind('\n', r.out.size() - 2) + 1);
  EXPECT_THAT(last, AllOf(StartsWith("out of bounds: "), HasSubstr("encounter.")));
}

// Stopped when the first benchmark is complete, in the middle of the second, which would take minutes.
class StoppedBench : public ::testing::TestWithParam<int> {};

TEST_P(StoppedBench, LeavesWhatIsCompleteAndSaysWhatIsMissing) {
  const test::TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  // Job control is on; otherwise the shell would make its child ignore SIGINT.
  const Result r =
      run({"bash", "-c",
           "set -m; \"$1\" bench dent press --repeats 1000000 --out \"$2\" & until grep -q dent.contact "
           "\"$2/results.json\" 2>/dev/null; do sleep 0.05; done; kill -$3 $!; wait $!",
           "bash", program_file(), out.string(), std::to_string(GetParam())});
  const bool asked = GetParam() != SIGKILL;
  EXPECT_EQ(r.code, 128 + GetParam()) << r.err;
  if (asked) {
    EXPECT_THAT(r.err, HasSubstr("interrupted; 1 of 2 benchmarks complete, missing: press\n"));
  }
  const Json json = Json::parse(bytes_of(out / "results.json"));
  ASSERT_EQ(json["benchmarks"].size(), 1U);
  EXPECT_EQ(json["benchmarks"][0]["name"], "dent");
  EXPECT_THAT(json["benchmarks"][0]["figures"], Not(IsEmpty()));
  EXPECT_EQ(json["missing"], Json({"press"}));
  EXPECT_THAT(bytes_of(out / "report.html"), AllOf(HasSubstr("Missing: press"), EndsWith("</html>\n")));
  EXPECT_THAT(bytes_of(out / "REPORT.md"),
              AllOf(HasSubstr("- **Missing**: press\n"), Not(HasSubstr("all hold"))));
  EXPECT_TRUE(fs::exists(out / "dent.csv"));
  EXPECT_FALSE(fs::exists(out / "press.csv"));
}

// A good report is worth more than an empty one.
TEST(Bench, ARunWithoutABenchmarkLeavesTheReportThatIsThere) {
  const test::TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  // None of its figures depends on the processor's speed.
  ASSERT_EQ(run_program({"bench", "deformation", "--quick", "--out", out}).code, 0);
  const std::string before = bytes_of(folder.path() / "out" / "results.json");
  const Result r =
      run({"bash", "-c",
           "set -m; \"$1\" bench press --repeats 1000000 --out \"$2\" & sleep 1; kill -INT $!; wait $!",
           "bash", program_file(), out});
  EXPECT_EQ(r.code, 130) << r.err;
  EXPECT_EQ(bytes_of(folder.path() / "out" / "results.json"), before);
  EXPECT_THAT(bytes_of(folder.path() / "out" / "REPORT.md"), HasSubstr("all hold"));
}

INSTANTIATE_TEST_SUITE_P(By, StoppedBench, ::testing::Values(SIGINT, SIGTERM, SIGKILL));

}  // namespace
}  // namespace enc::bench
