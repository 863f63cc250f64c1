// Keys of a rig: models/rigs/*.toml without [truth]. The numbers of the core, and its calibration.
#include "models/schema/schema_walk.h"

namespace enc::models {
namespace {

using enum Confidence;
using enum Presence;

// A device table must name the driver that fills the role.
void driver(Visitor& v, std::string& value) {
  v.value({"driver", "driver: sim, a folder of hw_drivers, or none", "rig", chosen, kAny, needed}, &value);
}

void describe(Visitor& v, ManipulatorRig& m) {
  driver(v, m.driver);
  v.value({"speed_mm_s", "speed limit of commands", "[VHMR 2]", published, kPositive}, &m.speed);
  v.value({"acceleration_m_s2", "acceleration limit of commands", "sources/hexapod 4", derived, kPositive},
          &m.acceleration);
  v.value({"tip_radius_mm",
           "radius of the haptic-tip's sphere, whose centre is H",
           "sources/hexapod 7",
           assumed,
           {0.0, 1000.0, true}},
          &m.tip_radius);
  v.value({"stem_radius_mm", "radius of the rod under the haptic-tip, an obstacle for a tool from below",
           "[VHMR 5]", assumed, kNotNegative},
          &m.stem_radius);
  v.value({"stem_length_mm", "length of the rod under the haptic-tip, from H down to the gripper", "[VHMR 5]",
           assumed, kPositive},
          &m.stem_length);
  v.value({"gripper_radius_mm", "radius of gripper and sensor about H's z axis; that of the sensor",
           "sources/force_sensor 1", derived, kNotNegative},
          &m.gripper_radius);
  v.value({"servo_hz",
           "assumed natural frequency of the position loop",
           "sources/hexapod 4",
           assumed,
           {0.0, 1000.0, true}},
          &m.servo);
  v.value({"servo_damping", "assumed damping ratio of the position loop", "sources/hexapod 4", assumed,
           kPositive},
          &m.servo_damping);
  v.value({"delay_ms", "assumed dead time from command to servo", "sources/hexapod 4", assumed, kNotNegative},
          &m.delay);
  v.value({"payload_N", "largest sum of carried weight and pressing force", "[VHMR 2]", published, kPositive},
          &m.payload);
  table(v, "geometry", [&] { describe(v, m.geometry); });
}

void describe(Visitor& v, ForceRig& f) {
  driver(v, f.driver);
  v.value({"filter_hz", "corner frequency of the force low-pass", "sources/hexapod 4", derived, kPositive},
          &f.filter);
  v.value({"threshold_N", "force subtracted from the pressing force", "sources/force_sensor 3", assumed,
           kNotNegative},
          &f.threshold);
  v.value({"contact_N", "pressing force from which on a contact begins", "sources/force_sensor 3", assumed,
           kPositive},
          &f.contact);
  v.value({"mass_kg", "mass behind the sensor: gripper, adapters, tip", "sources/hexapod 3", assumed,
           kNotNegative},
          &f.mass);
  choice(v,
         {"tare",
          "when the force zero is estimated: once at the start; free: also slowly while the tool is clear; "
          "window: also over each tare_time_s of that",
          "sources/force_sensor 3", chosen},
         f.tare);
  v.value({"tare_time_s", "averaging time of the first zero; 0: use the sensor's own zero",
           "sources/force_sensor 3", assumed, kNotNegative},
          &f.tare_time);
  v.value({"tare_clearance_mm", "gap beyond which the tool counts as clear", "sources/force_sensor 3",
           assumed, kPositive},
          &f.tare_clearance);
  v.value(
      {"stale_ms", "age beyond which a sample counts as lost", "sources/choices 5", assumed, {0.1, 1000.0}},
      &f.stale);
}

void describe(Visitor& v, ReachBelief& r) {
  v.value({"share", "share of the distance that the first movement of a reach covers",
           "Elliott, Hansen and Grierson 2010", assumed, kPositive},
          &r.share);
  v.value({"scatter", "standard deviation of the share of the first movement", "Meyer et al. 1988", assumed,
           kPositive},
          &r.scatter);
  v.value({"aside", "lateral error of the first movement, rms per axis, as a share of the distance",
           "Meyer et al. 1988", assumed, kPositive},
          &r.aside);
  v.value({"slowest_mm_s", "lowest peak speed of a first movement", "docs/reference/reaching.md", assumed,
           kPositive},
          &r.slowest);
  v.value({"fastest_mm_s", "highest peak speed of a first movement", "docs/reference/reaching.md", assumed,
           kPositive},
          &r.fastest);
  v.value({"shortest_ms", "shortest duration of the second movement", "Milner 1992", assumed, kPositive},
          &r.shortest);
  v.value({"touch_slowest_mm_s", "lowest intended speed at the surface", "docs/reference/reaching.md",
           assumed, kPositive},
          &r.touch_slowest);
  v.value({"touch_fastest_mm_s", "highest intended speed at the surface", "docs/reference/reaching.md",
           assumed, kPositive},
          &r.touch_fastest);
  v.value({"vaguest_mm", "position noise (rms per axis) above which a frame cannot show the second movement",
           "docs/reference/reaching.md", assumed, kPositive},
          &r.vaguest);
}

void describe(Visitor& v, TrackerRig& t) {
  driver(v, t.driver);
  choice(v,
         {"prediction", "how the core extrapolates the tip from an old pose", "sources/tracking 4", chosen},
         t.prediction);
  v.value(
      {"measurement_noise_mm", "assumed position noise (rms per axis) of a tracker that does not report it",
       "sources/tracking 2", derived, kNotNegative},
      &t.measurement_noise);
  v.value({"acceleration_noise_m_s2_per_sqrt_hz",
           "process noise of constant_velocity: white acceleration of the tip", "sources/tracking 4", derived,
           kPositive},
          &t.acceleration_noise);
  v.value(
      {"surprise_noise_m_s2_per_sqrt_hz",
       "process noise of constant_velocity up to which a pose more than four sigma off raises it; 0: never",
       "docs/reference/reaching.md", chosen, kNotNegative},
      &t.surprise_noise);
  v.value({"jerk_noise_m_s3_per_sqrt_hz", "process noise of constant_acceleration: white jerk of the tip",
           "sources/tracking 4", derived, kPositive},
          &t.jerk_noise);
  v.value({"longest_prediction_ms", "time without a new pose after which the prediction slows down to rest",
           "sources/tracking 5", chosen, kNotNegative},
          &t.longest_prediction);
  v.value({"stamp_late_ms",
           "assumed delay of the time stamps after the exposure",
           "the lab's calibration",
           assumed,
           {-50.0, 50.0}},
          &t.stamp_late);
  v.value({"usual_age_ms", "age beyond which a pose raises the notice that it is predicted",
           "sources/tracking 3, sources/tracking 5", derived, kPositive},
          &t.usual_age);
  v.value(
      {"rate_hz",
       "rate of new poses: one after which two are missing raises the notice, too; unset: only an old one",
       "[VHMR 2]", chosen, kPositive, optional},
      &t.rate);
  v.value({"lost_age_ms", "age beyond which the tool counts as lost, which means hold", "sources/tracking 5",
           chosen, kPositive},
          &t.lost_age);
  v.value({"farthest_m", "distance from C beyond which a pose is rejected", "sources/tracking 1", assumed,
           kPositive},
          &t.farthest);
  v.value({"volume_mm", "sides, along W's axes, of the box around W's origin in which tools are followed",
           "[VHMR 5] gives the product, 75e-3 m3", assumed, kPositive},
          &t.volume);
  choice(v,
         {"foresight",
          "touch that an arm expects: carried_on, by the filter's extrapolation; reach, by a model of "
          "reaching movements",
          "docs/reference/reaching.md", chosen},
         t.foresight);
  table_if(v, "reach", t.foresight == TouchPrediction::reach, [&] { describe(v, t.reach); });
}

void describe(Visitor& v, DisplayRig& d) {
  driver(v, d.driver);
  choice(v,
         {"tip",
          "tip that displaces the seen surface: tracked (newest pose), predicted, or fused (haptic-tip while "
          "it presses)",
          "docs/notes/synchrony.md", chosen},
         d.tip);
  v.value({"lead_ms",
           "fused: lead time, which is half a frame plus the delay of the reported surface",
           "docs/notes/synchrony.md",
           chosen,
           {0.0, 200.0}},
          &d.lead);
  v.value({"compliance_um_per_N", "fused: assumed compliance of tool and haptic-tip where they touch",
           "docs/notes/synchrony.md", assumed, kNotNegative},
          &d.compliance);
  v.value({"overdue_ms", "age of the visual surface beyond which the core holds", "[VHMR 3.5]", assumed,
           kPositive},
          &d.overdue);
  v.value({"margin_mm", "tolerated distance between seen and felt surface", "sources/tracking 2", assumed,
           kNotNegative},
          &d.margin);
  v.value({"margin_speed_mm_s", "growth of margin_mm with the age of the visual surface", "[VHMR 2]", assumed,
           kNotNegative},
          &d.margin_speed);
}

void describe(Visitor& v, GripperRig& g) {
  driver(v, g.driver);
  v.value({"force_N", "clamping force", "sources/force_sensor 4", chosen, kPositive}, &g.force);
}

void describe(Visitor& v, ContactRig& c) {
  v.value({"leave_gap_mm", "gap above which a contact can end", "sources/tracking 2", assumed, kPositive},
          &c.leave_gap);
  v.value({"leave_time_ms", "time without force after which a contact can end", "sources/tracking 3", assumed,
           kNotNegative},
          &c.leave_time);
  v.value({"restored_um", "distance from the buffered first-touch point at which restore ends", "[VHMR 2]",
           assumed, kPositive},
          &c.restored);
  v.value({"hand_stiffness_N_per_mm",
           "stiffness of the person's hand near the frequency at which the loop becomes unstable",
           "sources/hand 1", assumed, kPositive},
          &c.hand_stiffness);
  v.value({"hand_damping_Ns_per_m", "damping of the person's hand at that frequency", "sources/hand 1",
           assumed, kNotNegative},
          &c.hand_damping);
  v.value({"softest_N_per_mm",
           "stiffness below which an object is refused; unset: the stability limit with the hand above; 0: "
           "refuse no object",
           "sources/hexapod 5", chosen, kNotNegative, optional},
          &c.softest);
}

void describe(Visitor& v, AdmittanceRig& a) {
  const std::string_view source = "docs/reference/model.md (damping)";
  choice(v, {"damping", "damper beside the object: none, or set by the observed oscillation", source, chosen},
         a.damping);
  choice(v, {"passivity", "passivity controller: none or controlled", "docs/reference/stability.md", chosen},
         a.passivity);
  v.value(
      {"margin", "factor of the damping over the sufficient one", "sources/hexapod 5", derived, kPositive},
      &a.margin);
  v.value({"calm_time_s", "time in which the damping falls to 1/e without oscillation", source, chosen,
           kPositive},
          &a.calm_time);
  v.value({"slowest_hz", "frequency below which motion counts as the user's own", source, chosen, kPositive},
          &a.slowest);
  v.value({"average_time_s", "averaging time of the oscillation's energies", source, chosen, kPositive},
          &a.average_time);
  v.value(
      {"least_swing_um", "smallest motion, rms, that counts as an oscillation", source, chosen, kPositive},
      &a.least_swing);
  v.value({"most_damping_Ns_per_m", "largest damping", source, chosen, kPositive}, &a.most_damping);
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
  v.value({"base_radius_mm", "radius of the circle of base joints", source, derived, kPositive},
          &g.base_radius);
  v.value({"platform_radius_mm", "radius of the circle of platform joints", source, derived, kPositive},
          &g.platform_radius);
  v.value({"base_half_angle_deg",
           "half the angle between the two base joints of a pair",
           source,
           derived,
           {0.0, 60.0}},
          &g.base_half_angle);
  v.value({"platform_half_angle_deg",
           "half the angle between the two platform joints of a pair",
           source,
           derived,
           {0.0, 60.0}},
          &g.platform_half_angle);
  v.value({"height_mm", "distance of the two joint planes at the machine's zero", source, derived, kPositive},
          &g.height);
  v.value({"tip_height_mm", "height of H above the platform's joint plane", source, assumed, kPositive},
          &g.tip_height);
  v.value({"stroke_mm", "stroke of a strut, to either side of zero", source, derived, kPositive}, &g.stroke);
  v.value({"tilt_limit_deg",
           "largest tilt of the platform, to either side",
           "sources/hexapod 6",
           published,
           {0.0, 90.0, true}},
          &g.tilt_limit);
  v.value({"yaw_limit_deg",
           "largest turn of the platform about z, to either side",
           "sources/hexapod 6",
           published,
           {0.0, 90.0, true}},
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
  v.value({"title", "name of the rig, one line", "rig", chosen}, &r.title);
  table(v, "loop", [&] {
    // Below 200 Hz a cycle is longer than 5 ms, the longest allowed time step (sources/twin 2).
    v.value({"rate_hz", "rate of the haptic loop", "[VHMR 2]", published, {200.0, 1e4}}, &r.loop.rate);
    v.value({"late_cycles",
             "number of missed cycles from which on the core holds",
             "sources/twin 2",
             assumed,
             {1.0, 1e6}},
            &r.loop.late_cycles);
  });
  table(v, "calibration", [&] {
    v.value({"file",
             "file of `encounter calibrate rig RIG`, beside the rig file: replaces date, frames.W_C, "
             "rotation of frames.H_F and force.mass_kg",
             "the lab's calibration", chosen},
            &r.calibration.file);
    v.value(
        {"date",
         "day on which frames, geometry and force sensor were measured; without it no real machine is armed",
         "the lab's calibration", chosen},
        &r.calibration.date);
    v.value({"valid_days",
             "days after the date for which a real machine can be armed",
             "rig",
             chosen,
             {1.0, 36500.0}},
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
  if (!table_if(v, "hand_tracker", r.hand_tracker.driver != "none",
                [&] { driver(v, r.hand_tracker.driver); }))
    r.hand_tracker.driver = "none";
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
