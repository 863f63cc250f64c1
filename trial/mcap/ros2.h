// The fields of a message as ROS 2 has them: one visitor writes CDR, another one the ros2msg schema. They
// take the same calls as those of json.h. A message of ROS 2 has all of its fields: an unknown number is NaN,
// an unknown text is empty.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "trial/mcap/json.h"

namespace enc::trial {

// The names of the fields in ROS 2, which has no capital letters there: "force_n" for "force_N".
[[nodiscard]] std::string ros2_field(std::string_view name);
// The type of an object with this name, such as geometry_msgs/Point.
[[nodiscard]] std::string_view ros2_type(std::string_view name);
// "geometry_msgs/msg/PoseStamped" for "foxglove.PoseInFrame".
[[nodiscard]] std::string ros2_schema(std::string_view json_schema);

class CdrMessage {
 public:
  static constexpr bool kRos = true;
  explicit CdrMessage(std::string& out) : out_(out) {}

  template <class Inner>
  void whole(Inner&& inner) {
    out_.assign("\0\1\0\0", kHead);  // little-endian CDR
    inner(*this);
  }
  template <class Inner>
  void object(std::string_view, std::string_view, Inner&& inner) {
    inner(*this);
  }
  template <class Inner>
  void object_if(std::string_view, std::string_view, bool, Inner&& inner) {
    inner(*this);
  }
  template <class Items, class Inner>
  void list(std::string_view, std::string_view, const Items& items, Inner&& inner) {
    put(static_cast<std::uint32_t>(items.size()));
    for (const auto& item : items) inner(*this, item);
  }
  void number(std::string_view, std::string_view, double x) { put(std::bit_cast<std::uint64_t>(x)); }
  template <WholeNumber T>
  void integer(std::string_view, std::string_view, T x) {
    put(static_cast<std::make_unsigned_t<T>>(x));
  }
  void flag(std::string_view, std::string_view, bool x) { out_ += x ? '\1' : '\0'; }
  void text(std::string_view, std::string_view, std::string_view x) {
    put(static_cast<std::uint32_t>(x.size() + 1));
    out_.append(x).push_back('\0');
  }
  void text_if(std::string_view name, std::string_view about, const std::optional<std::string_view>& x) {
    text(name, about, x.value_or(""));
  }

 private:
  static constexpr std::size_t kHead = 4;
  // Aligned to its own size, counted from behind the head.
  template <class T>
  void put(T x) {
    while ((out_.size() - kHead) % sizeof(T) != 0) out_ += '\0';
    for (std::size_t i = 0; i < sizeof(T); ++i) out_ += static_cast<char>((x >> (8 * i)) & 0xFFU);
  }
  std::string& out_;
};

class Ros2Schema {
 public:
  static constexpr bool kRos = true;
  template <class Inner>
  [[nodiscard]] static std::string of(Inner&& inner) {
    Ros2Schema schema;
    inner(schema);
    return schema.text_ + schema.others_;
  }
  template <class Inner>
  void object(std::string_view name, std::string_view about, Inner&& inner) {
    add(ros2_type(name), name, about);
    Ros2Schema other;
    inner(other);
    define(ros2_type(name), other);
  }
  template <class Inner>
  void object_if(std::string_view name, std::string_view about, bool, Inner&& inner) {
    object(name, about, inner);
  }
  template <class Items, class Inner>
  void list(std::string_view name, std::string_view about, const Items&, Inner&& inner) {
    add(std::string(ros2_type(name)) + "[]", name, about);
    Ros2Schema other;
    inner(other, typename Items::value_type{});
    define(ros2_type(name), other);
  }
  void number(std::string_view name, std::string_view about, double) { add("float64", name, about); }
  template <WholeNumber T>
  void integer(std::string_view name, std::string_view about, T) {
    add((std::signed_integral<T> ? "int" : "uint") + std::to_string(8 * sizeof(T)), name, about);
  }
  void flag(std::string_view name, std::string_view about, bool) { add("bool", name, about); }
  void text(std::string_view name, std::string_view about, std::string_view) { add("string", name, about); }
  void text_if(std::string_view name, std::string_view about, const std::optional<std::string_view>&) {
    add("string", name, about);
  }

 private:
  void add(std::string_view type, std::string_view name, std::string_view about);
  void define(std::string_view type, const Ros2Schema& other);  // once
  std::string text_, others_;
};

}  // namespace enc::trial
