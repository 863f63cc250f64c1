// What one key alone does not show. What needs the machine (reach, monotone curves) is checked by core's
// prepare().
#include "models/setup/scene_check.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/control/task/measure/probe.h"
#include "core/control/world/contact_limits.h"
#include "core/control/world/object.h"
#include "core/devices/roles.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"
#include "models/setup/rig_calibration.h"
#include "models/setup/scene_file.h"

namespace enc::models {
namespace {

// `table` names an entry of [[list]].
template <class T>
void check_named(const Setup& setup, const std::vector<T>& items, const std::string& name,
                 const std::string& list, const std::string& table = "user") {
  const std::vector<std::string> names = names_of(items);
  if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return;
  fail(setup, table + "." + list,
       fmt::format("there is no {} {}; expected the name of a [[{}]]; {}", list, quoted(name), list,
                   advice(name, names)));
}

// Only what the probe presses may be there instead of being rendered.
void check_real(const Setup& setup, const ObjectSpec& o) {
  const std::string path = "object." + o.name;
  const bool probed = setup.scene.probe && &o == &probed_object(setup.scene);
  if (!probed) {
    fail(setup, path,
         fmt::format("object {} has no 'behaviour'; expected one, because {}; write it like 'behaviour = "
                     "\"{}\"'",
                     quoted(o.name),
                     setup.scene.probe ? "[probe] does not press it" : "nothing else says what is felt",
                     checks_of(setup.scene).behaviour));
  }
  if (!std::isnan(o.limit) || !o.limits.empty()) {
    const char* key = o.limits.empty() ? "limit_mm" : "limits_mm";
    fail(setup, fmt::format("{}.{}", path, key),
         fmt::format("object {} is real and has a '{}'; expected none, or a 'behaviour' that it limits; "
                     "remove it",
                     quoted(o.name), key));
  }
}

// `most`: where the behaviour ends, 0 while that is not known.
void check_contacts(const Setup& setup, const ObjectSpec& o, double most, const std::string& behaviour) {
  const LimitCheck found = check_limits(o, most);
  if (found.fault == LimitFault::none) return;
  const bool several = !o.limits.empty();
  const std::string key = fmt::format("object.{}.{}", o.name, several ? "limits_mm" : "limit_mm");
  const auto wrong = [&](const std::string& expected) {
    fail(setup, key,
         fmt::format("'{}' is {}; expected {}",
                     several ? fmt::format("limits_mm[{}]", found.index) : "limit_mm",
                     mm(several ? o.limits[found.index] : o.limit), expected));
  };
  switch (found.fault) {
    case LimitFault::none:
      return;
    case LimitFault::two_keys:
      fail(setup, key,
           fmt::format("object {} has both 'limit_mm' and 'limits_mm'; expected one of them; remove one",
                       quoted(o.name)));
    case LimitFault::too_many:
      fail(setup, key,
           fmt::format("'limits_mm' has {} elements; expected at most {}; the last one stays for all further "
                       "contacts; remove some",
                       o.limits.size(), ContactLimits::kMost));
    case LimitFault::not_positive:
      return wrong("a positive number; raise it");
    case LimitFault::beyond_radius:
      return wrong(fmt::format("less than the radius, {} mm; lower it", mm(o.radius)));
    case LimitFault::beyond_behaviour:
      return wrong(
          fmt::format("at most {} mm, where behaviour {} ends; lower it", mm(most), quoted(behaviour)));
  }
}

void check_object(const Setup& setup, const ObjectSpec& o) {
  const std::string path = "object." + o.name;
  if (o.shape == ShapeKind::plane || o.shape == ShapeKind::button) {
    check_unit(setup, path + ".normal", o.normal);  // mend_normals() has mended what has a direction
  }
  if (o.behaviour.empty()) return check_real(setup, o);
  const auto b = std::find_if(setup.scene.behaviours.begin(), setup.scene.behaviours.end(),
                              [&](const BehaviourSpec& item) { return item.name == o.behaviour; });
  if (b == setup.scene.behaviours.end()) {
    fail(setup, path + ".behaviour",
         fmt::format("there is no behaviour {}; expected a [[behaviour]]; {}", quoted(o.behaviour),
                     advice(o.behaviour, names_of(setup.scene.behaviours))));
  }
  const double most = std::isnan(b->limit) ? b->curves.limit : b->limit;
  check_contacts(setup, o, most, b->name);
}

// Called before and after the curves are there.
void check_behaviour(const Setup& setup, const BehaviourSpec& b) {
  if (b.interaction.kind != Interaction::press) return check_interaction(setup, b);
  const std::string path = "behaviour." + b.name;
  const bool linear = !std::isnan(b.stiffness);
  if (linear && !b.response.empty()) {
    fail(setup, path + ".stiffness_N_per_mm",
         fmt::format(
             "behaviour {} has both 'response' and 'stiffness_N_per_mm'; expected one of them; remove one",
             quoted(b.name)));
  }
  if (!linear && b.response.empty()) {
    fail(setup, path,
         fmt::format("behaviour {} says nothing about its force; expected 'response' or "
                     "'stiffness_N_per_mm'; add 'response = \"tennis_ball\"'",
                     quoted(b.name)));
  }
  if (linear && std::isnan(b.limit)) {
    fail(setup, path,
         fmt::format(
             "behaviour {} has no 'limit_mm'; expected one with 'stiffness_N_per_mm'; add 'limit_mm = 6'",
             quoted(b.name)));
  }
  if (b.curves.limit > 0.0 && b.limit > b.curves.limit) {
    fail(setup, path + ".limit_mm",
         fmt::format("'limit_mm' is {}; expected at most {} mm, where response {} ends; lower it",
                     mm(b.limit), mm(b.curves.limit), quoted(b.response)));
  }
}

void check_user(const Setup& setup) {
  if (!setup.scene.user) return;
  if (setup.scene.tools.empty()) {
    fail(setup, "user", "the user has no tool; expected at least one [[tool]]; add one or remove [user]");
  }
  check_named(setup, setup.scene.objects, setup.scene.user->object, "object");
  check_named(setup, setup.scene.tools, setup.scene.user->tool, "tool");
  check_session(setup);
  check_reaches(setup);
}

// What the simulated ball is good for (sim/bodies/ball_plant.h). A real machine may press other things.
void check_probe(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.probe || setup.rig.force.driver != "sim") return;
  constexpr double kRadius = 10e-3, kDeepest = 8e-3;  // m
  const ObjectSpec& object = probed_object(s);
  if (object.shape != ShapeKind::sphere) {
    fail(setup, fmt::format("object.{}.shape", object.name),
         "the simulated rig has a ball to press and nothing else; expected a sphere; write it like 'shape = "
         "\"sphere\"'");
  }
  if (std::abs(s.probe->radius - kRadius) > 1e-9) {
    fail(setup, "probe.radius_mm",
         fmt::format("'radius_mm' is {}; expected 10, because the law of the simulated ball holds for that "
                     "probe only; write it like 'radius_mm = 10'",
                     mm(s.probe->radius)));
  }
  if (s.probe->depth > kDeepest) {
    fail(setup, "probe.depth_mm",
         fmt::format(
             "'depth_mm' is {}; expected at most {}, where the law of the simulated ball ends; lower it",
             mm(s.probe->depth), mm(kDeepest)));
  }
}

// What pushes from outside is alone with the machine and its force sensor: force alone makes the contact.
void check_pusher(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.pusher) return;
  check_named(setup, s.objects, s.pusher->object, "object", "pusher");
  const auto alone = [&](bool there, const char* table) {
    if (there)
      fail(setup, table,
           fmt::format("the scene has both [pusher] and [{}]; expected one of them; remove one", table));
  };
  alone(s.user.has_value(), "user");
  alone(s.probe.has_value(), "probe");
  alone(s.tracker.has_value(), "tracker");
  alone(s.display.has_value(), "display");
  if (!s.force)
    fail(setup, "pusher", "the tip cannot feel the pusher; expected a [force]; add it or remove [pusher]");
  if (s.pusher->rest_time < setup.rig.force.tare_time)
    fail(setup, "pusher.rest_s",
         fmt::format("'rest_s' is {:g}; expected at least 'rig.force.tare_time_s', {:g}, in which the force "
                     "zero is found; raise it",
                     s.pusher->rest_time, setup.rig.force.tare_time));
}

// The tool that the gripper clamps is nobody's hand-held one.
void check_gripper(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.gripper) return;
  if (s.tools.empty())
    fail(setup, "gripper",
         "the gripper has no tool; expected at least one [[tool]]; add one or remove [gripper]");
  check_named(setup, s.tools, s.gripper->tool, "tool", "gripper");
  const auto first = [&](const std::string& name) { return name.empty() ? s.tools.front().name : name; };
  if (s.user && first(s.user->tool) == first(s.gripper->tool))
    fail(setup, "gripper.tool",
         fmt::format("tool {} is both clamped and held by the user; expected another one; name it in "
                     "'gripper.tool' or remove [user]",
                     quoted(first(s.gripper->tool))));
  const sim::GripperTruth& g = setup.twin.gripper;
  if (g.force_max < g.force_min)
    fail(setup, "truth.gripper.force_max_N",
         "'force_max_N' is less than 'force_min_N'; expected at least that; raise it");
  if (g.width > 2.0 * g.stroke)
    fail(setup, "truth.gripper.width_mm",
         fmt::format("'width_mm' is {}; expected at most {} mm, which the jaws open; lower it", mm(g.width),
                     mm(2.0 * g.stroke)));
}

void check_driver(const Setup& setup, bool named, const std::string& table, const std::string& driver) {
  if (!named || driver != "none") return;
  fail(setup, table,
       fmt::format("the scene names [{}] and rig {} has none; expected a [{}] with a driver; add it to the "
                   "rig, or use '--rig {}'",
                   table, quoted(setup.rig_path), table, checks_of(setup.scene).rig));
}

void check_calibration(const Setup& setup) {
  const std::string& date = setup.rig.calibration.date;
  if (date.empty() || day_of(date)) return;
  fail(setup, "rig.calibration.date",
       fmt::format(
           "'date' is {}; expected a day, as \"2026-11-27\"; write the day on which the rig was measured",
           quoted(date)));
}

void check_rig(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  const RigSpec& r = setup.rig;
  check_driver(setup, s.camera.has_value(), "camera", r.camera.driver);
  check_camera(setup);
  check_calibration(setup);
  each_role([&](const auto& role) {
    check_driver(setup, (s.*role.scene).has_value(), role.table, (r.*role.rig).driver);
  });
  if (r.tracker.lost_age < r.tracker.usual_age) {
    fail(setup, "rig.tracker.lost_age_ms",
         "'lost_age_ms' is less than 'usual_age_ms'; expected at least that; raise it");
  }
}

// The physics steps a whole number of times in a haptic period, and not so often that a run never ends.
void check_stepping(const Setup& setup) {
  constexpr double kMost = 1000.0;
  const sim::Stepping stepping = setup.twin.stepping(setup.scene);
  const double rate = setup.rig.loop.rate, period = 1e6 / rate;  // us
  if (stepping.timestep * rate * kMost < 1.0 - 1e-6)
    fail(
        setup, stepping.table + ".timestep_us",
        fmt::format("'timestep_us' is {:g}; expected at least a thousandth of the haptic period, {:g}; raise "
                    "it",
                    stepping.timestep * 1e6, period / kMost));
  if (stepping.steps_per_tick(rate) == 0)
    fail(setup, stepping.table + ".timestep_us",
         fmt::format(
             "'timestep_us' does not divide the haptic period, {} us; expected a whole share of it, such "
             "as 'timestep_us = {}'",
             period, period));
}

}  // namespace

void fail(const Setup& setup, const std::string& key, const std::string& what) {
  throw Error(fmt::format("{}: {}", place_of(setup, key), what));
}

std::string mm(double metres) { return text_of(unit_of("x_mm"), metres); }

void check_unit(const Setup& setup, const std::string& key, const Vec3& v) {
  const double length = v.stableNorm();
  if (std::abs(length - 1.0) < 1e-6) return;
  const bool none = !(length > kNoWay);
  const Vec3 u = none ? Vec3(0, 0, 1) : Vec3(v / length);
  const std::string name = key.substr(key.rfind('.') + 1);
  fail(setup, key,
       fmt::format("'{}' has length {:.6g}{}; expected length 1; write it like '{} = [{}, {}, {}]'", name,
                   length, none ? " and no direction" : "", name, u.x(), u.y(), u.z()));
}

// As with [user] and a real tracker: the scene says what is done, and who does it is there.
void note_pusher(Setup& setup) {
  const std::string& driver = setup.rig.force.driver;
  if (!setup.scene.pusher || driver == "none" || driver == "sim") return;
  setup.notes.push_back(
      fmt::format("{}: warning: [pusher] is simulated and the rig's force sensor is {}, which feels what is "
                  "there: somebody has to push, or `encounter fake` with this scene",
                  place_of(setup, "pusher"), quoted(driver)));
}

void check(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (s.objects.empty() && !s.travel)
    fail(
        setup, "",
        "the scene has no object; expected at least one [[object]]; add one, as in models/scenes/plane.toml");
  if (s.probe) check_named(setup, s.objects, s.probe->object, "object", "probe");
  for (const ObjectSpec& object : s.objects) check_object(setup, object);
  for (const BehaviourSpec& behaviour : s.behaviours) check_behaviour(setup, behaviour);
  for (const ToolSpec& tool : s.tools) checks_of(s).tool(setup, tool);
  if (s.follow.resume > s.follow.pause) {
    fail(setup, "follow.resume_mm",
         fmt::format("'resume_mm' is {}; expected at most 'pause_mm', {} mm; lower it", mm(s.follow.resume),
                     mm(s.follow.pause)));
  }
  check_user(setup);
  check_probe(setup);
  check_pusher(setup);
  check_gripper(setup);
  checks_of(s).scene(setup);
  check_rig(setup);
  check_stepping(setup);
}

}  // namespace enc::models
