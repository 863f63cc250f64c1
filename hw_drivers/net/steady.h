// The clock of the drivers: measures ages and late answers. It does not give experiment time, which each
// read() and poll() receives.
#pragma once

#include "core/base/time.h"

namespace enc::net {

[[nodiscard]] Duration steady_now() noexcept;  // any start, common to all threads

}  // namespace enc::net
