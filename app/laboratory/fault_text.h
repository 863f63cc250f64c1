// The text form of a fault of a fake: "netft:loss=5%@2s+500ms".
#pragma once

#include <string>
#include <vector>

#include "core/devices/fake.h"

namespace enc::app {

struct Fault {
  std::string driver;  // driver whose fake has the fault
  Trouble trouble;
  double at = 0.0;        // s of the fakes' time
  double lasts = kUnset;  // s; unset: to the end
};

// DRIVER:KIND[=VALUE][@TIME][+TIME]. Throws Error (kind input) with what was expected. `where`: of the
// message.
[[nodiscard]] Fault fault_of(const std::string& text, const std::string& where);
[[nodiscard]] std::string text_of(const Trouble& trouble);
// The kinds, each with its value, for --help: "loss=5%, jitter=20ms, ..."
[[nodiscard]] std::string fault_examples();

}  // namespace enc::app
