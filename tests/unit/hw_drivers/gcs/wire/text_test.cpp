#include "hw_drivers/gcs/wire/text.h"

#include <string>

#include <gtest/gtest.h>

namespace enc::gcs {
namespace {

std::string said(double number) { return std::string(Text().add(number).view()); }

// What PIPython 2.11.0.6 sends for the same numbers.
TEST(GcsText, NumbersHaveTwelveDigits) {
  EXPECT_EQ(said(1.23456789012345), "1.23456789012");
  EXPECT_EQ(said(2.0), "2");
  EXPECT_EQ(said(-0.5), "-0.5");
  EXPECT_EQ(said(20.0), "20");
  EXPECT_EQ(said(1e-7), "1e-07");
  EXPECT_EQ(said(-0.0), "0");
}

TEST(GcsText, NumbersAreReadWholeOrNotAtAll) {
  double number = 7.0;
  for (const char* text : {"", "-", "1,5", "1.5x", " 1", "nan", "inf", "1e999", "0x10", "+-1"})
    EXPECT_FALSE(read_number(text, number)) << text;
  EXPECT_EQ(number, 7.0);
  EXPECT_TRUE(read_number("+1.5", number));
  EXPECT_EQ(number, 1.5);
  EXPECT_TRUE(read_number("-2e-3", number));
  EXPECT_EQ(number, -0.002);
  int whole = 7;
  EXPECT_FALSE(read_number("1.5", whole));
  EXPECT_FALSE(read_number("99999999999", whole));
  EXPECT_TRUE(read_number("-1004", whole));
  EXPECT_EQ(whole, -1004);
}

TEST(GcsText, KeepsItsBound) {
  Text text;
  const std::string most(kMostText, 'a');
  EXPECT_FALSE(text.add(most).cut());
  EXPECT_TRUE(text.add('b').cut());
  EXPECT_EQ(text.view(), most);
  text.clear();
  EXPECT_FALSE(text.add('b').cut());
}

TEST(GcsText, WordsAreParted) {
  std::string_view text = "  MOV X\t1.5 \r";
  EXPECT_EQ(next_word(text), "MOV");
  EXPECT_EQ(next_word(text), "X");
  EXPECT_EQ(next_word(text), "1.5");
  EXPECT_EQ(next_word(text), "");
  EXPECT_EQ(trimmed(" X=1 \n"), "X=1");
  EXPECT_EQ(trimmed(" \n"), "");
}

}  // namespace
}  // namespace enc::gcs
