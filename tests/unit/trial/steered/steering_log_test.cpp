// What a record keeps of a steered hand.
#include "trial/steered/steering_log.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace enc::trial {
namespace {

TEST(SteeringLog, ComesBackToTheBit) {
  SteeringLog log;
  log.add(0, {0.1, -1.0 / 3.0, 1e-17});
  log.add(17, {0, 0, 0});
  log.add(17, {1, 2, 3});
  SteeringLog back = SteeringLog::read(log.text(), "a.encrec");
  EXPECT_EQ(back.text(), log.text());
  EXPECT_EQ(back.at(0)->xyz, (std::array{0.1, -1.0 / 3.0, 1e-17}));
  EXPECT_FALSE(back.at(1));
  EXPECT_FALSE(back.at(16));
  EXPECT_EQ(back.at(20)->xyz, (std::array{1.0, 2.0, 3.0})) << "the last of what is due";
  EXPECT_FALSE(back.at(21));
}

std::string refusal(const std::string& rows) {
  try {
    (void)SteeringLog::read("tick,x_m,y_m,z_m\n" + rows, "a.encrec");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(SteeringLog, WhatIsWrongIsSaidWithItsLine) {
  using testing::HasSubstr;
  EXPECT_EQ(refusal("3,0,0,0\n"), "");
  EXPECT_THAT(refusal("3,0,0,0\n2,0,0,0\n"), HasSubstr(":3:1: a tick is a whole number"));
  EXPECT_THAT(refusal("-1,0,0,0\n"), HasSubstr(":2:1:"));
  EXPECT_THAT(refusal("0.5,0,0,0\n"), HasSubstr(":2:1:"));
  EXPECT_THAT(refusal("1e300,0,0,0\n"), HasSubstr(":2:1:"));
  EXPECT_THAT(refusal("1,0,0,11\n"), HasSubstr("within 10 m"));
  EXPECT_THAT(refusal("1,0,nan,0\n"), HasSubstr(":2:5:"));
  EXPECT_THAT(refusal("1,0,0\n"), HasSubstr(":2:"));
}

}  // namespace
}  // namespace enc::trial
