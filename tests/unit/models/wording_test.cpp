// Words of a file that go to a terminal.
#include "models/schema/wording.h"

#include <gtest/gtest.h>

namespace enc::models {
namespace {

TEST(Wording, WhatATerminalObeysIsShownInLetters) {
  EXPECT_EQ(printable("left\033[2J\r\n\t01\x7F.png"), "left\\x1b[2J\\r\\n\\t01\\x7f.png");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("a\u009b31m"), "a\\u009b31m");  // a terminal's other way to begin
  EXPECT_EQ(printable("a\x9B 31m"), "a\\x9b 31m");    // and in one byte
  for (const auto& [letter, shown] : {std::pair{"\u2028", "\\u2028"},
                                      {"\u202e", "\\u202e"},
                                      {"\u2066", "\\u2066"},
                                      {"\u2069", "\\u2069"},
                                      {"\u200f", "\\u200f"}})
    EXPECT_EQ(printable(letter), shown);
  for (const char* plain : {"H\u00e4nde \u00b5m \u2026 \u2212 \U0001F3BE", "a\\b", ""})
    EXPECT_EQ(printable(plain), plain);
  EXPECT_EQ(printable("'\xC2' is \xE2\x80"),
            "'\\xc2' is \\xe2\\x80");  // half a letter, and what is behind it stays
  EXPECT_EQ(printable("\xC0\x8A\xED\xA0\x80"),
            "\\xc0\\x8a\\xed\\xa0\\x80");  // letters that UTF-8 does not have
  EXPECT_EQ(quoted("a\nb"), "'a\\nb'");
  EXPECT_EQ(quoted(std::string(79, 'x') + "\u00e4y"), "'" + std::string(79, 'x') + "...'");
}

TEST(Wording, NamesOfAFileAreShownAsTheyMayBe) {
  EXPECT_EQ(advice("ball", {"bal\n"}), "did you mean 'bal\\n'?");
  EXPECT_EQ(advice("b", {"stylus\t", "plane"}), "the names here are 'stylus\\t', 'plane'");
  EXPECT_EQ(unknown_text("[behaviour.\t]", "kin", {"kind"}),
            "unknown key 'kin'; expected a key of [behaviour.\\t]; did you mean 'kind'?");
}

TEST(Wording, AllNamesAreOffered) {
  std::vector<std::string> names;
  std::string list;
  for (int i = 0; i < 30; ++i) {
    names.push_back("name_number_" + std::to_string(i));
    list += (i == 0 ? "'" : ", '") + names.back() + "'";
  }
  EXPECT_EQ(advice("quite_another", names), "the names here are " + list);
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
