// Keys of the simulated devices, room and person: [truth.*] of models/rigs/sim.toml. The core never sees it.
#include <span>

#include "models/schema/schema_walk.h"

namespace enc::models {
namespace {

using enum Confidence;
using enum Presence;

constexpr Range kRates{0.1, 1e5};  // rates of repeated events: a clock can count them

// 5 ms: beyond it a servo and a contact diverge (sources/twin 2).
constexpr Range kTimestep{0.0, 5000.0, true};

void describe(Visitor& v, sim::WorldTruth& w) {
  v.value({"timestep_us", "MuJoCo's time step, control form", "sources/twin 1", chosen, kTimestep},
          &w.timestep);
  v.value({"integrator", "MuJoCo's integrator, control form", "sources/twin 1", chosen, kAny, defaulted,
           sim::kIntegrators},
          &w.integrator);
  v.value({"tip_friction", "friction coefficient of the tool on the haptic-tip", "sources/hand 1", assumed,
           kNotNegative},
          &w.tip_friction);
  v.value({"contact_time_ms", "MuJoCo's time constant of the contact between tool and haptic-tip",
           "sources/twin 3", derived, kPositive},
          &w.contact_time);
}

void describe(Visitor& v, sim::SolverTruth& s) {
  choice(v, {"cone", "shape of MuJoCo's friction cone", "sources/twin 3", chosen}, s.cone);
  v.value({"impratio", "MuJoCo's ratio of frictional to normal contact impedance", "sources/twin 3", chosen,
           Range{0.0, 1000.0, true}},
          &s.impratio);
  v.value({"noslip_iterations", "iterations of MuJoCo's no-slip solver; unset: 4, or 0 with an arm",
           "docs/reference/phantom_twin.md", chosen, Range{0.0, 1000.0, false, true}, optional},
          &s.noslip);
  v.value({"iterations", "largest number of solver iterations", "sources/twin 3", chosen,
           Range{1.0, 10000.0, false, true}},
          &s.iterations);
  v.value({"tolerance", "tolerance at which the solver ends", "sources/twin 3", chosen, Range{0.0, 1e-4}},
          &s.tolerance);
}

void describe(Visitor& v, sim::HexapodTruth& h) {
  choice(v,
         {"form", "control: prescribed pose; structural: platform on elastic legs", "sources/twin 1", chosen},
         h.form);
  v.value({"servo_hz",
           "natural frequency of the position loop",
           "sources/hexapod 4",
           assumed,
           {0.0, 1000.0, true}},
          &h.servo);
  v.value({"damping", "damping ratio of the position loop", "sources/hexapod 4", assumed, kPositive},
          &h.damping);
  v.value({"delay_cycles", "cycles from command to servo", "sources/hexapod 4", assumed, {0.0, 1000.0}},
          &h.delay_cycles);
  v.value({"speed_mm_s", "largest speed of the haptic-tip", "[VHMR 2]", published, kPositive}, &h.speed);
  v.value({"acceleration_m_s2", "largest acceleration of the haptic-tip", "sources/hexapod 4", derived,
           kPositive},
          &h.acceleration);
  v.value({"step_um", "smallest change of a command", "[VHMR 2]", published, kNotNegative}, &h.step);
  v.value({"repeatability_um", "rms per axis, scatter of a repeated command's position", "[VHMR 2]",
           published, kNotNegative},
          &h.repeatability);
  v.value({"tip_radius_mm",
           "radius of the haptic-tip's sphere",
           "sources/hexapod 7",
           assumed,
           {0.0, 1000.0, true}},
          &h.tip_radius);
  v.value(
      {"mass_kg", "mass behind the sensor: gripper, adapters, tip", "sources/hexapod 3", assumed, kPositive},
      &h.mass);
  v.value({"misplaced_mm", "true minus assumed position, in W", "injected", chosen}, &h.misplaced);
  v.value({"turned_deg", "true minus assumed rotation about W's axes", "injected", chosen, {-5.0, 5.0}},
          &h.turned);
  table(v, "geometry", [&] { describe(v, h.geometry); });
}

void describe(Visitor& v, sim::StructureTruth& s) {
  v.value({"timestep_us", "MuJoCo's time step, structural form", "sources/hexapod 6", derived, kTimestep},
          &s.timestep);
  v.value({"integrator", "MuJoCo's integrator, structural form", "sources/hexapod 6", derived, kAny,
           defaulted, sim::kIntegrators},
          &s.integrator);
  v.value({"leg_stiffness_N_per_um", "axial stiffness of a leg", "sources/hexapod 6", assumed, kPositive},
          &s.leg_stiffness);
  v.value({"leg_damping", "damping ratio of a leg that carries a sixth of the moved mass",
           "sources/hexapod 6", assumed, kNotNegative},
          &s.leg_damping);
  v.value({"platform_mass_kg", "moved mass without the mass behind the sensor", "sources/hexapod 3", assumed,
           kPositive},
          &s.platform_mass);
  v.value({"payload_kg", "mass put on the platform after the calibration of its zero", "injected", chosen,
           kNotNegative},
          &s.payload);
}

void describe(Visitor& v, sim::GripperTruth& g) {
  const std::string_view source = "sources/force_sensor 4";
  v.value({"stroke_mm", "stroke of each jaw", source, published, kPositive}, &g.stroke);
  v.value({"closing_time_s", "closing time over the whole stroke; opening takes as long", source, published,
           kPositive},
          &g.closing_time);
  v.value({"force_min_N", "lowest adjustable grip force", source, published, kPositive}, &g.force_min);
  v.value({"force_max_N", "highest grip force", source, published, kPositive}, &g.force_max);
  v.value({"repeatability_mm", "scatter, rms, of the jaws' final position", source, published, kNotNegative},
          &g.repeatability);
  v.value(
      {"width_mm", "width of the object between the jaws; 0: no object", "injected", chosen, kNotNegative},
      &g.width);
}

void describe(Visitor& v, sim::HandTrackerTruth& h) {
  const std::string_view source = "sources/hand 7";
  v.value({"rate_hz", "frames", "[VHMR 2]", published, kRates}, &h.rate);
  v.value({"latency_ms", "from exposure to arrival", source, published, kNotNegative}, &h.latency);
  v.value({"noise_mm", "rms, each frame, axis and joint", source, published, kNotNegative}, &h.noise);
  v.value({"turn_noise_deg", "rms, each frame, of the wrist", source, assumed, kNotNegative}, &h.turn_noise);
  v.value({"skin_mm", "thickness from a joint to the skin", source, assumed, kPositive}, &h.skin);
  v.value({"loss", "share of frames lost", "injected", chosen, {0.0, 1.0}}, &h.loss);
}

void describe(Visitor& v, sim::ForceTruth& f) {
  v.value({"quantum_N", "quantisation step of a force reading", "[VHMR 2], sources/force_sensor 1", published,
           kNotNegative},
          &f.quantum);
  v.value({"torque_quantum_Nm", "quantisation step of a torque reading", "sources/force_sensor 1", published,
           kNotNegative},
          &f.torque_quantum);
  v.value({"range_N", "force beyond which the sensor saturates", "[VHMR 2], sources/force_sensor 1",
           published, kPositive},
          &f.range);
  v.value({"torque_range_Nm", "torque beyond which the sensor saturates", "sources/force_sensor 1", published,
           kPositive},
          &f.torque_range);
  v.value({"noise_N", "force noise of a sample, rms", "sources/force_sensor 2", assumed, kNotNegative},
          &f.noise);
  v.value({"oversampling",
           "number of readings, each with noise and quantisation, averaged into a sample",
           "docs/reference/model.md",
           chosen,
           {1.0, 64.0}},
          &f.oversampling);
  v.value(
      {"torque_noise_Nm", "torque noise of a sample, rms", "sources/force_sensor 2", assumed, kNotNegative},
      &f.torque_noise);
  v.value({"zero_N", "zero error at power-up, rms", "sources/force_sensor 2", assumed, kNotNegative},
          &f.zero);
  v.value({"drift_N_per_sqrt_s", "random walk of the zero error", "sources/force_sensor 2", assumed,
           kNotNegative},
          &f.drift);
  v.value({"drift_N_per_push", "zero error, rms, drawn anew for each push of [pusher]",
           "sources/force_sensor 2", assumed, kNotNegative},
          &f.push_drift);
  v.value(
      {"drift_ahead_s",
       "time before a push in which the zero error moves to its new value; 0: at once when the push begins",
       "docs/reference/model.md", chosen, kNotNegative},
      &f.drift_ahead);
  v.value({"turned_deg", "true minus assumed rotation of the sensor", "injected", chosen, {-180.0, 180.0}},
          &f.turned);
}

void describe(Visitor& v, sim::TrackerTruth& t) {
  v.value({"rate_hz", "exposure rate, free-running", "[VHMR 2]", published, kRates}, &t.rate);
  v.value({"latency_ms", "delay from exposure to the server", "sources/tracking 3", derived, kNotNegative},
          &t.latency);
  choice(v,
         {"packets", "polled: newest pose at the server's rate; event: each pose when ready", "[VHMR 2]",
          published},
         t.packets);
  v.value({"server_rate_hz", "rate at which the server sends polled packets", "[VHMR 2]", published, kRates},
          &t.server_rate);
  choice(v,
         {"clocks", "free: exposures and server ticks begin at any time; aligned: both begin with the loop",
          "sources/tracking 1", assumed},
         t.clocks);
  v.value({"process_ms", "fixed part of the server's processing delay", "Table 1 (benchmark tracking)",
           derived, kNotNegative},
          &t.process);
  v.value({"udp_delay_ms", "mean of the exponentially distributed delay of process and network",
           "sources/tracking 3", derived, kNotNegative},
          &t.udp_delay);
  v.value({"bias_mm", "registration error, in W", "sources/tracking 2", derived}, &t.bias);
  v.value(
      {"noise_mm", "noise of a frame, rms along each axis of W", "sources/tracking 2", derived, kNotNegative},
      &t.noise);
  v.value({"turn_noise_deg",
           "rotation noise of a frame, rms about each axis of W, besides that of noise_mm",
           "docs/notes/synchrony.md",
           assumed,
           {0.0, 10.0}},
          &t.turn_noise);
  v.value({"marker_noise_mm",
           "noise of each marker, rms per frame and axis; unset: the tool's identity is known, not "
           "recognised from markers",
           "sources/tracking 2",
           derived,
           {0.0, 10.0},
           optional},
          &t.marker_noise);
  v.value(
      {"stamp_error_ms", "delay of the time stamps after the exposure", "injected", chosen, {-50.0, 50.0}},
      &t.stamp_error);
  v.value({"loss", "share of packets lost", "injected", chosen, {0.0, 1.0}}, &t.loss);
  v.value({"blackout_at_s", "start of one drop-out; unset: no drop-out", "injected", chosen, kNotNegative,
           optional},
          &t.blackout_at);
  v.value({"blackout_for_s", "duration of the drop-out", "injected", chosen, kNotNegative}, &t.blackout_for);
}

void describe(Visitor& v, sim::CameraTruth& c) {
  v.value({"baseline_mm",
           "distance from the left camera to the right one",
           "sources/tracking 7",
           published,
           {1.0, 1000.0}},
          &c.baseline);
  v.value({"focal_px", "focal length of both cameras", "sources/tracking 7", derived, {10.0, 1e5}}, &c.focal);
  v.value({"width_px", "width of an image", "sources/tracking 7", assumed, {16.0, 4096.0}}, &c.width);
  v.value({"height_px", "height of an image", "sources/tracking 7", assumed, {16.0, 4096.0}}, &c.height);
  v.value({"rate_hz", "frame rate", "[VisHap 2.3.1]", published, kRates}, &c.rate);
  v.value({"matching_px", "disparity noise of a frame, rms", "sources/tracking 7", assumed, kNotNegative},
          &c.matching);
  v.value({"pointing_px", "position noise of a frame in the left image, rms", "docs/guide/registration.md",
           assumed, kNotNegative},
          &c.pointing);
  v.value({"standing_px", "constant error of position and disparity while nothing moves, rms",
           "sources/tracking 7", assumed, kNotNegative},
          &c.standing);
  v.value({"disparity_step_px", "quantisation step of a disparity; 0: no quantisation", "sources/tracking 7",
           published, kNotNegative},
          &c.disparity_step);
  choice(v, {"scenery", "background behind the hand", "docs/notes/segmentation.md", chosen}, c.scenery);
  choice(v, {"skin", "colour of the hand", "docs/notes/segmentation.md", chosen}, c.skin);
  v.value({"hand_from_s", "time at which the hand enters the picture", "[VisHap 3]", chosen, kNotNegative},
          &c.hand_from);
  v.value(
      {"noise_of_255", "noise of a pixel, rms, of 255 levels", "sources/tracking 7", assumed, {0.0, 30.0}},
      &c.noise);
  v.value({"exposure", "factor on the available light", "injected", chosen, {0.01, 100.0}}, &c.exposure);
  v.value({"stalls_at_s", "time from which on no frame comes; unset: never", "injected", chosen, kNotNegative,
           optional},
          &c.stalls_at);
  v.value({"back_at_s", "time after stalls_at_s at which frames come again; unset: never", "injected", chosen,
           kNotNegative, optional},
          &c.back_at);
  v.value({"swapped_at_s", "time from which on left and right images are exchanged; unset: never", "injected",
           chosen, kNotNegative, optional},
          &c.swapped_at);
  v.value({"moved_mm",
           "displacement of the camera from [truth.frames.W_C], in W",
           "injected",
           chosen,
           {-1000.0, 1000.0}},
          &c.moved);
  v.value({"moved_at_s", "time from which on the camera is displaced", "injected", chosen, kNotNegative},
          &c.moved_at);
  v.value({"distortion",
           "distortion of both lenses: k1, k2, p1, p2, k3",
           "sources/tracking 7",
           assumed,
           {-10.0, 10.0}},
          std::span<double>(c.distortion));
  v.value({"ball_radius_mm", "radius of the ball at the tip during registration of camera and arm",
           "docs/guide/registration.md", assumed, kPositive},
          &c.ball_radius);
  v.value({"ball_rgb",
           "colour of the ball: linear red, green and blue",
           "docs/guide/registration.md",
           assumed,
           {0.0, 1.0}},
          std::span<double>(c.ball_rgb));
}

void describe(Visitor& v, sim::DisplayTruth& d) {
  v.value({"rate_hz", "frame rate", "sources/tracking 1", assumed, kRates}, &d.rate);
  v.value({"latency_ms", "delay from a frame to the arrival of its surface at the core", "sources/tracking 1",
           assumed, kNotNegative},
          &d.latency);
}

void describe(Visitor& v, sim::HandTruth& h) {
  v.value({"mass_kg", "effective mass of arm and hand", "sources/hand 1", published, kPositive}, &h.mass);
  v.value({"damping_Ns_per_m", "damping of the arm", "sources/hand 1", published, kNotNegative}, &h.damping);
  v.value({"stiffness_N_per_mm", "stiffness of the arm", "sources/hand 1", published, kPositive},
          &h.stiffness);
  v.value(
      {"grip_stiffness_N_per_mm", "stiffness between hand and tool", "sources/hand 1", assumed, kPositive},
      &h.grip_stiffness);
  v.value({"grip_damping_Ns_per_m", "damping between hand and tool", "sources/hand 1", assumed, kNotNegative},
          &h.grip_damping);
  v.value({"integral_time_ms", "integral time of the person's control of depth", "sources/hand 3", assumed,
           kPositive},
          &h.integral_time);
  v.value({"strength_N", "largest force of the arm on a finger or a light tool", "docs/reference/reaching.md",
           assumed, kPositive},
          &h.strength);
  v.value({"tremor_mm", "tremor, rms", "sources/hand 2", assumed, kNotNegative}, &h.tremor);
  v.value({"tremor_rate_hz", "frequency of the tremor", "sources/hand 2", published, kPositive},
          &h.tremor_rate);
  v.value({"drift_mm", "slow drift below 2 Hz, rms", "sources/hand 2", assumed, kNotNegative}, &h.drift);
  v.value({"tremor_band_hz", "width of the tremor's band above tremor_rate_hz, for tremor = \"band\"",
           "sources/hand 2", published, kNotNegative},
          &h.tremor_band);
  v.value({"primary_share", "share of the distance at which the first part of a reach aims",
           "Elliott, Hansen and Grierson 2010", assumed, kPositive},
          &h.primary_share);
  v.value({"primary_scatter", "standard deviation of that share, cut off at two", "Meyer et al. 1988",
           assumed, kNotNegative},
          &h.primary_scatter);
  v.value({"aside_scatter",
           "lateral error of the first part, standard deviation per axis, as a share of the distance",
           "Meyer et al. 1988", assumed, kNotNegative},
          &h.aside_scatter);
  v.value({"submovement_min_ms", "shortest duration of a correction", "Milner 1992", assumed, kPositive},
          &h.shortest);
  v.value({"aborted",
           "share of a session's reaches that turn back before the touch",
           "sources/hand 4",
           assumed,
           {0.0, 1.0}},
          &h.aborted);
  v.value({"tilt_deg",
           "tilt of the tool about its tip, to either side",
           "docs/notes/synchrony.md",
           assumed,
           {0.0, 45.0}},
          &h.tilt);
  v.value({"tilt_rate_hz", "frequency of that tilt", "docs/notes/synchrony.md", assumed, kNotNegative},
          &h.tilt_rate);
}

void describe(Visitor& v, sim::ContactTruth& c) {
  v.value({"compliance_um_per_N",
           "compliance of tool tip and haptic-tip where they touch: their centres come closer",
           "docs/notes/synchrony.md", assumed, kNotNegative},
          &c.compliance);
  v.value({"flexure_um_per_N", "flexibility of the tool: its markers move on while its tip is stopped",
           "docs/notes/synchrony.md", assumed, kNotNegative},
          &c.flexure);
}

void describe(Visitor& v, sim::PusherTruth& p) {
  v.value({"stiffness_N_per_mm", "stiffness of the pusher, a hand or a stand; a firm one has 1",
           "[VHMR Fig 3]", derived, kPositive},
          &p.stiffness);
  v.value({"damping_Ns_per_m", "damping of the pusher", "sources/hand 5", assumed, kNotNegative}, &p.damping);
  v.value({"tremor_N", "tremor of the pushing force, rms", "sources/hand 5", assumed, kNotNegative},
          &p.tremor);
  v.value({"tremor_rate_hz", "frequency of the tremor", "sources/hand 2", published, kPositive},
          &p.tremor_rate);
}

// Unset numbers come from the set.
void describe_make(Visitor& v, sim::BallTruth& b) {
  const std::string_view from = "sources/ball 4";
  v.value(
      {"radius_mm", "outer radius; unset: as in the scene", "sources/ball 1", published, kPositive, optional},
      &b.radius);
  v.value({"wall_mm", "wall thickness of the rubber core", "sources/ball 1", published, kPositive, optional},
          &b.wall);
  v.value({"felt_mm", "thickness of the uncompressed felt", "sources/ball 1", published, kPositive, optional},
          &b.felt);
  v.value({"rubber_modulus_MPa", "modulus of the rubber at rest", from, derived, kPositive, optional},
          &b.rubber_modulus);
  v.value({"pressure_kPa", "gauge pressure inside", from, derived, kNotNegative, optional}, &b.pressure);
  v.value({"felt_modulus_MPa", "modulus of the felt", from, derived, kPositive, optional}, &b.felt_modulus);
  v.value({"friction",
           "share of the force that is Coulomb friction inside the ball",
           from,
           assumed,
           {0.0, 1.0},
           optional},
          &b.friction);
  v.value(
      {"friction_travel_mm", "travel over which that friction reverses", from, assumed, kPositive, optional},
      &b.friction_travel);
  constexpr std::array<std::string_view, 3> kShare{"relaxing_fast", "relaxing_middle", "relaxing_slow"};
  constexpr std::array<std::string_view, 3> kTime{"relaxation_fast_s", "relaxation_middle_s",
                                                  "relaxation_slow_s"};
  for (std::size_t i = 0; i < 3; ++i) {
    v.value({kShare[i], "share of the force in a rubber branch that relaxes", from, assumed, kNotNegative,
             optional},
            &b.relaxing[i]);
    v.value({kTime[i], "time constant of that branch", from, assumed, kPositive, optional}, &b.relaxation[i]);
  }
}

void describe(Visitor& v, sim::BallTruth& b) {
  choice(v, {"set", "kind of ball in the test rig", "sources/ball 4", derived}, b.set);
  describe_make(v, b);
  v.value({"uneven",
           "extra stiffness away from the poles of the ball's z axis, as a share",
           "sources/ball 1, sources/ball 4",
           assumed,
           {-0.05, 0.05}},
          &b.uneven);
  v.value({"surface_friction", "friction coefficient of felt on the probe", "sources/ball 4", assumed,
           kNotNegative},
          &b.surface_friction);
  v.value({"surface_travel_mm", "travel of the probe along the surface before it slides",
           "sources/ball 4 (indentation B)", assumed, kPositive},
          &b.surface_travel);
  v.value({"misplaced_mm", "true position of the ball minus that in the scene, in W", "injected", chosen},
          &b.misplaced);
}

}  // namespace

void describe(Visitor& v, sim::TwinSpec& t) {
  table(v, "world", [&] { describe(v, t.world); });
  table(v, "solver", [&] { describe(v, t.solver); });
  table(v, "frames", [&] {
    describe(v, "W_C", t.frames.W_C);
    describe(v, "H_F", t.frames.H_F);
  });
  table(v, "hexapod", [&] { describe(v, t.hexapod); });
  table(v, "structure", [&] { describe(v, t.structure); });
  t.arm.there = table_if(v, "arm", t.arm.there, [&] { describe(v, t.arm); });
  table(v, "gripper", [&] { describe(v, t.gripper); });
  table(v, "force", [&] { describe(v, t.force); });
  table(v, "tracker", [&] { describe(v, t.tracker); });
  table(v, "camera", [&] { describe(v, t.camera); });
  table(v, "display", [&] { describe(v, t.display); });
  t.hand_tracker.there =
      table_if(v, "hand_tracker", t.hand_tracker.there, [&] { describe(v, t.hand_tracker); });
  table(v, "contact", [&] { describe(v, t.contact); });
  table(v, "hand", [&] { describe(v, t.hand); });
  table(v, "ball", [&] { describe(v, t.ball); });
  table(v, "pusher", [&] { describe(v, t.pusher); });
}

}  // namespace enc::models
