// The JSON Schema of a message, from the calls that write it; their values are ignored.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "trial/mcap/json_message.h"

namespace enc::trial {

class JsonSchema {
 public:
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
  [[nodiscard]] std::string rest() const;  // the inside of an object's braces
  std::string properties_, required_;
};

}  // namespace enc::trial
