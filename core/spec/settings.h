// A driver's own table of the rig file, [driver.NAME]. The driver declares its keys once; readers, listers
// and writers of the table are visitors of that declaration.
//
//   struct Wire { std::string address = "127.0.0.1"; double timeout = 0.1; };
//   void declare(Settings& table, Wire& wire) {
//     table.value({.name = "address", .meaning = "address of the controller"}, wire.address);
//     table.value({.name = "timeout_ms", .meaning = "longest time for an answer", .low = 1, .high = 1e3},
//                 wire.timeout);
//   }
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace enc {

// A key. A number carries its unit at the end of its name, "timeout_ms"; in memory it is SI. The variable's
// value before reading is the default.
struct Setting {
  std::string_view name, meaning;
  double low = -std::numeric_limits<double>::infinity();  // limits, in the name's unit
  double high = std::numeric_limits<double>::infinity();
  bool needed = false;                        // true: no default could be right
  std::span<const std::string_view> words{};  // text only: valid values; empty: any
  std::string_view source = "driver";         // source of the default
};

class Settings {
 public:
  virtual ~Settings() = default;
  virtual void value(const Setting& key, double& number) = 0;
  virtual void value(const Setting& key, std::int64_t& whole) = 0;
  virtual void value(const Setting& key, std::string& text) = 0;
  virtual void value(const Setting& key, std::vector<double>& numbers) = 0;
};

// The table as text from the file, because only its driver can interpret it.
struct DriverValue {
  std::string key, text;        // "port", "4711"
  std::string meaning, source;  // empty until the driver has read it
};
struct DriverTable {
  std::string name;                 // name of the driver
  std::vector<DriverValue> values;  // sorted by key
};

}  // namespace enc
