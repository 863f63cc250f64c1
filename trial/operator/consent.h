// What is asked and refused before an armed machine moves for the first time.
#pragma once

#include <string>
#include <vector>

#include "trial/assemble.h"

namespace enc::trial {

// A device that is not simulated will move once it is armed.
[[nodiscard]] bool moves_device(const models::Setup& setup);
// A line for each device that will move, and one for how far, how fast or how hard. `devices`: as they
// describe themselves.
[[nodiscard]] std::string motion_text(const models::Setup& setup, const Scene& scene,
                                      const std::vector<DeviceWords>& devices);
// That, and what to do before Enter.
[[nodiscard]] std::string motion_question(const models::Setup& setup, const Scene& scene,
                                          const std::vector<DeviceWords>& devices);

// Throws Error (kind input) where there is no terminal on which the question could be asked.
void refuse_unasked();

}  // namespace enc::trial
