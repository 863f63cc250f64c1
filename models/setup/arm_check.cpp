// What one key alone does not show, of a scene with an arm.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "models/schema/wording.h"
#include "models/setup/scene_check.h"

namespace enc::models {
namespace {

std::size_t joints_of(const ArmMachine& machine) {
  return machine.kind == ArmKind::phantom ? kMostJoints : machine.links.size();
}

// At home all joints are at 0.
void check_joints(const Setup& setup, const std::string& key, const ArmMachine& machine) {
  for (std::size_t i = 0; i < joints_of(machine); ++i) {
    const ArmDrive& drive = machine.drives[i];
    if (drive.low < drive.high && drive.low <= 0.0 && drive.high >= 0.0) continue;
    fail(setup, key + (drive.low > 0.0 ? ".joint_low" : ".joint_high"),
         fmt::format(
             "joint {} goes from {:g} to {:g}; expected 'joint_low' below 'joint_high' and 0, where the "
             "arm is at home, between them; correct one of them",
             i + 1, drive.low, drive.high));
  }
  const PhantomGeometry& g = machine.phantom;
  if (machine.kind == ArmKind::phantom && !(g.coupled_low < g.coupled_high))
    fail(setup, key + ".coupled_low_deg",
         "'coupled_low_deg' and 'coupled_high_deg' are both 0; expected a range; lower the first");
}

void check_links(const Setup& setup, const std::string& key, const ArmMachine& machine) {
  if (machine.kind == ArmKind::phantom) return;
  if (machine.links.empty() || machine.links.size() > kMostJoints)
    fail(setup, key,
         fmt::format("this chain has {} links; expected 1 to {}; write each as '[[{}.link]]'",
                     machine.links.size(), kMostJoints, key.substr(key.starts_with("rig.") ? 4 : 0)));
  for (const ChainLink& link : machine.links)
    check_unit(setup, fmt::format("{}.link.{}.axis", key, link.name), link.axis);
}

void check_machine(const Setup& setup, const std::string& key, const ArmMachine& machine) {
  check_links(setup, key, machine);
  check_joints(setup, key, machine);
}

// What a motor or the tip does for hours it can do for a moment.
void check_continuous(const Setup& setup, const std::string& table, const char* continuous, const char* peak,
                      double for_hours, double at_most) {
  if (for_hours <= at_most) return;
  fail(setup, table + "." + continuous,
       fmt::format("'{}' is {:g}; expected at most '{}', {:g}; lower it", continuous, for_hours, peak,
                   at_most));
}

// MuJoCo takes no time constant shorter than two steps (its refsafe), and says nothing.
void check_friction_time(const Setup& setup) {
  const sim::ArmTruth& truth = setup.twin.arm;
  const double least = 2.0 * truth.timestep;
  const bool none =
      std::all_of(truth.friction.begin(), truth.friction.end(), [](double f) { return f == 0.0; });
  if (truth.friction_form != sim::ArmFriction::dry || none || truth.friction_time >= least * (1.0 - 1e-9))
    return;
  const double period = 1.0 / setup.rig.loop.rate;
  fail(setup, "truth.arm.friction_time_ms",
       fmt::format(
           "'friction_time_ms' is {:g}; expected at least two time steps, {:g} ms, because MuJoCo takes "
           "nothing shorter; raise it, or use 'timestep_us = {:g}' or less in [truth.arm]",
           truth.friction_time * 1e3, least * 1e3,
           1e6 * period / std::ceil(2.0 * period / truth.friction_time * (1.0 - 1e-9))));
}

// What the simulator has is the machine that the rig believes in: other numbers, not other joints.
void check_truth(const Setup& setup) {
  const sim::ArmTruth& truth = setup.twin.arm;
  if (!truth.there)
    fail(setup, "rig.arm",
         "the rig's arm is simulated and nothing says what it is; expected [truth.arm]; add it");
  check_machine(setup, "truth.arm.machine", truth.machine);
  const std::size_t joints = joints_of(setup.rig.arm.machine);
  if (joints_of(truth.machine) != joints)
    fail(setup, "truth.arm.machine",
         fmt::format(
             "this machine has {} joints; expected {}, as [arm.machine] has; describe the same machine",
             joints_of(truth.machine), joints));
  for (std::size_t i = 0; i < joints; ++i)
    check_continuous(setup, "truth.arm", "continuous_torque_Nm", "peak_torque_Nm", truth.continuous_torque[i],
                     truth.peak_torque[i]);
  check_friction_time(setup);
}

// Where the scene names the behaviour.
std::string naming(const Setup& setup, const BehaviourSpec& b) {
  const auto& objects = setup.scene.objects;
  const auto named = std::find_if(objects.begin(), objects.end(),
                                  [&](const ObjectSpec& o) { return o.behaviour == b.name; });
  return named == objects.end() ? "behaviour." + b.name : fmt::format("object.{}.behaviour", named->name);
}

// A force-controlled arm renders a spring as deep as the finger goes.
void check_no_limit(const Setup& setup, const std::string& key) {
  fail(setup, key,
       fmt::format("'{}' limits a deflection, which an arm does not; expected none; remove it",
                   key.substr(key.rfind('.') + 1)));
}

}  // namespace

// A fingertip has no markers and no orientation (sources/choices 12).
void check_finger(const Setup& setup, const ToolSpec& tool) {
  if (!tool.markers.empty())
    fail(setup, fmt::format("tool.{}.markers_mm", tool.name),
         "an arm meets a bare finger, which has no markers; expected none; remove them, or use [manipulator] "
         "for a tool");
  constexpr double kThickest = 0.05;  // m
  if (tool.tip_shape != TipShape::sphere || !(tool.tip_radius > 0.0 && tool.tip_radius <= kThickest))
    fail(setup, fmt::format("tool.{}.tip_radius_mm", tool.name),
         fmt::format("a finger is a sphere; expected a positive radius of at most {} mm; write it like "
                     "'tip_radius_mm = 8'",
                     mm(kThickest)));
  if (&tool != &setup.scene.tools.front())
    fail(setup, "tool." + tool.name,
         fmt::format(
             "an arm meets one finger and tool {} is another; expected one [[tool]], because nothing tells "
             "bare fingers apart; remove it",
             quoted(tool.name)));
}

void check_interaction(const Setup& setup, const BehaviourSpec& b) {
  const std::string path = "behaviour." + b.name;
  const InteractionSpec& does = b.interaction;
  if (!b.response.empty())
    fail(setup, path + ".response",
         fmt::format("behaviour {} has an [interaction], which knows no response curve; expected "
                     "'stiffness_N_per_mm'; remove 'response'",
                     quoted(b.name)));
  if (does.kind != Interaction::passive && std::isnan(b.stiffness))
    fail(setup, path,
         fmt::format("behaviour {} says nothing about its force; expected 'stiffness_N_per_mm'; add "
                     "'stiffness_N_per_mm = 0.6'",
                     quoted(b.name)));
  if (!std::isnan(b.limit)) check_no_limit(setup, path + ".limit_mm");
  if (b.tangential != Tangential::stick)
    fail(setup, path + ".tangential",
         fmt::format(
             "behaviour {} gives sideways, which an arm renders for no object; expected 'stick'; remove it",
             quoted(b.name)));
  if (does.kind == Interaction::shift || does.kind == Interaction::spin)
    check_unit(setup, path + ".interaction.way", does.way);
}

// A normal of another length than 1 still says which way is outward.
void mend_normals(Setup& setup) {
  for (ObjectSpec& o : setup.scene.objects) {
    if (o.shape != ShapeKind::plane && o.shape != ShapeKind::button) continue;
    const double length = o.normal.stableNorm();
    if (std::abs(length - 1.0) < 1e-6 || !(length > kNoWay)) continue;
    o.normal /= length;
    const std::string key = fmt::format("object.{}.normal", o.name);
    setup.notes.push_back(
        fmt::format("{}: note: 'normal' has length {:.6g}; taken as [{:.6g}, {:.6g}, {:.6g}]",
                    place_of(setup, key), length, o.normal.x(), o.normal.y(), o.normal.z()));
  }
}

// Of a stop it is said alone: it is hard either way. And of the solver, what it makes of friction.
void note_stops(Setup& setup) {
  const SceneSpec& scene = setup.scene;
  const RigSpec& rig = setup.rig;
  const sim::TwinSpec& twin = setup.twin;
  const bool has_arm = scene.arm.has_value();
  if (has_arm ? rig.arm.driver != "sim" : rig.manipulator.driver != "sim") return;
  const double least = 2.0 * twin.stepping(scene).timestep;
  const auto note = [&](bool there, const char* key, double time) {
    if (!there || time >= least * (1.0 - 1e-9)) return;
    const std::string name = std::string(key).substr(std::string(key).rfind('.') + 1);
    setup.notes.push_back(
        fmt::format("{}: warning: '{}' is {:g} and MuJoCo takes nothing shorter than two time steps, {:g} "
                    "ms; raise it, or "
                    "shorten '{}.timestep_us'",
                    place_of(setup, key), name, time * 1e3, least * 1e3, twin.stepping(scene).table));
  };
  const bool drum = scene.prop && scene.prop->kind == PropKind::drum;
  note(!has_arm && scene.user.has_value(), "truth.world.contact_time_ms", twin.world.contact_time);
  note(has_arm && !drum, "truth.arm.contact_time_ms", twin.arm.contact_time);
  note(has_arm && drum, "truth.arm.belt_time_ms", twin.arm.belt_time);
  note(has_arm && drum, "truth.arm.belt_friction_time_ms", twin.arm.belt_friction_time);
  if (scene.user && twin.solver.cone == sim::Cone::pyramidal && twin.solver.impratio > 1.0)
    setup.notes.push_back(
        fmt::format("{}: warning: a pyramidal cone with 'impratio' over 1, here {:g}, gives wrong forces: "
                    "what is pressed slips "
                    "and jumps (docs/sources/twin.md 3); use 'impratio = 1', or the elliptic cone",
                    place_of(setup, "truth.solver.cone"), twin.solver.impratio));
}

// The prop is what is really felt [VisHap 2.2]. One line for each entry that wants another one.
void note_props(Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.prop) return;
  const auto mounted = static_cast<std::int32_t>(s.prop->kind);
  for (const BehaviourSpec& b : s.behaviours) {
    const std::int32_t wanted = b.interaction.prop;
    if (wanted < 0 || wanted == mounted) continue;
    const auto wants = [&](const ObjectSpec& o) { return o.behaviour == b.name; };
    const auto first = std::find_if(s.objects.begin(), s.objects.end(), wants);
    if (first == s.objects.end()) continue;
    const auto others = std::count_if(s.objects.begin(), s.objects.end(), wants) - 1;
    setup.notes.push_back(
        fmt::format("{}: warning: object {}{} shall feel like a {} and the arm carries a {}; mount another "
                    "prop, or name another "
                    "behaviour",
                    place_of(setup, fmt::format("object.{}.behaviour", first->name)), quoted(first->name),
                    others > 0 ? fmt::format(" and {} more", others) : "",
                    word_of(static_cast<PropKind>(wanted)), word_of(s.prop->kind)));
  }
}

namespace {

void check_armless(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (s.prop) fail(setup, "prop", "nothing carries the prop; expected an [arm]; add it or remove [prop]");
  for (const BehaviourSpec& b : s.behaviours)
    if (b.interaction.kind != Interaction::press)
      fail(setup, naming(setup, b),
           fmt::format("behaviour {} is rendered by a force-controlled arm; expected one without "
                       "[interaction]; name another, or use [arm] instead of [manipulator]",
                       quoted(b.name)));
}

}  // namespace

void check_arm(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.arm) {
    check_armless(setup);
    return;
  }
  const auto without = [&](bool there, const char* table) {
    if (there)
      fail(setup, table,
           fmt::format("the scene has both [arm] and [{}]; expected one of them; remove one", table));
  };
  without(s.manipulator.has_value(), "manipulator");
  without(s.force.has_value(), "force");
  without(s.gripper.has_value(), "gripper");
  without(s.probe.has_value(), "probe");
  without(s.pusher.has_value(), "pusher");
  without(s.travel.has_value(), "travel");
  without(s.display.has_value(), "display");
  if (!s.tracker)
    fail(setup, "arm", "the arm does not know where the finger is; expected a [tracker]; add it");
  for (const BehaviourSpec& b : s.behaviours)
    if (b.interaction.kind == Interaction::press)
      fail(setup, naming(setup, b),
           fmt::format("behaviour {} is for a machine that measures force; expected one with [interaction]; "
                       "name another, such as \"phantom_wall\"",
                       quoted(b.name)));
  for (const ObjectSpec& o : s.objects) {
    if (!std::isnan(o.limit)) check_no_limit(setup, fmt::format("object.{}.limit_mm", o.name));
    if (!o.limits.empty()) check_no_limit(setup, fmt::format("object.{}.limits_mm", o.name));
  }
  const ArmRig& arm = setup.rig.arm;
  check_machine(setup, "rig.arm.machine", arm.machine);
  check_continuous(setup, "rig.arm", "continuous_N", "peak_N", arm.continuous, arm.peak);
  if (arm.driver == "sim") check_truth(setup);
}

}  // namespace enc::models
