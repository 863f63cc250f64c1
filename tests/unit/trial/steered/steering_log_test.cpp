// What a record keeps of a steered hand.
#include "trial/steered/steering_log.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc::trial {
namespace {

HandWord to(double x, double y, double z) { return {Point<'W'>(x, y, z)}; }

TEST(SteeringLog, ComesBackToTheBit) {
  SteeringLog log;
  log.add(0, to(0.1, -1.0 / 3.0, 1e-17));
  log.add(17, to(0, 0, 0));
  log.add(17, to(1, 2, 3));
  log.add(19, {{}, true, 5});
  SteeringLog back = SteeringLog::read(log.text(), "a.encrec");
  EXPECT_EQ(back.text(), log.text());
  EXPECT_EQ(back.at(0)->place->xyz, (std::array{0.1, -1.0 / 3.0, 1e-17}));
  EXPECT_FALSE(back.at(1));
  EXPECT_FALSE(back.at(16));
  EXPECT_EQ(back.at(18)->place->xyz, (std::array{1.0, 2.0, 3.0})) << "the last of what is due";
  const HandWord last = *back.at(21);
  EXPECT_FALSE(last.place);
  EXPECT_TRUE(last.changes_tool);
  EXPECT_EQ(last.faults, 5);
  EXPECT_FALSE(back.at(22));
}

std::string refusal(const std::string& rows) {
  try {
    (void)SteeringLog::read("tick,steered,x_m,y_m,z_m,changes_tool,faults\n" + rows, "a.encrec");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(SteeringLog, WhatIsWrongIsSaidWithItsLine) {
  using testing::HasSubstr;
  EXPECT_EQ(refusal("3,1,0,0,0,0,0\n"), "");
  EXPECT_THAT(refusal("3,1,0,0,0,0,0\n2,1,0,0,0,0,0\n"), HasSubstr(":3:1: a tick is not below"));
  EXPECT_THAT(refusal("-1,1,0,0,0,0,0\n"), HasSubstr(":2:1:"));
  EXPECT_THAT(refusal("0.5,1,0,0,0,0,0\n"), HasSubstr(":2:1: a tick is a whole number"));
  EXPECT_THAT(refusal("1e300,1,0,0,0,0,0\n"), HasSubstr(":2:1:"));
  EXPECT_THAT(refusal("1,2,0,0,0,0,0\n"), HasSubstr("steered is 0 or 1"));
  EXPECT_THAT(refusal("1,1,0,0,11,0,0\n"), HasSubstr("within 10 m"));
  EXPECT_THAT(refusal("1,1,0,nan,0,0,0\n"), HasSubstr(":2:7:"));
  EXPECT_THAT(refusal("1,1,0,0,0,7,0\n"), HasSubstr("changes_tool is 0 or 1"));
  EXPECT_THAT(refusal("1,1,0,0,0,0,16\n"), HasSubstr("from 0 to 15"));
  EXPECT_THAT(refusal("1,1,0,0\n"), HasSubstr(":2:"));
}

}  // namespace
}  // namespace enc::trial
