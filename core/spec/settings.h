// A driver's own table of the rig file, [driver.NAME]. The driver declares its keys once; whoever reads,
// lists or writes the table is a visitor of that declaration.
//
//   struct Wire { std::string address = "127.0.0.1"; double timeout = 0.1; };
//   void declare(Settings& table, Wire& wire) {
//     table.value({.name = "address", .meaning = "of the controller"}, wire.address);
//     table.value({.name = "timeout_ms", .meaning = "for an answer", .low = 1, .high = 1e3}, wire.timeout);
//   }
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace enc {

// A key. A number carries its unit at the end of its name, "timeout_ms"; in memory it is SI. What the
// variable holds before it is read is the default.
struct Setting {
  std::string_view name, meaning;
  double low = -std::numeric_limits<double>::infinity();  // in the unit of the name
  double high = std::numeric_limits<double>::infinity();
  bool needed = false;                        // has no default that could be right
  std::span<const std::string_view> words{};  // of a text: what it may be; empty: anything
  std::string_view source = "driver";         // of the default
};

class Settings {
 public:
  virtual ~Settings() = default;
  virtual void value(const Setting& key, double& number) = 0;
  virtual void value(const Setting& key, std::int64_t& whole) = 0;
  virtual void value(const Setting& key, std::string& text) = 0;
  virtual void value(const Setting& key, std::vector<double>& numbers) = 0;
};

// The table as the file has it: kept as text, because its driver alone knows what it means.
struct DriverValue {
  std::string key, text;        // "port", "4711"
  std::string meaning, source;  // empty until the driver has read it
};
struct DriverTable {
  std::string name;                 // of the driver
  std::vector<DriverValue> values;  // by key
};

}  // namespace enc
