// The part of LeapC (libLeapC.so) that the driver calls: our own declarations of its C interface, whose
// structures are packed. Lengths are in mm, times in microseconds of the library's clock.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hw_drivers/arm/library.h"

namespace enc::leap::leapc {

using Result = std::uint32_t;
inline constexpr Result kSuccess = 0, kUnknownError = 0xE2010000, kInsufficientBuffer = 0xE2010003,
                        kTimeout = 0xE2010004, kNotConnected = 0xE2010005;
// "eLeapRS_NotConnected (0xe2010005)"; an unknown number has no name.
[[nodiscard]] std::string words_of(Result result);

// Types of messages.
inline constexpr std::uint32_t kConnection = 1, kConnectionLost = 2, kDevice = 3, kDeviceFailure = 4,
                               kTracking = 0x100, kDeviceLost = 0x104;

using Connection = void*;
using Device = void*;

#pragma pack(push, 1)
struct Vector {
  std::array<float, 3> v{};  // x, y, z
};
struct Quaternion {
  float x = 0, y = 0, z = 0, w = 1;
};
struct Bone {
  Vector begin, end;  // prev_joint, next_joint
  float width = 0;    // of the flesh around it
  Quaternion rotation;
};
struct Digit {
  std::int32_t id = 0;
  std::array<Bone, 4> bones;  // from the palm to the tip
  std::uint32_t extended = 0;
};
struct Palm {
  Vector position, stabilized_position, velocity, normal;
  float width = 0;
  Vector direction;
  Quaternion orientation;
};
struct Hand {
  std::uint32_t id = 0, flags = 0;
  std::int32_t type = 0;  // kLeft or kRight
  float confidence = 0;
  std::uint64_t visible_time = 0;
  float pinch_distance = 0, grab_angle = 0, pinch_strength = 0, grab_strength = 0;
  Palm palm;
  std::array<Digit, 5> digits;  // from the thumb on
  Bone arm;                     // ends at the wrist
};
inline constexpr std::int32_t kLeft = 0, kRight = 1;
struct FrameHeader {
  void* reserved = nullptr;
  std::int64_t frame = 0, timestamp = 0;
};
struct TrackingEvent {
  FrameHeader info;
  std::int64_t tracking_frame = 0;
  std::uint32_t hands_count = 0;
  const Hand* hands = nullptr;
  float rate = 0;  // Hz
};
struct DeviceReference {
  void* handle = nullptr;
  std::uint32_t id = 0;
};
struct DeviceEvent {
  std::uint32_t flags = 0;
  DeviceReference device;
  std::uint32_t status = 0;
};
struct Message {
  std::uint32_t size = sizeof(Message), type = 0;
  const void* event = nullptr;  // valid until the next poll
  std::uint32_t device = 0;
};
struct ConnectionConfig {
  std::uint32_t size = sizeof(ConnectionConfig), flags = 0;
  const char* server = nullptr;  // namespace of the service; null: the usual one
};
struct DeviceInfo {
  std::uint32_t size = sizeof(DeviceInfo), status = 0, capabilities = 0, kind = 0, baseline = 0;
  std::uint32_t serial_length = 0;  // room at `serial`, with the zero at its end
  char* serial = nullptr;
  float horizontal_view = 0, vertical_view = 0;
  std::uint32_t range = 0;
};
#pragma pack(pop)

static_assert(sizeof(Bone) == 44 && sizeof(Digit) == 184 && sizeof(Palm) == 80 && sizeof(Hand) == 1084);
static_assert(sizeof(FrameHeader) == 24 && sizeof(TrackingEvent) == 48 && sizeof(Message) == 20);
static_assert(sizeof(DeviceEvent) == 20 && sizeof(DeviceInfo) == 44 && sizeof(ConnectionConfig) == 16);

// The library's functions.
struct Functions {
  Result (*create)(const ConnectionConfig*, Connection*) = nullptr;
  Result (*open)(Connection) = nullptr;
  Result (*poll)(Connection, std::uint32_t timeout_ms, Message*) = nullptr;
  void (*close)(Connection) = nullptr;
  void (*destroy)(Connection) = nullptr;
  std::int64_t (*now)() = nullptr;
  Result (*set_mode)(Connection, std::uint32_t mode) = nullptr;
  Result (*open_device)(DeviceReference, Device*) = nullptr;
  Result (*device_info)(Device, DeviceInfo*) = nullptr;
  void (*close_device)(Device) = nullptr;

  Functions() = default;
  // Sets every pointer. Throws Error (kind device) if the library lacks a function.
  explicit Functions(const arm::Library& library);
};

}  // namespace enc::leap::leapc
