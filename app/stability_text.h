// What certificates say, in words: for `check`, for a run and for its record.
#pragma once

#include <string>
#include <vector>

#include "trial/certificates.h"

namespace enc::app {

// A line for each object, alike ones together, and the bounds of the one that is nearest to its own. Empty:
// nothing is rendered.
[[nodiscard]] std::string stability_text(const models::Setup& setup,
                                         const std::vector<trial::Certified>& certificates);
// Whose rows are shown: of those beyond their bound, else of those of which it is not known, else of all the
// one with the least margin; of equal ones an object comes before the tip that nobody touches, and the first
// in the scene's order. There is one.
[[nodiscard]] const trial::Certified& nearest_its_bound(const std::vector<trial::Certified>& certificates);
// "stable     ...", a line for each class that there is.
[[nodiscard]] std::string stability_lines(const std::vector<trial::Certified>& certificates);

}  // namespace enc::app
