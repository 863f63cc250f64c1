// Commands to a controller: lines, and single bytes that need no end of line.
#pragma once

#include "hw_drivers/gcs/wire/coordinates.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {

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
// A command and the end of its line: "POS?", "ERR?", "FRF".
void add_line(Text& text, std::string_view words) noexcept;

}  // namespace enc::gcs
