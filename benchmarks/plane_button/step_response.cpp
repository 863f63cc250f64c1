// In free space: what the tip does when its target goes 20 mm aside, and how stiff a wall may be that it
// holds alone, by two integrators.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/plane_button/plane_button.h"
#include "core/control/scene/arm_scene.h"

namespace enc::bench::plane_button {
namespace {

constexpr double kLeap = 20e-3;  // m
// At home the tip is lightest along x; 30 mm farther back it is 2.5 times as heavy along y.
struct Way {
  Vec3 from, along;
};
const Way kHome{{0, 0, 0}, Vec3::UnitX()}, kHeavy{{-0.03, -0.01, 0}, Vec3::UnitY()};
constexpr double kAbove = 40e-3;  // m: near enough to be followed
constexpr double kWhen = 1.0;     // s
constexpr double kEnd = 2.5;      // s

// A finger that stands above the wall and leaps aside.
class LeapingFinger : public PoseTracker {
 public:
  LeapingFinger(std::unique_ptr<PoseTracker> clockwork, const Pose<'C', 'W'>& X_CW, const Way& way)
      : clockwork_(std::move(clockwork)), X_CW_(X_CW), way_(way) {}
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override {
    const bool news = clockwork_->poll(now, newest);
    const bool after = seconds(newest.t.time_since_epoch()) >= kWhen;
    newest.value.X_CT =
        X_CW_ * Pose<'W', 'T'>(Quat::Identity(),
                               way_.from + (after ? kLeap : 0.0) * way_.along + kAbove * Vec3::UnitZ());
    return news;
  }

 private:
  std::unique_ptr<PoseTracker> clockwork_;  // of which the stamps are taken
  Pose<'C', 'W'> X_CW_;
  Way way_;
};

struct Leap {
  std::vector<double> t, x, target;  // s, m, m
  double speed = 0.0;                // rms at the end, m/s
  double ratio = kUnset;             // damping, with the mass at the tip
};

Leap leap(const BenchContext& context, const std::vector<std::string>& more, const Way& way = kHome) {
  std::vector<std::string> own = live(more);
  own.insert(own.end(), {"user.approach_mm_s=[1]", "user.approach_from_mm=40", "user.approach_tilt_deg=0",
                         "rig.arm.settle_ms=20"});
  models::Setup setup = load_scene(context, "wall", own);
  const Pose<'C', 'W'> X_CW = pose_of<'W', 'C'>(setup.rig.frames.W_C).inverse();
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = kEnd;
  options.fit_out = [&](Rig& rig) {
    rig.tracker = std::make_unique<LeapingFinger>(std::move(rig.tracker), X_CW, way);
  };
  Leap leap;
  double sum = 0.0, n = 0.0;
  options.watch = [&](const trial::Glance& glance) {
    const double now = seconds(glance.truth.t.time_since_epoch());
    leap.t.push_back(now - kWhen);
    leap.x.push_back((glance.truth.tip.e() - way.from).dot(way.along));
    leap.target.push_back((glance.out.wanted.e() - way.from).dot(way.along));
    if (now < kEnd - 0.3) return;
    sum += std::pow(glance.truth.tip_velocity.norm(), 2);
    n += 1.0;
  };
  trial::Trial trial(std::move(setup), std::move(options));
  const Impedance& law = *trial.scene().impedance();
  leap.ratio = damping_ratio(law.rig, law.home_mass);
  trial.run();
  leap.speed = std::sqrt(sum / n);
  return leap;
}

// The stiffest wall, lambda K_p, that the free prop holds without ringing; K_v goes along, as lambda has it.
double stiffest(const BenchContext& context, const std::string& integrator) {
  constexpr double kRinging = 0.02;  // m/s
  const Law law = law_of(context, "wall");
  const double damping = trial::prepare_setup(load_scene(context, "wall")).impedance()->rig.damping;
  double low = 1.0, high = 16.0;
  for (int i = 0; i < 7; ++i) {
    const double lambda = std::sqrt(low * high);
    const Leap run = leap(context, {fmt::format("rig.arm.stiffness_N_per_m={}", lambda * law.free),
                                    fmt::format("rig.arm.damping_Ns_per_m={}", lambda * damping),
                                    "truth.arm.friction_Nm=[0,0,0]", "truth.arm.viscous_Nms=[0,0,0]",
                                    "truth.arm.integrator=\"" + integrator + "\""});
    (run.speed > kRinging ? high : low) = lambda;
  }
  return std::sqrt(low * high) * law.free;
}

}  // namespace

void measure_step(const BenchContext& context, const Report& report) {
  const Leap step = leap(context, {});
  const auto overshoot = [](const Leap& run) {
    return std::max(0.0, 100.0 * (*std::max_element(run.x.begin(), run.x.end()) / kLeap - 1.0));
  };
  report.figure("step.overshoot", overshoot(step), "%", "the target leaps 20 mm aside in free space", 0.0,
                1.0);
  report.figure("step.overshoot_heavy", overshoot(leap(context, {}, kHeavy)), "%",
                "the same 30 mm behind home and along y, where the tip is half as heavy again", 0.0, 1.0);
  report.figure("step.damping_ratio", step.ratio, "",
                "K_v / (2 sqrt(K_p m)), with the greatest mass that is felt at the tip at home", 1.0);
  Plot plot{"plane_button_step", "Step response in free space", "time (s)", "tip along x (mm)"};
  Series wanted{"target"}, tip{"tip"};
  for (std::size_t i = 0; i < step.t.size(); ++i) {
    if (step.t[i] < -0.05 || step.t[i] > 0.5) continue;
    wanted.x.push_back(step.t[i]);
    wanted.y.push_back(1e3 * step.target[i]);
    tip.x.push_back(step.t[i]);
    tip.y.push_back(1e3 * step.x[i]);
  }
  plot.series = {wanted, tip};
  plot.caption =
      "The target keeps within speed and acceleration; the tip stops short by what dry friction holds.";
  report.result().plots.push_back(std::move(plot));
  if (context.quick) return;
  const std::array<std::string, 2> integrators{"rk4", "implicitfast"};
  std::array<double, 2> limit{};
  in_parallel(limit.size(), [&](std::size_t i) { limit[i] = stiffest(context, integrators[i]); });
  report.figure("limit.rk4", limit[0], "N/m",
                "lambda K_p at which the free prop begins to ring, no friction, RK4 at 1 ms");
  report.figure("limit.implicitfast", limit[1], "N/m",
                "the same physics by a first-order integrator [sources/twin 1]");
}

}  // namespace enc::bench::plane_button
