// The limits that a run exceeded, one line each; the program then ends with exit code 1.
#pragma once

#include <string>
#include <vector>

#include "app/run/run_report.h"

namespace enc::app {

[[nodiscard]] std::vector<std::string> crossed(const RunReport& report);

}  // namespace enc::app
