#include "models/schema/units.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace enc::models {
namespace {

// Longest suffix first, because "_mm_s" also ends in "_s".
constexpr auto kUnits = std::to_array<Unit>({{"_m_s2_per_sqrt_hz", "m/s^2/sqrt(Hz)"},
                                             {"_m_s3_per_sqrt_hz", "m/s^3/sqrt(Hz)"},
                                             {"_N_per_sqrt_s", "N/sqrt(s)"},
                                             {"_N_per_mm_k", "N/mm^k", 3, false, true},
                                             {"_Ns_per_m", "N s/m"},
                                             {"_N_per_push", "N"},
                                             {"_N_per_um", "N/um", 6},
                                             {"_um_per_N", "um/N", -6},
                                             {"_N_per_mm", "N/mm", 3},
                                             {"_N_per_m", "N/m"},
                                             {"_N_per_s", "N/s"},
                                             {"_mm_s2", "mm/s^2", -3},
                                             {"_m_s2", "m/s^2"},
                                             {"_mm_s", "mm/s", -3},
                                             {"_m_s", "m/s"},
                                             {"_cycles", "cycles"},
                                             {"_deg", "deg", 0, true},
                                             {"_MPa", "MPa", 6},
                                             {"_kPa", "kPa", 3},
                                             {"_mm", "mm", -3},
                                             {"_um", "um", -6},
                                             {"_px", "px"},
                                             {"_ms", "ms", -3},
                                             {"_us", "us", -6},
                                             {"_hz", "Hz"},
                                             {"_kg", "kg"},
                                             {"_Nm", "N m"},
                                             {"_N", "N"},
                                             {"_s", "s"},
                                             {"_m", "m"},
                                             {"", ""}});

// Units as people write them in names, longest suffix first. `kind`: only units of one kind can be converted.
struct UnitSuffix {
  std::string_view suffix;
  char kind;
  double in_si;
};
constexpr auto kWritten = std::to_array<UnitSuffix>(
    {{"_N_per_mm", 'k', 1e3}, {"_N_per_um", 'k', 1e6}, {"_N_per_m", 'k', 1.0}, {"_mm_s2", 'a', 1e-3},
     {"_cm_s", 'v', 1e-2},    {"_inch", 'l', 0.0254},  {"_mm_s", 'v', 1e-3},   {"_m_s2", 'a', 1.0},
     {"_um_s", 'v', 1e-6},    {"_mrad", 'w', 1e-3},    {"_m_s", 'v', 1.0},     {"_deg", 'w', M_PI / 180.0},
     {"_rad", 'w', 1.0},      {"_MPa", 'p', 1e6},      {"_kPa", 'p', 1e3},     {"_kHz", 'f', 1e3},
     {"_khz", 'f', 1e3},      {"_min", 't', 60.0},     {"_Pa", 'p', 1.0},      {"_Hz", 'f', 1.0},
     {"_hz", 'f', 1.0},       {"_cm", 'l', 1e-2},      {"_mm", 'l', 1e-3},     {"_um", 'l', 1e-6},
     {"_nm", 'l', 1e-9},      {"_in", 'l', 0.0254},    {"_ms", 't', 1e-3},     {"_us", 't', 1e-6},
     {"_ns", 't', 1e-9},      {"_kN", 'n', 1e3},       {"_mN", 'n', 1e-3},     {"_kg", 'm', 1.0},
     {"_N", 'n', 1.0},        {"_s", 't', 1.0},        {"_m", 'l', 1.0},       {"_g", 'm', 1e-3}});

const UnitSuffix* written_in(std::string_view name) {
  const auto ends = [&](const UnitSuffix& unit) {
    return name.size() > unit.suffix.size() && name.ends_with(unit.suffix);
  };
  const auto found = std::find_if(kWritten.begin(), kWritten.end(), ends);
  return found == kWritten.end() ? nullptr : &*found;
}

// value * 10^power, rounded once. to_chars and from_chars ignore the locale.
double shift(double value, int power) {
  if (power == 0 || value == 0.0 || !std::isfinite(value)) return value;
  std::array<char, 64> text{};
  char* end = std::to_chars(text.data(), text.data() + 32, value, std::chars_format::scientific).ptr;
  char* e = end;
  while (*(e - 1) != 'e') --e;
  int exponent = 0;
  std::from_chars(*e == '+' ? e + 1 : e, end, exponent);
  end = std::to_chars(e, text.data() + text.size(), exponent + power).ptr;
  double result = 0.0;
  const bool too_large = std::from_chars(text.data(), end, result).ec == std::errc::result_out_of_range;
  if (!too_large) return result;
  return exponent + power > 0 ? std::copysign(std::numeric_limits<double>::infinity(), value) : 0.0;
}

double from_si(const Unit& unit, double si, int k) {
  if (unit.degrees) return si * 180.0 / M_PI;
  return shift(si, -unit.power * (unit.per_power ? k : 1));
}

double parsed(const std::string& text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Empty if no text near `value` gives `si`.
std::string shortest(const Unit& unit, double value, double si, int k) {
  for (int digits = 1; digits <= 17; ++digits) {
    std::string text = fmt::format("{}", parsed(fmt::format("{:.{}e}", value, digits - 1)));
    if (to_si(unit, parsed(text), k) == si) return text;
  }
  for (const double way : {-1.0, 1.0}) {
    double next = value;
    for (int i = 0; i < 4; ++i) {
      next = std::nextafter(next, way * std::numeric_limits<double>::infinity());
      if (to_si(unit, next, k) == si) return fmt::format("{}", next);
    }
  }
  return {};
}

}  // namespace

const Unit& unit_of(std::string_view key) {
  for (const Unit& unit : kUnits) {
    if (key.size() > unit.suffix.size() && key.ends_with(unit.suffix)) return unit;
  }
  return kUnits.back();
}

std::string_view stem_of(std::string_view key) {
  return key.substr(0, key.size() - unit_of(key).suffix.size());
}

double to_si(const Unit& unit, double value, int k) {
  if (unit.degrees) return value * M_PI / 180.0;
  return shift(value, unit.power * (unit.per_power ? k : 1));
}

std::string text_of(const Unit& unit, double si, int k) {
  if (si == 0.0) return "0";
  const double value = from_si(unit, si, k);
  std::string text = shortest(unit, value, si, k);
  if (text.empty()) text = shortest(unit, value, to_si(unit, value, k), k);
  return text.empty() ? fmt::format("{}", value) : text;
}

std::optional<double> factor_between(std::string_view from, std::string_view to) {
  const UnitSuffix *a = written_in(from), *b = written_in(to);
  if (a == nullptr || b == nullptr || a->kind != b->kind) return std::nullopt;
  if (from.substr(0, from.size() - a->suffix.size()) != to.substr(0, to.size() - b->suffix.size()))
    return std::nullopt;
  return a->in_si / b->in_si;
}

double round_to(double value, double per_unit) {
  const double near = std::round(value * per_unit) / per_unit;
  return std::isfinite(near) ? near : value;
}

}  // namespace enc::models
