// Sweeps: reading their files, the points of their designs and the seeds of their runs.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_of.h"
#include "trial/sweep/design.h"
#include "trial/sweep/spec.h"

namespace enc::trial {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kHead = "format = 1\nscene = \"plane\"\nkeep = \"contacts\"\n";
const std::string kRange = "[[vary]]\nname = \"a\"\nfrom = 1\nto = 3\n";

SweepSpec spec_of(const std::string& text) { return parse_sweep(kHead + text, "s.toml"); }
std::string error_of(const std::string& text) {
  return test::error_of([&] { static_cast<void>(spec_of(text)); });
}

TEST(SweepSpec, AGridHasAllCombinationsAndTheLastChangesFastest) {
  const SweepSpec spec =
      spec_of("seeds = 4\n" + kRange + "steps = 3\n[[vary]]\nname = \"b\"\nwords = \"none observed\"\n");
  EXPECT_EQ(spec.points, 6);
  EXPECT_EQ(spec.runs(), 24);
  const Design design(spec);
  EXPECT_THAT(design.values(0), ElementsAre("1", "none"));
  EXPECT_THAT(design.values(1), ElementsAre("1", "observed"));
  EXPECT_THAT(design.values(2), ElementsAre("2", "none"));
  EXPECT_THAT(design.values(5), ElementsAre("3", "observed"));
}

TEST(SweepSpec, ALogScaleHasEqualRatiosAndExactEnds) {
  const SweepSpec spec = spec_of("[[vary]]\nname = \"a\"\nfrom = 0.1\nto = 10\nsteps = 3\nscale = \"log\"\n");
  const Design design(spec);
  EXPECT_THAT(design.values(0), ElementsAre("0.1"));
  EXPECT_NEAR(std::stod(design.values(1)[0]), 1.0, 1e-12);
  EXPECT_THAT(design.values(2), ElementsAre("10"));
}

TEST(SweepSpec, EachMistakeIsOneLineWithItsPlace) {
  EXPECT_THAT(error_of(""), AllOf(StartsWith("s.toml:"), HasSubstr("empty")));
  EXPECT_THAT(error_of("design = \"random\"\npoints = 5\n"), HasSubstr("empty: nothing varies"));
  EXPECT_THAT(error_of("design = \"random\"\n" + kRange), HasSubstr("empty: 'points' is missing"));
  EXPECT_THAT(error_of("points = 5\n" + kRange + "steps = 2\n"), HasSubstr("'points' is for random"));
  EXPECT_THAT(error_of(kRange), AllOf(StartsWith("s.toml:4:1: "), HasSubstr("steps")));
  EXPECT_THAT(error_of(kRange + "steps = 2\nvalues = [1]\n"), HasSubstr("expected one of 'values'"));
  EXPECT_THAT(error_of("[[vary]]\nname = \"a\"\n"), HasSubstr("expected one of 'values'"));
  EXPECT_THAT(error_of("[[vary]]\nname = \"a\"\nfrom = 2\nto = 2\nsteps = 2\n"), HasSubstr("'to' is 2"));
  EXPECT_THAT(error_of("[[vary]]\nname = \"a\"\nvalues = [1]\nscale = \"log\"\n"), HasSubstr("'log' needs"));
  EXPECT_THAT(error_of("seed = 3\n"), HasSubstr("unknown key"));
  EXPECT_THAT(error_of(kRange + "steps = 2\n" + kRange + "steps = 2\n"), HasSubstr("two [[vary]]"));
}

TEST(SweepSpec, SoManyRunsAreRefused) {
  EXPECT_THAT(error_of("seeds = 1000000000\n"), HasSubstr("1e+09 runs; expected at most 10000000"));
  EXPECT_THAT(error_of("design = \"sobol\"\npoints = 1000000\nseeds = 1000\n" + kRange),
              HasSubstr("1e+09 runs"));
}

// Independent values: the known answer of the authors, kat_vectors of Random123.
TEST(SweepDesign, TheCounterIsPhilox) {
  EXPECT_EQ(counter_bits(0, 0, 0, CounterStream::seeds), 0xe169c58d6627e8d5U);
}

TEST(SweepDesign, SeedsDependOnTheDesignAndTheRunAlone) {
  const SweepSpec a = spec_of("seeds = 1000\n"), b = spec_of("# a comment\nseeds = 1000\n"),
                  c = spec_of("seeds = 1001\n");
  std::set<std::uint64_t> seeds;
  for (std::int64_t i = 0; i < a.runs(); ++i) {
    seeds.insert(Design(a).seed(i));
    EXPECT_LT(Design(a).seed(i), 1ULL << 53U);
  }
  EXPECT_EQ(seeds.size(), 1000U);
  EXPECT_EQ(Design(a).seed(7), Design(b).seed(7));
  EXPECT_NE(Design(a).seed(7), Design(c).seed(7));
}

// The first points, as scipy.stats.qmc.Sobol(3, scramble=False) has them.
TEST(SweepDesign, TheSobolPointsAreTheKnownOnes) {
  const std::vector<std::vector<double>> known{{0, 0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125},
                                               {0, 0.5, 0.25, 0.75, 0.375, 0.875, 0.125, 0.625}};
  for (std::size_t axis = 0; axis < known.size(); ++axis)
    for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(sobol(axis, i) * 0x1p-32, known[axis][i]) << axis << i;
}

TEST(SweepDesign, EachSobolAxisFillsEachPartOfItsRangeOnce) {
  for (std::size_t axis = 0; axis < kMostSobolAxes; ++axis) {
    std::set<std::uint32_t> parts;
    for (std::uint32_t i = 0; i < 1024; ++i) parts.insert(sobol(axis, i) >> 22U);
    EXPECT_EQ(parts.size(), 1024U) << axis;
  }
}

TEST(SweepDesign, RandomPointsFillTheirRange) {
  const SweepSpec spec = spec_of("design = \"random\"\npoints = 4000\n" + kRange);
  const Design design(spec);
  double sum = 0.0, squares = 0.0;
  for (std::int64_t i = 0; i < spec.points; ++i) {
    const double x = std::stod(design.values(i)[0]);
    EXPECT_TRUE(x >= 1.0 && x <= 3.0) << x;
    sum += x;
    squares += (x - 2.0) * (x - 2.0);
  }
  // Four standard errors of a uniform distribution.
  EXPECT_NEAR(sum / 4000.0, 2.0, 4.0 * std::sqrt(1.0 / 3.0 / 4000.0));
  EXPECT_NEAR(squares / 4000.0, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / 4000.0));
}

}  // namespace
}  // namespace enc::trial
