// The clock of the drivers: how old something is, and whether an answer is late. It says nothing of
// experiment time, which each read() and poll() is told.
#pragma once

#include "core/base/time.h"

namespace enc::net {

[[nodiscard]] Duration steady_now() noexcept;  // since any start, the same for all threads

}  // namespace enc::net
