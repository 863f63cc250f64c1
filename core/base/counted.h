// "1 contact", "2 contacts", "0 passes": a count and what is counted.
#pragma once

#include <string>
#include <string_view>

namespace enc {

// `one` is the word for a single one; its last word gets the ending.
template <class Count>
[[nodiscard]] std::string counted(Count count, std::string_view one) {
  std::string text = std::to_string(count).append(" ").append(one);
  if (count == Count{1}) return text;
  const bool hisses = one.ends_with("s") || one.ends_with("x") || one.ends_with("sh") || one.ends_with("ch");
  return text.append(hisses ? "es" : "s");
}

}  // namespace enc
