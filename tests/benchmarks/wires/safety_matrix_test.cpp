// Every cell of the matrix of docs/reference/safety.md: fault, mode, seed.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/kit/parallel.h"
#include "tests/benchmarks/wires/safety.h"
#include "tests/support/built.h"

namespace enc::bench::wires {
namespace {

struct Cell {
  const Fault* fault;
  Mode mode;
  std::uint64_t seed;
  Reaction of{};
};

void expect_all_hold(std::vector<Cell>& cells) {
  const ShortPress press(tests::source_dir() + "/models");
  in_parallel(cells.size(), [&](std::size_t i) {
    cells[i].of = react(press.of(*cells[i].fault), *cells[i].fault, cells[i].mode, cells[i].seed);
  });
  for (const Cell& cell : cells) {
    const std::string name = fmt::format("{} {}, in {}, seed {}", cell.fault->device, cell.fault->name,
                                         mode_name(cell.mode), cell.seed);
    EXPECT_EQ(wrong_with(*cell.fault, cell.mode, cell.of, press.datagrams), "") << name;
    testing::Test::RecordProperty(
        name, fmt::format("hold {} ms, fastest {:.1f} mm/s, rest {} ms, {:.2f} mm", cell.of.hold,
                          1e3 * cell.of.speed, cell.of.rest, 1e3 * cell.of.way));
  }
}

// Each fault once in each mode, at another moment each time.
TEST(SafetyMatrix, EachFaultEndsAsStatedWithTheMachineAtRest) {
  std::vector<Cell> cells;
  for (const Fault& fault : faults())
    for (const Mode mode : kInjectedIn) cells.push_back({&fault, mode, 1 + cells.size()});
  expect_all_hold(cells);
}

// The table of docs/reference/safety.md has the least and the most of these.
TEST(SafetyMatrixLong, EachFaultEndsAsStatedOverFiveSeeds) {
  std::vector<Cell> cells;
  for (const Fault& fault : faults())
    for (const Mode mode : kInjectedIn)
      for (std::uint64_t seed = 1; seed <= 5; ++seed) cells.push_back({&fault, mode, seed});
  expect_all_hold(cells);
}

// The bounds of the way mean something: in half of the cells in which the tip moves, it would have gone
// farther than its bound without the fault.
TEST(SafetyMatrix, WithoutTheFaultTheTipWouldHaveGoneFarther) {
  const ShortPress press(tests::source_dir() + "/models");
  std::vector<Cell> cells;
  for (const Mode mode : {Mode::follow, Mode::contact}) {
    cells.push_back({&no_fault(), mode, 1});
    for (const Fault& fault : faults())
      if (fault.end != End::unharmed) cells.push_back({&fault, mode, 1});
  }
  in_parallel(cells.size(), [&](std::size_t i) {
    cells[i].of = react(press.of(*cells[i].fault), *cells[i].fault, cells[i].mode, cells[i].seed);
  });
  std::size_t moving = 0, farther = 0;
  double undisturbed = 0.0;  // m, of this mode
  for (const Cell& cell : cells) {
    if (cell.fault == &no_fault()) {
      undisturbed = cell.of.way;
      continue;
    }
    ++moving;
    farther += undisturbed > way_bound(*cell.fault, cell.of, press.datagrams) ? 1 : 0;
  }
  EXPECT_GE(2 * farther, moving);
}

}  // namespace
}  // namespace enc::bench::wires
