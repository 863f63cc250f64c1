// The fake controller, byte by byte: every command of PIPython 2.11.0.6, and the answers of a C-887.
#include "hw_drivers/gcs/fake/controller.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "hw_drivers/gcs/fake/commands.h"
#include "tests/support/devices.h"

namespace enc::gcs {
namespace {

struct Bench {
  test::FollowingMachine machine;
  Controller controller;
  std::int64_t now = 0;  // ms

  explicit Bench(const ControllerSettings& settings = {}) : controller(machine, settings) { pass(1); }
  std::string say(const std::string& bytes) { return std::string(controller.take(bytes)); }
  void pass(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) controller.cycle(Time(Duration(1'000'000 * now++)));
  }
  int rest() {  // ms until it stands
    int passed = 0;
    for (; !controller.at_rest() && passed < 10'000; ++passed) pass(1);
    return passed;
  }
  int error(const std::string& command) {
    EXPECT_EQ(say(command + "\n"), "") << command;
    return std::stoi(say("ERR?\n"));
  }
};

const std::string kZero = "X=0 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n";
const std::string kOnes = "X=1 \nY=1 \nZ=1 \nU=1 \nV=1 \nW=1\n";

TEST(GcsController, SaysWhatItIs) {
  Bench bench;
  EXPECT_EQ(bench.say("*IDN?\n"),
            "(c)2019 Physik Instrumente (PI) GmbH & Co. KG Encounter fake, C-887.53, 119000000, 2.10.0.1\n");
  EXPECT_EQ(bench.say("CSV?\n"), "2.0\n");
  EXPECT_EQ(bench.say("ERR?\n"), "0\n");
  EXPECT_EQ(bench.say("SAI?\n"), "X \nY \nZ \nU \nV \nW\n");
  EXPECT_EQ(bench.say("SAI? ALL\n"), "X \nY \nZ \nU \nV \nW\n");
  EXPECT_EQ(bench.say("CST? X\n"), "X=H-840.D2\n");
  EXPECT_EQ(bench.say("PUN? Z U\n"), "Z=MM \nU=DEG\n");
  EXPECT_EQ(bench.say("SSN?\n"), "119000000\n");
  const std::string help = bench.say("HLP?\n");
  EXPECT_EQ(help.find("The following commands are valid: \n"), 0U);
  EXPECT_TRUE(help.ends_with(" \nend of help\n"));
  EXPECT_NE(help.find("\nFRF? ["), std::string::npos);
  EXPECT_EQ(help.find("INI"), std::string::npos);
}

TEST(GcsController, MovesAsTold) {
  Bench bench;
  EXPECT_EQ(bench.say("MOV X 2\n"), "");
  EXPECT_EQ(bench.say("ERR?\n"), "0\n");
  EXPECT_EQ(bench.say("\x05"), "3f\n");
  EXPECT_EQ(bench.say("ONT? X\n"), "X=0\n");
  EXPECT_EQ(bench.say("\x07"), "\xB1\n");
  bench.rest();
  EXPECT_EQ(bench.say("\x05"), "0\n");
  EXPECT_EQ(bench.say("ONT?\n"), kOnes);
  EXPECT_EQ(bench.say("\x04"), "0x9000\n");
  EXPECT_EQ(bench.say("POS? X\n"), "X=2\n");
  EXPECT_EQ(bench.say("\x06"), "1\n");
  EXPECT_EQ(bench.say("\x06"), "0\n");
  EXPECT_EQ(bench.say("MOV X 1.23456789012 Z -0.5\n"), "");
  EXPECT_EQ(bench.say("MOV?\n"), "X=1.23456789012 \nY=0 \nZ=-0.5 \nU=0 \nV=0 \nW=0\n");
  bench.rest();
  EXPECT_EQ(bench.say("MVR X 1 W 2\n"), "");
  bench.rest();
  EXPECT_EQ(bench.say("POS? W X\n"), "W=2 \nX=2.23456789012\n");
  EXPECT_LT((bench.machine.pose.p() - bench.machine.can.machine.zero().p() - Vec3(2.23456789012e-3, 0, -5e-4))
                .norm(),
            1e-12);
}

// Rest to rest over 20 mm at 50 mm/s and 0.41 m/s2: 0.4 s and 50 / 410 s; the last steps take longer.
TEST(GcsController, KeepsItsVelocityAndAcceleration) {
  Bench bench;
  EXPECT_EQ(bench.say("MOV X 20\n"), "");
  double fastest = 0, hardest = 0;
  Vec3 before = bench.machine.pose.p(), velocity{0, 0, 0};
  int passed = 0;
  for (; !bench.controller.at_rest(); ++passed) {
    bench.pass(1);
    const Vec3 now = (bench.machine.pose.p() - before) / 1e-3;
    before = bench.machine.pose.p();
    fastest = std::max(fastest, now.norm());
    hardest = std::max(hardest, (now - velocity).norm() / 1e-3);
    velocity = now;
  }
  EXPECT_NEAR(passed, 522, 10);
  EXPECT_NEAR(fastest, 0.05, 1e-9);
  EXPECT_LE(hardest, 0.41 * (1 + 1e-6));
  EXPECT_GT(hardest, 0.40);
}

TEST(GcsController, AStopBrakesAndIsAnError) {
  for (const std::string& stop : {std::string("\x18"), std::string("\x1b"), std::string("STP\n"),
                                  std::string("HLT\n"), std::string("HLT X\n")}) {
    Bench bench;
    EXPECT_EQ(bench.say("MOV X 20\n"), "");
    bench.pass(200);
    const double at = bench.controller.measured()[0];
    EXPECT_EQ(bench.say(stop), "");
    EXPECT_EQ(bench.say("ERR?\n"), "10\n");
    EXPECT_EQ(bench.say("ERR?\n"), "0\n");
    bench.rest();
    const double stood = bench.controller.measured()[0];
    const double braking = 0.05 * 0.05 / (2 * 0.41 * (stop.starts_with("HLT") ? 1 : 4));
    EXPECT_NEAR(stood - at, braking, 0.1e-3) << stop;
    bench.pass(1000);
    EXPECT_EQ(bench.controller.measured()[0], stood);
    EXPECT_EQ(bench.say("ONT? X\n"), "X=1\n");
    EXPECT_EQ(bench.error("MOV X 1"), 0);  // and it starts anew
  }
}

TEST(GcsController, IsReferencedFirst) {
  ControllerSettings settings;
  settings.referenced = false;
  Bench bench(settings);
  bench.machine.pose = Pose<'R', 'H'>::shift(0.002, 0, bench.machine.pose.p().z());
  EXPECT_EQ(bench.say("FRF?\n"), kZero);
  EXPECT_EQ(bench.say("POS?\n"), kZero);
  EXPECT_EQ(bench.error("MOV X 1"), 5);
  EXPECT_EQ(bench.error("FRF X"), 0);
  bench.pass(1);
  EXPECT_EQ(bench.say("FRF? X\n"), "X=1\n");
  EXPECT_EQ(bench.error("MOV X 1"), 0);
  bench.rest();
  EXPECT_EQ(bench.error("FRF"), 0);
  EXPECT_EQ(bench.say("\x07"), "\xB0\n");
  EXPECT_EQ(bench.error("MOV X 2"), 53);
  EXPECT_EQ(bench.say("POS? X\n"), "X=0\n");
  bench.rest();
  EXPECT_EQ(bench.say("\x07"), "\xB1\n");
  EXPECT_EQ(bench.say("FRF?\n"), kOnes);
  EXPECT_EQ(bench.error("FRF A"), 15);
}

TEST(GcsController, ServosAreKept) {
  Bench bench;
  EXPECT_EQ(bench.say("SVO? X\n"), "X=1\n");
  EXPECT_EQ(bench.error("SVO X 0"), 0);
  EXPECT_EQ(bench.say("SVO?\n"), "X=0 \nY=1 \nZ=1 \nU=1 \nV=1 \nW=1\n");
  EXPECT_EQ(bench.error("MOV Y 1"), 5);
  EXPECT_EQ(bench.error("SVO X 1 Y 1"), 0);
  EXPECT_EQ(bench.error("MOV Y 1"), 0);
  EXPECT_EQ(bench.error("SVO X 2"), 17);
}

TEST(GcsController, LimitsAreSaidAndKept) {
  Bench bench;
  const double most = std::stod(bench.say("TMX? X\n").substr(2));
  EXPECT_LT(std::stod(bench.say("TMN? X\n").substr(2)), -45);
  EXPECT_GT(most, 45);
  EXPECT_EQ(bench.error("MOV X " + std::to_string(most + 0.01)), 7);
  EXPECT_EQ(bench.error("MOV X " + std::to_string(most - 0.01)), 0);
  EXPECT_EQ(bench.error("MOV X " + std::to_string(most - 0.01) + " Z 15"), 7);  // together they are too far
  EXPECT_EQ(bench.say("VMO? X 1.0\n"), "1\n");
  EXPECT_EQ(bench.say("VMO? X 100\n"), "0\n");
  EXPECT_EQ(bench.say("ERR?\n"), "0\n");  // a question is no error
}

TEST(GcsController, VelocityAndPivotHaveTheirRules) {
  Bench bench;
  EXPECT_EQ(bench.say("VLS?\n"), "50\n");
  EXPECT_EQ(bench.error("VLS 20"), 0);
  EXPECT_EQ(bench.say("VLS?\n"), "20\n");
  EXPECT_EQ(bench.error("VLS 101"), 8);
  EXPECT_EQ(bench.error("VLS -1"), 8);
  EXPECT_EQ(bench.say("SPI?\n"), "R=0 \nS=0 \nT=0\n");
  EXPECT_EQ(bench.error("SPI R 0 S 0 T 12.5"), 0);
  EXPECT_EQ(bench.say("SPI? T\n"), "T=12.5\n");
  EXPECT_EQ(bench.error("MOV W 1"), 0);
  EXPECT_EQ(bench.error("VLS 30"), 53);
  bench.rest();
  EXPECT_EQ(bench.error("SPI T 0"), 9);
  EXPECT_EQ(bench.say("VLS?\n"), "20\n");
  EXPECT_EQ(bench.say("SPI? T\n"), "T=12.5\n");
}

TEST(GcsController, WhatIsWrongIsAnErrorAndHasNoAnswer) {
  Bench bench;
  for (const auto& [line, error] : {std::pair{"XYZ", 2},
                                    {"POS? A", 15},
                                    {"POS? X X", 22},
                                    {"MOV", 26},
                                    {"MOV X", 24},
                                    {"MOV X 1 Y", 24},
                                    {"MOV X 1 X 2", 22},
                                    {"MOV X one", 25},
                                    {"MOV X nan", 25},
                                    {"MOV Q 1", 15},
                                    {"SAI? SOME", 1},
                                    {"VLS", 26},
                                    {"VLS 1 2", 24},
                                    {"SPI X 1", 15},
                                    {"\x02", 2}})
    EXPECT_EQ(bench.error(line), error) << line;
  EXPECT_EQ(bench.error(std::string(kMostText + 1, 'a')), 3);
  EXPECT_EQ(bench.say("ERR?\n"), "0\n");
  EXPECT_TRUE(bench.controller.at_rest());
}

TEST(GcsController, TakesSeveralLinesAtOnceAndOneInPieces) {
  Bench bench;
  EXPECT_EQ(bench.say("SVO X 1\nERR?\n"), "0\n");
  EXPECT_EQ(bench.say("\n\r\n\x05POS? X\r\n\x07"), "0\nX=0\n\xB1\n");
  EXPECT_EQ(bench.say("pos?"), "");
  EXPECT_EQ(bench.say(" x Y\nPOS? X"), "");  // axis names are case-sensitive
  EXPECT_EQ(bench.say("\nERR?\n"), "X=0\n15\n");
  EXPECT_EQ(bench.error("MOV\x05 X 1"), 2);  // a byte is a command only at the start of a line
  EXPECT_EQ(bench.say("MOV X"), "");
  bench.controller.forget_line();
  EXPECT_EQ(bench.say("ERR?\n"), "0\n");
}

// Lines of all kinds, damaged, in any pieces.
TEST(GcsController, BearsWhateverComesAndPiecesDoNotMatter) {
  std::mt19937_64 random(3);
  std::string some =
      "\x05\x18\x07MOV X 1 Z -0.5\nMOV X 50 Z 20\nMVR Z -9 U 8\nSPI R 1\nVLS 20\nSVO X 0\nFRF\nHLT X\n";
  std::vector<std::string> lines;
  for (const Commands::Entry& one : Commands::all()) lines.push_back(std::string(one.word) + "\n");
  for (std::size_t from = 0; from < some.size(); from = some.find('\n', from) + 1)
    lines.push_back(some.substr(from, some.find('\n', from) + 1 - from));
  Bench whole, pieces;
  double farthest = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    std::string text = lines[random() % lines.size()];
    for (std::uint64_t n = random() % 3; n > 0; --n) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, 1 + random() % 3);
          break;
        default:
          text.insert(at, lines[random() % lines.size()].substr(0, random() % 8));
      }
      if (text.empty()) text = "\n";
    }
    const std::string answer = whole.say(text);
    std::string together;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t size = 1 + random() % 5;
      together += pieces.say(text.substr(at, size));
      at += size;
    }
    ASSERT_EQ(answer, together) << i << ": " << text;
    whole.pass(5);
    pieces.pass(5);
    ASSERT_TRUE(whole.machine.can.contains(whole.machine.pose)) << i << ": " << text;
    farthest = std::max(farthest, whole.controller.measured()[0]);
  }
  EXPECT_GT(farthest, 0.001);  // it did move
  EXPECT_EQ(whole.controller.measured(), pieces.controller.measured());
}

}  // namespace
}  // namespace enc::gcs
