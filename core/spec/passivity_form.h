// Treatment of the energy that a law gives out because it is sampled, delayed or quantised (passivity.h).
#pragma once

#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/base/words.h"

namespace enc {

enum class PassivityForm : std::uint8_t { none, controlled };
constexpr auto words(PassivityForm) { return enum_words("none", "controlled"); }

// Refuses a passivity controller that has nothing to control, for this reason; `key`: of the rig.
[[noreturn]] inline void refuse_passivity(const std::string& why, const std::string& key) {
  throw Error("the passivity controller has nothing to control: " + why + "; expected passivity = 'none'",
              key);
}

}  // namespace enc
