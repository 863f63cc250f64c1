// `check --advise`: the time step and integrator of the twin that suffice for the user's error of the force,
// of the tip's path, or of both.
#pragma once

#include <string>

#include "trial/precision/precision.h"

namespace enc::app {

[[nodiscard]] std::string advice_text(const trial::Precision& all, const trial::Accuracy& asked);
// Throws Error for an error that no setting meets and that two converged runs do not meet either.
void refuse_below_floor(const trial::Precision& all, const trial::Accuracy& asked);

}  // namespace enc::app
