// Threads beside a real-time loop.
#pragma once

#include <functional>
#include <stop_token>
#include <thread>

namespace enc::trial {

// Starts a thread that takes no signal, because a signal would end the loop's sleep. It has a lower priority
// than the loop, whatever the caller's priority.
[[nodiscard]] std::jthread beside_loop(std::function<void(const std::stop_token&)> work);

}  // namespace enc::trial
