// What devices say goes to a terminal: a line each, whatever bytes a wire brought.
#include "trial/devices/device_log.h"

#include <gtest/gtest.h>

namespace enc::trial {
namespace {

TEST(DeviceLog, ALineOfADeviceIsOneLine) {
  DeviceLog log;
  log.say("serial 7\nstate hash  122d7c00183e94e0\033[2J\x9B");
  EXPECT_EQ(log.lines(), std::vector<std::string>{"serial 7\\nstate hash  122d7c00183e94e0\\x1b[2J\\x9b"});
}

}  // namespace
}  // namespace enc::trial
