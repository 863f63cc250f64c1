#include "hw_drivers/gcs/wire/answer.h"

#include <array>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hw_drivers/gcs/wire/command.h"
#include "hw_drivers/gcs/wire/error_text.h"

namespace enc::gcs {
namespace {

const std::string kStream = "X=1.5 \nY=0 \nZ=-2e-3\n0\n\xB1\n(c)2019 PI, C-887.53, 1, 2\n\n20.5\n";
const std::vector<std::string> kAnswers{"X=1.5 \nY=0 \nZ=-2e-3\n",      "0\n", "\xB1\n",
                                        "(c)2019 PI, C-887.53, 1, 2\n", "\n",  "20.5\n"};

std::vector<std::string> read_in(const std::vector<std::string>& pieces) {
  std::vector<std::string> answers;
  AnswerReader reader;
  for (std::string_view piece : pieces)
    while (!piece.empty()) {
      piece.remove_prefix(reader.take(piece));
      if (!reader.complete()) continue;
      answers.emplace_back(reader.answer());
      reader.next();
    }
  return answers;
}

TEST(GcsAnswer, EndsWithALineThatNoBlankEnds) { EXPECT_EQ(read_in({kStream}), kAnswers); }

TEST(GcsAnswer, AnySegmentationGivesTheSame) {
  std::mt19937_64 random(5);
  for (int run = 0; run < 2000; ++run) {
    std::vector<std::string> pieces;
    for (std::size_t at = 0; at < kStream.size();) {
      const std::size_t size = 1 + random() % 6;
      pieces.push_back(kStream.substr(at, size));
      at += size;
    }
    ASSERT_EQ(read_in(pieces), kAnswers) << run;
  }
}

TEST(GcsAnswer, TooLongIsRefusedForGood) {
  AnswerReader reader;
  EXPECT_EQ(reader.take(std::string(kMostText, ' ')), kMostText);
  EXPECT_FALSE(reader.overflown());
  static_cast<void>(reader.take("1\n"));
  EXPECT_TRUE(reader.overflown());
  EXPECT_FALSE(reader.complete());
  reader.next();
  EXPECT_EQ(reader.take("0\n"), 2U);
  EXPECT_FALSE(reader.complete());
}

TEST(GcsAnswer, AxesInAnyOrderEachOnce) {
  std::array<double, 3> values{};
  EXPECT_TRUE(read_axes("Z=3 \nX=1 \nY=-2.5e-1\n", "XYZ", values));
  EXPECT_EQ(values, (std::array{1.0, -0.25, 3.0}));
  for (const char* text : {"", "\n", "X=1 \nY=2\n", "X=1 \nX=1 \nY=2 \nZ=3\n", "X=1 \nY=2 \nZ=\n",
                           "X=1 \nY=2 \nU=3\n", "X=1 \nY=2 \nZ=nan\n", "X 1 \nY=2 \nZ=3\n", "0\n"})
    EXPECT_FALSE(read_axes(text, "XYZ", values)) << text;
  int error = 0;
  EXPECT_TRUE(read_error("-1004\n", error));
  EXPECT_EQ(error, -1004);
  EXPECT_FALSE(read_error("X=1\n", error));
  double single = 0;
  EXPECT_TRUE(read_single("20.5\n", single));
  EXPECT_EQ(single, 20.5);
  EXPECT_FALSE(read_single("X=20.5\n", single));
}

TEST(GcsCommand, LinesAreToTheByte) {
  Text text;
  EXPECT_TRUE(add_move(text, from_wire_units({1.5, 0, -0.25, 0, 0, -2})));
  EXPECT_EQ(text.view(), "MOV X 1.5 Y 0 Z -0.25 U 0 V 0 W -2\n");
  EXPECT_FALSE(add_move(text, {0, 0, kUnset, 0, 0, 0}));
  text.clear();
  add_velocity(text, 0.02);
  add_servo(text, true);
  add_line(text, "POS?");
  EXPECT_EQ(text.view(), "VLS 20\nSVO X 1 Y 1 Z 1 U 1 V 1 W 1\nPOS?\n");
}

TEST(GcsError, EachNumberHasASentenceAndAWayOut) {
  EXPECT_EQ(error_words(5),
            "error 5: not referenced, or a servo is off; reference it (FRF) and switch the servos on (SVO)");
  EXPECT_EQ(error_words(0), "error 0: none");
  EXPECT_EQ(error_words(4711), "error 4711: look it up in the controller's manual (GCS 2)");
  int before = -1;
  for (const ErrorMeaning& one : error_meanings()) {
    EXPECT_GT(one.number, before);
    before = one.number;
    EXPECT_FALSE(one.what.empty());
    EXPECT_EQ(one.to_do.empty(), one.number == 0);
  }
  EXPECT_EQ(error_meanings().size(), 52U);
}

}  // namespace
}  // namespace enc::gcs
