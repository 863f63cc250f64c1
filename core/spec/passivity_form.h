// What is done about energy that a law gives out by being sampled, late or counted (passivity.h).
#pragma once

#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/base/words.h"

namespace enc {

enum class PassivityForm : std::uint8_t { none, controlled };
constexpr auto words(PassivityForm) { return enum_words("none", "controlled"); }

// Refuses one that has nothing to control, for this reason; `key`: of the rig.
[[noreturn]] inline void refuse_passivity(const std::string& why, const std::string& key) {
  throw Error("the passivity controller has nothing to control: " + why + "; expected passivity = 'none'",
              key);
}

}  // namespace enc
