#include "tests/terminal/run_record.h"

#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "core/record/record.h"

namespace enc::test {

std::vector<double> stops_in(const std::string& log) {
  static const std::regex kLine("stops, in s:((?: [0-9.]+)+)");
  std::vector<double> all;
  for (std::sregex_iterator found(log.begin(), log.end(), kLine), end; found != end; ++found) {
    std::istringstream times((*found)[1]);
    for (double t = 0.0; times >> t;) all.push_back(t);
  }
  return all;
}

std::string last_mode(const std::string& record) {
  RecordReader reader(record);  // throws where it is damaged
  EXPECT_TRUE(reader.sealed());
  RecordedTick tick;
  Mode mode = Mode::away;
  while (reader.next(tick)) mode = tick.out.mode;
  return std::string(mode_name(mode));
}

}  // namespace enc::test
