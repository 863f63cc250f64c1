// What of a run was beyond a limit, one line each; then the program ends with exit code 1.
#pragma once

#include <string>
#include <vector>

#include "app/run/run_report.h"

namespace enc::app {

[[nodiscard]] std::vector<std::string> crossed(const RunReport& report);

}  // namespace enc::app
