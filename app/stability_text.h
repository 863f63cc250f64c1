// The certificates as text, for `check`, for a run and for its record.
#pragma once

#include <string>
#include <vector>

#include "trial/certificates.h"

namespace enc::app {

// One line for each object, equal ones together, and the bounds of the object nearest to its bound. Empty: no
// rendering.
[[nodiscard]] std::string stability_text(const models::Setup& setup,
                                         const std::vector<trial::ObjectCertificate>& certificates);
// The certificate whose rows are shown: the smallest margin among those beyond their bound, else among the
// unknown ones, else among all. If margins are equal, an object comes before the free tip, and the first in
// the scene's order wins. `certificates` must not be empty.
[[nodiscard]] const trial::ObjectCertificate& nearest_its_bound(
    const std::vector<trial::ObjectCertificate>& certificates);
// "stable     ...", one line for each existing class.
[[nodiscard]] std::string stability_lines(const std::vector<trial::ObjectCertificate>& certificates);

}  // namespace enc::app
