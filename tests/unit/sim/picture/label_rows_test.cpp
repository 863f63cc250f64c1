// Labels of a picture keep out of its title.
#include <gtest/gtest.h>

#include "sim/picture/picture.h"

namespace enc::sim {
namespace {

constexpr double kPitch = 30.0, kTop = 90.0, kBottom = 670.0, kClear = 60.0;

TEST(LabelRows, StandApartAndInOrder) {
  std::vector<LabelRow> labels{{true, 100, 300}, {true, 100, 295}, {false, 100, 296}, {true, 100, 1000}};
  spread_rows(labels, kPitch, kTop, kBottom);
  EXPECT_EQ(labels[1].row, 295.0);
  EXPECT_EQ(labels[0].row, 325.0);
  EXPECT_EQ(labels[2].row, 296.0) << "the other margin";
  EXPECT_EQ(labels[3].row, kBottom);
}

// More labels than the space allows: they move closer together, and never up into the title.
TEST(LabelRows, NeverStandInTheTitle) {
  std::vector<LabelRow> labels(40, LabelRow{true, 100, 900});
  spread_rows(labels, kPitch, kTop, kBottom);
  for (const LabelRow& label : labels) {
    EXPECT_GE(label.row, kTop - 1e-9);
    EXPECT_LE(label.row, kBottom + 1e-9);
  }
}

// A longer tool reaches above the picture: its line ends below the title, on the way there.
TEST(LabelRows, ALineEndsBelowTheTitle) {
  LabelRow above{true, 500, -120, 90};
  end_below(above, 200, kClear);
  EXPECT_EQ(above.y, kClear);
  EXPECT_NEAR(above.x, 200.0 + 300.0 * 30.0 / 210.0, 1e-9);
  EXPECT_FALSE(above.dot);
  LabelRow below{true, 500, 200, 90};
  end_below(below, 200, kClear);
  EXPECT_EQ(below.y, 200.0);
  EXPECT_TRUE(below.dot);
}

// Two labels at the right margin in the order of their objects, the upper of which is farther away: its line
// would cross the second text. So their rows are exchanged.
TEST(LabelRows, LinesCrossNeitherLinesNorTexts) {
  std::vector<LabelRow> labels{{false, 400, 480, 200, 1000, 950}, {false, 750, 250, 230, 1000, 700}};
  uncross(labels);
  EXPECT_EQ(labels[0].row, 230.0);
  EXPECT_EQ(labels[1].row, 200.0);
  uncross(labels);
  EXPECT_EQ(labels[0].row, 230.0) << "it stays so";
}

}  // namespace
}  // namespace enc::sim
