// Messages of OpenIGTLink, protocol 3 (header of version 2), of which each is a datagram here: 58 bytes of
// header, then 12 of extended header with the message's number, then what it says. All big-endian. Version 1
// is read, too; its messages have no number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/frames.h"

namespace enc::igtl {

inline constexpr std::size_t kHeader = 58, kExtendedHeader = 12, kTransform = 48;
inline constexpr std::size_t kMostBytes = 1472;  // of a message: what a datagram of Ethernet holds

// Of a body, as the header has it: polynomial 0x42F0E1EBA9EA3693, from 0, not reflected.
[[nodiscard]] std::uint64_t crc64(std::span<const std::byte> bytes) noexcept;

// Text in a field of fixed length: what is longer is cut.
template <std::size_t kLength>
struct Name {
  std::array<char, kLength> letters{};
  Name() = default;
  explicit Name(std::string_view text) noexcept { text.copy(letters.data(), kLength); }
  [[nodiscard]] std::string_view view() const noexcept {
    const std::string_view all(letters.data(), kLength);
    return all.substr(0, all.find('\0'));
  }
};

struct Message {
  Name<12> type;    // "TRANSFORM", "STATUS", "STT_TRANS"
  Name<20> device;  // whose: "stylusToTracker"
  std::int64_t stamp_ns = 0;
  bool numbered = false;
  std::uint32_t number = 0;  // where it is numbered
  // Of the bytes it was read from: what it says, and what it says about that in pairs of words.
  std::span<const std::byte> content, metadata;
};

enum class Wrong : std::uint8_t { nothing, cut, version, size, checksum };
// Why a message is none; `message` is set where it is one.
[[nodiscard]] Wrong read(std::span<const std::byte> bytes, Message& message) noexcept;

// A numbered message, in a buffer that never grows.
class Written {
 public:
  Written(std::string_view type, std::string_view device, std::int64_t stamp_ns, std::uint32_t number,
          std::span<const std::byte> content, std::string_view key = {},
          std::string_view value = {}) noexcept;
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<std::byte, 512> bytes_{};
  std::size_t size_ = 0;
};

// The content of a TRANSFORM: the columns of the rotation, then the place in mm, single precision. False
// where it is not of that size, holds what is no number, or turns by what is no rotation.
[[nodiscard]] bool read_transform(std::span<const std::byte> content, Pose<'C', 'T'>& X_CT) noexcept;
[[nodiscard]] std::array<std::byte, kTransform> transform(const Pose<'C', 'T'>& X_CT) noexcept;
// The same to the last bit, as metadata: "x y z qx qy qz qw", mm, in decimal. A TRANSFORM is 30 nm coarse at
// half a metre.
inline constexpr std::string_view kPoseKey = "pose";
[[nodiscard]] std::string pose_text(const Pose<'C', 'T'>& X_CT);
// The value of a key in metadata; empty: there is none.
[[nodiscard]] std::string_view value_of(std::span<const std::byte> metadata, std::string_view key) noexcept;
[[nodiscard]] bool read_pose(std::string_view text, Pose<'C', 'T'>& X_CT) noexcept;
// The content of a STATUS that all is well.
[[nodiscard]] bool read_status(std::span<const std::byte> content, int& code) noexcept;  // false: it is none
[[nodiscard]] std::array<std::byte, 31> status(std::uint16_t code) noexcept;             // 1: all is well

}  // namespace enc::igtl
