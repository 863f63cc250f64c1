// Drivers' own tables of a rig file, [driver.NAME]: kept as text until the driver declares its keys, then
// read strictly, with the place of each mistake.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/spec/settings.h"
#include "models/setup/scene_file.h"

namespace enc::models {

// The drivers that fill a role of the rig; the simulator has no table.
[[nodiscard]] std::set<std::string> drivers_of(const RigSpec& rig);
// Tables that belong to no role: refused where somebody wrote them, or left out where --set has put another
// driver in the role.
void refuse_driverless(const Setup& setup);
void settle_drivers(Setup& setup);

// Reads the table into what the driver declares (null: it has no keys). The set-up then holds every value,
// defaults included.
void read_driver_table(Setup& setup, const std::string& driver, void (*declare)(Settings&));

// What a driver's table says of a key, a text without its quotes; empty where it says nothing.
[[nodiscard]] std::string driver_text(const RigSpec& rig, std::string_view driver, std::string_view key);

// Gives one table's values to who asks for them.
class DriverTableReader final : public Settings {
 public:
  DriverTableReader(const Setup& setup, const std::string& driver);
  void value(const Setting& key, double& number) override { read(key, &number); }
  void value(const Setting& key, std::int64_t& whole) override { read(key, &whole); }
  void value(const Setting& key, std::string& text) override { read(key, &text); }
  void value(const Setting& key, std::vector<double>& numbers) override { read(key, &numbers); }
  // Refuses keys that nobody asked for, and says which needed ones are missing.
  void finish() const;
  [[nodiscard]] const std::vector<DriverValue>& all() const { return all_; }  // in order of their keys

 private:
  void read(const Setting& setting, const Target& target);
  [[nodiscard]] std::string place(const std::string& key) const;

  const Setup& setup_;
  std::string driver_, title_;
  std::vector<DriverValue> given_, all_;
  std::vector<std::string> known_, missing_;
};

}  // namespace enc::models
