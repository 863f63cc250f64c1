// Writes the structs of schema.h as TOML: shortest numbers, in the file's units, independent of the locale.
#pragma once

#include <functional>
#include <string>

#include "models/schema/schema.h"

namespace enc::models {

// Everything that is set, in the order of the schema. Reading and writing the text again does not change it.
std::string write_toml(const std::function<void(Visitor&)>& walk);

// One value in TOML form; empty if it is unset.
std::string value_text(const Key& key, const Target& target);

}  // namespace enc::models
