// What one key alone does not show, of a scene with an arm.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "models/scene_check.h"
#include "models/wording.h"

namespace enc::models {
namespace {

void check_unit(const Setup& setup, const std::string& key, const Vec3& v) {
  const double length = v.norm();
  if (std::abs(length - 1.0) < 1e-6) return;
  const Vec3 u = length > 0 ? Vec3(v / length) : Vec3(0, 0, 1);
  fail(setup, key,
       fmt::format("its length is {:.6g}; expected 1; write it like '[{}, {}, {}]'", length, u.x(), u.y(),
                   u.z()));
}

void check_machine(const Setup& setup, const std::string& key, const ArmMachine& machine) {
  if (machine.kind == ArmKind::phantom) return;
  if (machine.links.empty() || machine.links.size() > kMostJoints)
    fail(setup, key,
         fmt::format("this chain has {} links; expected 1 to {}; write each as '[[{}.link]]'",
                     machine.links.size(), kMostJoints, key));
  for (const ChainLink& link : machine.links)
    check_unit(setup, fmt::format("{}.link.{}.axis", key, link.name), link.axis);
}

}  // namespace

// A fingertip has no markers and no orientation (decisions 12).
void check_finger(const Setup& setup, const ToolSpec& tool) {
  if (!tool.markers.empty())
    fail(setup, fmt::format("tool.{}.markers_mm", tool.name),
         "an arm meets a bare finger, which has no markers; expected none; remove them, or use [manipulator] "
         "for a tool");
  if (tool.tip_shape != TipShape::sphere || !(tool.tip_radius > 0.0))
    fail(setup, fmt::format("tool.{}.tip_radius_mm", tool.name),
         "a finger is a sphere; expected a positive radius; write it like 'tip_radius_mm = 8'");
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
  if (does.kind == Interaction::shift || does.kind == Interaction::spin)
    check_unit(setup, path + ".interaction.way", does.way);
}

// A normal of another length than 1 still says which way is outward.
void mend_normals(Setup& setup) {
  constexpr double kNoWay = 1e-6;
  for (ObjectSpec& o : setup.scene.objects) {
    if (o.shape != ShapeKind::plane && o.shape != ShapeKind::button) continue;
    const double length = o.normal.norm();
    if (std::abs(length - 1.0) < 1e-6 || !(length > kNoWay) || !std::isfinite(length)) continue;
    o.normal /= length;
    const std::string key = fmt::format("object.{}.normal", o.name);
    setup.notes.push_back(
        fmt::format("{}: note: 'normal' has length {:.6g}; taken as [{:.6g}, {:.6g}, {:.6g}]",
                    place_of(setup, key), length, o.normal.x(), o.normal.y(), o.normal.z()));
  }
}

// The prop is what is really felt [VisHap 2.2]. One line for each entry that wants another one.
void note_props(Setup& setup) {
  constexpr std::array<std::string_view, 3> kNames{"plate", "key", "drum"};
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
                    kNames[static_cast<std::size_t>(wanted)], kNames[static_cast<std::size_t>(mounted)]));
  }
}

void check_arm(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.arm) {
    if (s.prop) fail(setup, "prop", "nothing carries the prop; expected an [arm]; add it or remove [prop]");
    for (const BehaviourSpec& b : s.behaviours)
      if (b.interaction.kind != Interaction::press)
        fail(setup, "behaviour." + b.name,
             fmt::format("behaviour {} is rendered by a force-controlled arm; expected one without "
                         "[interaction]; name another, or use [arm] instead of [manipulator]",
                         quoted(b.name)));
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
      fail(setup, "behaviour." + b.name,
           fmt::format("behaviour {} is for a machine that measures force; expected one with [interaction]; "
                       "name another, such as \"phantom_wall\"",
                       quoted(b.name)));
  check_machine(setup, "rig.arm.machine", setup.rig.arm.machine);
  if (setup.rig.arm.driver != "sim") return;
  if (!setup.twin.arm.there)
    fail(setup, "rig.arm",
         "the rig's arm is simulated and nothing says what it is; expected [truth.arm]; add it");
  check_machine(setup, "truth.arm.machine", setup.twin.arm.machine);
}

}  // namespace enc::models
