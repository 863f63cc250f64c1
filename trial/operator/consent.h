// What is asked and refused before an armed machine moves for the first time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "trial/assemble/assemble.h"

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
// Prints the question and waits for Enter, or until `stopped`. Any other line, or the end of the input, is a
// no, and what was typed before the question is no answer.
enum class Answer : std::uint8_t { yes, no, stopped };
[[nodiscard]] Answer ask(const std::string& question, const std::function<bool()>& stopped);

}  // namespace enc::trial
