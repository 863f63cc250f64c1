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
  v.value({"l1_mm", "length of the upper arm", kSet, derived, kPositive}, &p.l1);
  v.value(
      {"l2_mm", "length of the forearm up to the tip; the least certain length", kSet, derived, kPositive},
      &p.l2);
  v.value({"l3_mm", "length of the parallelogram's crank", kSet, derived, kPositive}, &p.l3);
  v.value({"l5_mm", "position along the upper arm of its centre of mass (with motor), from the axis", kSet,
           derived},
          &p.l5);
  v.value(
      {"l6_mm", "position along the crank of its centre of mass (with motor), from the axis", kSet, derived},
      &p.l6);
  v.value({"m_a_kg", "mass of the forearm", kSet, derived, kPositive}, &p.m_a);
  v.value({"m_c_kg", "mass of the parallelogram link", kSet, derived, kPositive}, &p.m_c);
  v.value({"m_be_kg", "mass of the upper arm with its motor", kSet, derived, kPositive}, &p.m_be);
  v.value({"m_df_kg", "mass of the crank with its motor", kSet, derived, kPositive}, &p.m_df);
  v.value({"I_a_kgm2", "inertia of the forearm about its centre of mass", kSet, derived, kPositive}, &p.I_a);
  v.value(
      {"I_c_kgm2", "inertia of the parallelogram link about its centre of mass", kSet, derived, kPositive},
      &p.I_c);
  v.value({"I_be_kgm2", "inertia of the upper arm with its motor about the origin of R", kSet, derived,
           kPositive},
          &p.I_be);
  v.value(
      {"I_df_kgm2", "inertia of the crank with its motor about the origin of R", kSet, derived, kPositive},
      &p.I_df);
  v.value({"I_base_kgm2", "inertia of the turret about its axis", kSet, derived, kPositive}, &p.I_base);
  v.value({"coupled_low_deg", "lower limit of q2 - q3", "sources/arm 3", published, {-180.0, 0.0}},
          &p.coupled_low);
  v.value({"coupled_high_deg", "upper limit of q2 - q3", "sources/arm 3", published, {0.0, 180.0}},
          &p.coupled_high);
}

void describe(Visitor& v, ChainLink& l) {
  v.value({"name", "name of the joint and of the link that it moves", "rig", chosen, kAny, needed, {}, true},
          &l.name);
  choice(v, {"kind", "hinge (rad) or slide (m)", "rig", chosen, kAny, needed}, l.kind);
  v.value({"axis",
           "unit vector along the joint's axis, in the frame of the previous link",
           "rig",
           chosen,
           {-1.0, 1.0},
           needed},
          &l.axis);
  v.value({"origin_mm", "position of the joint, from the previous joint", "rig", chosen}, &l.origin);
  v.value({"mass_kg", "mass of the link", "rig", chosen, kPositive}, &l.mass);
  v.value({"centre_mm", "centre of mass of the link, from its joint", "rig", chosen}, &l.centre);
  v.value(
      {"inertia_kgm2", "inertia about the link's centre of mass, along its axes", "rig", chosen, kPositive},
      &l.inertia);
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
  each({"joint_low", "lower limit of each joint, rad or m", "sources/arm 3", published}, &ArmDrive::low);
  each({"joint_high", "upper limit of each joint, rad or m", "sources/arm 3", published}, &ArmDrive::high);
  each({"ratio", "motor angle (rad) per joint angle (rad) or slide travel (m)", kSet, derived, kPositive},
       &ArmDrive::ratio);
  each({"rotor_inertia_kgm2", "rotor inertia of each motor", "sources/arm 3", published, kNotNegative},
       &ArmDrive::rotor_inertia);
}

void describe(Visitor& v, ArmMachine& m) {
  choice(v, {"kind", "a PHANToM, or a chain of hinges and slides", "rig", chosen}, m.kind);
  describe_drives(v, m);
  if (m.kind == ArmKind::phantom) return describe(v, m.phantom);
  v.value({"tip_mm", "position of H in the frame of the last link", "rig", chosen}, &m.tip);
  list(v, "link", m.links, [&](ChainLink& link) { describe(v, link); });
}

}  // namespace

void describe(Visitor& v, ThermalModel& t) {
  v.value({"winding_time_s", "thermal time constant of each motor's winding", "sources/arm 3", published,
           kPositive},
          &t.winding_time);
  v.value({"housing_time_s", "thermal time constant of each motor's housing", "sources/arm 3", published,
           kPositive},
          &t.housing_time);
  v.value({"winding_share",
           "share of a winding's temperature rise that lies between winding and housing",
           "sources/arm 3",
           published,
           {0.0, 1.0}},
          &t.winding_share);
}

void describe(Visitor& v, ArmLoop& l) {
  const auto each = [&](const Key& key, PerJoint& numbers) { per_joint(v, key, numbers); };
  each({"friction_Nm", "assumed Coulomb friction of each joint; N for a slide", "sources/arm 3", published,
        kNotNegative},
       l.friction);
  each({"viscous_Nms", "viscous friction of each joint; N s/m for a slide", "sources/arm 3", published,
        kNotNegative},
       l.viscous);
  each({"counts", "counts of each encoder per turn of its motor", "sources/arm 3", published, {1.0}},
       l.counts);
  v.value({"velocity_window_ms", "window over which the device differences its encoder readings",
           "docs/reference/phantom_twin.md", assumed, kPositive},
          &l.velocity_window);
  v.value({"delay_ms", "delay from a reading to the force computed from it, beyond the hold of one tick",
           "docs/reference/stability.md", assumed, kNotNegative},
          &l.delay);
}

void describe(Visitor& v, ArmRig& a) {
  v.value({"driver", "driver: sim, a folder of hw_drivers, or none", "rig", chosen, kAny, needed}, &a.driver);
  choice(
      v,
      {"gravity",
       "gravity compensation: none, by eq. 5 with the prop's mass in m_a, or exact with the prop at the tip",
       "[VisHap eq. 5]", chosen},
      a.gravity);
  v.value({"stiffness_N_per_m", "position gain K_p of [VisHap eq. 2]", "docs/reference/plane_button.md",
           chosen, kPositive},
          &a.stiffness);
  v.value({"damping_Ns_per_m", "velocity gain K_v of [VisHap eq. 2]", "docs/reference/plane_button.md",
           chosen, kPositive},
          &a.damping);
  v.value({"filter_hz", "corner a / 2 pi of the low-pass a / (s + a) on e and its rate [VisHap eq. 3]",
           "docs/reference/plane_button.md", chosen, kPositive},
          &a.filter);
  v.value({"peak_N", "largest force of the tip for a short time", "sources/arm 1", published, kPositive},
          &a.peak);
  v.value({"continuous_N", "largest continuous force of the tip", "sources/arm 1", published, kPositive},
          &a.continuous);
  per_joint(v, {"peak_torque_Nm", "assumed peak torque of each motor", "sources/arm 3", published, kPositive},
            a.peak_torque);
  per_joint(
      v, {"continuous_torque_Nm", "continuous torque of each motor", "sources/arm 3", published, kPositive},
      a.continuous_torque);
  describe(v, a.thermal);
  v.value({"speed_mm_s", "speed limit of the target on its path to the expected touch",
           "docs/reference/reaching.md", chosen, kPositive},
          &a.speed);
  v.value({"acceleration_m_s2", "acceleration limit of the target on its path to the expected touch",
           "docs/reference/reaching.md", chosen, kPositive},
          &a.acceleration);
  v.value({"settle_ms", "time in which the target follows a jump of the tracked finger",
           "docs/reference/plane_button.md", chosen, kPositive},
          &a.settle);
  constexpr const char* kReaching = "docs/reference/reaching.md";
  v.value({"reach_acceleration_m_s2",
           "acceleration limit of the target on its path to the predicted touch of a reach", kReaching,
           chosen, kPositive},
          &a.reach_acceleration);
  v.value({"reach_settle_ms", "time in which the target follows a jump of the predicted touch", kReaching,
           chosen, kPositive},
          &a.reach_settle);
  v.value({"prop_lag_ms", "lag of a driven prop's surface behind its command", "docs/reference/objects.md",
           assumed, kNotNegative},
          &a.prop_lag);
  v.value(
      {"stale_ms", "age beyond which a sample counts as lost", "sources/choices 5", assumed, {0.1, 1000.0}},
      &a.stale);
  v.value({"least_dexterity",
           "minimum dexterity at each object; 0 is a singular pose",
           "docs/reference/phantom.md",
           chosen,
           {0.0, 1.0}},
          &a.least_dexterity);
  constexpr const char* kPassivity = "docs/reference/stability.md";
  choice(v, {"passivity", "passivity controller of the control law: none or controlled", kPassivity, chosen},
         a.passivity);
  part(v, "loop", a.loop, [&](ArmLoop& loop) { describe(v, loop); });
  table(v, "machine", [&] { describe(v, a.machine); });
}

void describe(Visitor& v, sim::ArmTruth& a) {
  v.value({"timestep_us",
           "MuJoCo's time step in a world with an arm",
           "sources/twin 1",
           chosen,
           {0.0, 5000.0, true}},
          &a.timestep);
  v.value({"integrator", "MuJoCo's integrator in a world with an arm", "sources/twin 1", chosen, kAny,
           defaulted, sim::kIntegrators},
          &a.integrator);
  v.value({"mass_scale",
           "factor on all masses and inertias of the machine table below",
           "sources/arm 2",
           assumed,
           {0.01, 100.0}},
          &a.mass_scale);
  const auto each = [&](const Key& key, PerJoint& numbers) { per_joint(v, key, numbers); };
  each({"counts", "counts of each encoder per turn of its motor", "sources/arm 3", published, {1.0}},
       a.counts);
  choice(v,
         {"friction_form", "dry: holds a joint at rest; smooth: c tanh(10 qd), zero at rest", "sources/arm 3",
          chosen},
         a.friction_form);
  each({"friction_Nm", "Coulomb friction of each joint; N for a slide", "sources/arm 3", published,
        kNotNegative},
       a.friction);
  v.value({"friction_time_ms",
           "onset time of dry friction, which only damps slower motions",
           "docs/reference/phantom_twin.md",
           assumed,
           {0.1, 100.0}},
          &a.friction_time);
  each({"viscous_Nms", "viscous friction of each joint; N s/m for a slide", "sources/arm 3", published,
        kNotNegative},
       a.viscous);
  each({"peak_torque_Nm", "peak torque of each motor", "sources/arm 3", published, kPositive}, a.peak_torque);
  each({"continuous_torque_Nm", "continuous torque of each motor", "sources/arm 3", published, kPositive},
       a.continuous_torque);
  describe(v, a.thermal);
  v.value({"velocity_window_ms", "window over which the device differences its encoder readings",
           "docs/reference/phantom_twin.md", assumed, kPositive},
          &a.velocity_window);
  v.value({"watchdog_ms", "time without a command after which the motors switch off", "sources/choices 16",
           chosen, kPositive},
          &a.watchdog);
  choice(v,
         {"facing", "direction of the prop's front: told, as the core commands; finger, the true one",
          "docs/reference/phantom_twin.md", assumed},
         a.facing);
  v.value({"gimbal_time_ms", "time in which the prop turns to another surface",
           "docs/reference/phantom_twin.md", assumed, kPositive},
          &a.gimbal_time);
  v.value({"contact_time_ms", "MuJoCo's time constant of the contact between finger and prop",
           "sources/twin 3", derived, kPositive},
          &a.contact_time);
  v.value({"drum_time_ms", "time constant of the motor that drives a prop's surface",
           "docs/reference/objects.md", assumed, kPositive},
          &a.drum_time);
  v.value({"belt_time_ms", "MuJoCo's time constant of the contact between finger and belt",
           "docs/reference/objects.md", assumed, kPositive},
          &a.belt_time);
  v.value({"belt_impedance", "MuJoCo's impedance of the contact between finger and belt; 1: rigid",
           "docs/reference/objects.md", assumed, Range{0.5, 0.9999}},
          &a.belt_impedance);
  v.value({"belt_friction_time_ms", "time in which friction stops slip of the finger on the belt",
           "docs/reference/objects.md", assumed, kPositive},
          &a.belt_friction_time);
  v.value({"prop_friction", "friction coefficient of a finger on the prop", "sources/hand 1", assumed,
           kNotNegative},
          &a.prop_friction);
  v.value({"misplaced_mm", "true minus assumed position of the base", "injected", chosen}, &a.misplaced);
  v.value({"turned_deg",
           "true minus assumed rotation of the base, about W's axes",
           "injected",
           chosen,
           {-5.0, 5.0}},
          &a.turned);
  table(v, "machine", [&] { describe(v, a.machine); });
}

void describe(Visitor& v, PropSpec& p) {
  choice(v, {"kind", "prop that the arm carries at its tip", "[VisHap 2]", chosen}, p.kind);
  v.value({"mass_kg", "mass of the prop", "[VisHap 2.3.2]", assumed, kNotNegative}, &p.mass);
  v.value({"size_mm", "width and height of the prop's front, and depth behind it", "[VisHap 2.2]", assumed,
           kPositive},
          &p.size);
}

namespace {

void describe_click(Visitor& v, InteractionSpec& i) {
  v.value({"trigger_mm", "depth d1 at which the key triggers", "[VisHap Fig 4]", assumed, kPositive},
          &i.trigger);
  v.value({"after_N_per_mm", "stiffness beyond trigger_mm", "[VisHap Fig 4]", assumed, kPositive, needed},
          &i.after);
  v.value({"bottom_mm", "depth d2 of the key's bottom", "[VisHap Fig 4]", assumed, kPositive}, &i.bottom);
  v.value({"floor_N_per_mm", "stiffness beyond bottom_mm", "[VisHap Fig 4]", assumed, kPositive, needed},
          &i.floor);
}

// Keys of a ball, a tile or a belt.
void describe_moving(Visitor& v, InteractionSpec& i) {
  if (i.kind == Interaction::hit || i.kind == Interaction::shift)
    v.value({"mass_kg", "mass of the moving object", "docs/reference/objects.md", chosen, kPositive},
            &i.mass);
  if (i.kind == Interaction::hit || i.kind == Interaction::shift) {
    v.value({"restitution",
             "relative speed of finger and object after a hit, over that before",
             "docs/reference/objects.md",
             chosen,
             {0.05, 1.0}},
            &i.restitution);
    v.value({"travel_mm", "tile: travel to its end stop; ball: travel until it is put back",
             "docs/reference/objects.md", chosen, kPositive},
            &i.travel);
  }
  if (i.kind == Interaction::shift || i.kind == Interaction::spin)
    v.value({"way",
             "unit vector of the motion, in O; +z is outward",
             "docs/reference/objects.md",
             chosen,
             {-1.0, 1.0}},
            &i.way);
  if (i.kind == Interaction::shift)
    v.value({"friction_N", "friction force that stops the object", "docs/reference/objects.md", chosen,
             kNotNegative},
            &i.friction);
  if (i.kind == Interaction::spin)
    v.value({"speed_mm_s", "speed of the object's surface", "docs/reference/objects.md", chosen}, &i.speed);
}

}  // namespace

// Entries of the interaction database that only an arm renders.
void describe(Visitor& v, InteractionSpec& i) {
  choice(v, {"kind", "what happens when a finger meets the object", "[VisHap 2.2]", chosen}, i.kind);
  if (i.kind == Interaction::press) return;
  auto prop = static_cast<std::uint8_t>(i.prop + 1);
  v.value({"prop", "prop that the finger should meet; a scene with another one gets a warning",
           "[VisHap 2.2]", chosen},
          Choice{kAnyOrProp, &prop});
  i.prop = static_cast<std::int32_t>(prop) - 1;
  v.value({"gradual_mm", "depth over which one stiffness blends into the next; 0: at once", "[VisHap 3]",
           assumed, kNotNegative},
          &i.gradual);
  v.value({"gradual_ms", "minimum time for which one stiffness blends into the next; 0: no minimum",
           "[VisHap 3]", assumed, kNotNegative},
          &i.gradual_time);
  if (i.kind == Interaction::click) describe_click(v, i);
  describe_moving(v, i);
}

}  // namespace enc::models
