// Keys of a scene, a rig and the simulator's ground truth for a force-controlled arm and for interactions
// that only an arm renders.
#include <algorithm>

#include "models/schema/schema_walk.h"

namespace enc::models {
namespace {

using enum Confidence;
using enum Presence;

// The words of PropKind, preceded by a word for -1.
constexpr auto kAnyOrProp = [] {
  std::array<std::string_view, kWords<PropKind>.size() + 1> all{"any"};
  std::copy(kWords<PropKind>.begin(), kWords<PropKind>.end(), all.begin() + 1);
  return all;
}();
constexpr std::string_view kSet = "sources/arm 5: the published 1.5 scaled by 2/3";

void describe(Visitor& v, PhantomGeometry& p) {
  v.value({"l1_mm", "upper arm", kSet, derived, kPositive}, &p.l1);
  v.value({"l2_mm", "forearm, to the tip; the least sure of the lengths", kSet, derived, kPositive}, &p.l2);
  v.value({"l3_mm", "crank of the parallelogram", kSet, derived, kPositive}, &p.l3);
  v.value({"l5_mm", "centre of mass of the upper arm with its motor, from the axis", kSet, derived}, &p.l5);
  v.value({"l6_mm", "and of the crank with its motor", kSet, derived}, &p.l6);
  v.value({"m_a_kg", "forearm", kSet, derived, kPositive}, &p.m_a);
  v.value({"m_c_kg", "parallelogram link", kSet, derived, kPositive}, &p.m_c);
  v.value({"m_be_kg", "upper arm with motor", kSet, derived, kPositive}, &p.m_be);
  v.value({"m_df_kg", "crank with motor", kSet, derived, kPositive}, &p.m_df);
  v.value({"I_a_kgm2", "forearm about its centre of mass", kSet, derived, kPositive}, &p.I_a);
  v.value({"I_c_kgm2", "parallelogram link, likewise", kSet, derived, kPositive}, &p.I_c);
  v.value({"I_be_kgm2", "upper arm with motor, about the origin of R", kSet, derived, kPositive}, &p.I_be);
  v.value({"I_df_kgm2", "crank with motor, about the origin of R", kSet, derived, kPositive}, &p.I_df);
  v.value({"I_base_kgm2", "turret about its axis", kSet, derived, kPositive}, &p.I_base);
  v.value({"coupled_low_deg", "least q2 - q3", "sources/arm 3", published, {-180.0, 0.0}}, &p.coupled_low);
  v.value({"coupled_high_deg", "greatest q2 - q3", "sources/arm 3", published, {0.0, 180.0}},
          &p.coupled_high);
}

void describe(Visitor& v, ChainLink& l) {
  v.value({"name", "of the joint and the link behind it", "rig", chosen, kAny, needed, {}, true}, &l.name);
  choice(v, {"kind", "hinge, in rad, or slide, in m", "rig", chosen, kAny, needed}, l.kind);
  v.value({"axis", "of length 1, in the link before", "rig", chosen, {-1.0, 1.0}, needed}, &l.axis);
  v.value({"origin_mm", "of the joint, from the joint before", "rig", chosen}, &l.origin);
  v.value({"mass_kg", "of the link", "rig", chosen, kPositive}, &l.mass);
  v.value({"centre_mm", "of its mass, from the joint", "rig", chosen}, &l.centre);
  v.value({"inertia_kgm2", "about that, along its axes", "rig", chosen, kPositive}, &l.inertia);
}

// One number for each joint, as an array of three.
void per_joint(Visitor& v, const Key& key, PerJoint& numbers) {
  Vec3 all(numbers[0], numbers[1], numbers[2]);
  v.value(key, &all);
  numbers = {all.x(), all.y(), all.z()};
}

void describe_drives(Visitor& v, ArmMachine& m) {
  const auto each = [&](const Key& key, double ArmDrive::*member) {
    PerJoint all{};
    for (std::size_t i = 0; i < kMostJoints; ++i) all[i] = m.drives[i].*member;
    per_joint(v, key, all);
    for (std::size_t i = 0; i < kMostJoints; ++i) m.drives[i].*member = all[i];
  };
  each({"joint_low", "least of each joint, rad or m", "sources/arm 3", published}, &ArmDrive::low);
  each({"joint_high", "greatest of each joint, rad or m", "sources/arm 3", published}, &ArmDrive::high);
  each({"ratio", "rad of the motor for each rad or m of the joint", kSet, derived, kPositive},
       &ArmDrive::ratio);
  each({"rotor_inertia_kgm2", "of each motor", "sources/arm 3", published, kNotNegative},
       &ArmDrive::rotor_inertia);
}

void describe(Visitor& v, ArmMachine& m) {
  choice(v, {"kind", "a PHANToM, or a chain of hinges and slides", "rig", chosen}, m.kind);
  describe_drives(v, m);
  if (m.kind == ArmKind::phantom) return describe(v, m.phantom);
  v.value({"tip_mm", "H in the last link", "rig", chosen}, &m.tip);
  list(v, "link", m.links, [&](ChainLink& link) { describe(v, link); });
}

}  // namespace

void describe(Visitor& v, ThermalModel& t) {
  v.value({"winding_time_s", "thermal, of each motor's winding", "sources/arm 3", published, kPositive},
          &t.winding_time);
  v.value({"housing_time_s", "thermal, of each motor's housing", "sources/arm 3", published, kPositive},
          &t.housing_time);
  v.value({"winding_share",
           "of a winding's rise over the room that is over its housing",
           "sources/arm 3",
           published,
           {0.0, 1.0}},
          &t.winding_share);
}

void describe(Visitor& v, ArmLoop& l) {
  const auto each = [&](const Key& key, PerJoint& numbers) { per_joint(v, key, numbers); };
  each({"friction_Nm", "Coulomb's, at each joint, as is believed; N of a slide", "sources/arm 3", published,
        kNotNegative},
       l.friction);
  each({"viscous_Nms", "at each joint, for each rad/s; N s/m of a slide", "sources/arm 3", published,
        kNotNegative},
       l.viscous);
  each({"counts", "of each encoder, for a turn of its motor", "sources/arm 3", published, {1.0}}, l.counts);
  v.value({"velocity_window_ms", "over which the device differences its encoders",
           "docs/reference/phantom_twin.md", assumed, kPositive},
          &l.velocity_window);
  v.value({"delay_ms", "from a reading to the force that answers it, beyond the tick that holds it",
           "docs/reference/stability.md", assumed, kNotNegative},
          &l.delay);
}

void describe(Visitor& v, ArmRig& a) {
  v.value({"driver", "sim, a folder of hw_drivers, or none", "rig", chosen, kAny, needed}, &a.driver);
  choice(v,
         {"gravity", "what is done against it: nothing, eq. 5 with the prop in m_a, or the prop at the tip",
          "[VisHap eq. 5]", chosen},
         a.gravity);
  v.value({"stiffness_N_per_m", "K_p of eq. 2", "docs/reference/plane_button.md", chosen, kPositive},
          &a.stiffness);
  v.value({"damping_Ns_per_m", "K_v of eq. 2", "docs/reference/plane_button.md", chosen, kPositive},
          &a.damping);
  v.value({"filter_hz", "a / 2 pi of eq. 3 in its s-domain form, a / (s + a)",
           "docs/reference/plane_button.md", chosen, kPositive},
          &a.filter);
  v.value({"peak_N", "what the tip pushes with at most", "sources/arm 1", published, kPositive}, &a.peak);
  v.value({"continuous_N", "and for hours", "sources/arm 1", published, kPositive}, &a.continuous);
  per_joint(v, {"peak_torque_Nm", "of each motor, as is believed", "sources/arm 3", published, kPositive},
            a.peak_torque);
  per_joint(v, {"continuous_torque_Nm", "of each motor, for hours", "sources/arm 3", published, kPositive},
            a.continuous_torque);
  describe(v, a.thermal);
  v.value({"speed_mm_s", "of the target on its way to where the finger will touch",
           "docs/reference/reaching.md", chosen, kPositive},
          &a.speed);
  v.value({"acceleration_m_s2", "of that", "docs/reference/reaching.md", chosen, kPositive}, &a.acceleration);
  v.value({"settle_ms", "in which the target follows a leap of the finger that is seen",
           "docs/reference/plane_button.md", chosen, kPositive},
          &a.settle);
  constexpr const char* kReaching = "docs/reference/reaching.md";
  v.value({"reach_acceleration_m_s2", "of the target on its way to where a reach is foreseen to touch",
           kReaching, chosen, kPositive},
          &a.reach_acceleration);
  v.value({"reach_settle_ms", "in which it follows a leap of that place", kReaching, chosen, kPositive},
          &a.reach_settle);
  v.value({"prop_lag_ms", "of a driven prop's surface behind what it is told", "docs/reference/objects.md",
           assumed, kNotNegative},
          &a.prop_lag);
  v.value({"stale_ms", "an older sample is lost", "sources/choices 5", assumed, {0.1, 1000.0}}, &a.stale);
  v.value({"least_dexterity",
           "nearer to a singular pose no object may be",
           "docs/reference/phantom.md",
           chosen,
           {0.0, 1.0}},
          &a.least_dexterity);
  constexpr const char* kPassivity = "docs/reference/stability.md";
  choice(v,
         {"passivity", "what is done about energy that the law gives out: nothing, or it is controlled",
          kPassivity, chosen},
         a.passivity);
  part(v, "loop", a.loop, [&](ArmLoop& loop) { describe(v, loop); });
  table(v, "machine", [&] { describe(v, a.machine); });
}

void describe(Visitor& v, sim::ArmTruth& a) {
  v.value({"timestep_us", "of MuJoCo, of a world with an arm", "sources/twin 1", chosen, {0.0, 5000.0, true}},
          &a.timestep);
  v.value({"integrator", "of MuJoCo, likewise", "sources/twin 1", chosen, kAny, defaulted, sim::kIntegrators},
          &a.integrator);
  v.value({"mass_scale",
           "of all its masses and inertias against the machine's below",
           "sources/arm 2",
           assumed,
           {0.01, 100.0}},
          &a.mass_scale);
  const auto each = [&](const Key& key, PerJoint& numbers) { per_joint(v, key, numbers); };
  each({"counts", "of each encoder, for a turn of its motor", "sources/arm 3", published, {1.0}}, a.counts);
  choice(v,
         {"friction_form", "dry: holds what is at rest; smooth: c tanh(10 qd), at rest nothing",
          "sources/arm 3", chosen},
         a.friction_form);
  each({"friction_Nm", "Coulomb's, at each joint; N of a slide", "sources/arm 3", published, kNotNegative},
       a.friction);
  v.value({"friction_time_ms",
           "in which dry friction sets in: slower motions it only damps",
           "docs/reference/phantom_twin.md",
           assumed,
           {0.1, 100.0}},
          &a.friction_time);
  each({"viscous_Nms", "at each joint, for each rad/s; N s/m of a slide", "sources/arm 3", published,
        kNotNegative},
       a.viscous);
  each({"peak_torque_Nm", "of each motor", "sources/arm 3", published, kPositive}, a.peak_torque);
  each({"continuous_torque_Nm", "of each motor, for hours", "sources/arm 3", published, kPositive},
       a.continuous_torque);
  describe(v, a.thermal);
  v.value({"velocity_window_ms", "over which the device differences its encoders",
           "docs/reference/phantom_twin.md", assumed, kPositive},
          &a.velocity_window);
  v.value(
      {"watchdog_ms", "without a command, then the motors are off", "sources/choices 16", chosen, kPositive},
      &a.watchdog);
  choice(v,
         {"facing", "what the prop faces: told, as the core believes; finger, as is true",
          "docs/reference/phantom_twin.md", assumed},
         a.facing);
  v.value({"gimbal_time_ms", "in which the prop turns to another surface", "docs/reference/phantom_twin.md",
           assumed, kPositive},
          &a.gimbal_time);
  v.value({"contact_time_ms", "of the stop between finger and prop", "sources/twin 3", derived, kPositive},
          &a.contact_time);
  v.value({"drum_time_ms", "of the motor that drives a prop's surface", "docs/reference/objects.md", assumed,
           kPositive},
          &a.drum_time);
  v.value({"belt_time_ms", "of the stop between finger and the belt of a drum", "docs/reference/objects.md",
           assumed, kPositive},
          &a.belt_time);
  v.value({"belt_impedance", "of that stop, of MuJoCo; 1: it does not give", "docs/reference/objects.md",
           assumed, Range{0.5, 0.9999}},
          &a.belt_impedance);
  v.value({"belt_friction_time_ms", "in which friction takes out a slip on that belt",
           "docs/reference/objects.md", assumed, kPositive},
          &a.belt_friction_time);
  v.value({"prop_friction", "of a finger on the prop", "sources/hand 1", assumed, kNotNegative},
          &a.prop_friction);
  v.value({"misplaced_mm", "of the base against where the rig says it is", "injected", chosen}, &a.misplaced);
  v.value({"turned_deg", "likewise, about W's axes", "injected", chosen, {-5.0, 5.0}}, &a.turned);
  table(v, "machine", [&] { describe(v, a.machine); });
}

void describe(Visitor& v, PropSpec& p) {
  choice(v, {"kind", "what the arm carries at its tip", "[VisHap 2]", chosen}, p.kind);
  v.value({"mass_kg", "of it", "[VisHap 2.3.2]", assumed, kNotNegative}, &p.mass);
  v.value({"size_mm", "along x and y of its front, and behind it", "[VisHap 2.2]", assumed, kPositive},
          &p.size);
}

namespace {

void describe_click(Visitor& v, InteractionSpec& i) {
  v.value({"trigger_mm", "depth d1 at which it triggers", "[VisHap Fig 4]", assumed, kPositive}, &i.trigger);
  v.value({"after_N_per_mm", "stiffness from there on", "[VisHap Fig 4]", assumed, kPositive, needed},
          &i.after);
  v.value({"bottom_mm", "depth d2 of the bottom", "[VisHap Fig 4]", assumed, kPositive}, &i.bottom);
  v.value({"floor_N_per_mm", "stiffness from there on", "[VisHap Fig 4]", assumed, kPositive, needed},
          &i.floor);
}

// Keys of a ball, a tile or a belt.
void describe_moving(Visitor& v, InteractionSpec& i) {
  if (i.kind == Interaction::hit || i.kind == Interaction::shift)
    v.value({"mass_kg", "of what moves", "docs/reference/objects.md", chosen, kPositive}, &i.mass);
  if (i.kind == Interaction::hit || i.kind == Interaction::shift) {
    v.value({"restitution",
             "speed at which finger and object part, over that at which they met",
             "docs/reference/objects.md",
             chosen,
             {0.05, 1.0}},
            &i.restitution);
    v.value({"travel_mm", "of a tile to its end; of a ball until it is put back", "docs/reference/objects.md",
             chosen, kPositive},
            &i.travel);
  }
  if (i.kind == Interaction::shift || i.kind == Interaction::spin)
    v.value({"way",
             "of length 1, along which it moves, in O; z is outward",
             "docs/reference/objects.md",
             chosen,
             {-1.0, 1.0}},
            &i.way);
  if (i.kind == Interaction::shift)
    v.value({"friction_N", "that stops it", "docs/reference/objects.md", chosen, kNotNegative}, &i.friction);
  if (i.kind == Interaction::spin)
    v.value({"speed_mm_s", "of its surface", "docs/reference/objects.md", chosen}, &i.speed);
}

}  // namespace

// Entries of the interaction database that only an arm renders.
void describe(Visitor& v, InteractionSpec& i) {
  choice(v, {"kind", "what happens when a finger meets the object", "[VisHap 2.2]", chosen}, i.kind);
  if (i.kind == Interaction::press) return;
  auto prop = static_cast<std::uint8_t>(i.prop + 1);
  v.value({"prop", "what the finger should meet; others are warned of", "[VisHap 2.2]", chosen},
          Choice{kAnyOrProp, &prop});
  i.prop = static_cast<std::int32_t>(prop) - 1;
  v.value({"gradual_mm", "depth over which one stiffness becomes the next; 0: at once", "[VisHap 3]", assumed,
           kNotNegative},
          &i.gradual);
  v.value({"gradual_ms", "and the time that takes at least; 0: none", "[VisHap 3]", assumed, kNotNegative},
          &i.gradual_time);
  if (i.kind == Interaction::click) describe_click(v, i);
  describe_moving(v, i);
}

}  // namespace enc::models
