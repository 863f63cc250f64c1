// Keys of a rig: models/rigs/*.toml without [truth]. The numbers of the core, and its calibration.
#include "models/schema/schema_walk.h"

namespace enc::models {
namespace {

using enum Confidence;
using enum Presence;

// A device table must name the driver that fills the role.
void driver(Visitor& v, std::string& value) {
  v.value({"driver", "sim, a folder of hw_drivers, or none", "rig", chosen, kAny, needed}, &value);
}

void describe(Visitor& v, ManipulatorRig& m) {
  driver(v, m.driver);
  v.value({"speed_mm_s", "limit of commands", "[VHMR 2]", published, kPositive}, &m.speed);
  v.value({"acceleration_m_s2", "limit of commands", "sources/hexapod 4", derived, kPositive},
          &m.acceleration);
  v.value({"tip_radius_mm",
           "haptic-tip's sphere; H is its centre",
           "sources/hexapod 7",
           assumed,
           {0.0, 1000.0, true}},
          &m.tip_radius);
  v.value({"stem_radius_mm", "rod under the haptic-tip; in the way of a tool from below", "[VHMR 5]", assumed,
           kNotNegative},
          &m.stem_radius);
  v.value({"stem_length_mm", "of it, from H down to the gripper", "[VHMR 5]", assumed, kPositive},
          &m.stem_length);
  v.value({"gripper_radius_mm", "of gripper and sensor, round about H's z: the sensor's",
           "sources/force_sensor 1", derived, kNotNegative},
          &m.gripper_radius);
  v.value({"servo_hz",
           "believed natural frequency of the position loop",
           "sources/hexapod 4",
           assumed,
           {0.0, 1000.0, true}},
          &m.servo);
  v.value({"servo_damping", "believed ratio of it", "sources/hexapod 4", assumed, kPositive},
          &m.servo_damping);
  v.value(
      {"delay_ms", "believed dead time, from command to servo", "sources/hexapod 4", assumed, kNotNegative},
      &m.delay);
  v.value({"payload_N", "what it carries and is pressed with, together", "[VHMR 2]", published, kPositive},
          &m.payload);
  table(v, "geometry", [&] { describe(v, m.geometry); });
}

void describe(Visitor& v, ForceRig& f) {
  driver(v, f.driver);
  v.value({"filter_hz", "corner of the low-pass on the force", "sources/hexapod 4", derived, kPositive},
          &f.filter);
  v.value({"threshold_N", "taken off the pressing force", "sources/force_sensor 3", assumed, kNotNegative},
          &f.threshold);
  v.value({"contact_N", "a pressing force from here on is a contact", "sources/force_sensor 3", assumed,
           kPositive},
          &f.contact);
  v.value(
      {"mass_kg", "behind the sensor: gripper, adapters, tip", "sources/hexapod 3", assumed, kNotNegative},
      &f.mass);
  choice(v,
         {"tare", "zero once at the start, or also when free: slowly, or by windows of tare_time_s",
          "sources/force_sensor 3", chosen},
         f.tare);
  v.value({"tare_time_s", "of the first zero; 0: the sensor's own zero is believed", "sources/force_sensor 3",
           assumed, kNotNegative},
          &f.tare_time);
  v.value({"tare_clearance_mm", "gap from which on the tool is clear", "sources/force_sensor 3", assumed,
           kPositive},
          &f.tare_clearance);
  v.value({"stale_ms", "an older sample is lost", "sources/choices 5", assumed, {0.1, 1000.0}}, &f.stale);
}

void describe(Visitor& v, ReachBelief& r) {
  v.value({"share", "of the way, that a first movement makes", "Elliott, Hansen and Grierson 2010", assumed,
           kPositive},
          &r.share);
  v.value({"scatter", "of that share, standard deviation", "Meyer et al. 1988", assumed, kPositive},
          &r.scatter);
  v.value({"aside", "of the way, by which it ends beside its target, to each side, rms", "Meyer et al. 1988",
           assumed, kPositive},
          &r.aside);
  v.value({"slowest_mm_s", "peak of a first movement, at least", "docs/reference/reaching.md", assumed,
           kPositive},
          &r.slowest);
  v.value({"fastest_mm_s", "likewise, at most", "docs/reference/reaching.md", assumed, kPositive},
          &r.fastest);
  v.value({"shortest_ms", "the second movement, at least", "Milner 1992", assumed, kPositive}, &r.shortest);
  v.value({"touch_slowest_mm_s", "wanted where the surface is, at least", "docs/reference/reaching.md",
           assumed, kPositive},
          &r.touch_slowest);
  v.value({"touch_fastest_mm_s", "likewise, at most", "docs/reference/reaching.md", assumed, kPositive},
          &r.touch_fastest);
  v.value(
      {"vaguest_mm", "a picture whose place is known worse, rms of an axis, tells no correction from noise",
       "docs/reference/reaching.md", assumed, kPositive},
      &r.vaguest);
}

void describe(Visitor& v, TrackerRig& t) {
  driver(v, t.driver);
  choice(v, {"prediction", "how the tool's tip goes on from an old pose", "sources/tracking 4", chosen},
         t.prediction);
  v.value({"measurement_noise_mm",
           "rms of a pose along an axis, as the prediction believes of a tracker that does not tell it",
           "sources/tracking 2", derived, kNotNegative},
          &t.measurement_noise);
  v.value({"acceleration_noise_m_s2_per_sqrt_hz", "what drives the tip, to constant_velocity",
           "sources/tracking 4", derived, kPositive},
          &t.acceleration_noise);
  v.value({"surprise_noise_m_s2_per_sqrt_hz",
           "a pose four sigma off raises the noise to constant_velocity, up to this; 0: it does not",
           "docs/reference/reaching.md", chosen, kNotNegative},
          &t.surprise_noise);
  v.value({"jerk_noise_m_s3_per_sqrt_hz", "what drives the tip, to constant_acceleration",
           "sources/tracking 4", derived, kPositive},
          &t.jerk_noise);
  v.value({"longest_prediction_ms", "then the prediction slows down to rest", "sources/tracking 5", chosen,
           kNotNegative},
          &t.longest_prediction);
  v.value({"stamp_late_ms",
           "how much later than the exposure the stamps are believed to be",
           "the lab's calibration",
           assumed,
           {-50.0, 50.0}},
          &t.stamp_late);
  v.value({"usual_age_ms", "older poses are predicted and flagged", "sources/tracking 3, sources/tracking 5",
           derived, kPositive},
          &t.usual_age);
  v.value({"lost_age_ms", "older poses are lost: hold", "sources/tracking 5", chosen, kPositive},
          &t.lost_age);
  v.value({"farthest_m", "distance from C beyond which it is not a tool", "sources/tracking 1", assumed,
           kPositive},
          &t.farthest);
  v.value({"volume_mm", "sides along W of the box around its origin in which tools are followed",
           "[VHMR 5] gives the product, 75e-3 m3", assumed, kPositive},
          &t.volume);
  choice(v,
         {"foresight",
          "where an arm meets a finger that comes: carried_on, where the filter has it; reach, where a "
          "reaching hand touches",
          "docs/reference/reaching.md", chosen},
         t.foresight);
  table_if(v, "reach", t.foresight == TouchPrediction::reach, [&] { describe(v, t.reach); });
}

void describe(Visitor& v, DisplayRig& d) {
  driver(v, d.driver);
  choice(
      v,
      {"tip",
       "what dents the seen surface: the newest pose; that carried on; or, while it presses, the haptic-tip",
       "docs/notes/synchrony.md", chosen},
      d.tip);
  v.value({"lead_ms",
           "fused: how far ahead; half a frame and the way back",
           "docs/notes/synchrony.md",
           chosen,
           {0.0, 200.0}},
          &d.lead);
  v.value({"compliance_um_per_N", "fused: believed of tool and haptic-tip where they touch",
           "docs/notes/synchrony.md", assumed, kNotNegative},
          &d.compliance);
  v.value({"overdue_ms", "an older visual surface means hold", "[VHMR 3.5]", assumed, kPositive}, &d.overdue);
  v.value(
      {"margin_mm", "tolerated between seen and felt surface", "sources/tracking 2", assumed, kNotNegative},
      &d.margin);
  v.value({"margin_speed_mm_s", "how fast that margin grows with the surface's age", "[VHMR 2]", assumed,
           kNotNegative},
          &d.margin_speed);
}

void describe(Visitor& v, GripperRig& g) {
  driver(v, g.driver);
  v.value({"force_N", "clamps with this", "sources/force_sensor 4", chosen, kPositive}, &g.force);
}

void describe(Visitor& v, ContactRig& c) {
  v.value({"leave_gap_mm", "away: the gap is larger than this", "sources/tracking 2", assumed, kPositive},
          &c.leave_gap);
  v.value({"leave_time_ms", "and no force has been felt for this long", "sources/tracking 3", assumed,
           kNotNegative},
          &c.leave_time);
  v.value(
      {"restored_um", "distance from the buffered point that counts as back", "[VHMR 2]", assumed, kPositive},
      &c.restored);
  v.value({"hand_stiffness_N_per_mm", "of the person at the loop's limit frequency", "sources/hand 1",
           assumed, kPositive},
          &c.hand_stiffness);
  v.value({"hand_damping_Ns_per_m", "likewise", "sources/hand 1", assumed, kNotNegative}, &c.hand_damping);
  v.value({"softest_N_per_mm",
           "softer objects are refused; unset: what that hand makes unstable; 0: none is refused",
           "sources/hexapod 5", chosen, kNotNegative, optional},
          &c.softest);
}

void describe(Visitor& v, AdmittanceRig& a) {
  const std::string_view source = "docs/reference/model.md (damping)";
  choice(v, {"damping", "none, or as much as the energy that is seen to swing asks for", source, chosen},
         a.damping);
  choice(v,
         {"passivity", "what is done about energy that the law gives out: nothing, or it is controlled",
          "docs/reference/stability.md", chosen},
         a.passivity);
  v.value({"margin", "of the damping over what suffices", "sources/hexapod 5", derived, kPositive},
          &a.margin);
  v.value({"calm_time_s", "in which damping falls to 1/e when nothing swings", source, chosen, kPositive},
          &a.calm_time);
  v.value({"slowest_hz", "slower changes are the user's own", source, chosen, kPositive}, &a.slowest);
  v.value({"average_time_s", "over which energies are averaged", source, chosen, kPositive}, &a.average_time);
  v.value({"least_swing_um", "rms; less does not count as a swing", source, chosen, kPositive},
          &a.least_swing);
  v.value({"most_damping_Ns_per_m", "never more than this", source, chosen, kPositive}, &a.most_damping);
}

}  // namespace

void describe(Visitor& v, std::string_view name, PoseSpec& p) {
  table(v, name, [&] {
    v.value({"position_mm", "origin of the second frame in the first", "the lab's calibration", assumed},
            &p.position);
    v.value({"rotation_deg",
             "about the fixed x, then y, then z axis",
             "the lab's calibration",
             assumed,
             {-360.0, 360.0}},
            &p.rotation);
  });
}

void describe(Visitor& v, HexapodGeometry& g) {
  const std::string_view source = "sources/hexapod 2";
  v.value({"base_radius_mm", "of the base joints", source, derived, kPositive}, &g.base_radius);
  v.value({"platform_radius_mm", "of the platform joints", source, derived, kPositive}, &g.platform_radius);
  v.value({"base_half_angle_deg", "between the two joints of a pair, halved", source, derived, {0.0, 60.0}},
          &g.base_half_angle);
  v.value({"platform_half_angle_deg", "likewise on the platform", source, derived, {0.0, 60.0}},
          &g.platform_half_angle);
  v.value({"height_mm", "between the joint planes at zero", source, derived, kPositive}, &g.height);
  v.value({"tip_height_mm", "of H above the platform's joint plane", source, assumed, kPositive},
          &g.tip_height);
  v.value({"stroke_mm", "of a strut, to either side", source, derived, kPositive}, &g.stroke);
  v.value({"tilt_limit_deg", "to either side", "sources/hexapod 6", published, {0.0, 90.0, true}},
          &g.tilt_limit);
  v.value({"yaw_limit_deg", "to either side", "sources/hexapod 6", published, {0.0, 90.0, true}},
          &g.yaw_limit);
}

void describe(Visitor& v, RigSpec& r) {
  v.value({"format",
           "version of the rig format; this program reads version 1",
           "rig",
           chosen,
           {1.0, 1.0},
           needed,
           {},
           true},
          &r.format);
  v.value({"title", "which rig it is, in a line", "rig", chosen}, &r.title);
  table(v, "loop", [&] {
    // Below 200 Hz a cycle is longer than 5 ms, the longest allowed time step (sources/twin 2).
    v.value({"rate_hz", "of the haptic loop", "[VHMR 2]", published, {200.0, 1e4}}, &r.loop.rate);
    v.value({"late_cycles", "missed cycles that mean hold", "sources/twin 2", assumed, {1.0, 1e6}},
            &r.loop.late_cycles);
  });
  table(v, "calibration", [&] {
    v.value({"file",
             "of `encounter calibrate rig RIG`, beside the rig's: its date, frames.W_C, rotation of "
             "frames.H_F and "
             "force.mass_kg take the place of those here",
             "the lab's calibration", chosen},
            &r.calibration.file);
    v.value({"date",
             "day on which frames, geometry and force sensor were measured; a real machine is not armed "
             "without it",
             "the lab's calibration", chosen},
            &r.calibration.date);
    v.value(
        {"valid_days", "from that day on; then a real machine is not armed", "rig", chosen, {1.0, 36500.0}},
        &r.calibration.valid);
  });
  table(v, "frames", [&] {
    describe(v, "W_S", r.frames.W_S);
    describe(v, "W_C", r.frames.W_C);
    describe(v, "G_L", r.frames.G_L);
    describe(v, "H_F", r.frames.H_F);
  });
  table(v, "manipulator", [&] { describe(v, r.manipulator); });
  if (!table_if(v, "arm", r.arm.driver != "none", [&] { describe(v, r.arm); })) r.arm.driver = "none";
  table(v, "force", [&] { describe(v, r.force); });
  table(v, "tracker", [&] { describe(v, r.tracker); });
  if (!table_if(v, "camera", r.camera.driver != "none", [&] { describe(v, r.camera); }))
    r.camera.driver = "none";
  table_if(v, "vision", r.camera.driver != "none", [&] { describe(v, r.vision); });
  table(v, "display", [&] { describe(v, r.display); });
  table(v, "gripper", [&] { describe(v, r.gripper); });
  table(v, "contact", [&] { describe(v, r.contact); });
  table(v, "admittance", [&] { describe(v, r.admittance); });
  v.drivers("driver", r.drivers);
}

void describe_all(Visitor& v, SceneSpec& scene, RigSpec& rig, sim::TwinSpec& twin) {
  describe(v, scene);
  describe_behaviours(v, scene.behaviours, true);
  table(v, "rig", [&] { describe(v, rig); });
  table(v, "truth", [&] { describe(v, twin); });
}

}  // namespace enc::models
