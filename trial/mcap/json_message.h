// The fields of a message, named once: one visitor writes them as JSON, another one (json_schema.h) their
// JSON Schema, as core/base/fields.h does for a record. An unknown number is left out. It is not null: a
// schema could allow null only with a list of types, which viewers such as Foxglove refuse.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace enc::trial {

template <class T>
concept WholeNumber = std::integral<T> && !std::same_as<T, bool>;

// The text in quotes, as in JSON.
void add_quoted(std::string& out, std::string_view text);

class JsonMessage {
 public:
  explicit JsonMessage(std::string& out) : out_(out) {}

  template <class Inner>
  void whole(Inner&& inner) {
    out_ += '{';
    inner(*this);
    out_ += '}';
  }
  template <class Inner>
  void object(std::string_view name, std::string_view, Inner&& inner) {
    key(name);
    whole(inner);
  }
  template <class Inner>
  void object_if(std::string_view name, std::string_view about, bool there, Inner&& inner) {
    if (there) object(name, about, inner);
  }
  template <class Items, class Inner>
  void list(std::string_view name, std::string_view, const Items& items, Inner&& inner) {
    key(name);
    out_ += '[';
    for (const auto& item : items) {
      if (out_.back() != '[') out_ += ',';
      whole([&](JsonMessage& message) { inner(message, item); });
    }
    out_ += ']';
  }
  void number(std::string_view name, std::string_view, double x) {
    if (!std::isfinite(x)) return;
    key(name);
    digits(x);
  }
  template <WholeNumber T>
  void integer(std::string_view name, std::string_view, T x) {
    key(name);
    digits(x);
  }
  void flag(std::string_view name, std::string_view, bool x) {
    key(name);
    out_ += x ? "true" : "false";
  }
  void text(std::string_view name, std::string_view, std::string_view x) {
    key(name);
    add_quoted(out_, x);
  }
  void text_if(std::string_view name, std::string_view about, const std::optional<std::string_view>& x) {
    if (x) text(name, about, *x);
  }

 private:
  void key(std::string_view name) {
    if (out_.back() != '{') out_ += ',';
    out_ += '"';
    out_ += name;
    out_ += "\":";
  }
  // The shortest text that reads back to the same number, whatever the locale.
  template <class T>
  void digits(T x) {
    std::array<char, 32> text{};
    out_.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr);
  }
  std::string& out_;
};

}  // namespace enc::trial
