// Prepares a set-up and builds its devices: the twin for simulated slots, drivers for the slots that the rig
// names.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/control/scene/scene.h"
#include "core/devices/module.h"
#include "core/devices/rig.h"
#include "models/setup/scene_file.h"
#include "sim/world.h"

namespace enc::trial {

// prepare(); an error names its place in the file.
[[nodiscard]] Scene prepare_setup(const models::Setup& setup);

// Timing mode of the run and its devices (Offer).
struct TimingMode {
  bool waits = false, lockstep = false;
};

// The module of a driver, by its name in the rig file. Throws Error (kind device) if it is missing.
using DriverSource = std::function<const ModuleInfo&(const std::string& driver)>;

// The devices of the scene by kind: simulated ("sim") or not.
struct Slots {
  bool simulated = false, real = false;
  bool machine = false;  // the manipulator or the arm is real
};
[[nodiscard]] Slots slots_of(const models::Setup& setup);
// True if the scene has a real force sensor, tracker or camera. The user is then real too, as far as the core
// can see.
[[nodiscard]] bool meets_person(const models::Setup& setup);
// True if some real device runs in wall time, i.e. does more than replay a recording.
[[nodiscard]] bool keeps_wall_time(const models::Setup& setup, const DriverSource& drivers);

// The twin of a set-up; an error names its place in the file. Set-up and scene must outlive the twin.
[[nodiscard]] std::unique_ptr<sim::World> make_world(const models::Setup& setup, const Scene& prepared,
                                                     std::uint64_t seed, bool draw_all = false);

// A driver's module, or null to leave its table as text.
using DriverFinder = std::function<const ModuleInfo*(const std::string& driver)>;
// Reads each driver's own table by its declaration, including defaults. Throws Error with the place.
void read_driver_tables(models::Setup& setup, const DriverFinder& find);

// Puts the drivers' devices in the slots that the rig names; first it reads their tables. An error names the
// role and the place that names its driver.
void put_drivers(Rig& rig, models::Setup& setup, const DriverSource& drivers, Log& log, TimingMode keeping);

[[nodiscard]] std::vector<std::string> tool_names(const models::Setup& setup);  // by index

// A role in the scene that a driver fills; for a vision tracker, its camera.
struct DrivenRole {
  std::string driver, key;  // "netft"; the key that names it, "rig.force.driver"
  const char* name;         // name in messages, "force sensor"
  std::function<bool(const DriverModule&)> filled_by;
  bool moves = false;  // the device receives commands
};
[[nodiscard]] std::vector<DrivenRole> driven_roles(const models::Setup& setup);
// Drivers of these roles; the twin is not one.
[[nodiscard]] std::set<std::string> drivers_used(const models::Setup& setup);

// A driver's description of its device.
struct DeviceWords {
  std::string role, words;  // "force", "sample 127.0.0.1:4711, answered"
  bool there = true;        // false: the words state the problem
};
// A fake is described as such.
[[nodiscard]] std::vector<DeviceWords> describe_drivers(const Rig& rig, const models::Setup& setup);
// Key of the driver of a machine that moves and is not a fake, "rig.manipulator.driver"; empty: no such
// machine.
[[nodiscard]] std::string real_machine(const Rig& rig, const models::Setup& setup);
// Makes each device, or reports why it cannot. Moves nothing.
[[nodiscard]] std::vector<DeviceWords> put_each_driver(Rig& rig, const models::Setup& setup,
                                                       const DriverSource& drivers, Log& log);
// Makes, describes and releases each device, without a run. Moves nothing.
[[nodiscard]] std::vector<DeviceWords> ask_drivers(const models::Setup& setup, const DriverSource& drivers);

// Refuses, before anything moves, a device that can do less than the rig file states, is another machine, or
// cannot report its abilities.
void check_devices(const Rig& rig, const RigSpec& spec);

// Counts the periods of an experiment without a simulation; PacedClock adds wall time.
class CountingClock final : public Clock {
 public:
  explicit CountingClock(double rate);  // Hz
  Tick next() override;

 private:
  Tick next_;
};

}  // namespace enc::trial
