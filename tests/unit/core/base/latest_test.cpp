// The newest value of one thread for one other; what two threads make of it is in tests/threads.
#include "core/base/latest.h"

#include <gtest/gtest.h>

namespace enc {
namespace {

TEST(Latest, NothingIsReadBeforeSomethingIsWritten) {
  Latest<int> latest;
  int value = 7;
  EXPECT_FALSE(latest.read(value));
  EXPECT_EQ(value, 7);
}

TEST(Latest, TheNewestIsReadOnceHoweverManyWereWritten) {
  Latest<int> latest;
  int value = 0, next = 1;
  for (int round = 0; round < 50; ++round) {
    for (int i = 0; i <= round % 5; ++i) latest.write(next++);
    ASSERT_TRUE(latest.read(value));
    EXPECT_EQ(value, next - 1);
    EXPECT_FALSE(latest.read(value));
    EXPECT_EQ(value, next - 1);
  }
}

}  // namespace
}  // namespace enc
