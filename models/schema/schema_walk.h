// Helpers of schema_*.cpp for tables, parts, lists and choices.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "models/schema/schema.h"

namespace enc::models {

inline constexpr std::string_view kAuthor = "scene";  // source of a value: the author of the scene

template <class Walk>
void table(Visitor& visitor, std::string_view name, Walk walk) {
  if (!visitor.open(name, true)) return;
  walk();
  visitor.close();
}

// A table that exists only if it is named. Returns whether it exists.
template <class Walk>
bool table_if(Visitor& visitor, std::string_view name, bool there, Walk walk) {
  if (!visitor.open(name, there)) return false;
  walk();
  visitor.close();
  return true;
}

// A part that exists only if the scene names it.
template <class T, class Walk>
void part(Visitor& v, std::string_view name, std::optional<T>& item, Walk walk) {
  if (!v.open(name, item.has_value())) return item.reset();
  if (!item) item.emplace();
  walk(*item);
  v.close();
}

// A list of named tables.
template <class T, class Walk>
void list(Visitor& visitor, std::string_view name, std::vector<T>& items, Walk walk) {
  items.resize(visitor.open_list(name, items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    visitor.open_entry(name, i, items[i].name);
    walk(items[i]);
    visitor.close();
  }
}

// One of the words beside the enum.
template <class Enum>
void choice(Visitor& visitor, const Key& key, Enum& value) {
  auto index = static_cast<std::uint8_t>(value);
  visitor.value(key, Choice{kWords<Enum>, &index});
  value = static_cast<Enum>(index);
}

}  // namespace enc::models
