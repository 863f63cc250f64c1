// Reads TOML into the structs of schema.h, strictly. It is the only file that includes toml++, which is slow
// to compile.
//
// Every fault is an Error of one line, "file:line:column: what is wrong; what was expected; what to do", with
// an empty key(), because the place is already in it.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "models/schema/schema.h"

namespace enc::models {

// Place of each key and table: "object.ball.radius_mm" -> "scenes/ball.toml:7:1". List entries go by name.
using Places = std::map<std::string, std::string, std::less<>>;

// `name` is the file's, for messages. `walk` lets a visitor walk the structs to fill.
Places read_toml(const std::string& text, const std::string& name, const std::function<void(Visitor&)>& walk);

// Reads one value. For --set, texts need no quotes, and "unset" clears an optional value; in a file, texts
// need quotes.
enum class Quotes : std::uint8_t { may, must };
void read_value(const std::string& text, const std::string& place, const Key& key, const Target& target,
                Quotes quotes = Quotes::may);

// A text of --set in TOML form: quoted unless it is a value.
std::string as_value(const std::string& text);

}  // namespace enc::models
