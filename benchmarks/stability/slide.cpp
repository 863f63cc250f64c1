#include "benchmarks/stability/slide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"

namespace enc::bench::stability {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTurn = 2.0 * std::numbers::pi;

mjsBody* body_of(mjsBody* parent, double mass) {
  mjsBody* body = mjs_addBody(parent, nullptr);
  body->mass = mass;
  body->explicitinertial = true;
  std::fill_n(body->inertia, 3, 1e-3 * mass);
  return body;
}

// A mass on a slide; the hand is a body fixed rigidly to it.
sim::SpecPtr spec_of(const Device& device, const Stepping& stepping) {
  sim::install_mujoco_handlers();
  sim::SpecPtr spec(mj_makeSpec());
  spec->option.timestep = device.period / stepping.steps;
  spec->option.integrator = stepping.scheme == Scheme::rk4     ? mjINT_RK4
                            : stepping.scheme == Scheme::euler ? mjINT_EULER
                                                               : mjINT_IMPLICITFAST;
  std::fill_n(spec->option.gravity, 3, 0.0);
  mjsBody* body = body_of(mjs_findBody(spec.get(), "world"), device.mass);
  if (device.hand_mass > 0.0) body_of(body, device.hand_mass);
  mjsJoint* joint = mjs_addJoint(body, nullptr);
  joint->type = mjJNT_SLIDE;
  joint->damping[0] = device.damping + device.hand_damping;
  joint->stiffness[0] = device.hand_spring;
  if (device.friction > 0.0) {
    joint->frictionloss = device.friction;
    joint->solref_friction[0] = 2.0 * spec->option.timestep;  // sets in as soon as the step allows
    joint->solimp_friction[0] = joint->solimp_friction[1] = 0.9999;
  }
  return spec;
}

// s: some swings, or the time in which a damper creeps to rest.
double watched(const Device& device, const Wall& wall, double swings) {
  const double spring = wall.stiffness + device.hand_spring, mass = device.mass + device.hand_mass;
  const double damper = device.damping + device.hand_damping + wall.damper;
  return std::clamp(std::max(swings * kTurn * std::sqrt(mass / spring), 8.0 * damper / spring), 0.3, 20.0);
}

}  // namespace

const char* name_of(Scheme scheme) {
  return std::array{"rk4", "euler", "implicitfast"}[static_cast<std::size_t>(scheme)];
}

Slide::Slide(const Device& device, const Wall& wall, const Stepping& stepping, double x0)
    : device_(device),
      wall_(wall),
      steps_(stepping.steps),
      physics_(spec_of(device, stepping)),
      late_(std::llround(device.delay / device.period * stepping.steps)) {
  if (std::abs(static_cast<double>(late_) - device.delay / device.period * stepping.steps) > 1e-6)
    throw Error("a delay that is no whole number of steps");
  physics_.data()->qpos[0] = x0;
  before_ = read();
  force_ = -wall_.stiffness * before_;
}

double Slide::read() const {
  return device_.count > 0.0 ? device_.count * (std::floor(x() / device_.count) + 0.5) : x();
}

void Slide::period() {
  const double now = read(), speed = (now - before_) / device_.period;
  before_ = now;
  period(-(wall_.stiffness * now + wall_.damper * speed));
}

void Slide::period(double force, double hand) {
  under_way_.emplace_back(step_ + late_, force);
  for (int i = 0; i < steps_; ++i, ++step_) {
    for (; !under_way_.empty() && under_way_.front().first <= step_; under_way_.pop_front())
      force_ = under_way_.front().second;
    physics_.data()->qfrc_applied[0] = force_ + hand;
    const double from = x();
    if (!physics_.step()) throw Error("MuJoCo warns: " + physics_.warning_text());
    work_ += force_ * (x() - from);
  }
}

void Slide::throw_from(double x, double speed) {
  physics_.data()->qpos[0] = x;
  physics_.data()->qvel[0] = speed;
  under_way_.clear();
  force_ = 0.0;
}

double growth(const Device& device, const Wall& wall, const Stepping& stepping) {
  constexpr double kStart = 1.0, kGrown = 1e3;
  Slide slide(device, wall, stepping, kStart);
  const auto periods = static_cast<std::size_t>(watched(device, wall, 8.0) / device.period);
  std::vector<double> x;
  while (x.size() < periods) {
    slide.period();
    x.push_back(slide.x());
    if (std::abs(x.back()) > kGrown * kStart)
      return std::log(kGrown) / (static_cast<double>(x.size()) * device.period);
  }
  // x[i + 2s] = p x[i + s] - q x[i] of a swing that grows by sqrt(q) in s periods, about a quarter of a turn.
  const std::size_t half = periods / 2;
  std::size_t crossings = 0;
  for (std::size_t i = half + 1; i < periods; ++i) crossings += (x[i] > 0.0) != (x[i - 1] > 0.0) ? 1 : 0;
  if (crossings < 4)
    return std::log(std::abs(x.back() / x[half])) / (static_cast<double>(periods - half) * device.period);
  const std::size_t s = std::max<std::size_t>(1, (periods - half) / (2 * crossings));
  double aa = 0.0, ab = 0.0, bb = 0.0, ac = 0.0, bc = 0.0;
  for (std::size_t i = half; i + 2 * s < periods; ++i) {
    const double a = x[i + s], b = -x[i], c = x[i + 2 * s];
    aa += a * a;
    ab += a * b;
    bb += b * b;
    ac += a * c;
    bc += b * c;
  }
  const double q = (aa * bc - ab * ac) / (aa * bb - ab * ab);
  return std::log(q) / (2.0 * static_cast<double>(s) * device.period);
}

double critical(const Device& device, double damper, const Stepping& stepping, double near, double most) {
  constexpr double kLeast = 0.5, kEnough = 1.0005;
  const auto grows = [&](double stiffness) { return growth(device, {stiffness, damper}, stepping); };
  const double widen = std::isnan(near) ? 2.0 : 1.02;
  double high = std::isnan(near) ? most : near * widen, at_high = grows(high);
  if (std::isnan(near) && at_high < 0.0) return kInfinite;
  while (at_high < 0.0) at_high = grows(high *= widen);
  // Searches downwards, because growth shows quickly.
  double low = high / (widen * widen), at_low = grows(low);
  while (at_low >= 0.0) {
    high = low;
    at_high = at_low;
    if (low < kLeast) return 0.0;
    at_low = grows(low /= widen);
  }
  for (double before = 0.0; high / low > kEnough;) {
    const double share = std::clamp(at_low / (at_low - at_high), 0.02, 0.98);  // share at which a line is 0
    const double between = low * std::pow(high / low, share), at = grows(between);
    (at < 0.0 ? low : high) = between;
    (at < 0.0 ? at_low : at_high) = at;
    if (std::abs(between / before - 1.0) < 0.2 * (kEnough - 1.0)) return between;
    before = between;
  }
  return std::sqrt(low * high);
}

Outcome let_go(const Device& device, const Wall& wall, const Stepping& stepping, double x0) {
  Slide slide(device, wall, stepping, x0);
  const double seconds = std::max(watched(device, wall, 40.0), 40.0 * device.delay);
  const auto quarter = static_cast<std::size_t>(seconds / device.period) / 4;
  const double pushes = wall.stiffness + 2.0 * std::abs(wall.damper) / device.period;
  const bool held = pushes * device.count <= 2.0 * device.friction;
  double before = kInfinite;
  for (std::size_t quarters = 1; quarters <= 32; ++quarters) {
    double low = kInfinite, high = -kInfinite;
    for (std::size_t part = 0; part < 8; ++part) {
      double least = kInfinite, most = -kInfinite;
      for (std::size_t i = part * quarter / 8; i < (part + 1) * quarter / 8; ++i) {
        slide.period();
        least = std::min(least, slide.x());
        most = std::max(most, slide.x());
        if (std::abs(slide.x()) > 20.0 * x0) return Outcome::away;
      }
      if (most - least < 1e-4 * x0) return Outcome::still;
      low = std::min(low, least);
      high = std::max(high, most);
    }
    const double last = high - low;
    if (quarters >= 4) {
      if (last < 0.01 * x0) return Outcome::still;
      if (last > 1.1 * before) return Outcome::away;
      if (last > 0.9 * before) return Outcome::cycle;
      if (held) return Outcome::still;
    }
    before = last;
  }
  return Outcome::unknown;
}

}  // namespace enc::bench::stability
