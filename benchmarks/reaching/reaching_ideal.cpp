// In time, beside what an ideal predictor could do.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/reaching/ideal.h"
#include "benchmarks/reaching/reaching.h"

namespace enc::bench::reaching {

// What an ideal predictor could do with the very pictures of these reaches, and with this arm.
void add_ideal(const BenchContext& context, const std::vector<ReachOutcome>& wall, const Adder& add) {
  const models::Setup setup = load_scene(context, "wall");
  constexpr double kThere = 2e-3;  // m
  IdealSpec spec;
  spec.hand = setup.twin.hand;
  spec.noise = setup.twin.tracker.noise.maxCoeff();
  spec.speed = setup.rig.arm.speed;
  spec.acceleration = setup.rig.arm.acceleration;
  struct Judged {
    bool counts = false, reached = false, there = false;
    double within = 0.0;
  };
  std::vector<Judged> all(wall.size());
  const std::size_t most =
      context.full ? wall.size() : std::min<std::size_t>(wall.size(), context.quick ? 4 : 60);
  in_parallel(most, [&](std::size_t i) {
    const ReachOutcome& r = wall[i];
    if (std::isnan(r.met)) return;
    const Ideal at = ideal_place(spec, r.seen, r.met);
    all[i] = {true, (at.place - r.seen.where).norm() < kThere, ideal_miss(spec, r.seen) < kThere, at.within};
  });
  double counts = 0, reached = 0, there = 0, within = 0, ours = 0;
  for (std::size_t i = 0; i < most; ++i) {
    if (!all[i].counts) continue;
    ++counts;
    reached += all[i].reached ? 1 : 0;
    there += all[i].there ? 1 : 0;
    within += all[i].within;
    ours += wall[i].lead() >= wall[i].travel() ? 1 : 0;
  }
  const auto percent_of = [&](double n) { return 100.0 * n / counts; };
  add("ideal.place_percent.wall", percent_of(reached), "%", kUnset, kUnset,
      fmt::format(
          "of {:.0f} of these reaches: an ideal predictor of the same pictures, which knows the simulated "
          "person's numbers, with an arm that is anywhere at once",
          counts));
  add("ideal.expected_percent.wall", percent_of(within), "%", kUnset, kUnset,
      "what that predictor expects of itself: the same, if it is ideal");
  add("ideal.lead_percent.wall", percent_of(there), "%", kUnset, kUnset,
      "the same with this arm's speed and acceleration: what physics allows");
  add("vision.of_ideal_percent.wall", 100.0 * ours / there, "%", context.quick ? kUnset : 90.0, kUnset,
      fmt::format("in time, of what that ideal is in time in: {:.1f} % of the same reaches",
                  percent_of(ours)));
}

}  // namespace enc::bench::reaching
