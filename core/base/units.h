// Factors between SI (in memory) and the units of people and devices; they are defined only here. A factor
// with a unit's name is that unit in SI: `5.0 * kMillimetre` is 5 mm in metres. A factor named "A per B"
// converts from B to A: `metres * kMmPerM` is a number of millimetres.
#pragma once

#include <cmath>
#include <cstdint>

namespace enc {

inline constexpr double kMillimetre = 1e-3;          // m
inline constexpr double kMillisecond = 1e-3;         // s
inline constexpr double kDegree = M_PI / 180.0;      // rad
inline constexpr double kNewtonPerMillimetre = 1e3;  // N/m
inline constexpr double kKilopascal = 1e3;           // Pa
inline constexpr double kMegapascal = 1e6;           // Pa

inline constexpr double kMmPerM = 1e3;
inline constexpr double kUmPerM = 1e6;
inline constexpr double kMsPerS = 1e3;
inline constexpr double kDegPerRad = 180.0 / M_PI;
inline constexpr std::int64_t kNsPerMs = 1'000'000;

}  // namespace enc
