// The text of GCS: locale-independent numbers in a buffer that never grows, the commands to a controller, and
// its answers.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "hw_drivers/gcs/wire/coordinates.h"

namespace enc::gcs {

// The longest text in either direction. Six axes with numbers of 20 characters are far shorter.
inline constexpr std::size_t kMostText = 4096;

class Text {
 public:
  Text& add(std::string_view part) noexcept;
  Text& add(char character) noexcept { return add(std::string_view(&character, 1)); }
  // Writes twelve significant digits, as "%.12g" in the C locale; zero has no sign.
  Text& add(double number) noexcept;
  Text& add(int whole) noexcept;

  void clear() noexcept { size_ = 0, cut_ = false; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] bool cut() const noexcept { return cut_; }  // true if a part did not fit and was left out
  [[nodiscard]] std::string_view view() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<char, kMostText> bytes_{};
  std::size_t size_ = 0;
  bool cut_ = false;
};

// Reads a text that must be one finite number. Returns false and keeps `number` otherwise.
[[nodiscard]] bool read_number(std::string_view text, double& number) noexcept;
[[nodiscard]] bool read_number(std::string_view text, int& whole) noexcept;

// Removes and returns the next word of a text; blanks separate words. Empty: no word is left.
[[nodiscard]] std::string_view next_word(std::string_view& text) noexcept;

// The text without leading and trailing blanks and line ends.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

// Commands to a controller: lines, and single bytes without an end of line.

inline constexpr char kStopByte = '\x18';  // #24: stop at once
inline constexpr char kRoomByte = '\x0b';  // #11: free places in the point buffer
inline constexpr char kLineEnd = '\n';
// Part of a fake's answer to *IDN?: its time advances only with each MOV, by a cycle.
inline constexpr std::string_view kLockstep = "lockstep";

// "MOV X 1.5 Y 0 Z 0 U 0 V 0 W 0\n". Returns false and adds nothing if a coordinate is not a number.
[[nodiscard]] bool add_move(Text& text, const Coordinates& to) noexcept;
// "VLS 20\n": the velocity of the platform, m/s.
void add_velocity(Text& text, double velocity) noexcept;
// "SVO X 1 Y 1 Z 1 U 1 V 1 W 1\n".
void add_servo(Text& text, bool on) noexcept;
// Sets a path made of points, one for each cycle (s): "SPA X 0x19001900 1\nSCT T 10\n"; or the controller's
// own path.
void add_points(Text& text, double cycle) noexcept;
void add_own_path(Text& text) noexcept;
// Adds a command and its end of line: "POS?", "ERR?", "FRF".
void add_line(Text& text, std::string_view words) noexcept;

// Reads answers from a stream of bytes that may be cut anywhere. Each inner line ends with a blank and a line
// feed, the last one with only a line feed.
class AnswerReader {
 public:
  // Takes bytes up to the end of the pending answer, and returns their number. While an answer is complete(),
  // it takes no bytes.
  std::size_t take(std::string_view bytes) noexcept;
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  // True if the answer exceeded kMostText: the following bytes cannot be trusted, and everything is refused
  // from then on.
  [[nodiscard]] bool overflown() const noexcept { return answer_.cut(); }
  [[nodiscard]] std::string_view answer() const noexcept { return answer_.view(); }  // with its line feeds
  void next() noexcept;                                                              // discards the answer

 private:
  Text answer_;
  bool complete_ = false;
};

// Reads "X=1.5 \nY=0\n": one number for each axis. Returns false if one is missing, doubled, unknown or not a
// number.
[[nodiscard]] bool read_axes(std::string_view answer, std::string_view axes,
                             std::span<double> values) noexcept;
// Reads one number, "20.5\n".
[[nodiscard]] bool read_single(std::string_view answer, double& number) noexcept;
// Reads the answer to ERR?: "0\n".
[[nodiscard]] bool read_error(std::string_view answer, int& number) noexcept;

}  // namespace enc::gcs
