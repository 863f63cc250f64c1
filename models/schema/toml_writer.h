// Writes what schema.h describes as TOML: shortest numbers, in the file's units, the same in every locale.
#pragma once

#include <functional>
#include <string>

#include "models/schema/schema.h"

namespace enc::models {

// Everything that is set, in the order of the schema. Reading the text gives the same text again.
std::string write_toml(const std::function<void(Visitor&)>& walk);

// One value, as TOML writes it; empty if it is unset.
std::string value_text(const Key& key, const Target& target);

}  // namespace enc::models
