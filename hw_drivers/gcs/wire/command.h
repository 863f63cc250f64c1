// What is sent to a controller: lines, and single bytes that need no end of line.
#pragma once

#include "hw_drivers/gcs/wire/coordinates.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {

inline constexpr char kStopByte = '\x18';  // #24: stands at once
inline constexpr char kRoomByte = '\x0b';  // #11: how many points its buffer still takes
inline constexpr char kLineEnd = '\n';
// In what a fake answers to *IDN?: its time goes on by a cycle with each MOV, and not by itself.
inline constexpr std::string_view kLockstep = "lockstep";

// "MOV X 1.5 Y 0 Z 0 U 0 V 0 W 0\n". False, and nothing is added, where a coordinate is no number.
[[nodiscard]] bool add_move(Text& text, const Coordinates& to) noexcept;
// "VLS 20\n": the velocity of the platform, m/s.
void add_velocity(Text& text, double velocity) noexcept;
// "SVO X 1 Y 1 Z 1 U 1 V 1 W 1\n".
void add_servo(Text& text, bool on) noexcept;
// Its path is made of points, one each cycle, s: "SPA X 0x19001900 1\nSCT T 10\n"; or its own.
void add_points(Text& text, double cycle) noexcept;
void add_own_path(Text& text) noexcept;
// A word and the end of its line: "POS?", "ERR?", "FRF".
void add_line(Text& text, std::string_view words) noexcept;

}  // namespace enc::gcs
