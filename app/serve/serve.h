// The options of `encounter serve`.
#pragma once

#include <string>

#include "app/common/options.h"

namespace enc::app {

struct ServeOptions : RunOptions {
  double every = 0.0;  // s between two rows; 0: a row each tick
};

int serve(const ServeOptions& options);

}  // namespace enc::app
