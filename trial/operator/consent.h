// Questions and refusals before an armed machine moves for the first time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "trial/assemble/assemble.h"

namespace enc::trial {

// True if a real device will move once it is armed.
[[nodiscard]] bool moves_device(const models::Setup& setup);
// One line for each device that will move, and one with its reach, speed or force. `devices`: their own
// descriptions.
[[nodiscard]] std::string motion_text(const models::Setup& setup, const Scene& scene,
                                      const std::vector<DeviceWords>& devices);
// That text, and the steps before Enter.
[[nodiscard]] std::string motion_question(const models::Setup& setup, const Scene& scene,
                                          const std::vector<DeviceWords>& devices);

// Throws Error (kind input) if there is no terminal for the question.
void refuse_unasked();
// Prints the question and waits for Enter, or until `stopped`. Any other line, or the end of the input, means
// no. Keys typed before the question do not count.
enum class Answer : std::uint8_t { yes, no, stopped };
[[nodiscard]] Answer ask(const std::string& question, const std::function<bool()>& stopped);

}  // namespace enc::trial
