// `check --advise`: which time step and integrator of the twin are enough for an error that the user states.
#pragma once

#include <string>

#include "trial/precision/precision.h"

namespace enc::app {

// Throws Error for an error, N, that no time step gets below.
[[nodiscard]] std::string advice_text(const trial::Precision& all, double error);

}  // namespace enc::app
