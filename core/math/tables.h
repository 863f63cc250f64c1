// Tables of exp, log and pow. c is the middle of a piece of [0.7, 1.4], chosen for small errors of its
// entries.
//
// Copyright (c) 2018, Arm Limited.
// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

namespace enc::math {

// 2^(i/128): error of the nearest double, and that double's bits with i subtracted from the exponent.
extern const std::uint64_t kExpTable[256];

// 1/c, log(c), and c itself as two doubles.
struct LogRow {
  double inverse, log, c, c_tail;
};
extern const LogRow kLogTable[128];

// 1/c with few bits, log(c) as two doubles.
struct PowRow {
  double inverse, log, log_tail;
};
extern const PowRow kPowTable[128];

}  // namespace enc::math
