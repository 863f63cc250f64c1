// Several tools in view: the one that a person holds, and no other.
#include "hw_drivers/igtl/drive/in_hand.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace enc::igtl {
namespace {

struct Frames {
  explicit Frames(double rate = 100.0) : frame(std::llround(1e9 / rate)) {}
  // A frame: where each tool is seen; which one is in the hand, -1: none. In the frame of a change both are,
  // and the later one stays.
  int see(const std::vector<std::pair<std::size_t, Vec3>>& tools) {
    ++count;
    int which = -1;
    for (const auto& [tool, place] : tools)
      if (hand.is(tool, count * frame, place)) which = static_cast<int>(tool);
    return which;
  }
  InHand hand{2};
  std::int64_t frame, count = 0;  // ns
};
Vec3 moving(int frame) { return {0.1 * std::sin(0.05 * frame), 0, 1}; }
const Vec3 kTable(0.3, 0.2, 1.2);

TEST(IgtlInHand, OfOneInViewItIsThatOneFromItsFirstFrame) {
  Frames frames;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(frames.see({{0, moving(i)}}), 0);
  frames.count += 50;  // none in view for half a second
  for (int i = 0; i < 100; ++i) EXPECT_EQ(frames.see({{1, moving(i)}}), 1) << i;
}

// Whichever of the two a message names first, however often frames come, and while the hand's is hidden for
// some.
TEST(IgtlInHand, WhatLiesOnTheTableDoesNotTakeItsPlace) {
  for (const double rate : {20.0, 30.0, 60.0, 100.0, 335.0})
    for (const bool table_first : {false, true}) {
      Frames frames(rate);
      for (int i = 0; i < 10; ++i) EXPECT_EQ(frames.see({{0, moving(0)}, {1, kTable}}), 0);
      for (int i = 1; i < 500; ++i) {
        const std::pair hand(std::size_t{0}, moving(i)), table(std::size_t{1}, kTable);
        if (i % 100 < static_cast<int>(0.15 * rate))
          EXPECT_EQ(frames.see({table}), -1) << "hidden for 150 ms at " << rate << " Hz, frame " << i;
        else
          EXPECT_EQ(table_first ? frames.see({table, hand}) : frames.see({hand, table}), 0)
              << rate << ' ' << i;
      }
    }
}

TEST(IgtlInHand, WhatIsPickedUpTakesThePlaceOfWhatWasLaidDown) {
  Frames frames;
  for (int i = 0; i < 100; ++i) frames.see({{0, moving(i)}, {1, kTable}});
  const Vec3 down = moving(100);
  for (int i = 0; i < 300; ++i)
    EXPECT_EQ(frames.see({{0, down}, {1, kTable}}), 0) << "nobody moves any: " << i;
  int first = -1;
  for (int i = 0; i < 100; ++i)
    if (frames.see({{0, down}, {1, Vec3(kTable + Vec3(0, 0, 0.99e-3 * i))}}) == 1 && first < 0) first = i;
  EXPECT_EQ(first, 51) << "its first 50 mm";
  for (int i = 0; i < 100; ++i) EXPECT_EQ(frames.see({{0, down}, {1, kTable}}), 1);
}

// A hand presses with one, and holds still; somebody knocks at the table on which the other lies.
TEST(IgtlInHand, WhatIsPushedOnTheTableIsNotPickedUp) {
  Frames frames;
  for (int i = 0; i < 100; ++i) frames.see({{0, moving(i)}, {1, kTable}});
  const Vec3 pressing = moving(100);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 pushed = kTable + Vec3(0.02 * std::sin(0.01 * i), 0, 0);
    EXPECT_EQ(frames.see({{0, pressing}, {1, pushed}}), 0) << i;
  }
}

TEST(IgtlInHand, OfTwoThatMoveTheFirstStays) {
  Frames frames;
  for (int i = 0; i < 500; ++i) EXPECT_EQ(frames.see({{0, moving(i)}, {1, Vec3(kTable + moving(i))}}), 0);
}

TEST(IgtlInHand, WhatLiesThereIsNotTakenWhenTheOtherIsGone) {
  Frames frames;
  for (int i = 0; i < 50; ++i) frames.see({{0, moving(i)}, {1, kTable}});
  for (int i = 0; i < 300; ++i) EXPECT_EQ(frames.see({{1, kTable}}), -1) << "nobody moves it: " << i;
  EXPECT_EQ(frames.see({{0, moving(50)}, {1, kTable}}), 0) << "there it is again";
  for (int i = 0; i < 11; ++i) frames.see({{1, kTable}});
  EXPECT_EQ(frames.see({{1, Vec3(kTable + Vec3(0, 0, 6e-3))}}), 1) << "that one is moved";
}

TEST(IgtlInHand, AnotherClockBeginsAnew) {
  Frames frames;
  for (int i = 0; i < 50; ++i) frames.see({{0, moving(i)}});
  frames.count = -1'000'000;
  frames.hand.forget();
  for (int i = 0; i < 20; ++i) frames.see({{1, Vec3(kTable + Vec3(0, 0, 1e-3 * i))}});
  EXPECT_EQ(frames.see({{1, kTable}}), 1);
  frames.hand.forget();
  EXPECT_EQ(frames.see({{0, moving(0)}, {1, kTable}}), 1) << "the one in the hand stays it";
}

}  // namespace
}  // namespace enc::igtl
