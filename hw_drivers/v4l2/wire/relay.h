// Kernel calls of a camera over a local socket: the driver's end. The other end is a fake in another process,
// which answers each ioctl as a kernel would, and shares its buffers' memory.
//
// A camera's name begins with '@': an abstract name of a Unix socket, which leaves no file behind. After the
// connection the fake sends an eventfd that counts its full buffers. Then each call is one packet, and so is
// its answer.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/base/time.h"
#include "hw_drivers/v4l2/wire/system.h"

namespace enc::v4l2 {

inline constexpr std::size_t kMostData = 512;  // bytes: the struct of any request here

// Stamp of a frame from the world's time 0, of a fake in lockstep: a stamp of 0 is that of a driver that sets
// none.
inline constexpr Duration kLockstepZero{1'000'000'000};

struct Call {
  enum class Kind : std::uint32_t { control, map };
  Kind kind = Kind::control;
  std::uint32_t request = 0;  // of control
  std::uint32_t size = 0;     // of data
  std::array<std::byte, kMostData> data{};
};
struct Answer {
  std::int32_t result = 0;  // 0, or the negative error number
  std::uint32_t size = 0;
  std::array<std::byte, kMostData> data{};
};

[[nodiscard]] inline bool is_relayed(std::string_view path) { return path.starts_with('@'); }

// Sends a packet's used bytes, and a descriptor unless it is -1. False: the other end is gone.
bool send(int socket, const Call& call) noexcept;
bool send(int socket, const Answer& answer, int descriptor = -1) noexcept;
// Receives a packet. False: none came, the other end is gone, or its length is wrong.
bool receive(int socket, Call& call) noexcept;
bool receive(int socket, Answer& answer, int& descriptor) noexcept;  // -1: no descriptor came

// A socket with that name: connected, or listening. Negative: the error number.
// `patience`: longest time that a call then waits, in whole seconds.
[[nodiscard]] int connect_to(std::string_view name, std::chrono::seconds patience) noexcept;
[[nodiscard]] int listen_at(std::string_view name) noexcept;

// The driver's end. A fake that does not answer within `patience` counts as unplugged.
[[nodiscard]] std::unique_ptr<System> relayed(std::chrono::seconds patience = std::chrono::seconds(1));

}  // namespace enc::v4l2
