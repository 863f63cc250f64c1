// The part of OpenHaptics HD (libHD.so) that the driver calls: our own declarations of its C interface, with
// the values that its documentation gives.
#pragma once

#include <cstdint>
#include <string>

#include "hw_drivers/arm/library.h"

namespace enc::phantom::hd {

using Handle = unsigned;                    // HHD
using Enum = unsigned;                      // HDenum, HDerror
using Callback = unsigned (*)(void* data);  // HDSchedulerCallback

struct ErrorInfo {  // HDErrorInfo, returned by value
  Enum code = 0;
  int internal = 0;
  Handle handle = 0;
};

inline constexpr Handle kNoDevice = 0xFFFFFFFF;      // HD_INVALID_HANDLE
inline constexpr unsigned kDone = 0, kContinue = 1;  // of a callback
inline constexpr std::uint16_t kFirst = 65535;       // HD_MAX_SCHEDULER_PRIORITY

// Errors.
inline constexpr Enum kSuccess = 0x0000, kInvalidEnum = 0x0100, kInvalidOperation = 0x0102,
                      kBadHandle = 0x0104, kWarmMotors = 0x0200, kMaxForce = 0x0201, kForceError = 0x0204,
                      kDeviceFault = 0x0300, kAlreadyInitiated = 0x0301, kCommError = 0x0302,
                      kTimerError = 0x0304, kIllegalBegin = 0x0400, kIllegalEnd = 0x0401;
// Parameters.
inline constexpr Enum kButtons = 0x2000, kPosition = 0x2050, kVelocity = 0x2051, kTransform = 0x2052,
                      kJointAngles = 0x2100, kGimbalAngles = 0x2150, kVersion = 0x2500, kModel = 0x2501,
                      kDriverVersion = 0x2502, kVendor = 0x2503, kSerial = 0x2504, kCalibrationStyle = 0x2555,
                      kUpdateRate = 0x2600, kNominalMaxForce = 0x2603, kContinuousForce = 0x2604,
                      kMotorTemperature = 0x2605, kCurrentForce = 0x2700;
inline constexpr std::size_t kMotors = 6;  // numbers of kMotorTemperature, 0 to 1
// Capabilities.
inline constexpr Enum kForceOutput = 0x4000, kForceClamping = 0x4001, kForceRamping = 0x4002;
// Calibration: the state, and the device's ways.
inline constexpr Enum kCalibrated = 0x5000, kNeedsUpdate = 0x5001, kNeedsManual = 0x5002;
inline constexpr int kEncoderReset = 1, kAutomatic = 2, kInkwell = 4;

// The library's functions. Every pointer is set.
struct Functions {
  Handle (*init_device)(const char* name) = nullptr;
  void (*disable_device)(Handle) = nullptr;
  void (*make_current)(Handle) = nullptr;
  void (*begin_frame)(Handle) = nullptr;
  void (*end_frame)(Handle) = nullptr;
  ErrorInfo (*get_error)() = nullptr;
  const char* (*error_text)(Enum) = nullptr;
  void (*enable)(Enum) = nullptr;
  void (*disable)(Enum) = nullptr;
  void (*get_integers)(Enum, int*) = nullptr;
  void (*get_doubles)(Enum, double*) = nullptr;
  const char* (*get_string)(Enum) = nullptr;
  void (*set_doubles)(Enum, const double*) = nullptr;
  Enum (*check_calibration)() = nullptr;
  void (*update_calibration)(Enum style) = nullptr;
  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
  void (*set_rate)(unsigned long hz) = nullptr;
  unsigned long (*schedule)(Callback, void* data, std::uint16_t priority) = nullptr;
  void (*unschedule)(unsigned long) = nullptr;

  // Throws Error (kind device) if the library lacks one.
  explicit Functions(const arm::Library& library);
  // Takes all pending errors; returns the first one, or kSuccess.
  [[nodiscard]] Enum take_errors() const;
};

// "HD_WARM_MOTORS (0x0200): the motors are too warm; let them cool"; an unknown number has no name.
[[nodiscard]] std::string words_of(Enum error);
// True for errors that end the link: the device, its connection or its licence.
[[nodiscard]] constexpr bool is_grave(Enum error) noexcept { return error >= kDeviceFault; }

}  // namespace enc::phantom::hd
