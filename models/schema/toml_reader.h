// Reads TOML into what schema.h describes, strictly. The only file that knows toml++, which is slow to
// compile.
//
// Every mistake is an Error of one line, "file:line:column: what is wrong; what was expected; what to do",
// with an empty key(), because the place is already in it.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "models/schema/schema.h"

namespace enc::models {

// Where each key and table stands: "object.ball.radius_mm" -> "scenes/ball.toml:7:1". List entries go by
// name.
using Places = std::map<std::string, std::string, std::less<>>;

// `name` is the file's, for messages. `walk` lets a visitor walk what is read.
Places read_toml(const std::string& text, const std::string& name, const std::function<void(Visitor&)>& walk);

// One value. As --set gives it texts need no quotes, and "unset" clears what may be unset; as a file gives it
// they do.
enum class Quotes : std::uint8_t { may, must };
void read_value(const std::string& text, const std::string& place, const Key& key, const Target& target,
                Quotes quotes = Quotes::may);

// A text of --set as TOML writes it: quoted where it is no value.
std::string as_value(const std::string& text);

}  // namespace enc::models
