// Every cell of the matrix, once each; `encounter bench wires` has more seeds and makes the table.
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/wires/safety.h"
#include "tests/support/built.h"

namespace enc::bench::wires {
namespace {

TEST(SafetyMatrix, EachFaultEndsAsStatedWithTheMachineAtRest) {
  const ShortPress press(tests::source_dir() + "/models");
  const models::Setup& setup = press.datagrams;
  struct Cell {
    const Fault& fault;
    Mode mode;
    Reaction of{};
  };
  std::vector<Cell> cells;
  for (const Fault& fault : faults())
    for (const Mode mode : kInjectedIn) cells.push_back({fault, mode});
  in_parallel(cells.size(), [&](std::size_t i) {
    cells[i].of = react(press.of(cells[i].fault), cells[i].fault, cells[i].mode, 1 + i);
  });
  for (const Cell& cell : cells) {
    const std::string name =
        fmt::format("{} {}, in {}", cell.fault.device, cell.fault.name, mode_name(cell.mode));
    EXPECT_EQ(wrong_with(cell.fault, cell.mode, cell.of, setup), "") << name;
    testing::Test::RecordProperty(name, fmt::format("hold {} ms, rest {} ms, {:.2f} mm", cell.of.hold,
                                                    cell.of.rest, 1e3 * cell.of.way));
  }
}

}  // namespace
}  // namespace enc::bench::wires
