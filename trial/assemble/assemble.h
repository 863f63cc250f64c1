// From a set-up to devices: the twin where a slot asks for one, drivers where the rig names them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/devices/module.h"
#include "core/devices/rig.h"
#include "models/setup/scene_file.h"
#include "sim/world.h"
#include "trial/assemble/prepare.h"

namespace enc::trial {

// How the run and its devices keep time (Offer).
struct Keeping {
  bool waits = false, lockstep = false;
};

// The module of a driver, by the name that the rig gives it. Throws Error (kind device) where there is none.
using DriverSource = std::function<const ModuleInfo&(const std::string& driver)>;

// Which of the devices that the scene names are simulated ("sim"), and which are not.
struct Slots {
  bool simulated = false, real = false;
  bool machine = false;  // the manipulator or the arm is real
};
[[nodiscard]] Slots slots_of(const models::Setup& setup);
// A force sensor, tracker or camera of the scene is real: so is who touches or comes, as far as the core can
// tell.
[[nodiscard]] bool meets_person(const models::Setup& setup);
// Some device that is not simulated lives in wall time: it does not only play what was recorded.
[[nodiscard]] bool keeps_wall_time(const models::Setup& setup, const DriverSource& drivers);

// The twin of a set-up, with the place in the file put before what is wrong. Both must outlive it.
[[nodiscard]] std::unique_ptr<sim::World> make_world(const models::Setup& setup, const Scene& prepared,
                                                     std::uint64_t seed, bool draw_all = false);

// A driver's module, or null where its table is to stay as the file has it.
using DriverFinder = std::function<const ModuleInfo*(const std::string& driver)>;
// Reads each driver's own table as that declares it, defaults included. Throws Error with the place.
void read_driver_tables(models::Setup& setup, const DriverFinder& find);

// Puts the drivers' devices in the slots for which the rig names one; before, their tables are read. What is
// wrong with one is said with its role and the place that names its driver.
void put_drivers(Rig& rig, models::Setup& setup, const DriverSource& drivers, Log& log, Keeping keeping);

[[nodiscard]] std::vector<std::string> tool_names(const models::Setup& setup);  // by index

// A role that the scene names and a driver fills; of a tracker that is vision, its camera.
struct DrivenRole {
  std::string driver, key;  // "netft"; what names it, "rig.force.driver"
  const char* name;         // for messages, "force sensor"
  std::function<bool(const DriverModule&)> filled_by;
  bool moves = false;  // is told to
};
[[nodiscard]] std::vector<DrivenRole> driven_roles(const models::Setup& setup);
[[nodiscard]] std::set<std::string> drivers_used(const models::Setup& setup);  // of these; the twin is none

// What a driver says of its device.
struct DeviceWords {
  std::string role, words;  // "force", "sample 127.0.0.1:4711, answered"
  bool there = true;        // false: the words say what is wrong
};
// A fake says that it is one.
[[nodiscard]] std::vector<DeviceWords> describe_drivers(const Rig& rig, const models::Setup& setup);
// What names the driver of a machine that moves and is no fake, "rig.manipulator.driver"; empty: there is
// none.
[[nodiscard]] std::string real_machine(const Rig& rig, const models::Setup& setup);
// Makes each device, or says why there is none. Nothing moves.
[[nodiscard]] std::vector<DeviceWords> put_each_driver(Rig& rig, const models::Setup& setup,
                                                       const DriverSource& drivers, Log& log);
// The same without a run: each device is made, asked and let go. Nothing moves.
[[nodiscard]] std::vector<DeviceWords> ask_drivers(const models::Setup& setup, const DriverSource& drivers);

// A device that can do less than the rig file promises, is another machine, or does not know what it can do
// is refused before anything moves.
void check_devices(const Rig& rig, const RigSpec& spec);

// Counts the periods of an experiment that simulates nothing; Paced makes it keep wall time.
class CountingClock final : public Clock {
 public:
  explicit CountingClock(double rate);  // Hz
  Tick next() override;

 private:
  Tick next_;
};

}  // namespace enc::trial
