// Text such as "1 contact", "2 contacts", "0 passes": a count and its noun.
#pragma once

#include <string>
#include <string_view>

namespace enc {

// `one` is the singular noun; its last word gets the plural ending.
template <class Count>
[[nodiscard]] std::string counted(Count count, std::string_view one) {
  std::string text = std::to_string(count).append(" ").append(one);
  if (count == Count{1}) return text;
  const bool hisses = one.ends_with("s") || one.ends_with("x") || one.ends_with("sh") || one.ends_with("ch");
  return text.append(hisses ? "es" : "s");
}

}  // namespace enc
