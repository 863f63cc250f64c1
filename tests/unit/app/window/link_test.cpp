// The run's side of a window: a change of mode that was waited for stops time there, whatever is wished
// meanwhile.
#include "app/window/link.h"

#include <gtest/gtest.h>

namespace enc::app {
namespace {

constexpr double kTick = 1e-3;  // s

class WindowLink : public testing::Test {
 protected:
  // Whether the run goes on by a tick within 20 asks.
  bool goes_on() {
    for (int i = 0; i < 20; ++i)
      if (!link_.waits(kTick)) return true;
    return false;
  }
  void tick(Mode mode) {
    out_.mode = mode;
    link_.see({scene_, now_, truth_, in_, out_});
  }
  Link link_;
  Scene scene_;
  Tick now_;
  sim::Truth truth_;
  Inputs in_;
  Outputs out_;
};

TEST_F(WindowLink, PausesAndGoesTickByTick) {
  EXPECT_TRUE(goes_on());
  link_.wish({.paused = true});
  EXPECT_FALSE(goes_on());
  link_.wish({.paused = true, .ticks = 2});
  EXPECT_TRUE(goes_on());
  EXPECT_TRUE(goes_on());
  EXPECT_FALSE(goes_on());
  link_.wish({});
  EXPECT_TRUE(goes_on());
}

TEST_F(WindowLink, StandsAtTheEventUntilTheWindowKnows) {
  link_.wish({.to_event = true});
  tick(Mode::away);
  EXPECT_TRUE(goes_on());
  tick(Mode::follow);
  EXPECT_FALSE(goes_on());
  link_.wish({.to_event = true});  // of a picture that was begun before
  EXPECT_FALSE(goes_on());
  EXPECT_TRUE(link_.take_event());
  EXPECT_FALSE(link_.take_event());
  EXPECT_FALSE(goes_on()) << "paused, until the window says otherwise";
  link_.wish({});
  EXPECT_TRUE(goes_on());
}

TEST_F(WindowLink, ARunOnTheWallClockNeverWaits) {
  link_.let_go();
  EXPECT_TRUE(link_.begin(true));
  link_.wish({.paused = true, .speed = 0.01});
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(link_.waits(kTick));
}

TEST_F(WindowLink, ThePlaceOfTheHandIsNewsOnce) {
  EXPECT_FALSE(link_.hand());
  link_.wish({.hand = Point<'W'>(1, 2, 3)});
  link_.wish({.hand = Point<'W'>(1, 2, 3)});
  EXPECT_EQ(link_.hand()->place->xyz, (std::array{1.0, 2.0, 3.0}));
  EXPECT_FALSE(link_.hand());
}

// A change of tool is asked for once, also when nobody listened to the first wish; faults last.
TEST_F(WindowLink, ToolAndFaultsReachTheRun) {
  link_.wish({.changes_tool = true, .faults = 2});
  link_.wish({.faults = 2});
  const auto word = link_.hand();
  ASSERT_TRUE(word);
  EXPECT_TRUE(word->changes_tool && word->faults == 2 && !word->place);
  EXPECT_FALSE(link_.hand());
  link_.wish({});
  EXPECT_EQ(link_.hand()->faults, 0);
}

TEST_F(WindowLink, AStopComesBeforeAResume) {
  link_.wish({.stops = true, .resumes = true});
  EXPECT_EQ(link_.machine(), trial::Hand::halt);
  link_.wish({.resumes = true});
  link_.wish({.stops = true});
  EXPECT_EQ(link_.machine(), trial::Hand::halt);
  link_.wish({.stops = true});
  link_.wish({.resumes = true});
  EXPECT_EQ(link_.machine(), trial::Hand::halt) << "not taken yet";
  EXPECT_EQ(link_.machine(), trial::Hand::none);
}

TEST_F(WindowLink, ARunWithoutItsWindowIsRefused) {
  link_.refuse();
  EXPECT_FALSE(link_.begin(false));
}

}  // namespace
}  // namespace enc::app
