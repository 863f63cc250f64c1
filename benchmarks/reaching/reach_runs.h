// The outcome of each reach of a finger, from the ground truth: whether and since when the prop was where the
// finger met the surface, and the force of the meeting [VisHap 2.2].
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/reaching/ideal.h"
#include "models/setup/scene_file.h"
#include "trial/measure/finger_measure.h"

namespace enc::bench::reaching {

inline constexpr double kThere = 2e-3;  // m: largest distance at which the prop counts as there

// A reach has met the surface when the finger first touches the prop, or passes through the surface without
// it.
struct ReachOutcome {
  std::int32_t aim = -1;       // object that the person reaches for
  std::int32_t chosen = -1;    // the core's choice when they meet
  std::int32_t felt = -1;      // the first object that the core renders while the finger touches the prop
  double felt_after = kUnset;  // s: since the finger met the surface
  double felt_depth = kUnset;  // m: depth of the finger below the surface then
  double prepared = kUnset;    // s of experiment: the last "prepare" before the touch
  double arrived = kUnset;     // s: since then the prop has stayed where they meet; unset: it is not there
  double met = kUnset;         // s
  double speed = kUnset;       // m/s, speed of the finger when they meet
  double miss = kUnset;        // m, along the surface: from the prop's middle to its ideal place
  double impact = 0.0;         // N, along the normal: largest force within 50 ms after
  double force_step = 0.0;     // N: largest change of the force on the finger in a tick
  double slide_error = 0.0;  // m: largest distance along the surface between prop and finger while it is held
  std::int32_t contacts = 0;  // contacts counted by the core
  std::int32_t prepares = 0;  // number of times that it began to prepare
  bool touched = false;       // any contact with the prop
  bool aborted = false;       // the finger turns back before the touch
  SeenReach seen;             // pictures of the reach that the core received until the touch

  [[nodiscard]] double lead() const { return met - prepared; }
  [[nodiscard]] double travel() const { return arrived - prepared; }  // unset: the prop did not get there
};

class ReachMeasure {
 public:
  void see(const trial::Glance& glance);
  [[nodiscard]] std::vector<ReachOutcome> reaches() const;
  [[nodiscard]] double far_speed() const { return far_.speed(); }

 private:
  void begin(const trial::Glance& glance);
  void take_picture(const trial::Glance& glance, double now);
  void meet(const trial::Glance& glance, double now);
  void watch_force(const trial::Glance& glance);
  void watch_contact(const trial::Glance& glance, double now);

  std::vector<ReachOutcome> over_;
  ReachOutcome now_;
  std::int32_t contacts_before_ = 0;
  Vec<'W'> force_ = Vec<'W'>::zero();  // N, on the finger, in the last tick
  bool begun_ = false;
  sim::Phase phase_ = sim::Phase::wait;
  trial::FarWatch far_;
  Time newest_{};   // picture
  trial::Way way_;  // path of the prop since it was prepared
};

using Settings = std::vector<std::string>;

// Tracking of the finger: by the paper's vision, or without delay and noise.
enum class FingerTracking : std::uint8_t { vision, live };
[[nodiscard]] Settings seen(FingerTracking how);

struct ReachRun {
  std::string scene = "wall";
  Settings set;
  std::uint64_t seed = 1;
  std::int64_t random = 0;  // number of random reaches that replace the scene's programme
};
struct ReachResult {
  std::vector<ReachOutcome> reaches;
  double far_speed = 0.0;                 // m/s
  double simulated = 0.0, seconds = 0.0;  // s; seconds: CPU time
};
// Runs all of them, on all cores.
[[nodiscard]] std::vector<ReachResult> run_all(const BenchContext& context,
                                               const std::vector<ReachRun>& runs);

// Replaces the programme of the scene's user by `count` random reaches.
void reach_at_random(models::Setup& setup, std::int64_t count);
// `count` random reaches.
[[nodiscard]] ReachRun random_reaches(const std::string& scene, std::int64_t count, std::uint64_t seed);
// Reaches for the wall: the finger comes with a constant speed until it touches, `count` times.
[[nodiscard]] ReachRun steady_reaches(double speed, double tilt_deg, int count, std::uint64_t seed);
// The finger presses the wall and slides along it, there and back.
[[nodiscard]] ReachRun slide(double speed, int count, std::uint64_t seed);
[[nodiscard]] ReachRun operator+(ReachRun run, const Settings& set);

[[nodiscard]] std::vector<ReachOutcome> joined(const std::vector<ReachResult>& ran);
// One value for each reach that met the surface.
[[nodiscard]] std::vector<double> misses(const std::vector<ReachOutcome>& reaches);  // m
// One value for each reach with a rendered object.
[[nodiscard]] std::vector<double> felts(const std::vector<ReachOutcome>& reaches, double ReachOutcome::*what);
[[nodiscard]] std::vector<double> impacts(const std::vector<ReachOutcome>& reaches);  // N
// Contacts of the core over the reaches that met the surface.
[[nodiscard]] double contacts_per_reach(const std::vector<ReachOutcome>& reaches);
[[nodiscard]] std::vector<double> force_steps(const std::vector<ReachOutcome>& reaches);  // N
// Share of the reaches with the prop there in time.
[[nodiscard]] double in_time(const std::vector<ReachOutcome>& reaches);

// The parts that only `--full` runs: the camera's rate and latency, the filter's noise, the physics' steps.
void add_sweeps(const BenchContext& context, BenchResult& result);

}  // namespace enc::bench::reaching
