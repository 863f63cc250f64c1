// Units in keys: "radius_mm" is a length in mm in the file and in m in memory. The suffix says it all.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace enc::models {

struct Unit {
  std::string_view suffix;  // of the key, "_mm"; empty: a plain number
  std::string_view label;   // "mm"
  int power = 0;            // SI = value * 10^power
  bool degrees = false;     // SI = value * pi / 180
  bool per_power = false;   // polynomials: SI = value * 10^(power * k) for the coefficient of d^k
};

const Unit& unit_of(std::string_view key);
std::string_view stem_of(std::string_view key);  // "radius_mm" -> "radius"

// Powers of ten move the decimal point of the shortest text, so 0.0779 mm is exactly the number written
// 0.0779e-3 in C++.
double to_si(const Unit& unit, double value, int k = 1);
// The shortest text that to_si() turns into `si` again. (A number that no text in this unit gives is replaced
// by its neighbour.)
std::string text_of(const Unit& unit, double si, int k = 1);

// By what numbers are multiplied that go from a key or column into one that differs in its unit alone: 1000
// from "tip_m" to "tip_mm". Units that no key has count, too (cm, g, rad, ...). Empty where the stems or the
// kinds of unit differ.
[[nodiscard]] std::optional<double> factor_between(std::string_view from, std::string_view to);

// To the nearest whole number of 1 / per_unit, as a file shall have it; what is too large for that, or unset,
// stays.
[[nodiscard]] double round_to(double value, double per_unit);

}  // namespace enc::models
