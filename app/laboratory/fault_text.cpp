#include "app/laboratory/fault_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/sample.h"

namespace enc::app {
namespace {

enum class Value : std::uint8_t { none, share, time, code };

struct Named {
  const char* name;
  Trouble::Kind kind;
  Value value;
  double usual;         // where none is given; unset: the fake's own
  const char* example;  // of its value
};

constexpr std::array<Named, 11> kNames{{
    {"loss", Trouble::Kind::loss, Value::share, 1.0, "5%"},
    {"jitter", Trouble::Kind::jitter, Value::time, 0.020, "20ms"},
    {"reorder", Trouble::Kind::reorder, Value::share, 1.0, "30%"},
    {"duplicate", Trouble::Kind::duplicate, Value::share, 1.0, "10%"},
    {"stall", Trouble::Kind::stall, Value::none, 0.0, ""},
    {"disconnect", Trouble::Kind::disconnect, Value::none, 0.0, ""},
    {"garbage", Trouble::Kind::garbage, Value::share, 1.0, "1%"},
    {"half-message", Trouble::Kind::half_message, Value::share, 1.0, "1%"},
    {"saturate", Trouble::Kind::saturate, Value::none, 0.0, ""},
    {"error-code", Trouble::Kind::error_code, Value::code, kUnset, "504 or 0x90000000"},
    {"slow-start", Trouble::Kind::slow_start, Value::time, 2.0, "2s"},
}};

constexpr double kMostTime = 1e6, kMostCode = 4294967295.0;  // s; a status word
constexpr double kMostDecimal = 65535.0;                     // a greater code is shown as a status word

// "20" and "ms" of "20ms"; what is no number from 0 on is unset.
double number_of(std::string_view text, std::string_view& unit) {
  double number = kUnset;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  unit = text.substr(static_cast<std::size_t>(end - text.data()));
  return error == std::errc{} && number >= 0.0 ? number : kUnset;  // NaN, too
}

double time_of(std::string_view text) {
  std::string_view unit;
  const double number = number_of(text, unit);
  const double time = unit == "s" ? number : unit == "ms" ? 1e-3 * number : kUnset;
  return time <= kMostTime ? time : kUnset;
}

double share_of(std::string_view text) {
  std::string_view unit;
  const double number = number_of(text, unit);
  return unit == "%" && number <= 100.0 ? 0.01 * number : kUnset;
}

// Decimal, or hexadecimal as status words are.
double code_of(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0X")) {
    std::uint32_t code = 0;
    const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), code, 16);
    return error == std::errc{} && end == text.data() + text.size() ? code : kUnset;
  }
  std::string_view unit;
  const double number = number_of(text, unit);
  return unit.empty() && number <= kMostCode && std::floor(number) == number ? number : kUnset;
}

const Named& named(Trouble::Kind kind) {
  return *std::find_if(kNames.begin(), kNames.end(), [kind](const Named& one) { return one.kind == kind; });
}

// Of a fault that has one; unset: the text is none of its kind.
double value_of(const Named& fault, std::string_view text) {
  switch (fault.value) {
    case Value::share:
      return share_of(text);
    case Value::time:
      return time_of(text);
    case Value::code:
      return code_of(text);
    default:
      return kUnset;
  }
}

// Cuts what stands behind the last `mark`, if there is one.
bool cut(std::string_view& text, char mark, std::string_view& behind) {
  const std::size_t at = text.rfind(mark);
  if (at == std::string_view::npos) return false;
  behind = text.substr(at + 1);
  text = text.substr(0, at);
  return true;
}

}  // namespace

std::string fault_examples() {
  std::string all;
  for (const Named& one : kNames)
    all += fmt::format("{}{}{}{}", all.empty() ? "" : ", ", one.name, *one.example == '\0' ? "" : "=",
                       one.example);
  return all;
}

std::string text_of(const Trouble& trouble) {
  const Named& one = named(trouble.kind);
  switch (one.value) {
    case Value::share:
      return fmt::format("{}={:g}%", one.name, 100.0 * trouble.value);
    case Value::time:
      return fmt::format("{}={:g}ms", one.name, 1e3 * trouble.value);
    case Value::code:
      if (std::isnan(trouble.value)) return one.name;
      return trouble.value > kMostDecimal
                 ? fmt::format("{}={:#010x}", one.name, static_cast<std::uint32_t>(trouble.value))
                 : fmt::format("{}={:.0f}", one.name, trouble.value);
    default:
      return one.name;
  }
}

Fault fault_of(const std::string& text, const std::string& where) {
  const auto refuse = [&](const std::string& what) {
    return Error(
        fmt::format("{}: '{}': {}; expected DRIVER:FAULT[=V][@TIME][+TIME], such as "
                    "gcs:stall@3s+500ms, with a fault of {}",
                    where, text, what, fault_examples()));
  };
  Fault fault;
  std::string_view rest = text, time, value;
  if (cut(rest, '+', time)) {
    fault.lasts = time_of(time);
    if (!(fault.lasts > 0.0)) throw refuse(fmt::format("'{}' is no time to last", time));
  }
  if (cut(rest, '@', time)) {
    fault.at = time_of(time);
    if (std::isnan(fault.at)) throw refuse(fmt::format("'{}' is no time", time));
  }
  const bool valued = cut(rest, '=', value);
  std::string_view kind = rest;
  const std::size_t colon = rest.find(':');
  if (colon == std::string_view::npos || colon == 0) throw refuse("no driver is named");
  fault.driver = rest.substr(0, colon);
  kind = rest.substr(colon + 1);
  const auto* const found =
      std::find_if(kNames.begin(), kNames.end(), [kind](const Named& one) { return one.name == kind; });
  if (found == kNames.end()) throw refuse(fmt::format("there is no fault '{}'", kind));
  fault.trouble = {found->kind, found->usual};
  if (!valued) return fault;
  if (found->value == Value::none) throw refuse(fmt::format("'{}' has no value", kind));
  fault.trouble.value = value_of(*found, value);
  if (std::isnan(fault.trouble.value)) throw refuse(fmt::format("'{}' is no value of '{}'", value, kind));
  return fault;
}

}  // namespace enc::app
