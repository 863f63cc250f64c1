// A finished run: when it stopped the machine, from the fake's log, and its last mode, from its record.
#pragma once

#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/record/record.h"

namespace enc::test {

// s of the fakes' world: the stop commands of a finished run.
[[nodiscard]] inline std::vector<double> stops_in(const std::string& log) {
  static const std::regex kLine("stops, in s:((?: [0-9.]+)+)");
  std::vector<double> all;
  for (std::sregex_iterator found(log.begin(), log.end(), kLine), end; found != end; ++found) {
    std::istringstream times((*found)[1]);
    for (double t = 0.0; times >> t;) all.push_back(t);
  }
  return all;
}

// Throws if the record is damaged; expects it to be sealed.
[[nodiscard]] inline std::string last_mode(const std::string& record) {
  RecordReader reader(record);
  EXPECT_TRUE(reader.sealed());
  RecordedTick tick;
  Mode mode = Mode::away;
  while (reader.next(tick)) mode = tick.out.mode;
  return std::string(mode_name(mode));
}

}  // namespace enc::test
