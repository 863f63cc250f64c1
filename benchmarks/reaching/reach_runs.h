// What became of each reach of a finger, judged by the truth: was the prop where the finger met the surface,
// since when, and how hard was the meeting [VisHap 2.2].
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

inline constexpr double kThere = 2e-3;  // m: within this the prop is where it is met

// A reach has met the surface when the finger first touches the prop, or passes through the surface without
// it.
struct ReachOutcome {
  std::int32_t aim = -1;       // object that the person reaches for
  std::int32_t chosen = -1;    // by the core, when they meet
  std::int32_t felt = -1;      // that the core renders when it first does while the finger touches the prop
  double felt_after = kUnset;  // s: since they met
  double felt_depth = kUnset;  // m: how far the finger was through the surface then
  double prepared = kUnset;    // s of experiment: the last "prepare" before
  double arrived = kUnset;     // s: since then the prop has been where they meet; unset: it is not
  double met = kUnset;         // s
  double speed = kUnset;       // m/s, of the finger, when they meet
  double miss = kUnset;        // m, along the surface: prop's middle to where it should be
  double impact = 0.0;         // N, along the normal: most within 50 ms after
  double slide_error = 0.0;    // m: most along the surface between prop and finger while it is held
  std::int32_t contacts = 0;   // that the core counted
  std::int32_t prepares = 0;   // how often it began to prepare
  bool touched = false;        // the prop, at all
  bool aborted = false;        // it turns back before
  SeenReach seen;              // what was told of it until they met

  [[nodiscard]] double lead() const { return met - prepared; }
  [[nodiscard]] double travel() const { return arrived - prepared; }  // unset: it did not get there
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
  void watch_contact(const trial::Glance& glance, double now);

  std::vector<ReachOutcome> over_;
  ReachOutcome now_;
  std::int32_t contacts_before_ = 0;
  bool begun_ = false;
  sim::Phase phase_ = sim::Phase::wait;
  trial::FarWatch far_;
  Time newest_{};   // picture
  trial::Way way_;  // of the prop since it was prepared
};

using Settings = std::vector<std::string>;

// How the finger is seen: as by the vision of the paper, or at once and without noise.
enum class Seen : std::uint8_t { vision, live };
[[nodiscard]] Settings seen(Seen how);

struct ReachRun {
  std::string scene = "wall";
  Settings set;
  std::uint64_t seed = 1;
  std::int64_t random = 0;  // so many random reaches instead of what the scene's user does
};
struct ReachRan {
  std::vector<ReachOutcome> reaches;
  double far_speed = 0.0;                 // m/s
  double simulated = 0.0, seconds = 0.0;  // s; seconds: of CPU
};
// All of them, on all cores.
[[nodiscard]] std::vector<ReachRan> run_all(const BenchContext& context, const std::vector<ReachRun>& runs);

// In place of what the scene's user does, so many random reaches.
void reach_at_random(models::Setup& setup, std::int64_t count);
// `count` random reaches.
[[nodiscard]] ReachRun random_reaches(const std::string& scene, std::int64_t count, std::uint64_t seed);
// At the wall: comes with an even speed until it touches, so and so often.
[[nodiscard]] ReachRun steady_reaches(double speed, double tilt_deg, int count, std::uint64_t seed);
// Presses the wall and slides along it, there and back.
[[nodiscard]] ReachRun slide(double speed, int count, std::uint64_t seed);
[[nodiscard]] ReachRun operator+(ReachRun run, const Settings& set);

[[nodiscard]] std::vector<ReachOutcome> joined(const std::vector<ReachRan>& ran);
// Of each: of the reaches that met the surface.
[[nodiscard]] std::vector<double> misses(const std::vector<ReachOutcome>& reaches);  // m
// Of those that were felt.
[[nodiscard]] std::vector<double> felts(const std::vector<ReachOutcome>& reaches, double ReachOutcome::*what);
[[nodiscard]] std::vector<double> impacts(const std::vector<ReachOutcome>& reaches);  // N
// Share of the reaches for which the prop was there in time.
[[nodiscard]] double in_time(const std::vector<ReachOutcome>& reaches);

}  // namespace enc::bench::reaching
