#include "trial/mcap/json.h"

#include <cmath>

namespace enc::trial {
namespace {

// Adds the text in quotes, as in JSON.
void add_quoted(std::string& out, std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20U) {
      out += "\\u00";
      out += kHex[byte >> 4U];
      out += kHex[byte & 0xFU];
    } else {
      out += c;
    }
  }
  out += '"';
}

}  // namespace

void JsonMessage::key(std::string_view name) {
  if (out_.back() != '{') out_ += ',';
  out_ += '"';
  out_ += name;
  out_ += "\":";
}

void JsonMessage::number(std::string_view name, std::string_view /*about*/, double x) {
  if (!std::isfinite(x)) return;
  key(name);
  digits(x);
}

void JsonMessage::flag(std::string_view name, std::string_view /*about*/, bool x) {
  key(name);
  out_ += x ? "true" : "false";
}

void JsonMessage::text(std::string_view name, std::string_view /*about*/, std::string_view x) {
  key(name);
  add_quoted(out_, x);
}

void JsonMessage::text_if(std::string_view name, std::string_view about,
                          const std::optional<std::string_view>& x) {
  if (x) text(name, about, *x);
}

void JsonSchema::add(std::string_view name, std::string_view about, std::string_view type, bool required) {
  const auto add_name = [&](std::string& to) {
    if (!to.empty()) to += ',';
    add_quoted(to, name);
  };
  add_name(properties_);
  properties_ += ":{";
  properties_ += type;
  if (!about.empty()) {
    properties_ += R"(,"description":)";
    add_quoted(properties_, about);
  }
  properties_ += '}';
  if (required) add_name(required_);
}

std::string JsonSchema::rest() const {
  return R"("type":"object","properties":{)" + properties_ + "}" +
         (required_.empty() ? std::string() : R"(,"required":[)" + required_ + "]");
}

}  // namespace enc::trial
