// The driver's side of the wire, byte by byte, with time set by the test.
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/gcs/drive/conversation.h"
#include "hw_drivers/gcs/drive/inspect.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "tests/support/devices.h"
#include "tests/support/refusal.h"

namespace enc::gcs {
namespace {

constexpr Duration ms(std::int64_t n) { return Duration(n * 1'000'000); }
const std::string kAsk = "POS?\nERR?\n", kServos = "SVO?\nERR?\n";
const std::string kOn = "X=1 \nY=1 \nZ=1 \nU=1 \nV=1 \nW=1\n";
const std::string kZero = "X=0 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n";
const Stand kStand{{0, 0, 0.1}, {0, 0, 0}, {0, 0, 0.3}};

struct Talk {
  GcsSettings settings;
  Conversation conversation;
  Order order;

  // Path generation by the controller; the driver has set it before the time begins.
  explicit Talk(const GcsSettings& with = own_path())
      : settings(with), conversation(with, kStand, {}, Duration{}) {
    if (with.velocity > 0.0 || with.path != "own") return;
    aim(0, -100);
    EXPECT_EQ(sent(-100), "SPA X 0x19001900 0\nSPA? X 0x19001900\nERR?\n");
    heard("X 0x19001900=0\n0\n", -100);
  }
  static GcsSettings own_path() {
    GcsSettings settings;
    settings.path = "own";
    return settings;
  }
  std::string sent(std::int64_t at) { return std::string(conversation.send(ms(at))); }
  bool heard(const std::string& bytes, std::int64_t at) { return conversation.take(bytes, ms(at)); }
  void aim(double x, std::int64_t at) {
    ++order.number;
    order.to = {x, 0, 0, 0, 0, 0};
    order.given = ms(at);
    conversation.told(order);
  }
  void stop() {
    ++order.stops;
    order.stopped = order.number;
    conversation.told(order);
  }
  [[nodiscard]] Health health() const { return conversation.report().health; }
};

std::string move(const std::string& x) { return "MOV X " + x + " Y 0 Z 0 U 0 V 0 W 0\n"; }

TEST(GcsConversation, AsksOneQuestionAtATimeAndTellsNothingByItself) {
  Talk talk;
  EXPECT_EQ(talk.sent(0), kAsk);
  for (int t = 1; t < 100; ++t) EXPECT_EQ(talk.sent(t), "") << t;
  EXPECT_TRUE(talk.heard(kZero, 100));
  EXPECT_EQ(talk.sent(100), "");  // ERR? is still to come
  EXPECT_TRUE(talk.heard("0\n", 101));
  EXPECT_EQ(talk.sent(101), kAsk);
  talk.heard(kZero + "0\n", 102);
  EXPECT_EQ(talk.sent(102), "");  // poll_ms is 2
  EXPECT_EQ(talk.sent(103), kAsk);
  EXPECT_FALSE(talk.conversation.moving());
  EXPECT_EQ(talk.conversation.answers(), 3);
  EXPECT_EQ(talk.conversation.longest_answer(), ms(101));
}

TEST(GcsConversation, ASetPointGoesOnceAndNoOftenerThanTheCycle) {
  GcsSettings settings = Talk::own_path();
  settings.velocity = 0.02;
  Talk talk(settings);
  talk.aim(0.001, 0);
  // The driver sets the velocity once, and reads it back, before the first command.
  EXPECT_EQ(talk.sent(0), "VLS 20\nVLS?\nERR?\n");
  EXPECT_FALSE(talk.conversation.moving());
  talk.heard("20.001\n0\n", 0);
  talk.aim(0.001, 2);
  EXPECT_EQ(talk.sent(2), "SPA X 0x19001900 0\nSPA? X 0x19001900\nERR?\n");
  talk.heard("X 0x19001900=0\n0\n", 2);
  talk.aim(0.001, 4);
  EXPECT_EQ(talk.sent(4), move("1") + kAsk);
  std::string last = kAsk;
  std::map<int, std::string> moves;
  for (int t = 5; t < 30; ++t) {
    if (!last.empty()) talk.heard(kZero + "0\n", t);
    talk.aim(0.001 * t, t);
    last = talk.sent(t);
    if (last.starts_with("MOV")) moves[t] = last;
  }
  EXPECT_EQ(moves,
            (std::map<int, std::string>{{14, move("14") + kAsk}, {24, move("24") + kAsk}}));  // the newest
  EXPECT_TRUE(talk.conversation.moving());
}

TEST(GcsConversation, WithoutAFreshSetPointTheMachineIsStoppedOnce) {
  Talk talk;
  talk.aim(0.001, 0);
  EXPECT_EQ(talk.sent(0), move("1") + kAsk);
  EXPECT_EQ(talk.sent(4), "");
  EXPECT_EQ(talk.sent(5), "\x18");  // watchdog_ms is 5: also before a pending answer
  EXPECT_EQ(talk.sent(6), "");
  EXPECT_EQ(talk.conversation.watchdogs(), 1);
  talk.heard(kZero + "0\n", 6);
  EXPECT_EQ(talk.sent(50), "\x18" + kAsk);  // the first may have overtaken the set-point
  talk.heard(kZero + "10\n", 51);           // the error that our own stop leaves
  EXPECT_EQ(talk.health(), Health::ok);
  EXPECT_EQ(talk.conversation.report().errors, 0);
  talk.aim(0.002, 53);
  EXPECT_EQ(talk.sent(53), kServos);  // it replaced any other error
  talk.heard(kOn + "0\n", 54);
  talk.aim(0.002, 55);
  EXPECT_EQ(talk.sent(55), move("2") + kAsk);  // a command starts anew
}

TEST(GcsConversation, AnOldSetPointIsNotSentLate) {
  Talk talk;
  EXPECT_EQ(talk.sent(0), kAsk);
  talk.aim(0.001, 1);
  talk.heard(kZero + "0\n", 20);
  EXPECT_EQ(talk.sent(20), kAsk);
  EXPECT_FALSE(talk.conversation.moving());
}

TEST(GcsConversation, AStopGoesAtOnceEachTimeAndVoidsWhatWasToldBefore) {
  Talk talk;
  EXPECT_EQ(talk.sent(0), kAsk);
  talk.aim(0.001, 1);
  talk.stop();
  EXPECT_EQ(talk.sent(1), "\x18");
  EXPECT_EQ(talk.conversation.report().stops, 1);
  talk.heard(kZero + "10\n", 2);
  EXPECT_EQ(talk.sent(2), kServos);
  talk.heard(kOn + "0\n", 3);
  EXPECT_EQ(talk.sent(4), kAsk);  // no MOV: that set-point was sent before
  talk.heard(kZero + "0\n", 5);
  talk.stop();
  EXPECT_EQ(talk.sent(5), "\x18");
  talk.aim(0.002, 6);
  EXPECT_EQ(talk.sent(6), move("2") + kAsk);
  talk.heard(kZero + "10\n", 7);
  EXPECT_EQ(talk.health(), Health::ok);
  EXPECT_EQ(talk.sent(8), kServos);
  talk.heard(kOn + "0\n", 9);
  // Stop and command at once: the stop goes first, then the command.
  talk.stop();
  talk.aim(0.003, 30);
  EXPECT_EQ(talk.sent(30), "\x18" + move("3") + kAsk);
}

TEST(GcsConversation, AStopThatIsNotOursIsAFault) {
  Talk talk;
  talk.aim(0.001, 0);
  EXPECT_EQ(talk.sent(0), move("1") + kAsk);
  talk.heard(kZero + "10\n", 1);
  EXPECT_EQ(talk.health(), Health::fault);
  EXPECT_EQ(talk.conversation.report().error, 10);
  EXPECT_EQ(talk.conversation.loss(), Loss::fault);
  for (int t = 2; t < 1000; ++t) {
    talk.aim(0.001, t);
    ASSERT_EQ(talk.sent(t), "") << "a person may be there; at " << t;
  }
}

// SIGSTOP: this side wakes up and finds the loop's earlier set-point.
TEST(GcsConversation, WhatWasGivenBeforeAPauseIsNotSentAfterIt) {
  Talk talk;
  talk.aim(0.001, 0);
  EXPECT_EQ(talk.sent(0), move("1") + kAsk);
  talk.heard(kZero + "0\n", 1);
  ++talk.order.number;
  talk.order.given = ms(2);
  talk.conversation.told(talk.order);
  EXPECT_EQ(talk.sent(150), "\x18" + kAsk);
  EXPECT_FALSE(talk.conversation.moving());
  EXPECT_EQ(talk.conversation.watchdogs(), 1);
}

TEST(GcsConversation, AVelocityThatIsNotTakenEndsIt) {
  for (const auto& [answer, loss] : {std::pair{"50\n", Loss::velocity},
                                     {"20\n8\n", Loss::none},
                                     {"20\n53\n", Loss::fault},
                                     {"nan\n", Loss::garbled}}) {
    GcsSettings settings = Talk::own_path();
    settings.velocity = 0.02;
    Talk talk(settings);
    talk.aim(0.001, 0);
    EXPECT_EQ(talk.sent(0), "VLS 20\nVLS?\nERR?\n");
    talk.heard(answer, 1);
    EXPECT_EQ(talk.conversation.loss(), loss) << answer;
    EXPECT_FALSE(talk.conversation.moving());
  }
}

// A stop overtakes the lines before it: a controller may execute them afterwards.
TEST(GcsConversation, AStopThatOvertookASetPointGoesOnceMore) {
  Talk talk;
  talk.aim(0.001, 0);
  EXPECT_EQ(talk.sent(0), move("1") + kAsk);
  talk.stop();
  EXPECT_EQ(talk.sent(1), "\x18");
  EXPECT_EQ(talk.sent(2), "");
  talk.heard(kZero + "10\n", 3);
  EXPECT_EQ(talk.sent(3), "\x18" + kServos);
  talk.heard(kOn + "10\n", 4);  // of the second
  EXPECT_EQ(talk.conversation.loss(), Loss::none);
  EXPECT_EQ(talk.sent(6), kServos);
  talk.heard(kOn + "0\n", 7);
  EXPECT_EQ(talk.sent(9), kAsk);
  EXPECT_EQ(talk.conversation.report().stops, 1);
}

// Error 10 is the last one; the servo states show any earlier error.
TEST(GcsConversation, AFaultThatOurStopHidIsFound) {
  Talk talk;
  talk.stop();
  EXPECT_EQ(talk.sent(0), "\x18" + kAsk);
  talk.heard(kZero + "10\n", 1);
  EXPECT_EQ(talk.sent(2), kServos);
  talk.heard("X=1 \nY=1 \nZ=0 \nU=1 \nV=1 \nW=1\n", 3);
  EXPECT_EQ(talk.conversation.loss(), Loss::servo_off);
}

// Our stop explains one error 10. It explains no more errors once one was seen, or once a later question was
// answered.
TEST(GcsConversation, OurStopExcusesOneErrorTen) {
  for (const char* first : {"10\n", "0\n"}) {
    Talk talk;
    talk.stop();
    EXPECT_EQ(talk.sent(0), "\x18" + kAsk);
    talk.heard(kZero + first, 1);
    EXPECT_EQ(talk.health(), Health::ok) << first;
    const bool seen = first[0] == '1';
    EXPECT_EQ(talk.sent(2), seen ? kServos : kAsk);
    talk.heard((seen ? kOn : kZero) + "10\n", 3);
    EXPECT_EQ(talk.health(), Health::fault) << first;
  }
}

// Points of 0.5 mm: 50 mm/s for a cycle of 10 ms.
struct PointTalk {
  std::string tell(double x, std::int64_t at) {
    ++order.number;
    order.to = {x, 0, 0, 0, 0, 0};
    order.given = ms(at);
    talk.told(order);
    return std::string(talk.send(ms(at)));
  }
  Order order;
  Conversation talk{GcsSettings{}, kStand, {}, Duration{}, 0.05};
};

// The driver sends one point each cycle, and none while more than two wait at the controller. No point is
// farther than the platform gets in a cycle.
TEST(GcsConversation, PointsAreWatchedAndNeverFar) {
  PointTalk points;
  EXPECT_EQ(points.tell(0.01, 0), "SPA X 0x19001900 1\nSCT T 10\nSPA? X 0x19001900\nERR?\n");
  points.talk.take("X 0x19001900=1\n0\n", ms(0));
  EXPECT_TRUE(points.talk.by_points());
  EXPECT_EQ(points.tell(0.01, 2), move("0.5") + "\x0b" + kAsk) << "10 mm in a cycle of 10 ms, at 50 mm/s";
  points.talk.take("64\n" + kZero + "0\n", ms(3));
  EXPECT_EQ(points.tell(0.0007, 12), move("0.7") + "\x0b" + kAsk);
  points.talk.take("61\n" + kZero + "0\n", ms(13));
  EXPECT_EQ(points.tell(0.0008, 22), "\x0b" + kAsk) << "three wait";
  points.talk.take("62\n" + kZero + "0\n", ms(23));
  EXPECT_EQ(points.tell(0.0009, 24), move("0.9") + "\x0b" + kAsk);
}

// The controller takes a cycle for each point: a late point no longer belongs to its cycle.
TEST(GcsConversation, AfterALateAnswerAPointIsNoFartherThanACycleAllows) {
  PointTalk points;
  static_cast<void>(points.tell(0.0, 0));
  points.talk.take("X 0x19001900=1\n0\n", ms(0));
  EXPECT_EQ(points.tell(0.0004, 10), move("0.4") + "\x0b" + kAsk);
  EXPECT_EQ(points.tell(0.005, 150), "") << "still awaited";
  points.talk.take("64\n" + kZero + "0\n", ms(160));
  EXPECT_EQ(points.tell(0.005, 161), move("0.9") + "\x0b" + kAsk) << "0.5 mm in a cycle of 10 ms, at 50 mm/s";
}

TEST(GcsConversation, ErrorsAreSaidUntilASetPointIsTaken) {
  Talk talk;
  talk.aim(0.001, 0);
  EXPECT_EQ(talk.sent(0), move("1") + kAsk);
  talk.heard(kZero + "7\n", 1);
  EXPECT_EQ(talk.health(), Health::out_of_range);
  talk.aim(0.001, 2);
  EXPECT_EQ(talk.sent(2), kAsk);  // no cycle yet
  talk.heard(kZero + "0\n", 3);
  EXPECT_EQ(talk.health(), Health::out_of_range);
  talk.aim(0.001, 10);
  EXPECT_EQ(talk.sent(10), move("1") + kAsk);
  talk.heard(kZero + "0\n", 11);
  EXPECT_EQ(talk.health(), Health::ok);
  for (const auto& [error, health] : {std::pair{"5\n", Health::fault},
                                      {"8\n", Health::out_of_range},
                                      {"504\n", Health::fault},
                                      {"4711\n", Health::fault}}) {
    Talk other;
    EXPECT_EQ(other.sent(0), kAsk);
    other.heard(kZero + error, 1);
    EXPECT_EQ(other.health(), health) << error;
  }
}

TEST(GcsConversation, APositionIsTrueBetweenQuestionAndAnswer) {
  Talk talk;
  EXPECT_EQ(talk.sent(0), kAsk);
  talk.heard("X=1 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n0\n", 4);
  EXPECT_EQ(talk.conversation.report().t, ms(2));
  EXPECT_LT((talk.conversation.report().X_RH.p() - Vec3(0.001, 0, 0.3)).norm(), 1e-15);
  EXPECT_EQ(talk.conversation.report().velocity.norm(), 0.0);  // not over so short a time
  EXPECT_EQ(talk.sent(20), kAsk);
  talk.heard("X=1.5 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n0\n", 24);
  EXPECT_NEAR(talk.conversation.report().velocity.e().x(), 0.0015 / 0.022, 1e-12);  // 1.5 mm in 22 ms
}

TEST(GcsConversation, ALinkIsLostForGood) {
  Talk silent;
  EXPECT_EQ(silent.sent(0), kAsk);
  EXPECT_EQ(silent.sent(200), "");
  EXPECT_EQ(silent.conversation.loss(), Loss::none);
  EXPECT_EQ(silent.sent(201), "");
  EXPECT_EQ(silent.conversation.loss(), Loss::silent);
  silent.heard(kZero + "0\n", 202);
  EXPECT_EQ(silent.sent(300), "");
  EXPECT_EQ(silent.conversation.loss(), Loss::silent);
  for (const std::string& bad :
       {std::string("0\n"), std::string("X=0 \nY=0\n"), kZero + "X=1\n", kZero + "0\n0\n",
        std::string(5000, 'a'), std::string("HTTP/1.1 400 Bad Request\r\n")}) {
    Talk talk;
    EXPECT_EQ(talk.sent(0), kAsk);
    talk.heard(bad, 1);
    EXPECT_EQ(talk.conversation.loss(), Loss::garbled) << bad;
    EXPECT_EQ(talk.sent(10), "");
  }
  Talk closed;
  closed.conversation.closed();
  EXPECT_EQ(closed.conversation.loss(), Loss::closed);
  EXPECT_EQ(closed.sent(0), "");
}

TEST(GcsConversation, AnySegmentationOfTheAnswersGivesTheSame) {
  Talk talk;
  EXPECT_EQ(talk.sent(0), kAsk);
  for (const char byte : "X=1.25 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n7\n") {
    if (byte == '\0') break;
    talk.heard(std::string(1, byte), 1);
  }
  EXPECT_EQ(talk.conversation.loss(), Loss::none);
  EXPECT_EQ(talk.conversation.answers(), 2);
  EXPECT_EQ(talk.health(), Health::out_of_range);
  EXPECT_NEAR(talk.conversation.report().X_RH.p().x(), 0.00125, 1e-15);
}

// The driver's questions before any motion, to the fake and to faulty devices.

struct Device {
  test::FollowingMachine machine;
  Controller controller;
  GcsSettings settings;
  std::map<std::string, std::string> instead;  // replacements for its own answers
  std::string told;                            // all of it

  explicit Device(const ControllerSettings& with = {}) : controller(machine, with) {
    controller.cycle(Time{});
  }
  ControllerInfo inspected() {
    return inspect(
        [&](std::string_view line) {
          told.append(line).append(" ");
          const auto found = instead.find(std::string(line));
          const bool byte = line[0] < ' ';
          std::string own(controller.take(std::string(line) + (byte ? "" : "\n")));
          return found != instead.end() ? found->second : own;
        },
        settings, machine.can);
  }
  std::string refused() {
    return test::refusal(ErrorKind::device, [&] { inspected(); });
  }
};

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(GcsInspect, FindsWhatIsThereAndTellsNothing) {
  Device device;
  EXPECT_EQ(device.controller.take("SPI T 12.5\nBAD\n"), "");
  const ControllerInfo found = device.inspected();
  EXPECT_EQ(found.identity, "C-887.53 119000000");
  EXPECT_EQ(found.firmware, "2.10.0.1");
  EXPECT_EQ(found.velocity, 0.05);
  EXPECT_EQ(found.stand.pivot, Vec3(0, 0, 0.0125));
  EXPECT_EQ(found.left_over, 2);
  EXPECT_EQ(found.at, Coordinates{});
  EXPECT_EQ(device.told,
            "*IDN? CSV? ERR? CST? PUN? KEN? SPA? X 0x19001900 \x05 FRF? SVO? SPI? TMN? TMX? VLS? POS? ERR? ");
  EXPECT_TRUE(device.controller.at_rest());
}

TEST(GcsInspect, AFakeIsWhatSaysSo) {
  Device device;
  EXPECT_TRUE(device.inspected().fake);
  device.instead["*IDN?"] = "(c)2019 Physik Instrumente (PI) GmbH & Co. KG, C-887.53, 119000000, 2.10.0.1\n";
  EXPECT_FALSE(device.inspected().fake);
}

TEST(GcsInspect, AnotherDeviceIsNamed) {
  Device device;
  device.instead["*IDN?"] = "Acme, Coffee maker\n";
  EXPECT_EQ(device.refused(),
            "127.0.0.1:50000 is another device: it says 'Acme, Coffee maker', expected 'C-887'; correct "
            "driver.gcs.address or driver.gcs.identity");
  device.instead = {{"CSV?", "3.0\n"}};
  EXPECT_TRUE(says(device.refused(), "speaks GCS '3.0', not 2.0"));
  device.instead = {{"*IDN?", "C-887 \x1b[31m\n"}, {"CSV?", "x\n"}};
  EXPECT_TRUE(says(device.refused(), "C-887 ?[31m at"));
}

TEST(GcsInspect, WhatIsMeantOtherwiseIsRefused) {
  const std::string inches = "X=IN \nY=IN \nZ=IN \nU=DEG \nV=DEG \nW=DEG\n";
  for (const auto& [question, answer, words] :
       {std::tuple{"CST?", std::string("X=H-811.I2 \nY=H-811.I2\n"), "expected 'H-840'"},
        {"PUN?", inches, "has other units: it answered 'X=IN"},
        {"PUN?", std::string("X=MM \nY=MM \nZ=MM \nU=DEG \nV=DEG\n"), "has other units"},
        {"KEN?", std::string("TOOL1=KST\n"), "another coordinate system: it answered 'TOOL1=KST' to KEN?"},
        {"SPA? X 0x19001900", std::string("X 0x19001900=2\n"), "takes its path from elsewhere"},
        {"SPA? X 0x19001900", std::string("what\n"), "expected 0 or 1; send SPA X 0x19001900 0"},
        {"\x05", std::string("3f\n"), "moves: it answered '3f' to #5"}}) {
    Device device;
    device.instead[question] = answer;
    EXPECT_TRUE(says(device.refused(), words)) << question << ": " << device.refused();
  }
}

TEST(GcsInspect, FirmwareIsComparedByItsParts) {
  Device device;
  for (const char* least : {"", "2", "2.9.9.9", "2.10.0.1"}) {
    device.settings.firmware = least;
    EXPECT_EQ(device.refused(), "") << least;
  }
  for (const char* least : {"3", "2.10.0.2", "2.10.0.1.1", "2.11"}) {
    device.settings.firmware = least;
    EXPECT_TRUE(says(device.refused(), "has firmware '2.10.0.1', older than")) << least;
  }
}

TEST(GcsInspect, WhatIsNotReadyIsRefusedWithAWayOut) {
  ControllerSettings settings;
  settings.referenced = false;
  Device fresh(settings);
  EXPECT_TRUE(says(fresh.refused(), "is not referenced (X Y Z U V W); clear the room"));
  Device off;
  EXPECT_EQ(off.controller.take("SVO Y 0\n"), "");
  EXPECT_TRUE(says(off.refused(), "the servo of Y is off; switch it on (SVO Y 1)"));
  Device ill;
  ill.instead["POS?"] = "X=0 \nY=0\n";
  EXPECT_TRUE(says(ill.refused(), "answered 'X=0 ?Y=0' to POS?"));
  Device none;
  none.instead["TMN?"] = "\n";
  EXPECT_TRUE(says(none.refused(), "is a hexapod connected?"));
}

TEST(GcsInspect, LessThanTheRigPromisesIsRefused) {
  Device device;
  device.machine.can.speed = 0.06;
  EXPECT_TRUE(says(device.refused(), "velocity 50 of 60 mm/s; set driver.gcs.velocity_mm_s"));
  device.settings.velocity = 0.06;
  EXPECT_EQ(device.refused(), "");
  device.machine.can.speed = kUnset;
  EXPECT_TRUE(says(device.refused(), "velocity 60 of nan mm/s"));
  device.machine.can.speed = 0.05;
  device.instead["TMX?"] = "X=40 \nY=60 \nZ=60 \nU=60 \nV=60 \nW=60\n";
  EXPECT_TRUE(says(device.refused(), "X from -")) << device.refused();
  EXPECT_TRUE(
      says(device.refused(), "to 40 mm, not 50.578 to both sides; lower rig.manipulator.geometry.stroke_mm"))
      << device.refused();
  device.instead["TMX?"] = "X=50 \nY=50 \nZ=25 \nU=15 \nV=15 \nW=30\n";  // the catalogue's
  EXPECT_EQ(device.refused(), "");
  device.instead["TMX?"] = "X=60 \nY=60 \nZ=60 \nU=60 \nV=60 \nW=3\n";
  EXPECT_TRUE(says(device.refused(),
                   "to 3 degrees, not 30 to both sides; lower rig.manipulator.geometry.yaw_limit_deg"));
  device.instead["TMX?"] = "X=60 \nY=60 \nZ=60 \nU=60 \nV=60 \nW=nan\n";
  EXPECT_TRUE(says(device.refused(), "expected a number for each"));
  device.instead = {{"VLS?", "A=50\n"}};
  EXPECT_TRUE(says(device.refused(), "answered 'A=50' to VLS?"));
}

}  // namespace
}  // namespace enc::gcs
