#include "hw_drivers/phantom/wire/hd.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace enc::phantom::hd {

Functions::Functions(const arm::Library& library) {
  library.find("hdInitDevice", init_device);
  library.find("hdDisableDevice", disable_device);
  library.find("hdMakeCurrentDevice", make_current);
  library.find("hdBeginFrame", begin_frame);
  library.find("hdEndFrame", end_frame);
  library.find("hdGetError", get_error);
  library.find("hdGetErrorString", error_text);
  library.find("hdEnable", enable);
  library.find("hdDisable", disable);
  library.find("hdGetIntegerv", get_integers);
  library.find("hdGetDoublev", get_doubles);
  library.find("hdGetString", get_string);
  library.find("hdSetDoublev", set_doubles);
  library.find("hdCheckCalibration", check_calibration);
  library.find("hdUpdateCalibration", update_calibration);
  library.find("hdStartScheduler", start_scheduler);
  library.find("hdStopScheduler", stop_scheduler);
  library.find("hdSetSchedulerRate", set_rate);
  library.find("hdScheduleAsynchronous", schedule);
  library.find("hdUnschedule", unschedule);
}

Enum Functions::take_errors() const {
  constexpr int kMost = 16;  // errors of one frame; a library that never ends them must not hold us
  Enum first = kSuccess;
  for (int i = 0; i < kMost; ++i) {
    const Enum error = get_error().code;
    if (error == kSuccess) break;
    if (first == kSuccess) first = error;
  }
  return first;
}

namespace {

struct ErrorWords {
  Enum error;
  const char *name, *words;
};
constexpr std::array<ErrorWords, 20> kErrors{{
    {0x0100, "HD_INVALID_ENUM", "the device does not know a parameter"},
    {0x0101, "HD_INVALID_VALUE", "a value is not allowed"},
    {0x0102, "HD_INVALID_OPERATION", "not possible in this state"},
    {0x0103, "HD_INVALID_INPUT_TYPE", "a parameter of another type"},
    {0x0104, "HD_BAD_HANDLE", "no such device"},
    {0x0200, "HD_WARM_MOTORS", "the motors are too warm; let them cool"},
    {0x0201, "HD_EXCEEDED_MAX_FORCE", "a force beyond the device's limit"},
    {0x0202, "HD_EXCEEDED_MAX_FORCE_IMPULSE", "the force rose too fast"},
    {0x0203, "HD_EXCEEDED_MAX_VELOCITY", "the arm moved too fast"},
    {0x0204, "HD_FORCE_ERROR", "the force could not be exerted; see cable and power"},
    {0x0300, "HD_DEVICE_FAULT", "the device is faulty; see cable and power"},
    {0x0301, "HD_DEVICE_ALREADY_INITIATED", "another program has it; end that program"},
    {0x0302, "HD_COMM_ERROR", "no communication; see cable and power"},
    {0x0303, "HD_COMM_CONFIG_ERROR", "its port is configured wrongly"},
    {0x0304, "HD_TIMER_ERROR", "the scheduler's timer failed"},
    {0x0400, "HD_ILLEGAL_BEGIN", "a frame within a frame"},
    {0x0401, "HD_ILLEGAL_END", "the end of no frame"},
    {0x0402, "HD_FRAME_ERROR", "an error of a frame"},
    {0x0500, "HD_INVALID_PRIORITY", "a wrong priority"},
    {0x0600, "HD_INVALID_LICENSE", "OpenHaptics has no licence on this machine"},
}};

}  // namespace

std::string words_of(Enum error) {
  const auto* const found = std::find_if(kErrors.begin(), kErrors.end(),
                                         [error](const ErrorWords& one) { return one.error == error; });
  if (found == kErrors.end()) return fmt::format("HD error {:#06x}", error);
  return fmt::format("{} ({:#06x}): {}", found->name, error, found->words);
}

}  // namespace enc::phantom::hd
