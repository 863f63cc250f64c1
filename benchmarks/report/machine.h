// What a figure of time was taken on.
#pragma once

#include <string>

namespace enc::bench {

struct Machine {
  std::string processor, system, compiler;
  unsigned cores = 0;
};
[[nodiscard]] Machine this_machine();

}  // namespace enc::bench
