// What is done about energy that a law gives out by being sampled, late or counted (passivity.h).
#pragma once

#include <cstdint>

#include "core/text/words.h"

namespace enc {

enum class PassivityForm : std::uint8_t { none, controlled };
constexpr auto words(PassivityForm) { return enum_words("none", "controlled"); }

}  // namespace enc
