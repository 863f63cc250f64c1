// The part of Force Dimension's DHD (libdhd.so) that the driver calls: our own declarations of its C
// interface. Lengths are in m, forces in N, and each function returns a negative number on failure.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hw_drivers/arm/library.h"

namespace enc::forcedimension::dhd {

// Places in dhdGetStatus().
inline constexpr std::size_t kStatuses = 32;  // room for more than the library has
inline constexpr std::size_t kPower = 0, kReset = 3, kError = 9, kTimeGuard = 11;
// Error numbers of dhdErrorGetLast().
inline constexpr int kNoError = 0, kCommunication = 2, kNoDevice = 5, kTimeout = 7, kDeviceInUse = 20;
// Result of dhdSetForce() and others that is no failure: no newer data yet.
inline constexpr int kTimeGuarded = 1;
inline constexpr double kWatchdogStep = 125e-6;  // s, unit of dhdSetWatchdog()

// The library's functions. Every pointer is set. `id`: of an open device.
struct Functions {
  int (*open)() = nullptr;
  int (*open_serial)(int serial) = nullptr;
  int (*close)(char id) = nullptr;
  const char* (*system_name)(char id) = nullptr;
  int (*serial_number)(std::uint16_t* serial, char id) = nullptr;
  void (*sdk_version)(int* major, int* minor, int* release, int* revision) = nullptr;
  int (*status)(int* status, char id) = nullptr;
  int (*enable_force)(unsigned char on, char id) = nullptr;
  int (*stop)(char id) = nullptr;  // force off, brakes on
  int (*enable_expert)() = nullptr;
  int (*disable_expert)() = nullptr;
  int (*set_watchdog)(unsigned char steps, char id) = nullptr;
  int (*set_max_force)(double newtons, char id) = nullptr;
  int (*position)(double* x, double* y, double* z, char id) = nullptr;
  int (*velocity)(double* x, double* y, double* z, char id) = nullptr;
  int (*set_force)(double x, double y, double z, char id) = nullptr;
  unsigned (*buttons)(char id) = nullptr;
  int (*last_error)() = nullptr;
  const char* (*last_error_text)() = nullptr;

  // Throws Error (kind device) if the library lacks one.
  explicit Functions(const arm::Library& library);
  // The last error of this thread in the vendor's words, printable.
  [[nodiscard]] std::string error_text() const;
};

// "DHD error 2: no communication; see cable and power"
[[nodiscard]] std::string words_of(int error);

}  // namespace enc::forcedimension::dhd
