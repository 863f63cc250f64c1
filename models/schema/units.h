// Units in keys: "radius_mm" is a length in mm in the file and in m in memory. The suffix alone defines the
// unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace enc::models {

struct Unit {
  std::string_view suffix;  // suffix of the key, "_mm"; empty: a plain number
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
// The shortest text that to_si() converts back to `si`. (If no text in this unit gives that number, its
// neighbour is used.)
std::string text_of(const Unit& unit, double si, int k = 1);

// Factor for numbers that move from a key or column to one that differs only in its unit: 1000 from "tip_m"
// to "tip_mm". Includes units that no key has (cm, g, rad, ...). Empty if the stems or the kinds of unit
// differ.
[[nodiscard]] std::optional<double> factor_between(std::string_view from, std::string_view to);

// Rounds to the nearest multiple of 1 / per_unit, for a file; values that are too large for that, or unset,
// stay unchanged.
[[nodiscard]] double round_to(double value, double per_unit);

}  // namespace enc::models
