#include "hw_drivers/images/files/pair_names.h"

#include <algorithm>

#include <fmt/format.h>

namespace enc::images {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_small(char c) { return c >= 'a' && c <= 'z'; }

// A name whose part from `at` on says the side, and what the other side has in its place.
Marked marked(std::string_view name, std::size_t at, std::size_t length, std::string_view other) {
  Marked out{std::string(name), small_letters(name)};
  out.rest.erase(at, length);
  out.partner.replace(at, length, other);
  return out;
}

// Whether what begins at `at` is the end or the beginning of a word that says no side.
bool of_other_word(std::string_view small, std::size_t at) {
  constexpr std::array<std::string_view, 5> kEnd{"bright", "upright", "wright", "copyright", "cleft"};
  const std::string_view word = small.substr(at, small[at] == 'l' ? 4 : 5);
  return small.substr(at).starts_with("leftover") ||
         std::any_of(kEnd.begin(), kEnd.end(), [&](std::string_view other) {
           return other.ends_with(word) && small.substr(0, at + word.size()).ends_with(other);
         });
}

std::vector<Marked> words_in(std::string_view name, Eye eye) {
  const std::string_view word = eye == Eye::left ? "left" : "right",
                         other = eye == Eye::left ? "right" : "left";
  const std::string small = small_letters(name);
  std::vector<Marked> found;
  for (std::size_t at = small.find(word); at != std::string::npos; at = small.find(word, at + 1))
    if (!of_other_word(small, at)) found.push_back(marked(name, at, word.size(), other));
  return found;
}

std::vector<Marked> letters_in(std::string_view name, Eye eye) {
  const char letter = eye == Eye::left ? 'l' : 'r';
  const std::string_view other = eye == Eye::left ? "r" : "l";
  const std::string small = small_letters(name);
  std::vector<Marked> found;
  for (std::size_t i = 0; i < small.size(); ++i) {
    if (small[i] != letter || (i + 1 < small.size() && is_small(small[i + 1]))) continue;
    if (i == 0 || !is_small(small[i - 1]) || (is_capital(name[i]) && is_small(name[i - 1])))
      found.push_back(marked(name, i, 1, other));
  }
  return found;
}

// Whether the word before a number is one for a camera. A number of a file that counts images is none.
bool numbers_cameras(std::string_view before, std::string_view behind, Named named) {
  constexpr std::array<std::string_view, 2> kCameras{"cam", "camera"};
  constexpr std::array<std::string_view, 14> kFolders{"c",      "eye",    "image", "images", "img",
                                                      "infra",  "ir",     "lens",  "video",  "view",
                                                      "sensor", "stereo", "ch",    "channel"};
  const std::size_t last = before.find_last_not_of("_-. ");
  const std::string_view words = before.substr(0, last == std::string_view::npos ? 0 : last + 1);
  std::size_t begin = words.size();
  while (begin > 0 && is_small(words[begin - 1])) --begin;
  const std::string_view word = words.substr(begin);
  const auto is_one_of = [&](const auto& list) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  if (named == Named::folder)
    return before.empty() ? behind.empty() : is_one_of(kCameras) || is_one_of(kFolders);
  const auto counts = [](std::string_view text) { return std::any_of(text.begin(), text.end(), is_digit); };
  return is_one_of(kCameras) && (counts(before) || counts(behind));
}

std::vector<Marked> numbers_in(std::string_view name, Eye eye, Named named) {
  constexpr std::size_t kLongest = 2;  // digits: longer numbers count images or are of a maker
  const std::string small = small_letters(name);
  std::vector<Marked> found;
  for (std::size_t at = 0, end = 0; at < small.size(); at = end + 1) {
    for (end = at; end < small.size() && is_digit(small[end]);) ++end;
    const std::size_t length = end - at;
    if (length == 0 || length > kLongest) continue;
    const std::string_view all(small);
    if (!numbers_cameras(all.substr(0, at), all.substr(end), named)) continue;
    const int number = std::stoi(small.substr(at, length)) + (eye == Eye::left ? 1 : -1);
    if (number >= 0) found.push_back(marked(name, at, length, fmt::format("{:0{}}", number, length)));
  }
  return found;
}

// Without leading zeros; leaves `at` behind it.
std::string_view number_at(const std::string& text, std::size_t& at) {
  while (at + 1 < text.size() && text[at] == '0' && is_digit(text[at + 1])) ++at;
  const std::size_t begin = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  return std::string_view(text).substr(begin, at - begin);
}

}  // namespace

std::string small_letters(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return is_capital(c) ? static_cast<char>(c - 'A' + 'a') : c; });
  return small;
}

std::vector<Marked> marks_in(std::string_view name, Mark mark, Eye eye, Named named) {
  switch (mark) {
    case Mark::word:
      return words_in(name, eye);
    case Mark::letter:
      return letters_in(name, eye);
    case Mark::number:
      return numbers_in(name, eye, named);
  }
  return {};
}

bool NaturalOrder::operator()(const std::string& a, const std::string& b) const {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = number_at(a, i), y = number_at(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i, ++j;
    }
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

}  // namespace enc::images
