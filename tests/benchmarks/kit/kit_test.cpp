// What benchmarks are written with: the table, figures, grids, plots.
#include "benchmarks/kit/kit.h"

#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::bench {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsNan;
using ::testing::SizeIs;

BenchContext context_of(std::uint64_t seed = 1) {
  BenchContext context;
  context.models = tests::source_dir() + "/models";
  context.seed = seed;
  return context;
}

constexpr Benchmark kMade{"made", "tennis_ball", "for these tests", nullptr};

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// What the build leaves out where vision was not built: "|segmentation|fingertip|...|".
std::string through_a_camera() {
  const std::string text = text_of(tests::source_dir() + "/cmake/benchmarks.cmake"), before = "\"/(";
  const std::size_t from = text.find(before) + before.size();
  return "|" + text.substr(from, text.find(")$\"", from) - from) + "|";
}

// By name and folder: those with a line of their own for the table.
std::vector<std::string> written(bool with_camera) {
  const std::string cameras = through_a_camera();
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(tests::source_dir() + "/benchmarks")) {
    const std::string name = entry.path().filename().string();
    const bool camera = cameras.find("|" + name + "|") != std::string::npos;
    if (text_of(entry.path() / (name + ".cpp")).find("\nconst Entry kEntry{") != std::string::npos &&
        (with_camera || !camera))
      names.insert(name);
  }
  return {names.begin(), names.end()};
}

TEST(Table, HoldsEachBenchmarkOnceByName) {
  std::vector<std::string> names;
  bool camera = false;
  for (const Benchmark& b : benchmarks()) {
    names.emplace_back(b.name);
    camera = camera || std::string(b.scene) == "camera";
  }
  EXPECT_THAT(names, SizeIs(::testing::Ge(22U)));
  EXPECT_EQ(names, written(camera));
}

TEST(Table, IsWholeInTheProgram) {
  const tests::Result list = tests::run_program({"bench", "--list"});
  ASSERT_EQ(list.code, 0) << list.err;
  for (const Benchmark& b : benchmarks()) EXPECT_THAT(list.out, HasSubstr(std::string(b.name) + " "));
}

TEST(Table, EachIsHandedItsNameAndScene) {
  const Benchmark benchmark{"made", "wall", "", [](Bench& bench) {
                              bench.figure("seed", static_cast<double>(bench.context.seed), "");
                            }};
  const BenchResult result = result_of(benchmark, context_of(7));
  EXPECT_EQ(result.name, "made");
  EXPECT_EQ(result.scene, "wall");
  ASSERT_THAT(result.figures, SizeIs(1));
  EXPECT_EQ(result.figures[0].id, "made.seed");
  EXPECT_EQ(result.figures[0].twin, 7.0);
}

TEST(Kit, AFigureIsOneLine) {
  const BenchContext context = context_of();
  Bench bench(kMade, context);
  bench.figure("plain", 2.0, "mm", "why");
  bench.figure("bounded", Value{2.0, 1.0, 4.0} * 10.0, "mm", at_most(19.0));
  bench.figure("paper", 2.0, "mm", predicted(2.5), between(1.5, 3.0), "as printed");
  bench.figure("fit", 2.0, "mm", calibrated(2.0), exactly(2.0));
  const std::vector<Figure>& all = bench.result.figures;
  ASSERT_THAT(all, SizeIs(4));
  EXPECT_EQ(all[0].id, "made.plain");
  EXPECT_EQ(all[0].note, "why");
  EXPECT_EQ(all[0].role, Role::ours);
  EXPECT_THAT((std::array{all[0].paper, all[0].low, all[0].high, all[0].least, all[0].most}),
              ::testing::Each(IsNan()));
  EXPECT_THAT((std::array{all[1].twin, all[1].least, all[1].most, all[1].high}),
              ElementsAre(20.0, 10.0, 40.0, 19.0));
  EXPECT_THAT(all[1].low, IsNan());
  EXPECT_FALSE(all[1].ok());
  EXPECT_THAT((std::array{all[2].paper, all[2].low, all[2].high}), ElementsAre(2.5, 1.5, 3.0));
  EXPECT_EQ(all[2].role, Role::predicted);
  EXPECT_EQ(all[3].role, Role::calibrated);
  EXPECT_TRUE(all[3].ok());
}

TEST(Kit, AGridIsInItsOrderWhoeverWasFaster) {
  struct Cell {
    double value = 0.0;
    std::uint64_t seed = 0;
    double simulated = 0.0;
  };
  const BenchContext context = context_of(11);
  Bench bench(kMade, context);
  const std::array<double, 3> values{0.5, 0.25, 2.0};
  const auto cells = bench.grid(values, 4, [](double v, std::uint64_t seed) { return Cell{v, seed, 1.5}; });
  ASSERT_THAT(cells, SizeIs(3));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ASSERT_THAT(cells[i], SizeIs(4));
    for (std::size_t s = 0; s < 4; ++s) {
      EXPECT_EQ(cells[i][s].value, values[i]);
      EXPECT_EQ(cells[i][s].seed, 11 + s);
    }
  }
  EXPECT_DOUBLE_EQ(bench.result.simulated, 3 * 4 * 1.5);
}

TEST(Kit, TheFirstPartTellsHowFarItIs) {
  std::atomic<int> told{0};
  BenchContext context = context_of();
  context.progress = [&](double) { ++told; };
  Bench bench(kMade, context);
  const auto twice = [](std::uint64_t x) { return 2 * x; };
  EXPECT_THAT(bench.each(bench.seeds(3), twice), ElementsAre(2, 4, 6));
  EXPECT_EQ(told, 3);
  (void)bench.each(bench.seeds(3), twice);
  EXPECT_EQ(told, 3);
  bench.progress(1.0);
  EXPECT_EQ(told, 4);
}

TEST(Kit, TheUserSaysHowManyElseTheBenchmark) {
  BenchContext context;
  EXPECT_EQ(context.count(40, 5), 40U);
  context.quick = true;
  EXPECT_EQ(context.count(40, 5), 5U);
  context.repeats = 3;
  EXPECT_EQ(context.count(40, 5), 3U);
}

TEST(Kit, TheUsersSettingsReachItsScene) {
  BenchContext context = context_of();
  context.set = {"object.ball.radius_mm=30"};
  const Bench bench(kMade, context);
  EXPECT_DOUBLE_EQ(bench.setup({"object.ball.radius_mm=20"}).scene.objects.front().radius, 0.030);
  EXPECT_DOUBLE_EQ(bench.setup({}, {"object.ball.radius_mm=20"}).scene.objects.front().radius, 0.020);
}

TEST(Kit, TheMedianHasItsRangeAndGapsAreLeftOut) {
  struct Cell {
    double miss = kUnset;
  };
  EXPECT_THAT(known(std::vector<Cell>{{3.0}, {}, {1.0}}, &Cell::miss), ElementsAre(3.0, 1.0));
  const Value middle = median_of({5.0, 1.0, 2.0});
  EXPECT_THAT((std::array{middle.middle, middle.least, middle.most}), ElementsAre(2.0, 1.0, 5.0));
  EXPECT_THAT(median_of({}).middle, IsNan());
}

TEST(Kit, PointsKeepTheirBars) {
  Series line;
  line.add(1.0, 2.0);
  EXPECT_THAT(line.low, IsEmpty());
  Series bars;
  bars.add(1.0, {2.0, 1.0, 3.0});
  bars.add(2.0, median_of({}));
  EXPECT_THAT(bars.y, ElementsAre(2.0, IsNan()));
  EXPECT_THAT(bars.low, ElementsAre(1.0, IsNan()));
  EXPECT_THAT(bars.high, ElementsAre(3.0, IsNan()));
}

TEST(Kit, PlotsAndTablesBeginWithTheBenchmark) {
  const BenchContext context = context_of();
  Bench bench(kMade, context);
  bench.plot({.id = "miss", .title = "Miss", .x_label = "x (mm)", .y_label = "y (mm)", .log_x = true});
  Table table{"rows", "Rows", {"name", "count", "value (mm)"}};
  table.add("a", 3, 0.5);
  bench.table(table);
  EXPECT_EQ(bench.result.plots.at(0).id, "made.miss");
  EXPECT_TRUE(bench.result.plots.at(0).log_x);
  EXPECT_EQ(bench.result.tables.at(0).id, "made.rows");
  EXPECT_THAT(bench.result.tables.at(0).rows.at(0), ElementsAre("a", "3", "0.5"));
}

TEST(Kit, ATailOfTooFewValuesIsTheLargest) {
  std::vector<double> values{5.0, 1.0, 4.0};
  EXPECT_EQ(tail_of(values, 0.95).word, "max");
  EXPECT_EQ(tail_of(values, 0.95).value, 5.0);
  EXPECT_EQ(tail_of(values, 0.05).word, "min");
  EXPECT_EQ(tail_of(values, 0.05).value, 1.0);
  values.resize(19, 2.0);
  EXPECT_EQ(tail_of(values, 0.95).word, "max");
  values.resize(20, 2.0);
  EXPECT_EQ(tail_of(values, 0.95).word, "p95");
  EXPECT_EQ(tail_of(values, 0.95).value, 4.0);
  EXPECT_EQ(tail_of(values, 0.05).word, "p05");
}

// A busy machine must not turn a benchmark red.
TEST(Kit, ACostIsNoBoundOnATime) {
  const BenchContext context = context_of();
  Bench bench(kMade, context);
  bench.cost("time", 3.0, "ms", "informs");
  bench.cost("ratio", 3.0, "x", at_most(9.0), "to another time of the same run");
  ASSERT_THAT(bench.result.figures, testing::SizeIs(2));
  for (const Figure& figure : bench.result.figures) EXPECT_TRUE(figure.cost && figure.ok()) << figure.id;
  for (const char* unit : {"s", "ms", "us", "ns"})
    EXPECT_THROW(bench.cost("time", 3.0, unit, at_most(9.0)), std::logic_error) << unit;
}

}  // namespace
}  // namespace enc::bench
