// What is sent to a controller: lines, and single bytes that need no end of line.
#pragma once

#include "hw_drivers/gcs/wire/coordinates.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {

inline constexpr char kStopByte = '\x18';  // #24: stands at once
inline constexpr char kLineEnd = '\n';

// "MOV X 1.5 Y 0 Z 0 U 0 V 0 W 0\n". False, and nothing is added, where a coordinate is no number.
[[nodiscard]] bool add_move(Text& text, const Coordinates& to) noexcept;
// "VLS 20\n": the velocity of the platform, m/s.
void add_velocity(Text& text, double velocity) noexcept;
// "SVO X 1 Y 1 Z 1 U 1 V 1 W 1\n".
void add_servo(Text& text, bool on) noexcept;
// A word and the end of its line: "POS?", "ERR?", "FRF".
void add_line(Text& text, std::string_view words) noexcept;

}  // namespace enc::gcs
