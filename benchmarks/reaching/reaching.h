// Parts of the benchmark `reaching`: fingers, runs, and what is drawn of them.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/reaching/reach_measure.h"
#include "models/setup/scene_file.h"

namespace enc::bench::reaching {

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

// By `--full`: what the finger's rate and latency, the filter's noise and the physics' steps cost and give.
void add_reaching_full(const BenchContext& context, BenchResult& result);

// Cumulative distribution, %, of milliseconds.
[[nodiscard]] Series distribution(const std::string& name, std::vector<double> seconds);

// Puts a figure into the result.
using Adder = std::function<void(const std::string& id, double value, const char* unit, double low,
                                 double high, const std::string& note)>;

// How still the far tip is, over the friction of the joints.
void add_rest(const BenchContext& context, BenchResult& result, const Adder& add);

// Whether the prop was there, beside what an ideal predictor could do with the same pictures (ideal.h).
// Reaches at the wall, by the vision of the paper.
void add_ideal(const BenchContext& context, const std::vector<ReachOutcome>& wall, const Adder& add);

}  // namespace enc::bench::reaching
