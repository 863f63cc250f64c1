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
  v.value({"timestep_us", "of MuJoCo, control form", "sources/twin 1", chosen, kTimestep}, &w.timestep);
  v.value(
      {"integrator", "of MuJoCo, control form", "sources/twin 1", chosen, kAny, defaulted, sim::kIntegrators},
      &w.integrator);
  v.value({"tip_friction", "of the tool on the haptic-tip", "sources/hand 1", assumed, kNotNegative},
          &w.tip_friction);
  v.value(
      {"contact_time_ms", "of the stop between tool and haptic-tip", "sources/twin 3", derived, kPositive},
      &w.contact_time);
}

void describe(Visitor& v, sim::SolverTruth& s) {
  choice(v, {"cone", "of friction", "sources/twin 3", chosen}, s.cone);
  v.value({"impratio", "friction's impedance over that of the stop", "sources/twin 3", chosen,
           Range{0.0, 1000.0, true}},
          &s.impratio);
  v.value({"noslip_iterations", "of the pass against creep; unset: 4, and none where there is an arm",
           "docs/reference/phantom_twin.md", chosen, Range{0.0, 1000.0, false, true}, optional},
          &s.noslip);
  v.value(
      {"iterations", "of the solver, at most", "sources/twin 3", chosen, Range{1.0, 10000.0, false, true}},
      &s.iterations);
  v.value({"tolerance", "where the solver ends", "sources/twin 3", chosen, Range{0.0, 1e-4}}, &s.tolerance);
}

void describe(Visitor& v, sim::HexapodTruth& h) {
  choice(v,
         {"form", "control: the pose is prescribed; structural: legs with stiffness carry it",
          "sources/twin 1", chosen},
         h.form);
  v.value({"servo_hz",
           "natural frequency of the position loop",
           "sources/hexapod 4",
           assumed,
           {0.0, 1000.0, true}},
          &h.servo);
  v.value({"damping", "ratio, of the position loop", "sources/hexapod 4", assumed, kPositive}, &h.damping);
  v.value({"delay_cycles", "from command to servo", "sources/hexapod 4", assumed, {0.0, 1000.0}},
          &h.delay_cycles);
  v.value({"speed_mm_s", "of the haptic-tip, at most", "[VHMR 2]", published, kPositive}, &h.speed);
  v.value({"acceleration_m_s2", "of the haptic-tip, at most", "sources/hexapod 4", derived, kPositive},
          &h.acceleration);
  v.value({"step_um", "smallest change of a command", "[VHMR 2]", published, kNotNegative}, &h.step);
  v.value({"repeatability_um", "rms along each axis, of where the same command ends", "[VHMR 2]", published,
           kNotNegative},
          &h.repeatability);
  v.value({"tip_radius_mm", "haptic-tip's sphere", "sources/hexapod 7", assumed, {0.0, 1000.0, true}},
          &h.tip_radius);
  v.value({"mass_kg", "behind the sensor: gripper, adapters, tip", "sources/hexapod 3", assumed, kPositive},
          &h.mass);
  v.value({"misplaced_mm", "of the machine against where the rig says it is, in W", "injected", chosen},
          &h.misplaced);
  v.value({"turned_deg",
           "of the machine about W's axes, against what the rig says",
           "injected",
           chosen,
           {-5.0, 5.0}},
          &h.turned);
  table(v, "geometry", [&] { describe(v, h.geometry); });
}

void describe(Visitor& v, sim::StructureTruth& s) {
  v.value({"timestep_us", "of MuJoCo, structural form", "sources/hexapod 6", derived, kTimestep},
          &s.timestep);
  v.value({"integrator", "of MuJoCo, structural form", "sources/hexapod 6", derived, kAny, defaulted,
           sim::kIntegrators},
          &s.integrator);
  v.value({"leg_stiffness_N_per_um", "of a leg along its axis", "sources/hexapod 6", assumed, kPositive},
          &s.leg_stiffness);
  v.value({"leg_damping", "ratio, of a leg with a sixth of the moved mass", "sources/hexapod 6", assumed,
           kNotNegative},
          &s.leg_damping);
  v.value({"platform_mass_kg", "moved, without what is behind the sensor", "sources/hexapod 3", assumed,
           kPositive},
          &s.platform_mass);
  v.value(
      {"payload_kg", "put on the platform after its zero was calibrated", "injected", chosen, kNotNegative},
      &s.payload);
}

void describe(Visitor& v, sim::GripperTruth& g) {
  const std::string_view source = "sources/force_sensor 4";
  v.value({"stroke_mm", "of each jaw", source, published, kPositive}, &g.stroke);
  v.value({"closing_time_s", "over the whole stroke; opening takes as long", source, published, kPositive},
          &g.closing_time);
  v.value({"force_min_N", "lowest grip force that can be set", source, published, kPositive}, &g.force_min);
  v.value({"force_max_N", "highest grip force", source, published, kPositive}, &g.force_max);
  v.value({"repeatability_mm", "rms, of where the jaws come to stand", source, published, kNotNegative},
          &g.repeatability);
  v.value({"width_mm", "of what is between the jaws; 0: nothing", "injected", chosen, kNotNegative},
          &g.width);
}

void describe(Visitor& v, sim::ForceTruth& f) {
  v.value({"quantum_N", "step of the reading", "[VHMR 2], sources/force_sensor 1", published, kNotNegative},
          &f.quantum);
  v.value({"torque_quantum_Nm", "step of the reading", "sources/force_sensor 1", published, kNotNegative},
          &f.torque_quantum);
  v.value({"range_N", "larger forces saturate", "[VHMR 2], sources/force_sensor 1", published, kPositive},
          &f.range);
  v.value({"torque_range_Nm", "larger torques saturate", "sources/force_sensor 1", published, kPositive},
          &f.torque_range);
  v.value({"noise_N", "rms of a sample", "sources/force_sensor 2", assumed, kNotNegative}, &f.noise);
  v.value({"oversampling",
           "readings, each with noise and steps, averaged into a sample",
           "docs/reference/model.md",
           chosen,
           {1.0, 64.0}},
          &f.oversampling);
  v.value({"torque_noise_Nm", "rms of a sample", "sources/force_sensor 2", assumed, kNotNegative},
          &f.torque_noise);
  v.value({"zero_N", "rms of the zero error at power-up", "sources/force_sensor 2", assumed, kNotNegative},
          &f.zero);
  v.value({"drift_N_per_sqrt_s", "random walk of the zero", "sources/force_sensor 2", assumed, kNotNegative},
          &f.drift);
  v.value({"drift_N_per_push", "rms: where the zero has got to, drawn anew for each push of [pusher]",
           "sources/force_sensor 2", assumed, kNotNegative},
          &f.push_drift);
  v.value({"drift_ahead_s", "before a push, in which its zero gets there; 0: at once as it begins",
           "docs/reference/model.md", chosen, kNotNegative},
          &f.drift_ahead);
  v.value(
      {"turned_deg", "of the sensor against where the rig says it is", "injected", chosen, {-180.0, 180.0}},
      &f.turned);
}

void describe(Visitor& v, sim::TrackerTruth& t) {
  v.value({"rate_hz", "exposures, free-running", "[VHMR 2]", published, kRates}, &t.rate);
  v.value({"latency_ms", "from exposure to the server", "sources/tracking 3", derived, kNotNegative},
          &t.latency);
  choice(v,
         {"packets", "polled: newest pose at the server's rate; event: each pose when ready", "[VHMR 2]",
          published},
         t.packets);
  v.value({"server_rate_hz", "how often the server sends polled packets", "[VHMR 2]", published, kRates},
          &t.server_rate);
  choice(v,
         {"clocks", "free: exposures and server ticks begin at any time; aligned: both begin with the loop",
          "sources/tracking 1", assumed},
         t.clocks);
  v.value({"process_ms", "fixed part of the server's own delay", "Table 1 (benchmark tracking)", derived,
           kNotNegative},
          &t.process);
  v.value({"udp_delay_ms", "mean of the exponential delay of process and network", "sources/tracking 3",
           derived, kNotNegative},
          &t.udp_delay);
  v.value({"bias_mm", "of registration, in W", "sources/tracking 2", derived}, &t.bias);
  v.value({"noise_mm", "rms of a frame, along the axes of W", "sources/tracking 2", derived, kNotNegative},
          &t.noise);
  v.value({"turn_noise_deg",
           "rms, each frame, about each axis of W; 0: what noise_mm has of it is all",
           "docs/notes/synchrony.md",
           assumed,
           {0.0, 10.0}},
          &t.turn_noise);
  v.value(
      {"marker_noise_mm",
       "rms, each frame and axis, of each marker; unset: the tool is known, not recognised by its markers",
       "sources/tracking 2",
       derived,
       {0.0, 10.0},
       optional},
      &t.marker_noise);
  v.value({"stamp_error_ms",
           "how much later than the exposure the stamps are",
           "injected",
           chosen,
           {-50.0, 50.0}},
          &t.stamp_error);
  v.value({"loss", "share of packets lost", "injected", chosen, {0.0, 1.0}}, &t.loss);
  v.value(
      {"blackout_at_s", "one drop-out starts here; unset: none", "injected", chosen, kNotNegative, optional},
      &t.blackout_at);
  v.value({"blackout_for_s", "and lasts this long", "injected", chosen, kNotNegative}, &t.blackout_for);
}

void describe(Visitor& v, sim::CameraTruth& c) {
  v.value({"baseline_mm",
           "from the left camera to the right one",
           "sources/tracking 7",
           published,
           {1.0, 1000.0}},
          &c.baseline);
  v.value({"focal_px", "of both cameras", "sources/tracking 7", derived, {10.0, 1e5}}, &c.focal);
  v.value({"width_px", "of an image", "sources/tracking 7", assumed, {16.0, 4096.0}}, &c.width);
  v.value({"height_px", "of an image", "sources/tracking 7", assumed, {16.0, 4096.0}}, &c.height);
  v.value({"rate_hz", "frames", "[VisHap 2.3.1]", published, kRates}, &c.rate);
  v.value({"matching_px", "rms of a frame, of the disparity", "sources/tracking 7", assumed, kNotNegative},
          &c.matching);
  v.value({"pointing_px", "rms of a frame, of the place in the left image", "docs/guide/registration.md",
           assumed, kNotNegative},
          &c.pointing);
  v.value({"standing_px", "rms of the part that stays while nothing moves, of place and disparity",
           "sources/tracking 7", assumed, kNotNegative},
          &c.standing);
  v.value({"disparity_step_px", "smallest change of a disparity; 0: none", "sources/tracking 7", published,
           kNotNegative},
          &c.disparity_step);
  choice(v, {"scenery", "what stands behind the hand", "docs/notes/segmentation.md", chosen}, c.scenery);
  choice(v, {"skin", "colour of the hand", "docs/notes/segmentation.md", chosen}, c.skin);
  v.value({"hand_from_s", "until then the hand is out of the picture", "[VisHap 3]", chosen, kNotNegative},
          &c.hand_from);
  v.value({"noise_of_255", "rms of a pixel", "sources/tracking 7", assumed, {0.0, 30.0}}, &c.noise);
  v.value({"exposure", "of the light that is there", "injected", chosen, {0.01, 100.0}}, &c.exposure);
  v.value({"stalls_at_s", "no frame from then on; unset: never", "injected", chosen, kNotNegative, optional},
          &c.stalls_at);
  v.value({"back_at_s", "frames again, after stalls_at_s; unset: never", "injected", chosen, kNotNegative,
           optional},
          &c.back_at);
  v.value({"swapped_at_s", "left and right exchanged from then on; unset: never", "injected", chosen,
           kNotNegative, optional},
          &c.swapped_at);
  v.value(
      {"moved_mm", "of the camera against [truth.frames.W_C], in W", "injected", chosen, {-1000.0, 1000.0}},
      &c.moved);
  v.value({"moved_at_s", "from then on", "injected", chosen, kNotNegative}, &c.moved_at);
  v.value({"distortion", "of both lenses: k1, k2, p1, p2, k3", "sources/tracking 7", assumed, {-10.0, 10.0}},
          std::span<double>(c.distortion));
  v.value({"ball_radius_mm", "of the ball at the tip while camera and arm are registered",
           "docs/guide/registration.md", assumed, kPositive},
          &c.ball_radius);
  v.value({"ball_rgb",
           "its colour: linear shares of the light",
           "docs/guide/registration.md",
           assumed,
           {0.0, 1.0}},
          std::span<double>(c.ball_rgb));
}

void describe(Visitor& v, sim::DisplayTruth& d) {
  v.value({"rate_hz", "frames", "sources/tracking 1", assumed, kRates}, &d.rate);
  v.value(
      {"latency_ms", "from a frame to its surface at the core", "sources/tracking 1", assumed, kNotNegative},
      &d.latency);
}

void describe(Visitor& v, sim::HandTruth& h) {
  v.value({"mass_kg", "arm endpoint and hand", "sources/hand 1", published, kPositive}, &h.mass);
  v.value({"damping_Ns_per_m", "of the arm", "sources/hand 1", published, kNotNegative}, &h.damping);
  v.value({"stiffness_N_per_mm", "of the arm", "sources/hand 1", published, kPositive}, &h.stiffness);
  v.value({"grip_stiffness_N_per_mm", "between hand and tool", "sources/hand 1", assumed, kPositive},
          &h.grip_stiffness);
  v.value({"grip_damping_Ns_per_m", "between hand and tool", "sources/hand 1", assumed, kNotNegative},
          &h.grip_damping);
  v.value({"integral_time_ms", "of the loop that the person closes on depth", "sources/hand 3", assumed,
           kPositive},
          &h.integral_time);
  v.value({"strength_N", "pushes with no more: what a finger or a light tool is pushed with",
           "docs/reference/reaching.md", assumed, kPositive},
          &h.strength);
  v.value({"tremor_mm", "rms", "sources/hand 2", assumed, kNotNegative}, &h.tremor);
  v.value({"tremor_rate_hz", "of the tremor", "sources/hand 2", published, kPositive}, &h.tremor_rate);
  v.value({"drift_mm", "rms, below 2 Hz", "sources/hand 2", assumed, kNotNegative}, &h.drift);
  v.value({"tremor_band_hz", "from tremor_rate_hz upwards, where the scene asks for a band", "sources/hand 2",
           published, kNotNegative},
          &h.tremor_band);
  v.value({"primary_share", "of the way, at which the first part of a reach aims",
           "Elliott, Hansen and Grierson 2010", assumed, kPositive},
          &h.primary_share);
  v.value({"primary_scatter", "of that share, standard deviation, cut at two", "Meyer et al. 1988", assumed,
           kNotNegative},
          &h.primary_scatter);
  v.value({"aside_scatter", "of its end to each side, as a share of the way, standard deviation",
           "Meyer et al. 1988", assumed, kNotNegative},
          &h.aside_scatter);
  v.value({"submovement_min_ms", "shortest correction", "Milner 1992", assumed, kPositive}, &h.shortest);
  v.value(
      {"aborted", "share of the reaches of a session that turn back", "sources/hand 4", assumed, {0.0, 1.0}},
      &h.aborted);
  v.value({"tilt_deg",
           "of the tool about its tip, to either side",
           "docs/notes/synchrony.md",
           assumed,
           {0.0, 45.0}},
          &h.tilt);
  v.value({"tilt_rate_hz", "of that tilting", "docs/notes/synchrony.md", assumed, kNotNegative},
          &h.tilt_rate);
}

void describe(Visitor& v, sim::ContactTruth& c) {
  v.value({"compliance_um_per_N", "of tool tip and haptic-tip where they touch: they come nearer",
           "docs/notes/synchrony.md", assumed, kNotNegative},
          &c.compliance);
  v.value({"flexure_um_per_N", "of the tool: its markers go on where its tip stops",
           "docs/notes/synchrony.md", assumed, kNotNegative},
          &c.flexure);
}

void describe(Visitor& v, sim::PusherTruth& p) {
  v.value({"stiffness_N_per_mm", "of what pushes, a hand or a stand; firm: 1", "[VHMR Fig 3]", derived,
           kPositive},
          &p.stiffness);
  v.value({"damping_Ns_per_m", "likewise", "sources/hand 5", assumed, kNotNegative}, &p.damping);
  v.value({"tremor_N", "rms, while it pushes", "sources/hand 5", assumed, kNotNegative}, &p.tremor);
  v.value({"tremor_rate_hz", "of the tremor", "sources/hand 2", published, kPositive}, &p.tremor_rate);
}

// Unset numbers come from the set.
void describe_make(Visitor& v, sim::BallTruth& b) {
  const std::string_view from = "sources/ball 4";
  v.value({"radius_mm", "outer; unset: as the scene says", "sources/ball 1", published, kPositive, optional},
          &b.radius);
  v.value({"wall_mm", "of the rubber core", "sources/ball 1", published, kPositive, optional}, &b.wall);
  v.value({"felt_mm", "thickness, uncompressed", "sources/ball 1", published, kPositive, optional}, &b.felt);
  v.value({"rubber_modulus_MPa", "at rest", from, derived, kPositive, optional}, &b.rubber_modulus);
  v.value({"pressure_kPa", "gauge", from, derived, kNotNegative, optional}, &b.pressure);
  v.value({"felt_modulus_MPa", "of the felt", from, derived, kPositive, optional}, &b.felt_modulus);
  v.value({"friction", "Coulomb share of the force, inside of the ball", from, assumed, {0.0, 1.0}, optional},
          &b.friction);
  v.value({"friction_travel_mm", "over which it reverses", from, assumed, kPositive, optional},
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
  choice(v, {"set", "which ball is in the test rig", "sources/ball 4", derived}, b.set);
  describe_make(v, b);
  v.value({"uneven",
           "stiffer by this share away from the poles of its z axis",
           "sources/ball 1, sources/ball 4",
           assumed,
           {-0.05, 0.05}},
          &b.uneven);
  v.value({"surface_friction", "felt on the probe", "sources/ball 4", assumed, kNotNegative},
          &b.surface_friction);
  v.value({"surface_travel_mm", "of the probe along the surface before it slides",
           "sources/ball 4 (indentation B)", assumed, kPositive},
          &b.surface_travel);
  v.value({"misplaced_mm", "of the ball against where the scene says it is, in W", "injected", chosen},
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
  table(v, "contact", [&] { describe(v, t.contact); });
  table(v, "hand", [&] { describe(v, t.hand); });
  table(v, "ball", [&] { describe(v, t.ball); });
  table(v, "pusher", [&] { describe(v, t.pusher); });
}

}  // namespace enc::models
