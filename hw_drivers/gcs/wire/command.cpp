#include "hw_drivers/gcs/wire/command.h"

#include <cmath>

namespace enc::gcs {

bool add_move(Text& text, const Coordinates& to) noexcept {
  const Coordinates wire = to_wire_units(to);
  for (const double value : wire)
    if (!std::isfinite(value)) return false;
  text.add("MOV");
  for (std::size_t i = 0; i < kAxes; ++i) text.add(' ').add(kAxisNames[i]).add(' ').add(wire[i]);
  text.add(kLineEnd);
  return true;
}

void add_velocity(Text& text, double velocity) noexcept {
  text.add("VLS ").add(millimetres(velocity)).add(kLineEnd);
}

void add_servo(Text& text, bool on) noexcept {
  text.add("SVO");
  for (const char axis : kAxisNames) text.add(' ').add(axis).add(on ? " 1" : " 0");
  text.add(kLineEnd);
}

void add_points(Text& text, double cycle) noexcept {
  text.add("SPA X 0x19001900 1").add(kLineEnd).add("SCT T ").add(1e3 * cycle).add(kLineEnd);
}
void add_own_path(Text& text) noexcept { add_line(text, "SPA X 0x19001900 0"); }

void add_line(Text& text, std::string_view words) noexcept { text.add(words).add(kLineEnd); }

}  // namespace enc::gcs
