// The pressed ball. Contours: distances and overlaps of known shapes; the committed contours of Fig 11 are
// read whole or refused in one line. Indentations: the measure of Table 2 on hand-computed loops, the theory
// of its lag, and the twin against that theory.
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmarks/deformation/contour.h"
#include "benchmarks/indentation/indentation.h"
#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::bench::deformation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kRadius = 0.033;

Contour circle(double radius) {
  Contour contour;
  for (int i = 0; i <= 1800; ++i) {
    const double polar = std::numbers::pi * i / 1800;
    contour.emplace_back(radius * std::sin(polar), radius * std::cos(polar));
  }
  return contour;
}
// The ball with a slice of height `off` cut from its top.
Contour cut(double off) {
  const double z = kRadius - off;
  const double edge = std::acos(z / kRadius);
  Contour contour{{0.0, z}};
  for (int i = 0; i <= 1800; ++i) {
    const double polar = edge + (std::numbers::pi - edge) * i / 1800;
    contour.emplace_back(kRadius * std::sin(polar), kRadius * std::cos(polar));
  }
  return contour;
}
double slice_area(double off) {
  const double half = std::acos(1.0 - off / kRadius);
  return 0.5 * kRadius * kRadius * (half - std::sin(half) * std::cos(half));  // half the section's area
}
double slice_volume(double off) { return std::numbers::pi * off * off * (kRadius - off / 3.0); }

TEST(Contour, TwoCirclesAreTheirRadiiApart) {
  const ContourGap gap = contour_gap(circle(kRadius), circle(kRadius - 0.5e-3), kRadius);
  EXPECT_NEAR(gap.rms, 0.5e-3, 1e-8);
  EXPECT_NEAR(gap.largest, 0.5e-3, 1e-7);
  EXPECT_NEAR(gap.half_rms, 0.5e-3, 1e-8);
  const GapProfile along = gap_along(circle(kRadius), circle(kRadius - 0.5e-3));
  EXPECT_NEAR(along.outside.front(), -0.5e-3, 1e-7);
  EXPECT_NEAR(along.outside.back(), -0.5e-3, 1e-7);
  EXPECT_NEAR(along.length.back(), 0.5 * std::numbers::pi * kRadius, 0.1e-3);
}

TEST(Contour, WhatIsNotDentedDoesNotCount) {
  // The circles are 50 um apart: below the threshold of both.
  const ContourGap gap = contour_gap(circle(kRadius), circle(kRadius - 0.05e-3), kRadius);
  EXPECT_EQ(gap.rms, 0.0);
  EXPECT_NEAR(gap.half_rms, 0.05e-3, 1e-8);
  // A slice of 2 mm is missing from one contour. Only that side is dented, so the rest does not dilute the
  // value.
  const ContourGap sliced = contour_gap(circle(kRadius), cut(2e-3), kRadius);
  EXPECT_GT(sliced.rms, 1.5 * sliced.half_rms);
  EXPECT_NEAR(sliced.largest, 2e-3, 1e-5);
}

TEST(Contour, OverlapOfTwoSlices) {
  const Overlap common = overlap(cut(2e-3), cut(3e-3), kRadius);
  EXPECT_NEAR(common.area, slice_area(2e-3) / slice_area(3e-3), 1e-4);
  EXPECT_NEAR(common.volume, slice_volume(2e-3) / slice_volume(3e-3), 1e-4);
  const Overlap same = overlap(cut(2e-3), cut(2e-3), kRadius);
  EXPECT_EQ(same.area, 1.0);
  EXPECT_EQ(same.volume, 1.0);
  EXPECT_LT(overlap(circle(kRadius), cut(2e-3), kRadius).area, 1e-3);
}

TEST(Contour, AHoleWithUprightWalls) {
  // The hole is 5 mm wide and 4 mm deep in a flat top 3 mm down: z is known in every column.
  Contour hole{{0.0, 0.026}, {0.0025, 0.026}};
  const Contour flat = cut(3e-3);
  hole.emplace_back(0.0025, 0.030);
  hole.insert(hole.end(), flat.begin() + 1, flat.end());
  const Overlap common = overlap(hole, flat, kRadius);
  const double extra = 0.0025 * 0.004;
  EXPECT_NEAR(common.area, slice_area(3e-3) / (slice_area(3e-3) + extra), 1e-4);
  EXPECT_NEAR(contour_gap(hole, flat, kRadius).largest, 4e-3, 1e-9);
}

const std::string kModels = tests::source_dir() + "/models";
std::string file() { return test::bytes_of(kModels + "/../benchmarks/reference/fig11_contour.csv"); }

std::string refusal(const std::string& text) {
  try {
    (void)parse_fig11(text, "fig11_contour.csv");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}
std::string with(std::string text, const std::string& what, const std::string& instead) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), instead);
}

TEST(Fig11Contour, TheCommittedFileStartsOnTheProbe) {
  const Fig11Contours contours = load_fig11(kModels);
  for (std::size_t d = 0; d < fig11_depths().size(); ++d)
    for (const Contour& contour : {contours.probe[d], contours.stylus[d]}) {
      EXPECT_EQ(contour.front()[0], 0.0);
      EXPECT_NEAR(contour.front()[1], 0.033 - fig11_depths()[d], 1e-9);
      EXPECT_NEAR(contour.back().norm(), 0.033, 3e-6);  // the normal is one-sided at the mount
    }
}

TEST(Fig11Contour, ADamagedFileIsRefusedInOneLine) {
  const std::string whole = file();
  EXPECT_EQ(refusal(whole), "");
  const auto one_line = AllOf(HasSubstr("fig11_contour.csv"), Not(HasSubstr("\n")));
  EXPECT_THAT(refusal(""), one_line);
  EXPECT_THAT(refusal(whole.substr(0, whole.size() / 2)), AllOf(one_line, HasSubstr("expected")));
  EXPECT_THAT(refusal(with(whole, "10,2,0.0000,31.0000", "10,2,0.0000")),
              AllOf(one_line, HasSubstr("3 cells")));
  EXPECT_THAT(refusal(with(whole, "10,2,0.0000,31.0000", "10,2,0.0000,31.x")),
              AllOf(one_line, HasSubstr("expected a number")));
  EXPECT_THAT(refusal(with(whole, "10,2,0.0000,31.0000", "10,2,0.0000,nan")),
              AllOf(one_line, HasSubstr("row 1")));
  EXPECT_THAT(refusal(with(whole, "10,2,0.0000,31.0000", "10,2,0.0000,310")),
              AllOf(one_line, HasSubstr("row 1")));
  EXPECT_THAT(refusal(with(whole, "z_mm", "height")), AllOf(one_line, HasSubstr("no column 'z_mm'")));
}

}  // namespace
}  // namespace enc::bench::deformation

namespace enc::bench::indentation {
namespace {

using ::testing::ElementsAre;

const std::string kModels = tests::source_dir() + "/models";

// A loop with 2 N/mm while pressing and 1 N/mm while releasing.
Response loop() { return {ResponseSpec{{2000, 0, 0, 0}, {1000, 0, 0, 0}, 6e-3}, 0.0}; }

TEST(Indentation, ErrorsOfThreeReadings) {
  Branch branch;
  branch.add(1e-3, 2.1);  // e = 0.1
  branch.add(2e-3, 3.8);  // e = -0.2
  branch.add(3e-3, 6.4);  // e = 0.4
  const Errors e = errors_of(branch, loop(), true);
  EXPECT_NEAR(e.rmse, std::sqrt((0.01 + 0.04 + 0.16) / 3.0), 1e-12);
  EXPECT_NEAR(e.mae, 0.7 / 3.0, 1e-12);
  EXPECT_NEAR(e.mean, 0.1, 1e-12);
  EXPECT_NEAR(errors_of(branch, loop(), false).mean, (1.1 + 1.8 + 3.4) / 3.0, 1e-12);
  EXPECT_TRUE(std::isnan(errors_of({}, loop(), true).rmse));
}

// Press until near the limit, release from where the hand leaves it; samples at the limit and in the air do
// not count.
TEST(Indentation, LoopIsSplitAtTheLimit) {
  Branch contact;
  const std::vector<double> way{-0.1, 0.5, 3.0, 5.94, 5.96, 6.0, 5.97, 5.9, 2.0, -0.2};  // mm
  for (std::size_t i = 0; i < way.size(); ++i) contact.add(way[i] * 1e-3, static_cast<double>(i));
  const Recording r = split(contact, 6e-3);
  EXPECT_THAT(r.press.force, ElementsAre(1, 2, 3));
  EXPECT_THAT(r.release.force, ElementsAre(7, 8));
}

TEST(Indentation, LoopThatStaysBelowTheLimitIsSplitAtItsTop) {
  Branch contact;
  for (const double d : {1e-3, 3e-3, 4e-3, 3.5e-3, 1e-3}) contact.add(d, d * 1e3);
  const Recording r = split(contact, 6e-3);
  EXPECT_THAT(r.press.force, ElementsAre(1, 3));
  EXPECT_THAT(r.release.force, ElementsAre(4, 3.5, 1));
}

TEST(Indentation, CellOfSeveralRuns) {
  std::vector<IndentRun> runs(2);
  for (IndentRun& run : runs) run.reference = loop();
  runs[0].recorded.press.add(1e-3, 2.3);  // e = 0.3
  runs[1].recorded.press.add(1e-3, 1.9);  // e = -0.1
  const Cell cell = cell_of(runs, Reading::recorded, true);
  EXPECT_NEAR(cell.rmse, std::sqrt(0.05), 1e-12);
  EXPECT_NEAR(cell.mae, 0.2, 1e-12);
  EXPECT_NEAR(cell.bias, 0.1, 1e-12);
  EXPECT_NEAR(cell.least, 0.1, 1e-12);
  EXPECT_NEAR(cell.most, 0.3, 1e-12);
}

// The mean square speed of a minimum-jerk motion is 10/7 of its squared mean speed [Flash and Hogan 1985]. A
// linear object turns that into force.
TEST(Indentation, TheoryOfALinearObject) {
  const Response spring(ResponseSpec{{2000, 0, 0, 0}, {2000, 0, 0, 0}, 20e-3}, 0.0);
  const LagTheory theory{spring, spring, 6e-3, 0.0, 0.020};
  EXPECT_NEAR(predicted_rmse(theory, 3.0), 0.020 * 2000 * 2e-3 * std::sqrt(10.0 / 7.0), 1e-4);
  EXPECT_NEAR(predicted_rmse(theory, 1.5), 2.0 * predicted_rmse(theory, 3.0), 1e-4);
  const LagTheory still{spring, spring, 6e-3, 0.05, 0.0};
  EXPECT_NEAR(predicted_rmse(still, 3.0), 0.05, 1e-12);
}

TEST(Indentation, PaperCellsAreRead) {
  const std::vector<PaperCell> cells = paper_cells(kModels);
  ASSERT_EQ(cells.size(), kCells);
  EXPECT_EQ(cells[3].indentation + cells[3].way, "Brelease");
  for (std::size_t i = 0; i < kCells; ++i) {
    EXPECT_EQ(cells[i].consistent, i != 1);
    EXPECT_EQ(cells[i].consistent, cells[i].rmse >= cells[i].mae);
  }
}

// A seed always gives the same hand, different seeds give different hands, and each hand's numbers stay those
// of a person.
TEST(Indentation, HandsDifferWithTheirSeed) {
  const models::Setup setup = indent_setup(kModels, indentations().front(), {}, {});
  const UserSpec one = *varied(setup, 1).scene.user, same = *varied(setup, 1).scene.user;
  const UserSpec other = *varied(setup, 2).scene.user;
  EXPECT_EQ(one.press_time, same.press_time);
  EXPECT_NE(one.press_time, other.press_time);
  for (std::uint64_t seed = 1; seed < 200; ++seed) {
    const UserSpec user = *varied(setup, seed).scene.user;
    EXPECT_NEAR(user.press_time, setup.scene.user->press_time, 0.5 * setup.scene.user->press_time);
    EXPECT_NEAR(user.depth, setup.scene.user->depth, 0.25e-3);
    const double faster = user.approach.front() / setup.scene.user->approach.front();
    EXPECT_LT(std::abs(std::log(faster)), 4.0 * HandSpread{}.speed);
  }
}

// Perturbation: a filter with twice the corner frequency removes half of its lag from the error of the
// sensor's force.
TEST(Indentation, FilterMovesTheErrorAsItsLagSays) {
  const auto rmse = [](const std::string& corner, double& theory) {
    std::vector<std::string> own = still_hand();
    own.insert(own.end(), {"user.press_s=4", "user.release_s=1", "rig.contact.softest_N_per_mm=0",
                           "rig.force.filter_hz=" + corner});
    const models::Setup setup = indent_setup(kModels, indentations().front(), own, {});
    const BehaviourSpec& b = setup.scene.behaviours.front();
    theory = predicted_rmse({Response(b.curves, 0.0, b.reversal), Response(b.curves, 0.0),
                             setup.scene.user->depth, setup.rig.force.threshold, sensor_lag(setup)},
                            setup.scene.user->press_time);
    return cell_of({indent_run(setup, 1)}, Reading::sensor, true).rmse;
  };
  double slow_theory = 0.0, fast_theory = 0.0;
  const double slow = rmse("5", slow_theory), fast = rmse("10", fast_theory);
  EXPECT_GT(slow, fast);
  EXPECT_NEAR((slow - fast) / (slow_theory - fast_theory), 1.0, 0.15);
}

}  // namespace
}  // namespace enc::bench::indentation
