#include "hw_drivers/net/steady.h"

#include <chrono>

namespace enc::net {

Duration steady_now() noexcept {
  return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace enc::net
