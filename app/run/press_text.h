// The part of a run's report about presses of a hand, and about a tool carried by the machine.
#pragma once

#include <string>
#include <vector>

#include "app/run/run_report.h"

namespace enc::app {

[[nodiscard]] std::string press_lines(const RunReport& r);   // only for a machine with admittance rendering
[[nodiscard]] std::string travel_lines(const RunReport& r);  // [VHMR 4.1, Table 1]
// The largest value of a figure over all presses; 0 without presses.
[[nodiscard]] double peak_of(const std::vector<trial::PressFigures>& presses,
                             double trial::PressFigures::*figure);

}  // namespace enc::app
