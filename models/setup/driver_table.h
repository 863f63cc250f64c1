// The drivers' own tables of a rig file, [driver.NAME]: kept as text until the driver declares its keys, then
// read strictly, with the place of each fault.
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
// Tables without a role: the first function refuses those in a file; the second one drops those whose role
// --set has given to another driver.
void refuse_driverless(const Setup& setup);
void settle_drivers(Setup& setup);

// Reads the table into the keys that the driver declares (null: it has no keys). The set-up then holds every
// value, including defaults.
void read_driver_table(Setup& setup, const std::string& driver, void (*declare)(Settings&));

// A driver's value for a key, a text without its quotes; empty if the table lacks it.
[[nodiscard]] std::string driver_text(const RigSpec& rig, std::string_view driver, std::string_view key);

// Passes one table's values to its driver.
class DriverTableReader final : public Settings {
 public:
  DriverTableReader(const Setup& setup, const std::string& driver);
  void value(const Setting& key, double& number) override { read(key, &number); }
  void value(const Setting& key, std::int64_t& whole) override { read(key, &whole); }
  void value(const Setting& key, std::string& text) override { read(key, &text); }
  void value(const Setting& key, std::vector<double>& numbers) override { read(key, &numbers); }
  // Refuses keys that were not read, and names the missing required ones.
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
