#include "trial/assemble/assemble.h"

#include <cmath>
#include <set>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/devices/roles.h"
#include "models/schema/wording.h"
#include "models/setup/driver_table.h"
#include "models/setup/scene_sizes.h"
#include "trial/assemble/driver_device.h"
#include "trial/assemble/vision.h"

namespace enc::trial {

Scene prepare_setup(const models::Setup& setup) {
  try {
    return prepare(setup.scene, setup.rig);
  } catch (const Error& e) {
    throw Error(models::place_of(setup, e.key()) + ": " + e.what() + models::mesh_advice(setup, e.key()), {},
                e.kind());
  }
}

namespace {

// True if the tracker is vision, in which case its camera has the driver.
template <class Role>
bool sees(const models::Setup& setup, const Role& role) {
  return role.id == RoleId::tracker && setup.scene.camera;
}

// The driver of a role in the scene; empty: no driver, or the twin.
template <class Role>
std::string driver_of(const models::Setup& setup, const Role& role) {
  const std::string& driver = sees(setup, role) ? setup.rig.camera.driver : (setup.rig.*role.rig).driver;
  return setup.scene.*role.scene && driver != "sim" ? driver : std::string();
}

template <class Role>
auto make(const Role& role, const models::Setup& setup, const DriverSource& modules, Log& log,
          TimingMode keeping) {
  return driver_device(driver_of(setup, role), role.make, role.name, setup, modules, log, keeping);
}

DeviceWords words_of(const char* role, const std::string& driver, const Device& device) {
  const std::string said = device.describe();
  return {role, models::printable(said.empty() ? driver : said) + (device.is_fake() ? " (a fake)" : ""),
          true};
}

class SilentLog final : public Log {
  void say(const std::string&) override {}
};

}  // namespace

Slots slots_of(const models::Setup& setup) {
  Slots slots;
  each_device([&](const auto& role) {
    if (!(setup.scene.*role.scene)) return;
    const bool real = !driver_of(setup, role).empty();
    slots.simulated = slots.simulated || !real;
    slots.real = slots.real || real;
    slots.machine = slots.machine || (real && (role.id == RoleId::manipulator || role.id == RoleId::arm));
  });
  return slots;
}

bool meets_person(const models::Setup& setup) {
  bool real = false;
  each_device([&](const auto& role) {
    if (role.id == RoleId::force || role.id == RoleId::tracker)
      real = real || !driver_of(setup, role).empty();
  });
  return real;
}

bool keeps_wall_time(const models::Setup& setup, const DriverSource& drivers) {
  bool any = false;
  each_device([&](const auto& role) {
    const std::string driver = driver_of(setup, role);
    if (driver.empty()) return;
    try {
      const DriverModule* module = drivers(driver).driver;
      any = any || module == nullptr || !module->plays;
    } catch (const Error& e) {
      throw of_role(setup, sees(setup, role) ? "camera" : role.table, e);
    }
  });
  return any;
}

std::unique_ptr<sim::World> make_world(const models::Setup& setup, const Scene& prepared, std::uint64_t seed,
                                       bool draw_all) {
  const std::string mjcf = models::models_dir() + "/mjcf";
  try {
    return std::make_unique<sim::World>(
        sim::WorldSpec{setup.scene, setup.rig, setup.twin, prepared, mjcf, seed, draw_all});
  } catch (const Error& e) {
    if (e.key().empty()) throw;
    throw Error(models::place_of(setup, e.key()) + ": " + e.what(), {}, e.kind());
  }
}

void read_driver_tables(models::Setup& setup, const DriverFinder& find) {
  for (const std::string& driver : models::drivers_of(setup.rig))
    if (const ModuleInfo* module = find(driver); module != nullptr && module->driver != nullptr)
      models::read_driver_table(setup, driver, module->driver->settings);
}

std::vector<std::string> tool_names(const models::Setup& setup) {
  std::vector<std::string> names;
  for (const ToolSpec& tool : setup.scene.tools) names.push_back(tool.name);
  return names;
}

std::vector<DrivenRole> driven_roles(const models::Setup& setup) {
  std::vector<DrivenRole> all;
  each_device([&](const auto& role) {
    const std::string driver = driver_of(setup, role);
    if (driver.empty()) return;
    if (sees(setup, role)) {
      all.push_back({driver, "rig.camera.driver", "stereo camera",
                     [](const DriverModule& module) { return module.camera != nullptr; }});
      return;
    }
    constexpr bool kMoves = requires { (Rig{}.*role.slot)->stop(); };
    all.push_back({driver, fmt::format("rig.{}.driver", role.table), role.name,
                   [make = role.make](const DriverModule& module) { return module.*make != nullptr; },
                   kMoves});
  });
  return all;
}

std::set<std::string> drivers_used(const models::Setup& setup) {
  std::set<std::string> used;
  for (DrivenRole& role : driven_roles(setup)) used.insert(std::move(role.driver));
  return used;
}

void put_drivers(Rig& rig, models::Setup& setup, const DriverSource& drivers, Log& log, TimingMode keeping) {
  const std::set<std::string> used = drivers_used(setup);
  read_driver_tables(setup,
                     [&](const std::string& name) { return used.contains(name) ? &drivers(name) : nullptr; });
  each_device([&](const auto& role) {
    if (driver_of(setup, role).empty() || sees(setup, role)) return;
    try {
      rig.*role.slot = make(role, setup, drivers, log, keeping);
    } catch (const Error& e) {
      throw of_role(setup, role.table, e);
    }
  });
}

std::vector<DeviceWords> describe_drivers(const Rig& rig, const models::Setup& setup) {
  std::vector<DeviceWords> all;
  each_device([&](const auto& role) {
    const std::string driver = driver_of(setup, role);
    if (driver.empty()) return;
    all.push_back(words_of(role.table, driver, *(rig.*role.slot)));
  });
  return all;
}

std::string real_machine(const Rig& rig, const models::Setup& setup) {
  std::string key;
  each_device([&](const auto& role) {
    if constexpr (requires { (Rig{}.*role.slot)->stop(); })
      if (key.empty() && !driver_of(setup, role).empty() && !(rig.*role.slot)->is_fake())
        key = fmt::format("rig.{}.driver", role.table);
  });
  return key;
}

std::vector<DeviceWords> put_each_driver(Rig& rig, const models::Setup& setup, const DriverSource& drivers,
                                         Log& log) {
  constexpr const char* kNotAsked =
      "not asked, as the machine does not answer: a run that has it would lose this one, too";
  std::vector<DeviceWords> all;
  bool machine_absent = false;
  each_device([&](const auto& role) {
    const std::string driver = driver_of(setup, role);
    if (driver.empty()) return;
    auto& device = rig.*role.slot;
    if (machine_absent) return all.push_back({role.table, kNotAsked, false});
    try {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(device)>, std::unique_ptr<PoseTracker>>)
        if (sees(setup, role)) device = make_vision(setup, drivers, {.log = log});
      if (!device) device = make(role, setup, drivers, log, {});
      all.push_back(words_of(role.table, driver, *device));
    } catch (const Error& e) {
      all.push_back({role.table, models::printable(e.what()), false});
      machine_absent = role.id == RoleId::manipulator || role.id == RoleId::arm;
    }
  });
  return all;
}

std::vector<DeviceWords> ask_drivers(const models::Setup& setup, const DriverSource& drivers) {
  SilentLog log;
  Rig rig;
  return put_each_driver(rig, setup, drivers, log);
}

namespace {

// Compares a device's report with the rig file. A value that is not a number fails.
struct Comparison {
  const char* device;

  void able(double can, double promised, const char* what, const char* key, double unit) const {
    if (can >= promised * (1 - 1e-9)) return;
    throw Error(fmt::format("the {} can do less than the rig file promises: {} {:g} of {:g}; lower {}",
                            device, what, can / unit, promised / unit, key),
                {}, ErrorKind::device);
  }
  void same(double is, double promised, double within, const char* what, const char* key, double unit) const {
    if (std::abs(is - promised) <= within) return;
    throw Error(fmt::format("the {} is another one than the rig file says: {} {:.6g}, not {:.6g}; correct {}",
                            device, what, is / unit, promised / unit, key),
                {}, ErrorKind::device);
  }
};

constexpr double kLength = 10e-6;   // m: better than the accuracy of measured machines of this kind
constexpr double kAngle = 1e-4;     // rad
constexpr double kMassShare = 0.1;  // share of a mass: usual difference between data sheet and scale

void check_machine(const Reach& reach, const ManipulatorRig& rig) {
  const Comparison machine{"machine"};
  machine.able(reach.speed, rig.speed, "speed in mm/s", "rig.manipulator.speed_mm_s", kMillimetre);
  machine.able(reach.acceleration, rig.acceleration, "acceleration in m/s2",
               "rig.manipulator.acceleration_m_s2", 1.0);
  const HexapodGeometry& is = reach.machine.geometry();
  const HexapodGeometry& promised = rig.geometry;
  machine.able(is.stroke, promised.stroke, "stroke in mm", "rig.manipulator.geometry.stroke_mm", kMillimetre);
  machine.able(is.tilt_limit, promised.tilt_limit, "tilt in degrees",
               "rig.manipulator.geometry.tilt_limit_deg", kDegree);
  machine.able(is.yaw_limit, promised.yaw_limit, "yaw in degrees", "rig.manipulator.geometry.yaw_limit_deg",
               kDegree);
  const auto length = [&](double HexapodGeometry::*side, const char* what, const char* key) {
    machine.same(is.*side, promised.*side, kLength, what, key, kMillimetre);
  };
  length(&HexapodGeometry::base_radius, "base radius in mm", "rig.manipulator.geometry.base_radius_mm");
  length(&HexapodGeometry::platform_radius, "platform radius in mm",
         "rig.manipulator.geometry.platform_radius_mm");
  length(&HexapodGeometry::height, "height in mm", "rig.manipulator.geometry.height_mm");
  length(&HexapodGeometry::tip_height, "tip height in mm", "rig.manipulator.geometry.tip_height_mm");
  machine.same(is.base_half_angle, promised.base_half_angle, kAngle, "base half angle in degrees",
               "rig.manipulator.geometry.base_half_angle_deg", kDegree);
  machine.same(is.platform_half_angle, promised.platform_half_angle, kAngle, "platform half angle in degrees",
               "rig.manipulator.geometry.platform_half_angle_deg", kDegree);
}

void check_phantom(const Comparison& arm, const PhantomGeometry& is, const PhantomGeometry& promised) {
  const auto length = [&](double PhantomGeometry::*side, const char* what) {
    arm.same(is.*side, promised.*side, kLength, what, "rig.arm.machine", kMillimetre);
  };
  length(&PhantomGeometry::l1, "l1 in mm");
  length(&PhantomGeometry::l2, "l2 in mm");
  length(&PhantomGeometry::l3, "l3 in mm");
  length(&PhantomGeometry::l5, "l5 in mm");
  length(&PhantomGeometry::l6, "l6 in mm");
  arm.able(-is.coupled_low, -promised.coupled_low, "way of q2 - q3 below 0 in degrees",
           "rig.arm.machine.coupled_low_deg", -kDegree);
  arm.able(is.coupled_high, promised.coupled_high, "way of q2 - q3 above 0 in degrees",
           "rig.arm.machine.coupled_high_deg", kDegree);
  for (double PhantomGeometry::*mass :
       {&PhantomGeometry::m_a, &PhantomGeometry::m_c, &PhantomGeometry::m_be, &PhantomGeometry::m_df})
    arm.same(is.*mass, promised.*mass, kMassShare * promised.*mass, "a mass in kg", "rig.arm.machine", 1.0);
}

void check_chain(const Comparison& arm, const ArmMachine& is, const ArmMachine& promised) {
  arm.same((is.tip - promised.tip).norm(), 0.0, kLength, "the tip's place in mm from it",
           "rig.arm.machine.tip_mm", kMillimetre);
  for (std::size_t i = 0; i < promised.links.size(); ++i) {
    const ChainLink &link = is.links[i], &of = promised.links[i];
    if (link.kind != of.kind)
      throw Error(fmt::format("the arm is another one than the rig file says: link {} is of another kind; "
                              "correct rig.arm.machine",
                              i + 1),
                  {}, ErrorKind::device);
    arm.same((link.origin - of.origin).norm(), 0.0, kLength, "a link's origin in mm from it",
             "rig.arm.machine", kMillimetre);
    arm.same((link.axis.normalized() - of.axis.normalized()).norm(), 0.0, kAngle,
             "a link's axis in degrees from it", "rig.arm.machine", kDegree);
    arm.same(link.mass, of.mass, kMassShare * of.mass, "a link's mass in kg", "rig.arm.machine", 1.0);
  }
}

void check_arm(const ArmAbility& is, const ArmRig& rig) {
  const Comparison arm{"arm"};
  arm.able(is.peak, rig.peak, "peak force in N", "rig.arm.peak_N", 1.0);
  arm.able(is.continuous, rig.continuous, "continuous force in N", "rig.arm.continuous_N", 1.0);
  const ArmMachine& promised = rig.machine;
  if (is.machine.kind != promised.kind || is.machine.links.size() != promised.links.size())
    throw Error("the arm is another one than the rig file says; correct rig.arm.machine", {},
                ErrorKind::device);
  if (is.machine.kind == ArmKind::phantom)
    check_phantom(arm, is.machine.phantom, promised.phantom);
  else
    check_chain(arm, is.machine, promised);
  const std::size_t joints = promised.kind == ArmKind::phantom ? kMostJoints : promised.links.size();
  for (std::size_t i = 0; i < joints; ++i) {
    arm.able(-is.machine.drives[i].low, -promised.drives[i].low, "way of a joint below 0 in rad",
             "rig.arm.machine.joint_low", -1.0);
    arm.able(is.machine.drives[i].high, promised.drives[i].high, "way of a joint above 0 in rad",
             "rig.arm.machine.joint_high", 1.0);
  }
}

}  // namespace

void check_devices(const Rig& rig, const RigSpec& spec) {
  if (rig.manipulator) check_machine(rig.manipulator->reach(), spec.manipulator);
  if (rig.arm) check_arm(rig.arm->ability(), spec.arm);
}

CountingClock::CountingClock(double rate) { next_.dt = from_seconds(1.0 / rate); }

Tick CountingClock::next() {
  const Tick tick = next_;
  ++next_.index;
  next_.t = Time(Duration(next_.index * next_.dt.count()));
  return tick;
}

}  // namespace enc::trial
