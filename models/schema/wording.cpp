#include "models/schema/wording.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "models/schema/units.h"

namespace enc::models {
namespace {

std::string words_of(Words words) {
  std::string list;
  for (const std::string_view word : words) list += fmt::format("{}'{}'", list.empty() ? "" : " or ", word);
  return list;
}

std::string bounds(const Range& r) {
  if (r.low == r.high) return fmt::format(" that is {}", r.low);
  if (std::isfinite(r.low) && std::isfinite(r.high)) {
    return fmt::format(" {} {} {} {}", r.above_low ? "above" : "from", r.low,
                       r.above_low ? "and at most" : "to", r.high);
  }
  if (std::isfinite(r.low) && r.low != 0.0)
    return fmt::format(" of {} {}", r.above_low ? "more than" : "at least", r.low);
  return "";
}

std::string sign(const Range& r) {
  if (std::isfinite(r.high) || r.low != 0.0) return "";
  return r.above_low ? "positive " : "not negative ";
}

std::string unit_words(const Key& key) {
  const Unit& unit = unit_of(key.name);
  return unit.label.empty() ? "" : fmt::format(" in {}", unit.label);
}

struct Kind {
  const Key& key;
  std::string operator()(const double*) const { return wanted_number(key); }
  std::string operator()(const std::int64_t*) const { return "a whole number" + bounds(key.range); }
  std::string operator()(const std::string*) const {
    if (!key.words.empty()) return words_of(key.words);
    return key.presence == Presence::needed ? "a text that is not empty" : "a text";
  }
  std::string operator()(const Choice& choice) const { return words_of(choice.words); }
  std::string operator()(const Vec3*) const { return many("3 "); }
  std::string operator()(const std::vector<double>*) const { return many("one or more "); }
  std::string operator()(const std::vector<Vec3>*) const {
    return "a list of points [x, y, z]" + unit_words(key);
  }
  std::string operator()(std::span<double> v) const { return many(fmt::format("{} ", v.size())); }
  [[nodiscard]] std::string many(const std::string& count) const {
    return count + sign(key.range) + "numbers" + bounds(key.range) + unit_words(key);
  }
};

struct Example {
  const Key& key;
  std::string operator()(const double*) const {
    return std::isfinite(key.range.high) ? fmt::format("{}", key.range.high) : "1.5";
  }
  std::string operator()(const std::int64_t* usual) const {
    const auto value = static_cast<double>(*usual);
    return fmt::format("{}", value >= key.range.low && value <= key.range.high ? *usual : 1);
  }
  std::string operator()(const std::string*) const { return word(key.words); }
  std::string operator()(const Choice& choice) const { return word(choice.words); }
  std::string operator()(const Vec3*) const {
    const bool zero = key.range.above_low ? key.range.low < 0.0 : key.range.low <= 0.0;
    return zero ? "[0, 0, 1]" : "[10, 10, 10]";
  }
  std::string operator()(const std::vector<double>*) const { return "[10, 20]"; }
  std::string operator()(const std::vector<Vec3>*) const { return "[[0, 0, 0], [52, 0, 0], [0, 41, 0]]"; }
  std::string operator()(std::span<double> v) const {
    std::string text = "[0.6, 0.4";
    for (std::size_t i = 2; i < v.size(); ++i) text += ", 0.0";
    return text + "]";
  }
  static std::string word(Words words) {
    return fmt::format("\"{}\"", words.empty() ? "name" : words.back());
  }
};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Number of letters to insert, remove or replace, ignoring case.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

// Searches a name with the stem of `word` and any unit, or none.
std::string with_other_unit(std::string_view word, const std::vector<std::string>& names) {
  for (std::string_view stem = word; !stem.empty();) {
    const auto same = [&](const std::string& name) { return stem_of(name) == stem && name != word; };
    const auto found = std::find_if(names.begin(), names.end(), same);
    if (found != names.end()) return *found;
    const auto cut = stem.rfind('_');
    stem = stem.substr(0, cut == std::string_view::npos ? 0 : cut);
  }
  return {};
}

}  // namespace

std::string wanted_number(const Key& key) {
  return fmt::format("a {}{}number{}{}", key.range.whole ? "whole " : "", sign(key.range), bounds(key.range),
                     unit_words(key));
}

std::string expected(const Key& key, const Target& target) {
  return fmt::format("{} ({})", std::visit(Kind{key}, target), key.meaning);
}

std::string example_of(const Key& key, const Target& target) { return std::visit(Example{key}, target); }

std::string lower_case(std::string text) {
  for (char& c : text) c = lower(c);
  return text;
}

std::string quoted(const std::string& text) {
  constexpr std::size_t kMost = 80;
  std::size_t end = std::min(text.size(), kMost);
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80 && end > 0) --end;
  return fmt::format("'{}{}'", printable(std::string_view(text).substr(0, end)),
                     end < text.size() ? "..." : "");
}

std::string quoted_toml(const std::string& text) {
  std::string line = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      line += '\\';
      line += c;
    } else if (static_cast<unsigned char>(c) < ' ' || c == 127) {
      line += fmt::format("\\u{:04X}", static_cast<int>(c));
    } else {
      line += c;
    }
  }
  return line + '"';
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  // A longer word is no typing error, and the time grows with the product of the lengths.
  constexpr std::size_t kLongest = 200;
  if (word.size() > kLongest) return {};
  if (std::string name = with_other_unit(word, names); !name.empty()) return name;
  // A unit that no key uses, such as cm.
  for (const std::string& name : names)
    if (name != word && factor_between(word, name)) return name;
  std::string best;
  std::size_t fewest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : names) {
    if (name.size() > kLongest) continue;
    const std::size_t n = edits(word, name);
    if (n < fewest && n < std::min(word.size(), name.size())) {
      fewest = n;
      best = name;
    }
  }
  return best;
}

std::string missing_text(const std::string& table, const Key& key, const Target& target) {
  return fmt::format("{} has no '{}'; expected {}; add '{} = {}'", printable(table), key.name,
                     expected(key, target), key.name, example_of(key, target));
}

std::string unknown_text(const std::string& table, std::string_view key,
                         const std::vector<std::string>& known) {
  const std::string near = nearest_name(key, known);
  std::string wanted = "expected a key of " + printable(table);
  if (!unit_of(near).label.empty() && key.starts_with(stem_of(near)))
    wanted = fmt::format("expected the unit {}", unit_of(near).label);
  std::string times;
  if (const auto factor = factor_between(key, near); factor && *factor != 1.0)
    times = fmt::format(" then multiply by {:.6g}", *factor);
  return fmt::format("unknown key {}; {}; {}{}", quoted(std::string(key)), wanted, advice(key, known), times);
}

std::string advice(std::string_view word, const std::vector<std::string>& names) {
  const std::string name = nearest_name(word, names);
  if (!name.empty()) return fmt::format("did you mean {}?", quoted(name));
  if (names.empty()) return "nothing has a name here";
  std::string list;
  for (const std::string& offered : names) list += (list.empty() ? "" : ", ") + quoted(offered);
  return fmt::format("the names here are {}", list);
}

bool stands_in(std::string_view name, std::string_view table) {
  return name.starts_with(table) && (name.size() == table.size() || name[table.size()] == '.');
}

}  // namespace enc::models
