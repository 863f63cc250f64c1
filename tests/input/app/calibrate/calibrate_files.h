// Logs that tests of `calibrate` write, and the program's message about an invalid log.
#pragma once

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {

class CalibrateFiles : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (temporary_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  // The single line on stderr, with exit code 2.
  static std::string line(const std::vector<std::string>& args) {
    const Result r = run_program(args, kShipped);
    EXPECT_EQ(r.code, 2) << r.out;
    EXPECT_EQ(r.out, "");
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    return r.err;
  }
  test::TemporaryFolder temporary_;
};

}  // namespace enc::tests
