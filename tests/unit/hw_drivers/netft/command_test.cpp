// The command interface: the bytes of the manual, and back; its units.
#include "hw_drivers/netft/wire/command.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "hw_drivers/netft/wire/configuration.h"
#include "tests/unit/hw_drivers/hex.h"

namespace enc::netft {
namespace {

using tests::from_hex, tests::hex;

TEST(NetftCommand, QuestionsAreTwentyBytes) {
  const std::string zeros(30, '0');
  EXPECT_EQ(hex(bytes_of(Ask{})), "00" + zeros + "00000000");
  EXPECT_EQ(hex(bytes_of(Ask{.question = Question::calibration})), "01" + zeros + "00000000");
  EXPECT_EQ(hex(bytes_of(Ask{.monitor = 0x1234, .bias = true, .clear_latch = true})),
            "00" + zeros + "12340003");
  Ask ask;
  ASSERT_TRUE(read(from_hex("00" + zeros + "00010002"), ask));
  EXPECT_EQ(ask.question, Question::reading);
  EXPECT_EQ(ask.monitor, 1);
  EXPECT_FALSE(ask.bias);
  EXPECT_TRUE(ask.clear_latch);
  EXPECT_FALSE(read(from_hex("02" + zeros + "00000000"), ask));  // WRITETRANSFORM
  EXPECT_FALSE(read(from_hex("01" + zeros + "000000"), ask));
}

TEST(NetftCommand, AnswersAreTheBytesOfTheManual) {
  const Calibration calibration{2, 3, 1'000'000, 1'000'000, {4000, 4000, 12'000, 400, 400, 400}};
  const std::string wire =
      "1234"
      "02"
      "03"
      "000f4240"
      "000f4240"
      "0fa0"
      "0fa0"
      "2ee0"
      "0190"
      "0190"
      "0190";
  EXPECT_EQ(hex(bytes_of(calibration)), wire);
  Calibration back;
  ASSERT_TRUE(read(from_hex(wire), back));
  EXPECT_EQ(back.per_force, 1'000'000U);
  EXPECT_EQ(back.scale, calibration.scale);
  const Reading reading{0x8001, {1, -1, 32'767, -32'768, 0, 256}};
  EXPECT_EQ(hex(bytes_of(reading)),
            "1234"
            "8001"
            "0001"
            "ffff"
            "7fff"
            "8000"
            "0000"
            "0100");
  Reading again;
  EXPECT_FALSE(read(from_hex("1235"
                             "8001"
                             "0001"
                             "ffff"
                             "7fff"
                             "8000"
                             "0000"
                             "0100"),
                    again));
  EXPECT_FALSE(read(from_hex(wire), again));
  EXPECT_FALSE(read(from_hex("1234"), back));
}

TEST(NetftCommand, WhatIsWrittenIsRead) {
  std::mt19937 random(2);  // NOLINT: the same at each run
  const auto any = [&] { return static_cast<std::uint16_t>(random()); };
  for (int i = 0; i < 1000; ++i) {
    Reading reading{any(), {}};
    Calibration calibration{static_cast<std::uint8_t>(any()),
                            static_cast<std::uint8_t>(any()),
                            static_cast<std::uint32_t>(random()),
                            static_cast<std::uint32_t>(random()),
                            {}};
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      reading.coarse[axis] = static_cast<std::int16_t>(any());
      calibration.scale[axis] = any();
    }
    Reading read_back;
    Calibration calibration_back;
    ASSERT_TRUE(read(bytes_of(reading), read_back));
    ASSERT_TRUE(read(bytes_of(calibration), calibration_back));
    ASSERT_EQ(bytes_of(read_back), bytes_of(reading));
    ASSERT_EQ(bytes_of(calibration_back), bytes_of(calibration));
  }
}

TEST(NetftCommand, CodesAreUnitsWhoseFactorIsExact) {
  EXPECT_EQ(force_of_code(2), 1.0);
  EXPECT_EQ(force_of_code(1), 4.4482216152605);
  EXPECT_EQ(torque_of_code(3), 1.0);
  EXPECT_NEAR(torque_of_code(1), 0.1129848290276167, 1e-15);
  for (const int none : {-1, 0, 7, 255}) {
    EXPECT_TRUE(std::isnan(force_of_code(none)));
    EXPECT_TRUE(std::isnan(torque_of_code(none)));
  }
}

}  // namespace
}  // namespace enc::netft
