// Tables of exp, log and pow. c is the middle of a piece of [0.7, 1.4], chosen so that its entries err
// little.
//
// Copyright (c) 2018, Arm Limited.
// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

namespace enc::math {

// 2^(i/128): what the double nearest to it lacks, and its bits with i taken off the exponent.
extern const std::uint64_t kExpTable[256];

// 1/c, log(c), and c itself in two doubles.
struct LogRow {
  double inverse, log, c, c_tail;
};
extern const LogRow kLogTable[128];

// 1/c of few bits, log(c) in two doubles.
struct PowRow {
  double inverse, log, log_tail;
};
extern const PowRow kPowTable[128];

}  // namespace enc::math
