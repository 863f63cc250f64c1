// Checks of several keys together, for each machine: its tools, its behaviours, its stops.
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/control/track/markers.h"
#include "models/schema/wording.h"
#include "models/setup/scene_check.h"
#include "models/setup/scene_sizes.h"

namespace enc::models {
namespace {

std::size_t joints_of(const ArmMachine& machine) {
  return machine.kind == ArmKind::phantom ? kMostJoints : machine.links.size();
}

// All joints are at 0 at home.
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

// A motor or a tip that exerts a force for hours can exert it briefly.
void check_continuous(const Setup& setup, const std::string& table, const char* continuous, const char* peak,
                      double for_hours, double at_most) {
  if (for_hours <= at_most) return;
  fail(setup, table + "." + continuous,
       fmt::format("'{}' is {:g}; expected at most '{}', {:g}; lower it", continuous, for_hours, peak,
                   at_most));
}

// MuJoCo silently replaces a time constant below two steps (its refsafe).
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

// The simulator's machine may have other numbers than the rig's, but not other joints.
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

// The key by which the scene names the behaviour.
std::string naming(const Setup& setup, const BehaviourSpec& b) {
  const auto& objects = setup.scene.objects;
  const auto named = std::find_if(objects.begin(), objects.end(),
                                  [&](const ObjectSpec& o) { return o.behaviour == b.name; });
  return named == objects.end() ? "behaviour." + b.name : fmt::format("object.{}.behaviour", named->name);
}

// A force-controlled arm renders a spring to any depth of the finger.
void check_no_limit(const Setup& setup, const std::string& key) {
  fail(setup, key,
       fmt::format("'{}' limits a deflection, which an arm does not; expected none; remove it",
                   key.substr(key.rfind('.') + 1)));
}

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

// Root of the sum of squared distances of the markers from their best-fitting line, m.
double off_the_line(const std::vector<Vec3>& markers) {
  const Vec3 middle = middle_of(markers);
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& marker : markers) scatter += (marker - middle) * (marker - middle).transpose();
  const Vec3 along = Eigen::SelfAdjointEigenSolver<Mat3>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(std::max(0.0, along[0] + along[1]));  // all but the greatest
}
// Noise of the markers rotates the tool about that line by noise / (rms distance from it * sqrt(n)), rad,
// which is noise / off_the_line(). At 0.3 mm noise and 6 mm that is 0.05, or 3 deg.
constexpr double kMostTurn = 0.05;
constexpr double kLeastOffLine = kMarkerNoise / kMostTurn;  // m

void check_marked_tool(const Setup& setup, const ToolSpec& tool) {
  if (tool.tip_shape != TipShape::sphere)
    check_unit(setup, fmt::format("tool.{}.tip_axis", tool.name), tool.tip_axis);
  const std::string key = fmt::format("tool.{}.markers_mm", tool.name);
  const std::string unit = markers_advice(tool);
  const std::string advice = unit.empty() ? "move one of 'markers_mm'" : unit;
  if (tool.markers.size() < kFewestMarkers) {
    fail(setup, key,
         fmt::format("tool {} has {} markers; expected at least {}, or its pose is not known; add some to "
                     "'markers_mm'",
                     quoted(tool.name), tool.markers.size(), kFewestMarkers));
  }
  if (tool.markers.size() > kMostMarkers)
    fail(setup, key,
         fmt::format("tool {} has {} markers; expected at most {}; leave some out", quoted(tool.name),
                     tool.markers.size(), kMostMarkers));
  if (const double off = off_the_line(tool.markers); !(off >= kLeastOffLine)) {
    const double share = 1.0 / std::sqrt(static_cast<double>(tool.markers.size()));
    fail(setup, key,
         fmt::format(
             "the markers of tool {} are on a line, or almost: they are {:.2f} mm rms off it; expected "
             "at least {:.2f} mm, or nobody knows how it is turned about the line; {}",
             quoted(tool.name), 1e3 * share * off, 1e3 * share * kLeastOffLine, advice));
  }
  if (has_two_poses(tool.markers))
    fail(setup, key,
         fmt::format(
             "the markers of tool {} look the same in another order, so that it has two poses; expected "
             "distances that differ by {} mm; {}",
             quoted(tool.name), mm(kMarkersApart), advice));
  for (const ToolSpec& other : setup.scene.tools) {
    if (&other == &tool) return;
    if (!alike(tool.markers, other.markers)) continue;
    fail(setup, key,
         fmt::format("tools {} and {} have the same marker geometry; expected distances that differ by {} "
                     "mm; {}",
                     quoted(other.name), quoted(tool.name), mm(kMarkersApart), advice));
  }
}

}  // namespace

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
  if (b.tangential != TangentialMode::stick)
    fail(setup, path + ".tangential",
         fmt::format(
             "behaviour {} gives sideways, which an arm renders for no object; expected 'stick'; remove it",
             quoted(b.name)));
  if (does.kind == Interaction::shift || does.kind == Interaction::spin)
    check_unit(setup, path + ".interaction.way", does.way);
}

// A normal with a length other than 1 still defines the outward direction.
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

// Notes a stop without an error: it is hard in either case. Also notes how the solver changes friction.
void note_stops(Setup& setup) {
  const MachineChecks& machine = checks_of(setup.scene);
  if (!machine.simulated(setup.rig)) return;
  const sim::TwinSpec& twin = setup.twin;
  const sim::Stepping stepping = twin.stepping(setup.scene);
  const double least = 2.0 * stepping.timestep;
  for (const auto& [key, time] : machine.stops(setup)) {
    if (time >= least * (1.0 - 1e-9)) continue;
    setup.notes.push_back(fmt::format(
        "{}: warning: '{}' is {:g} and MuJoCo takes nothing shorter than two time steps, {:g} "
        "ms; raise it, or "
        "shorten '{}.timestep_us'",
        place_of(setup, key), key.substr(key.rfind('.') + 1), time * 1e3, least * 1e3, stepping.table));
  }
  if (setup.scene.user && twin.solver.cone == sim::Cone::pyramidal && twin.solver.impratio > 1.0)
    setup.notes.push_back(
        fmt::format("{}: warning: a pyramidal cone with 'impratio' over 1, here {:g}, gives wrong forces: "
                    "what is pressed slips "
                    "and jumps (docs/sources/twin.md 3); use 'impratio = 1', or the elliptic cone",
                    place_of(setup, "truth.solver.cone"), twin.solver.impratio));
}

// The user really touches the prop [VisHap 2.2]. One line for each entry that needs another prop.
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

void check_hexapod(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (s.prop) fail(setup, "prop", "nothing carries the prop; expected an [arm]; add it or remove [prop]");
  for (const BehaviourSpec& b : s.behaviours)
    if (b.interaction.kind != Interaction::press)
      fail(setup, naming(setup, b),
           fmt::format("behaviour {} is rendered by a force-controlled arm; expected one without "
                       "[interaction]; name another, or use [arm] instead of [manipulator]",
                       quoted(b.name)));
}

void check_arm(const Setup& setup) {
  const SceneSpec& s = setup.scene;
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

std::vector<StopTime> hexapod_stops(const Setup& setup) {
  if (!setup.scene.user) return {};
  return {{"truth.world.contact_time_ms", setup.twin.world.contact_time}};
}
std::vector<StopTime> arm_stops(const Setup& setup) {
  const std::optional<PropSpec>& prop = setup.scene.prop;
  const sim::ArmTruth& truth = setup.twin.arm;
  if (!prop || prop->kind != PropKind::drum) return {{"truth.arm.contact_time_ms", truth.contact_time}};
  return {{"truth.arm.belt_time_ms", truth.belt_time},
          {"truth.arm.belt_friction_time_ms", truth.belt_friction_time}};
}

constexpr sim::PerMachine<MachineChecks> kChecks{
    .hexapod = {.behaviour = "tennis_ball",
                .rig = "sim",
                .bare_finger = false,
                .simulated = [](const RigSpec& rig) { return rig.manipulator.driver == "sim"; },
                .tool = check_marked_tool,
                .scene = check_hexapod,
                .stops = hexapod_stops},
    .arm = {.behaviour = "phantom_wall",
            .rig = "vishap",
            .bare_finger = true,
            .simulated = [](const RigSpec& rig) { return rig.arm.driver == "sim"; },
            .tool = check_finger,
            .scene = check_arm,
            .stops = arm_stops}};

}  // namespace

const MachineChecks& checks_of(const SceneSpec& scene) { return kChecks.of(scene); }

}  // namespace enc::models
