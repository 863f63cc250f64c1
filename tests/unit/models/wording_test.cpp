// Words of a file that go to a terminal.
#include "models/schema/wording.h"

#include <gtest/gtest.h>

namespace enc::models {
namespace {

TEST(Wording, WhatMovesATerminalsCursorIsASpace) {
  EXPECT_EQ(printable("left\033[2J\r\n\t01\x7F.png"), "left [2J   01 .png");
  EXPECT_EQ(printable("a\xC2\x9B"
                      "31m"),
            "a  31m");  // U+009B, a terminal's other way to begin
  EXPECT_EQ(printable("H\xC3\xA4nde \xC2\xB5m \xE2\x80\xA6"), "H\xC3\xA4nde \xC2\xB5m \xE2\x80\xA6");
  EXPECT_EQ(printable("\xC2"), "\xC2");
  EXPECT_EQ(printable("'\xC2' is"), "'\xC2' is");  // half a letter, and what is behind it stays
  EXPECT_EQ(quoted("a\nb"), "'a b'");
}

TEST(Wording, NamesOfAFileAreShownAsTheyMayBe) {
  EXPECT_EQ(advice("ball", {"bal\n"}), "did you mean 'bal '?");
  EXPECT_EQ(advice("b", {"stylus\t", "plane"}), "the names here are 'stylus ', 'plane'");
  EXPECT_EQ(unknown_text("[behaviour.\t]", "kin", {"kind"}),
            "unknown key 'kin'; expected a key of [behaviour. ]; did you mean 'kind'?");
}

// Letter by letter two names of this length would take hours.
TEST(Wording, AVeryLongNameIsNearToNone) {
  const std::string one(1'000'000, 'a'), other(1'000'000, 'b');
  EXPECT_EQ(nearest_name(one, {other, "radius_mm"}), "");
  EXPECT_EQ(nearest_name("radius_m", {other, "radius_mm"}), "radius_mm");
  EXPECT_EQ(nearest_name(std::string(1'000'000, '_'), {"radius_mm"}), "");
}

TEST(Wording, LowerCaseIsOfTheLatinLetters) { EXPECT_EQ(lower_case(".JPG\xC3\x84"), ".jpg\xC3\x84"); }

}  // namespace
}  // namespace enc::models
