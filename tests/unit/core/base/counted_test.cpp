#include "core/base/counted.h"

#include <cstdint>

#include <gtest/gtest.h>

namespace enc {
namespace {

TEST(Counted, OneIsNotManyAndNoneIs) {
  EXPECT_EQ(counted(1, "contact"), "1 contact");
  EXPECT_EQ(counted(0, "contact"), "0 contacts");
  EXPECT_EQ(counted(std::size_t{2}, "contact"), "2 contacts");
  EXPECT_EQ(counted(std::int64_t{1}, "press"), "1 press");
  EXPECT_EQ(counted(std::int64_t{3}, "press"), "3 presses");
  EXPECT_EQ(counted(3, "touch"), "3 touches");
  EXPECT_EQ(counted(-2, "box"), "-2 boxes");
}

}  // namespace
}  // namespace enc
