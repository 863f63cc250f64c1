// The measure of Table 2 on loops worked by hand, the theory of its lag, and the twin against that theory.
#include "benchmarks/indentation/indentation.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"

namespace enc::bench::indentation {
namespace {

using testing::ElementsAre;

const std::string kModels = tests::source_dir() + "/models";

// 2 N/mm pressing, 1 N/mm releasing.
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

// Press until the limit is near, release from where it is left: nothing at the limit counts, nor in the air.
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

// Minimum jerk has the mean square of its speed at 10/7 of the square of its mean speed [Flash and Hogan
// 1985]; a linear object turns that into force.
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

// The same seed gives the same hand, another one another, and the hand's numbers stay those of a person.
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

// Perturbation: twice the corner of the force filter takes half of its lag out of the error of the sensor's
// force.
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
