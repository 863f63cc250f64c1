// A refusal as it has to be: one line on stderr, nothing on stdout, exit code 2.
#pragma once

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/run_program.h"

namespace enc::tests {

// Expects that, and returns the line.
inline std::string one_line(const Result& r) {
  EXPECT_EQ(r.code, 2) << r.out;
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  return r.err;
}

}  // namespace enc::tests
