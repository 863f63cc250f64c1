// Values printed in the papers.
#include "benchmarks/verdict/reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmarks/tracking/table1.h"
#include "core/base/error.h"
#include "tests/support/built.h"

namespace enc::bench {
namespace {

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

// The norms follow from their components but for the one that the paper has wrong.
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

}  // namespace
}  // namespace enc::bench
