// Texts for messages: the values that a key expects, and "did you mean".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "models/schema/printable.h"
#include "models/schema/schema.h"

namespace enc::models {

// "a positive number in mm (radius of the sphere)"
std::string expected(const Key& key, const Target& target);
// "a positive number in mm", for one number
std::string wanted_number(const Key& key);
// "33.0": a value of the right type
std::string example_of(const Key& key, const Target& target);
// "[force] has no 'filter_hz'; expected ...; add ..."
std::string missing_text(const std::string& table, const Key& key, const Target& target);
// "unknown key 'filtr_hz'; expected a key of [force]; did you mean ...?"
std::string unknown_text(const std::string& table, std::string_view key,
                         const std::vector<std::string>& known);
std::string lower_case(std::string text);  // converts only A to Z
// 'text' on one line, cut if long
std::string quoted(const std::string& text);
// "text", in TOML form
std::string quoted_toml(const std::string& text);

// True for the table or a key in it: "camera" and "camera.rate_hz" stand in "camera".
bool stands_in(std::string_view name, std::string_view table);

// The name that the author of `word` probably meant; empty if none is close. A key with another unit
// ("radius_cm") is close to the key with the right one ("radius_mm").
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

// "did you mean 'radius_mm'?", or else "the names here are 'a', 'b'", with all of them.
std::string advice(std::string_view word, const std::vector<std::string>& names);

}  // namespace enc::models
