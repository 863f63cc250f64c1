// Threads beside a loop that keeps time.
#pragma once

#include <functional>
#include <stop_token>
#include <thread>

namespace enc::trial {

// A thread that takes no signal, because a signal ends the loop's sleep, and that runs behind the loop, at
// whatever priority the caller runs.
[[nodiscard]] std::jthread beside_loop(std::function<void(const std::stop_token&)> work);

}  // namespace enc::trial
