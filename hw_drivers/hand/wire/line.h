// A line of a hand tracking streamer, as parser.py of PyPI hand-tracking-sdk 1.1.0 reads it:
//   Right wrist | f=12 | t=1500000000: x, y, z, qx, qy, qz, qw
//   Right landmarks | f=12 | t=1500000000: 21 times x, y, z
//   Head pose: as a wrist
// Metadata behind '|' are optional: f or frame is the number of the frame, t, ts or timestamp its time in ns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace enc::hand {

enum class Side : std::uint8_t { left, right, head };
enum class Kind : std::uint8_t { wrist, landmarks, pose };
inline constexpr std::size_t kPoseValues = 7, kLandmarkValues = 63;

struct Packet {
  Side side = Side::right;
  Kind kind = Kind::wrist;
  std::array<double, kLandmarkValues> values{};
  std::size_t count = 0;
  std::optional<std::int64_t> frame, stamp_ns;
  bool fake = false;  // a fake says so in its metadata
};

enum class LineFault : std::uint8_t { nothing, empty, colon, label, metadata, number, count };

// False positives of the SDK are refused: a number that is not finite or has '_', text that is not ASCII.
[[nodiscard]] LineFault read(std::string_view line, Packet& packet) noexcept;

// The line of a packet, with a line feed. Numbers come back to the last bit.
[[nodiscard]] std::string line_of(const Packet& packet);

inline constexpr std::size_t kLongestLine = 4096;

// Cuts a stream into lines. A line that is too long is skipped.
class Lines {
 public:
  // The place for received bytes; never empty.
  [[nodiscard]] std::span<std::byte> room() noexcept;
  void came(std::size_t count) noexcept { size_ += count; }
  // The next whole line, without its line feed; empty: none yet. Valid until the next call.
  [[nodiscard]] std::optional<std::string_view> next() noexcept;
  [[nodiscard]] std::int64_t skipped() const noexcept { return skipped_; }

 private:
  std::array<char, kLongestLine> bytes_{};
  std::size_t begin_ = 0, size_ = 0;  // size_: end of the received bytes
  bool skips_ = false;
  std::int64_t skipped_ = 0;
};

}  // namespace enc::hand
