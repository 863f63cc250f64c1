// What the driver asks before anything moves, of the fake and of devices that are not as they should be.
#include "hw_drivers/gcs/drive/inspect.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "tests/support/devices/following_machine.h"

namespace enc::gcs {
namespace {

struct Device {
  test::FollowingMachine machine;
  Controller controller;
  GcsSettings settings;
  std::map<std::string, std::string> instead;  // of its own answers
  std::string told;                            // all of it

  explicit Device(const ControllerSettings& with = {}) : controller(machine, with) {
    controller.cycle(Time{});
  }
  Found inspected() {
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
    try {
      inspected();
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::device);
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return e.what();
    }
    return "";
  }
};

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(GcsInspect, FindsWhatIsThereAndTellsNothing) {
  Device device;
  EXPECT_EQ(device.controller.take("SPI T 12.5\nBAD\n"), "");
  const Found found = device.inspected();
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
