// Earlier moments of a run: kept up to a number, and shown until somebody returns to the present.
#include "app/window/history/timeline.h"

#include <gtest/gtest.h>

namespace enc::app {
namespace {

class WindowTimeline : public testing::Test {
 protected:
  void add(int count, Mode mode = Mode::follow) {
    for (int i = 0; i < count; ++i) {
      Still still;
      still.now.t = Time{} + from_seconds(0.01 * added_++);
      still.out.mode = mode;
      timeline_.add(still);
    }
  }
  [[nodiscard]] int shown() const {
    return static_cast<int>(std::lround(100.0 * seconds_of(timeline_.shown())));
  }
  Timeline timeline_{100};
  int added_ = 0;
};

TEST_F(WindowTimeline, ShowsTheNewestUntilSomebodyLooksBack) {
  add(50);
  EXPECT_EQ(shown(), 49);
  EXPECT_FALSE(timeline_.past());
  timeline_.step(-10);
  EXPECT_TRUE(timeline_.past());
  add(30);
  EXPECT_EQ(shown(), 39) << "what is looked at stays";
  timeline_.seek(1.0);
  add(1);
  EXPECT_EQ(shown(), 80) << "from the present on it goes on";
}

TEST_F(WindowTimeline, TheOldestGoFirst) {
  add(250);
  timeline_.seek(0.0);
  EXPECT_EQ(shown(), 150);
  add(20);
  EXPECT_EQ(shown(), 170) << "the one that was looked at is gone";
  timeline_.step(-5);
  EXPECT_EQ(shown(), 170);
  timeline_.step(1000);
  EXPECT_EQ(shown(), 269);
}

TEST_F(WindowTimeline, PlaysInTime) {
  add(100);
  timeline_.seek(0.0);
  for (int i = 0; i < 30; ++i) timeline_.go_on(0.0034);
  EXPECT_EQ(shown(), 10);
  timeline_.go_on(5.0);
  EXPECT_EQ(shown(), 99);
  EXPECT_FALSE(timeline_.past());
}

TEST_F(WindowTimeline, StopsAtAChangeOfMode) {
  add(20);
  add(30, Mode::contact);
  add(20);
  timeline_.seek(0.0);
  timeline_.to_change();
  EXPECT_EQ(shown(), 20);
  timeline_.to_change();
  EXPECT_EQ(shown(), 50);
  timeline_.to_change();
  EXPECT_EQ(shown(), 69);
}

TEST_F(WindowTimeline, TheBarMarksContacts) {
  EXPECT_FALSE(timeline_.bar().shown);
  add(20);
  add(30, Mode::contact);
  add(51);
  const sim::ViewBar bar = timeline_.bar();
  EXPECT_TRUE(bar.shown);
  EXPECT_FLOAT_EQ(bar.at, 1.0F);
  ASSERT_EQ(bar.marks.size(), 1U);
  EXPECT_NEAR(bar.marks[0].from, 19.0 / 99.0, 1e-6);  // the first of 101 is gone
  EXPECT_NEAR(bar.marks[0].to, 49.0 / 99.0, 1e-6);
}

}  // namespace
}  // namespace enc::app
