// The datagrams between a fake vendor's library and the fake arm behind it. Both run on one machine, so they
// are the bytes of these structures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

namespace enc::arm {

inline constexpr std::uint32_t kMagic = 0x454e4341;  // "ENCA"
inline constexpr std::uint16_t kVersion = 2;

enum class Message : std::uint16_t { hello = 1, force, bye, state };

struct Header {
  std::uint32_t magic = kMagic;
  std::uint16_t version = kVersion;
  Message message = Message::state;
};

// From the library: it connects, commands a force, or leaves.
struct Command {
  Header header{};
  std::uint64_t session = 0;  // number of the client, so that a repeated hello is no new client
  std::uint64_t number = 0;   // of the force, counted from 1
  std::uint64_t state = 0;    // number of the state that the force answers; 0: it ends a force, at any time
  std::array<double, 3> force{};  // N, in R
  std::uint64_t enabled = 0;      // 1: the motors are on
  // Watchdog of the device's firmware, s: without a newer force for so long the force ends; 0: none.
  double watchdog = 0.0;
};

// Bits of State::flags.
inline constexpr std::uint32_t kLockstep = 1;      // time advances with each force
inline constexpr std::uint32_t kUncalibrated = 2;  // the encoders are not referenced
inline constexpr std::uint32_t kThrows = 4;        // test aid: the library throws while it is asked for this

// From the fake: the arm now.
struct State {
  Header header{};
  std::uint64_t number = 0;                           // counted from 1
  std::uint64_t answers = 0;                          // number of the last force received
  std::array<double, 3> joints{}, tip{}, velocity{};  // rad or m; m and m/s in R
  std::array<double, 3> home{};                       // the tip with all joints at 0, m in R
  double peak = 0.0, continuous = 0.0;                // N
  double warmth = 0.0;                                // of the warmest motor, 1: too hot
  std::uint32_t buttons = 0;                          // bit 0: button 1 is pressed
  std::uint32_t error = 0;                            // number of the vendor; 0: none
  std::uint32_t flags = 0;
  std::uint32_t unused = 0;
};

template <class Content>
[[nodiscard]] std::array<std::byte, sizeof(Content)> bytes_of(const Content& content) noexcept {
  static_assert(std::is_trivially_copyable_v<Content> && std::has_unique_object_representations_v<Header>);
  std::array<std::byte, sizeof(Content)> bytes;
  std::memcpy(bytes.data(), &content, sizeof(Content));
  return bytes;
}

// Returns false, and leaves `content` alone, for a datagram of another kind, size or version.
[[nodiscard]] inline bool read_header(std::span<const std::byte> bytes, std::size_t size, Header& header) {
  if (bytes.size() != size) return false;
  std::memcpy(&header, bytes.data(), sizeof(Header));
  return header.magic == kMagic && header.version == kVersion;
}
[[nodiscard]] inline bool read(std::span<const std::byte> bytes, State& state) noexcept {
  Header header;
  if (!read_header(bytes, sizeof(State), header) || header.message != Message::state) return false;
  std::memcpy(&state, bytes.data(), sizeof(State));
  return true;
}
[[nodiscard]] inline bool read(std::span<const std::byte> bytes, Command& command) noexcept {
  Header header;
  if (!read_header(bytes, sizeof(Command), header) || header.message < Message::hello ||
      header.message > Message::bye)
    return false;
  std::memcpy(&command, bytes.data(), sizeof(Command));
  return true;
}

// Where a fake arm listens and its library connects.
struct Place {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;
};
// Reads "127.0.0.1:18970"; returns false for any other text.
[[nodiscard]] bool read_place(const std::string& text, Place& place) noexcept;

}  // namespace enc::arm
