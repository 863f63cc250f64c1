#include "benchmarks/stiffness/push_study.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/scenes.h"
#include "core/control/stages/step_context.h"

namespace enc::bench::stiffness {
namespace {

// Shares of the hold, at its end: the part that is averaged (a raised cosine weighs 2 s like 1 s), and the
// part in which the tip must be at rest.
constexpr double kSteady = 1.0 / 3.0, kWatched = 0.5;
constexpr double kGravity = 9.80665;

std::span<const double> last(const std::vector<double>& signal, double share) {
  return std::span(signal).last(static_cast<std::size_t>(share * static_cast<double>(signal.size())));
}

// Signals of the hold. Displacements start where the tip rests unloaded at the surface, m; forces press, N.
// Signals that need the ground truth are empty without it.
struct Hold {
  std::vector<double> force, zero_error, displacement, true_displacement;
};

class Observer {
 public:
  // `world`: the true places of all devices; null: only the core's own data are available.
  Observer(const Scene& scene, const sim::World* world, const models::Setup& setup)
      : scene_(scene), world_(world), setup_(setup), at_(pushed_point(setup.scene, scene).at) {}

  [[nodiscard]] double true_displacement() const {
    // An error of the machine's place shifts its place of rest equally.
    const Pose<'W', 'R'>& X_WR = world_->X_WR();
    const Vec3 rest = X_WR.q() * (scene_.X_WR.inverse() * rest_point()).e() + X_WR.p();
    return at_.normal.e().dot(rest - world_->truth().tip.e());
  }
  [[nodiscard]] bool held(Time now) const {
    if (world_ == nullptr)
      return part_at(*setup_.scene.pusher, seconds(now.time_since_epoch())) == PushPart::hold;
    return world_->truth().phase == sim::Phase::hold && world_->truth().press == 0;
  }
  void see(const Inputs& in, const Outputs& out, const State& state, Hold& hold) const {
    const Pose<'W', 'H'> X_WH = scene_.X_WR * in.tip.value.X_RH;
    hold.force.push_back(-dot(out.force_unfiltered, at_.normal));
    hold.displacement.push_back(dot(rest_point() - X_WH.origin(), at_.normal));
    if (world_ == nullptr) return;
    hold.zero_error.push_back(-dot(zero_error(X_WH, state), at_.normal));
    hold.true_displacement.push_back(true_displacement());
  }

 private:
  [[nodiscard]] Point<'W'> rest_point() const {
    return at_.point - (scene_.tip_radius + stages::kSkin) * at_.normal;
  }
  // Error of the force that the core computes: the sensor's unloaded reading and weight unknown to the core,
  // less the core's zero.
  [[nodiscard]] Vec<'W'> zero_error(const Pose<'W', 'H'>& X_WH, const State& state) const {
    const Pose<'W', 'F'> X_WF = X_WH * scene_.X_HF;
    const double unknown = setup_.twin.hexapod.mass - scene_.force.mass;
    return X_WF * (world_->force->zero() - recall<CommandState>(state).force_zero) +
           Vec<'W'>(0, 0, -unknown * kGravity);
  }

  const Scene& scene_;
  const sim::World* world_;
  const models::Setup& setup_;
  PressPoint at_;
};

double deviation(std::span<const double> signal, double mean) {
  double sum = 0.0;
  for (const double x : signal) sum += (x - mean) * (x - mean);
  return std::sqrt(sum / static_cast<double>(signal.size()));
}

Push judged(const Hold& hold, double stiffness, double dt) {
  Push push;
  push.stiffness = stiffness;
  const auto steady = [&](const std::vector<double>& signal) { return last(signal, kSteady); };
  if (hold.force.size() < 100) return push;  // a hold that is too short has no result
  const double x = steady_mean(steady(hold.displacement));
  push.force = steady_mean(steady(hold.force));
  push.measured = push.force / x;
  push.reading = hold.force.back() / hold.displacement.back();
  push.way = peak_to_peak(last(hold.displacement, kWatched));
  push.force_noise = deviation(steady(hold.force), push.force);
  push.frequency = strongest_frequency(steady(hold.force), dt);
  if (hold.true_displacement.empty()) return push;
  push.load =
      (push.force - steady_mean(steady(hold.zero_error))) / steady_mean(steady(hold.true_displacement));
  push.peak_to_peak = peak_to_peak(last(hold.true_displacement, kWatched));
  return push;
}

// The window of Hann over n samples, times 2.
double window(std::size_t i, double n) {
  return 1.0 - std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / n);
}

}  // namespace

double peak_to_peak(std::span<const double> way) {
  if (way.empty() || !std::all_of(way.begin(), way.end(), [](double x) { return std::isfinite(x); }))
    return kUnset;
  const auto [low, high] = std::minmax_element(way.begin(), way.end());
  return *high - *low;
}

double steady_mean(std::span<const double> signal) {
  double sum = 0.0;
  double weight = 0.0;
  const auto n = static_cast<double>(signal.size());
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const double w = window(i, n);
    sum += w * signal[i];
    weight += w;
  }
  return sum / weight;
}

double strongest_frequency(std::span<const double> signal, double dt) {
  const double mean = steady_mean(signal);
  const auto n = static_cast<double>(signal.size());
  std::vector<double> weighted(signal.size());
  for (std::size_t i = 0; i < signal.size(); ++i) weighted[i] = window(i, n) * (signal[i] - mean);
  double best = kUnset;
  double most = std::norm(1e-9 * n * mean);           // rounding is no oscillation
  const double step = std::max(0.5, 1.0 / (n * dt));  // Hz
  const int steps = static_cast<int>((0.25 / dt - 1.0) / step);
  for (int k = 0; k <= steps; ++k) {
    const double f = 1.0 + k * step;
    const std::complex<double> turn = std::polar(1.0, 2.0 * std::numbers::pi * f * dt);
    std::complex<double> at = 1.0;
    std::complex<double> sum = 0.0;
    for (const double value : weighted) {
      sum += value * at;
      at *= turn;
    }
    if (std::norm(sum) <= most) continue;
    most = std::norm(sum);
    best = f;
  }
  return best;
}

models::Setup push_setup(const std::string& models, const std::vector<std::string>& set,
                         const std::vector<std::string>& variant) {
  std::vector<std::string> all{"rig.force.tare=start", "rig.contact.softest_N_per_mm=0"};
  all.insert(all.end(), set.begin(), set.end());
  all.insert(all.end(), variant.begin(), variant.end());
  return models::load(models + "/scenes/stiffness.toml", "sim", all);
}

models::Setup with_stiffness(models::Setup setup, double stiffness) {
  BehaviourSpec& b = setup.scene.behaviours[pushed_behaviour(setup.scene)];
  b.stiffness = stiffness;
  b.curves.press = b.curves.release = {stiffness, 0, 0, 0};
  return setup;
}

std::size_t pushed_behaviour(const SceneSpec& scene) {
  const std::string& name = scene.pusher->object;
  const auto object = std::find_if(scene.objects.begin(), scene.objects.end(),
                                   [&](const ObjectSpec& o) { return name.empty() || o.name == name; });
  const auto behaviour = std::find_if(scene.behaviours.begin(), scene.behaviours.end(),
                                      [&](const BehaviourSpec& b) { return b.name == object->behaviour; });
  return static_cast<std::size_t>(behaviour - scene.behaviours.begin());
}

PushPart part_at(const PusherSpec& pusher, double t) {
  if (t < pusher.rest_time) return PushPart::rest;
  return t < pusher.rest_time + pusher.ramp_time ? PushPart::ramp : PushPart::hold;
}

double push_time(const models::Setup& setup) {
  const PusherSpec& p = *setup.scene.pusher;
  return p.rest_time + p.ramp_time + p.hold_time;
}

Push push_once(const models::Setup& setup, std::uint64_t seed, PushTrace* trace,
               const trial::TrialOptions& base) {
  trial::TrialOptions options = base;
  options.seed = seed;
  options.seconds = push_time(setup);
  trial::Trial trial(setup, options);
  const bool known = !options.drivers || !trial::slots_of(setup).real;
  const Observer observer(trial.scene(), known ? &trial.world() : nullptr, setup);
  Hold hold;
  while (trial.tick()) {
    if (trace != nullptr && known) {
      trace->time.push_back(seconds(trial.truth().t.time_since_epoch()));
      trace->deflection.push_back(observer.true_displacement());
    }
    if (observer.held(trial.now().t)) observer.see(trial.inputs(), trial.outputs(), trial.state(), hold);
  }
  check_ended(trial);
  Push push = judged(hold, setup.scene.behaviours.front().stiffness, trial.scene().dt);
  push.held = held_in(trial);
  return push;
}

const std::vector<double>& StabilityMap::at(double stiffness) {
  const std::int64_t point = std::max<std::int64_t>(1, std::llround(stiffness / grid_));
  std::vector<double>& found = seen_[point];
  if (!found.empty()) return found;
  found.resize(pushes_);
  const models::Setup setup = with_stiffness(setup_, static_cast<double>(point) * grid_);
  in_parallel(pushes_, [&](std::size_t i) { found[i] = push_once(setup, seed_ + i).peak_to_peak; });
  return found;
}

double StabilityMap::unstable_share(double stiffness) {
  const std::vector<double>& ways = at(stiffness);
  const auto unstable = std::count_if(ways.begin(), ways.end(), [](double way) { return !(way <= kWander); });
  return static_cast<double>(unstable) / static_cast<double>(ways.size());
}

bool StabilityMap::stable(std::int64_t point) {
  return unstable_share(static_cast<double>(point) * grid_) <= 1.0 - share_ + 1e-9;
}

double StabilityMap::lowest_stable(double guess) {
  constexpr double kStiffest = 1e5;  // N/m: no pusher is that stiff
  auto high = std::max<std::int64_t>(1, std::llround(guess / grid_));
  while (!stable(high)) {
    if (static_cast<double>(high) * grid_ > kStiffest) return std::numeric_limits<double>::infinity();
    high += std::max<std::int64_t>(1, high / 4);
  }
  std::int64_t low = high;
  while (low > 0 && (low == high || stable(low))) {
    high = low;
    low -= std::max<std::int64_t>(1, low / 4);
  }
  while (high - low > 1) {
    const std::int64_t middle = (low + high) / 2;
    (stable(middle) ? high : low) = middle;
  }
  // "From there up": the stiffnesses already tried above must be stable as well.
  for (const auto& [point, ways] : seen_)
    if (point > high && !stable(point)) high = point + 1;
  return static_cast<double>(low == 0 && high == 1 ? 0 : high) * grid_;
}

double StabilityMap::simulated() const {
  return static_cast<double>(seen_.size() * pushes_) * push_time(setup_);
}

LoopModel pushed_loop(const models::Setup& setup) {
  LoopModel loop;
  loop.hand_stiffness = setup.twin.pusher.stiffness;
  loop.hand_damping = setup.twin.pusher.damping;
  loop.moved_mass = std::max(0.0, setup.twin.hexapod.mass - setup.rig.force.mass);
  loop.filter_hz = setup.rig.force.filter;
  loop.servo_hz = setup.twin.hexapod.servo;
  loop.servo_damping = setup.twin.hexapod.damping;
  loop.delay = (static_cast<double>(setup.twin.hexapod.delay_cycles) + 1.0 - 0.5) / setup.rig.loop.rate;
  return loop;
}

}  // namespace enc::bench::stiffness
