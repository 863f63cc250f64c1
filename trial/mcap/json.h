// The fields of a message, named once: one visitor writes them as JSON, another one their JSON Schema. An
// unknown number is left out: a schema could allow null only with a list of types, which Foxglove refuses.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace enc::trial {

template <class T>
concept WholeNumber = std::integral<T> && !std::same_as<T, bool>;

class JsonMessage {
 public:
  static constexpr bool kRos = false;  // true in ros2.h
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
  void number(std::string_view name, std::string_view about, double x);
  template <WholeNumber T>
  void integer(std::string_view name, std::string_view, T x) {
    key(name);
    digits(x);
  }
  void flag(std::string_view name, std::string_view about, bool x);
  void text(std::string_view name, std::string_view about, std::string_view x);
  void text_if(std::string_view name, std::string_view about, const std::optional<std::string_view>& x);

 private:
  void key(std::string_view name);
  // The shortest text that reads back to the same number, whatever the locale.
  template <class T>
  void digits(T x) {
    std::array<char, 32> text{};
    out_.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr);
  }
  std::string& out_;
};

// The JSON Schema of a message, from the calls that write it; their values are ignored.
class JsonSchema {
 public:
  static constexpr bool kRos = false;
  template <class Inner>
  [[nodiscard]] static std::string of(std::string_view title, Inner&& inner) {
    JsonSchema schema;
    inner(schema);
    return R"({"title":")" + std::string(title) + "\"," + schema.rest() + "}";
  }
  template <class Inner>
  void object(std::string_view name, std::string_view about, Inner&& inner) {
    JsonSchema schema;
    inner(schema);
    add(name, about, schema.rest(), true);
  }
  template <class Inner>
  void object_if(std::string_view name, std::string_view about, bool, Inner&& inner) {
    JsonSchema schema;
    inner(schema);
    add(name, about, schema.rest(), false);
  }
  template <class Items, class Inner>
  void list(std::string_view name, std::string_view about, const Items&, Inner&& inner) {
    JsonSchema schema;
    inner(schema, typename Items::value_type{});
    add(name, about, R"("type":"array","items":{)" + schema.rest() + "}", true);
  }
  void number(std::string_view name, std::string_view about, double) {
    add(name, about, R"("type":"number")", false);
  }
  template <WholeNumber T>
  void integer(std::string_view name, std::string_view about, T) {
    add(name, about, R"("type":"integer")", true);
  }
  void flag(std::string_view name, std::string_view about, bool) {
    add(name, about, R"("type":"boolean")", true);
  }
  void text(std::string_view name, std::string_view about, std::string_view) {
    add(name, about, R"("type":"string")", true);
  }
  void text_if(std::string_view name, std::string_view about, const std::optional<std::string_view>&) {
    add(name, about, R"("type":"string")", false);
  }

 private:
  void add(std::string_view name, std::string_view about, std::string_view type, bool required);
  [[nodiscard]] std::string rest() const;  // the text inside of an object's braces
  std::string properties_, required_;
};

}  // namespace enc::trial
