// A run that is over: when it stopped the machine, by the fake's log, and its last mode, by its record.
#pragma once

#include <string>
#include <vector>

namespace enc::test {

// s of the fakes' world: when the machine was commanded to stop, by a run that is over.
[[nodiscard]] std::vector<double> stops_in(const std::string& log);
// Throws where the record is damaged; expects it to be sealed.
[[nodiscard]] std::string last_mode(const std::string& record);

}  // namespace enc::test
