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
  constexpr double kThere = 2e-3;  // m
  constexpr double kSoon = 0.01;   // s: with it the ideal is best
  const models::Setup setup = load_scene(context, "wall");
  const bool reach = setup.rig.tracker.foresight == Foresight::reach;  // the law that is in force
  const double acceleration = reach ? setup.rig.arm.reach_acceleration : setup.rig.arm.acceleration;
  IdealSpec spec;
  spec.hand = setup.twin.hand;
  spec.noise = setup.twin.tracker.noise.maxCoeff();
  struct Judged {
    bool counts = false, reached = false, carried = false, followed = false;
    double within = 0.0;
  };
  const std::size_t most = context.quick ? std::min<std::size_t>(wall.size(), 4) : wall.size();
  std::vector<Judged> all(most);
  in_parallel(most, [&](std::size_t i) {
    const ReachOutcome& r = wall[i];
    if (std::isnan(r.met)) return;
    const Ideal at = ideal_place(spec, r.seen, r.met, r.met);
    const Eigen::Vector2d carried = ideal_carried(spec, r.seen, acceleration);
    const Eigen::Vector2d followed = ideal_followed(ideal_courses(spec, r.seen), r.met, acceleration, kSoon);
    const auto there = [&](const Eigen::Vector2d& place) { return (place - r.seen.where).norm() < kThere; };
    all[i] = {true, there(at.place), there(carried), there(followed), at.within};
  });
  double counts = 0.0, reached = 0.0, carried = 0.0, followed = 0.0, within = 0.0, ours = 0.0;
  for (std::size_t i = 0; i < most; ++i) {
    if (!all[i].counts) continue;
    ++counts;
    reached += all[i].reached ? 1.0 : 0.0;
    carried += all[i].carried ? 1.0 : 0.0;
    followed += all[i].followed ? 1.0 : 0.0;
    within += all[i].within;
    ours += wall[i].lead() >= wall[i].travel() ? 1.0 : 0.0;
  }
  add("ideal.place_percent.wall", 100.0 * reached / counts, "%", kUnset, kUnset,
      fmt::format("of {:.0f} of these reaches: within 2 mm of where they meet is the best place that an "
                  "ideal predictor "
                  "knows of by the same pictures, told when the finger touches, with a prop that is anywhere "
                  "at once: no "
                  "machine can do more",
                  counts));
  add("ideal.expected_percent.wall", 100.0 * within / counts, "%", kUnset, kUnset,
      "what that predictor expects of itself: the same, if it is ideal");
  add("ideal.carried_percent.wall", 100.0 * carried / counts, "%", kUnset, kUnset,
      fmt::format(
          "the same if an arm carries the prop from picture to picture with {:.0f} m/s^2, without any "
          "other delay",
          acceleration));
  add("ideal.followed_percent.wall", 100.0 * followed / counts, "%", kUnset, kUnset,
      "the same of a predictor that is not told when it touches: the arm goes after the mean of what is "
      "still to come; how soon was chosen on other reaches");
  add("vision.of_ideal_percent.wall", reached > 0.0 ? 100.0 * ours / reached : kUnset, "%", kUnset, kUnset,
      fmt::format("in time, of what that ideal is: {:.1f} % of the same reaches", 100.0 * ours / counts));
  // Of a thousand; of fewer it is drawn.
  add("vision.of_carried_percent.wall", carried > 0.0 ? 100.0 * ours / carried : kUnset, "%",
      context.full ? 90.0 : kUnset, kUnset, "the same, of that ideal with an arm");
}

}  // namespace enc::bench::reaching
