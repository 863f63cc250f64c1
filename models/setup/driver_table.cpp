#include "models/setup/driver_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/roles.h"
#include "models/schema/toml_writer.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

std::string path_of(const std::string& driver) { return "rig.driver." + driver; }

// True for a place of --set, "--set ..."; otherwise it is a place in a file.
bool is_set(const std::string& place) { return place.starts_with("--set "); }

// Either name may be the mistyped one: gives the similar name and the place where a role has it.
std::string near_driver(const Setup& setup, const std::string& near) {
  std::string at;
  const auto look = [&](const char* table, const std::string& driver) {
    if (at.empty() && driver == near) at = place_of(setup, fmt::format("rig.{}.driver", table));
  };
  each_device([&](const auto& role) { look(role.table, (setup.rig.*role.rig).driver); });
  look("camera", setup.rig.camera.driver);
  return fmt::format("did you mean {}, as {} says?", quoted(near), at);
}

std::string driverless(const Setup& setup, const std::string& name) {
  const std::set<std::string> there = drivers_of(setup.rig);
  const std::vector<std::string> names(there.begin(), there.end());
  const std::string near = nearest_name(name, names);
  return fmt::format(
      "no role of this rig has the driver {}; expected one that a role names; {}", quoted(name),
      names.empty()
          ? "write it like 'driver = \"" + printable(name) + "\"' in the role's table, or remove this one"
      : near.empty() ? advice(name, names)
                     : near_driver(setup, near));
}

}  // namespace

std::set<std::string> drivers_of(const RigSpec& rig) {
  std::set<std::string> names;
  each_device([&](const auto& role) { names.insert((rig.*role.rig).driver); });
  names.insert(rig.camera.driver);
  names.erase("sim");
  names.erase("none");
  return names;
}

void refuse_driverless(const Setup& setup) {
  for (const DriverTable& table : setup.rig.drivers)
    if (!drivers_of(setup.rig).contains(table.name))
      throw Error(fmt::format("{}: {}", place_of(setup, path_of(table.name)), driverless(setup, table.name)));
}

void settle_drivers(Setup& setup) {
  const std::set<std::string> there = drivers_of(setup.rig);
  std::erase_if(setup.rig.drivers, [&](const DriverTable& table) {
    if (there.contains(table.name)) return false;
    for (const DriverValue& value : table.values) {
      const std::string place = place_of(setup, path_of(table.name) + "." + value.key);
      if (is_set(place)) throw Error(fmt::format("{}: {}", place, driverless(setup, table.name)));
    }
    return true;
  });
}

DriverTableReader::DriverTableReader(const Setup& setup, const std::string& driver)
    : setup_(setup), driver_(driver), title_(fmt::format("[driver.{}]", driver)) {
  for (const DriverTable& table : setup.rig.drivers)
    if (table.name == driver) given_ = table.values;
}

std::string DriverTableReader::place(const std::string& key) const {
  return place_of(setup_, fmt::format("{}.{}", path_of(driver_), key));
}

void DriverTableReader::read(const Setting& setting, const Target& target) {
  const Key key{setting.name,
                setting.meaning,
                setting.source,
                Confidence::chosen,
                {setting.low, setting.high},
                setting.needed ? Presence::needed : Presence::defaulted,
                setting.words};
  const std::string name(setting.name);
  known_.push_back(name);
  const auto is = [&](const DriverValue& v) { return v.key == name; };
  // A value that the file lacks is the driver's own, to the bit, even if no file could contain it.
  const bool written = setup_.places.contains(fmt::format("{}.{}", path_of(driver_), name));
  if (const auto found = std::find_if(given_.begin(), given_.end(), is); written && found != given_.end())
    read_value(found->text, place(name), key, target, is_set(place(name)) ? Quotes::may : Quotes::must);
  else if (setting.needed)
    missing_.push_back(missing_text(title_, key, target));
  if (std::any_of(all_.begin(), all_.end(), is)) return;  // another role has this driver, too
  std::string text = value_text(key, target);
  if (text == "inf" || text == "-inf" || text == "[]") text.clear();  // counts as unset: no file contains it
  const DriverValue value{name, text, std::string(key.meaning), std::string(key.source)};
  const auto after = [&](const DriverValue& v) { return v.key > name; };
  all_.insert(std::find_if(all_.begin(), all_.end(), after), value);
}

// Unknown keys are reported before missing ones: a misspelt key is usually both.
void DriverTableReader::finish() const {
  for (const DriverValue& value : given_)
    if (std::find(known_.begin(), known_.end(), value.key) == known_.end())
      throw Error(fmt::format("{}: {}", place(value.key), unknown_text(title_, value.key, known_)));
  if (missing_.empty()) return;
  std::string at = path_of(driver_);
  if (!setup_.places.contains(at))  // without a table: the place that names the driver
    each_device([&, first = true](const auto& role) mutable {
      if (!first || (setup_.rig.*role.rig).driver != driver_) return;
      at = fmt::format("rig.{}.driver", role.table);
      first = false;
    });
  throw Error(fmt::format("{}: {}", place_of(setup_, at), missing_.front()));
}

void read_driver_table(Setup& setup, const std::string& driver, void (*declare)(Settings&)) {
  DriverTableReader reader(setup, driver);
  if (declare != nullptr) declare(reader);
  reader.finish();
  std::vector<DriverTable>& tables = setup.rig.drivers;
  std::erase_if(tables, [&](const DriverTable& table) { return table.name == driver; });
  if (reader.all().empty()) return;
  const auto after = [&](const DriverTable& table) { return table.name > driver; };
  tables.insert(std::find_if(tables.begin(), tables.end(), after), {driver, reader.all()});
}

std::string driver_text(const RigSpec& rig, std::string_view driver, std::string_view key) {
  for (const DriverTable& table : rig.drivers)
    for (const DriverValue& value : table.values) {
      if (table.name != driver || value.key != key) continue;
      std::string_view text = value.text;  // as in the file, with its quotes
      if (text.size() > 1 && (text.front() == '"' || text.front() == '\''))
        text = text.substr(1, text.size() - 2);
      return std::string(text);
    }
  return {};
}

}  // namespace enc::models
