// What a fake is to suffer, as it is written.
#include "app/laboratory/fault_text.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc::app {
namespace {

using Kind = Trouble::Kind;

std::string refused_fault(const std::string& text) {
  try {
    static_cast<void>(fault_of(text, "--fault"));
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::input);
    return e.what();
  }
  return "";
}

TEST(FaultText, IsADriverAFaultAValueATimeAndHowLong) {
  const Fault whole = fault_of("netft:loss=5%@2s+500ms", "");
  EXPECT_EQ(whole.driver, "netft");
  EXPECT_EQ(whole.trouble.kind, Kind::loss);
  EXPECT_DOUBLE_EQ(whole.trouble.value, 0.05);
  EXPECT_DOUBLE_EQ(whole.at, 2.0);
  EXPECT_DOUBLE_EQ(whole.lasts, 0.5);
  const Fault least = fault_of("gcs:stall", "");
  EXPECT_EQ(least.trouble.kind, Kind::stall);
  EXPECT_EQ(least.at, 0.0);
  EXPECT_TRUE(std::isnan(least.lasts));
  EXPECT_DOUBLE_EQ(fault_of("igtl:jitter=20ms", "").trouble.value, 0.020);
  EXPECT_DOUBLE_EQ(fault_of("gcs:error-code=504", "").trouble.value, 504.0);
  EXPECT_DOUBLE_EQ(fault_of("netft:error-code=0x90000000", "").trouble.value, 2415919104.0);
  EXPECT_DOUBLE_EQ(fault_of("netft:error-code=0XffFFffFF+1s", "").trouble.value, 4294967295.0);
  EXPECT_TRUE(std::isnan(fault_of("netft:error-code", "").trouble.value)) << "the device's own";
  EXPECT_DOUBLE_EQ(fault_of("gcs:slow-start=1.5s", "").trouble.value, 1.5);
  EXPECT_DOUBLE_EQ(fault_of("netft:garbage", "").trouble.value, 1.0);
}

TEST(FaultText, IsReadBackAsItWasWritten) {
  for (const char* text : {"loss=5%", "jitter=20ms", "reorder=30%", "duplicate=10%", "stall", "disconnect",
                           "garbage=1%", "half-message=1%", "saturate", "error-code=504", "error-code",
                           "error-code=0x90000000", "slow-start=2000ms"})
    EXPECT_EQ(text_of(fault_of(std::string("gcs:") + text, "").trouble), text);
}

TEST(FaultText, WhatIsNoneIsRefusedWithWhatWasExpected) {
  for (const auto& [text, why] : {std::pair{"loss=5%", "no driver is named"},
                                  {":loss", "no driver is named"},
                                  {"", "no driver"},
                                  {"netft:los=5%", "there is no fault 'los'"},
                                  {"netft:", "there is no fault ''"},
                                  {"netft:loss=5", "'5' is no value of 'loss'"},
                                  {"netft:loss=101%", "no value"},
                                  {"netft:loss=150 %", "no value"},
                                  {"netft:loss=-1%", "no value"},
                                  {"netft:loss=nan%", "no value"},
                                  {"netft:loss=1e400%", "no value"},
                                  {"igtl:jitter=20", "no value"},
                                  {"igtl:jitter=20us", "no value"},
                                  {"igtl:jitter=-20ms", "'-20ms' is no value of 'jitter'"},
                                  {"igtl:jitter=2e6s", "no value"},
                                  {"gcs:error-code=1.5", "no value"},
                                  {"gcs:error-code=1e10", "no value"},
                                  {"gcs:error-code=-504", "no value"},
                                  {"gcs:error-code=", "no value"},
                                  {"netft:error-code=0x", "no value"},
                                  {"netft:error-code=0x1g", "no value"},
                                  {"netft:error-code=0x-1", "no value"},
                                  {"netft:error-code=0x100000000", "no value"},
                                  {"gcs:stall=1", "'stall' has no value"},
                                  {"gcs:stall@3", "'3' is no time"},
                                  {"gcs:stall@-3s", "no time"},
                                  {"gcs:stall@3s+0s", "no time to last"},
                                  {"gcs:stall@3s+", "no time to last"},
                                  {"gcs:stall@infs", "no time"}}) {
    SCOPED_TRACE(text);
    EXPECT_THAT(refused_fault(text), testing::HasSubstr(why));
    EXPECT_THAT(refused_fault(text), testing::HasSubstr("expected DRIVER:FAULT[=V][@TIME][+TIME]"));
    EXPECT_THAT(refused_fault(text), testing::Not(testing::HasSubstr("\n")));
  }
}

}  // namespace
}  // namespace enc::app
