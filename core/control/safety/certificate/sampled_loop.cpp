#include "core/control/safety/certificate/sampled_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Eigenvalues>

#include "core/control/safety/certificate/tip_loop.h"

namespace enc::certificate {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

bool at_least(double value, double least) { return std::isfinite(value) && value >= least; }

// The device over a share of a period, in units of place, of place a period, and of force T^2 / mass: what is
// added to them. Without the identity, so that slow loops keep their digits.
Mat3 added(const SampledLoop& loop, double share) {
  const double mass = loop.mass + loop.hand.mass, T = loop.period;
  const double spring = loop.hand.stiffness * T * T / mass,
               damper = (loop.damping + loop.hand.damping) * T / mass;
  Mat3 a;
  a << 0.0, 1.0, 0.0, -spring, -damper, 1.0, 0.0, 0.0, 0.0;
  a *= share;
  double size = (1.0 + spring + damper) * share;
  int halved = 0;
  while (size > 0.1) {
    size *= 0.5;
    a *= 0.5;
    ++halved;
  }
  Mat3 sum = Mat3::Zero(), term = Mat3::Identity();
  for (int i = 1; i <= 12; ++i) {
    term = (term * a / static_cast<double>(i)).eval();
    sum += term;
  }
  for (int i = 0; i < halved; ++i) sum = (2.0 * sum + sum * sum).eval();  // e^2a - 1 of e^a - 1
  return sum;
}

// One period: what place and speed become by themselves, less what they were; by the force that begins in it;
// and by the one before, which lasts for its first part.
struct Device {
  Eigen::Matrix2d free;
  Eigen::Vector2d fresh, old;
  explicit Device(const SampledLoop& loop) {
    const double part = late(loop).part;
    const Mat3 whole = added(loop, 1.0), rest = part > 0.0 ? added(loop, 1.0 - part) : whole;
    free = whole.topLeftCorner<2, 2>();
    fresh = rest.topRightCorner<2, 1>();
    old = Eigen::Vector2d::Zero();
    if (part > 0.0) {
      const Eigen::Vector2d first = added(loop, part).topRightCorner<2, 1>();
      old = first + rest.topLeftCorner<2, 2>() * first;
    }
  }
};

// Place over force, with the delay, m/N, at z = e^{j angle}.
Complex compliance(const SampledLoop& loop, const Device& device, double angle) {
  const Late delay = late(loop);
  const Complex past = one_less(angle), turn = -std::conj(past);  // 1 - 1/z, z - 1
  const Eigen::Vector2cd push = device.fresh.cast<Complex>() + (1.0 - past) * device.old.cast<Complex>();
  const Complex a = turn - device.free(0, 0), d = turn - device.free(1, 1);
  const double b = device.free(0, 1), c = device.free(1, 0);
  const Complex place = (d * push(0) + b * push(1)) / (a * d - b * c);
  return place * (1.0 - one_less(angle * delay.whole)) * (loop.period * loop.period) /
         (loop.mass + loop.hand.mass);
}

// One step of everything that is remembered: place, speed, n readings, the filtered two, forces under way.
Eigen::MatrixXd step_of(const SampledLoop& loop, double stiffness, double damper) {
  const Late delay = late(loop);
  const Device device(loop);
  const Eigen::Index readings = 2, filtered = readings + loop.ticks;
  const Eigen::Index forces = filtered + (std::isnan(loop.filter) ? 0 : 2);
  const Eigen::Index size = forces + delay.whole + (delay.part > 0.0 ? 1 : 0);
  Eigen::RowVectorXd error = Eigen::RowVectorXd::Zero(size), rate = error;
  error(0) = 1.0;
  rate(0) = 1.0 / loop.ticks;
  rate(filtered - 1) = -1.0 / loop.ticks;
  if (!std::isnan(loop.filter)) {
    error *= loop.filter;
    rate *= loop.filter;
    error(filtered) = rate(filtered + 1) = 1.0;
    error /= 1.0 + loop.filter;
    rate /= 1.0 + loop.filter;
  }
  const double unit = loop.period * loop.period / (loop.mass + loop.hand.mass);
  const Eigen::RowVectorXd force = -unit * (stiffness * error + damper / loop.period * rate);
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(size, size);
  step.topLeftCorner<2, 2>() = Eigen::Matrix2d::Identity() + device.free;
  if (delay.whole == 0)
    step.topRows<2>() += device.fresh * force;
  else
    step.block<2, 1>(0, forces + delay.whole - 1) += device.fresh;
  if (delay.part > 0.0) step.block<2, 1>(0, forces + delay.whole) += device.old;
  step(readings, 0) = 1.0;
  for (Eigen::Index i = readings + 1; i < filtered; ++i) step(i, i - 1) = 1.0;
  if (forces > filtered) {
    step.row(filtered) = error;
    step.row(filtered + 1) = rate;
  }
  if (size > forces) step.row(forces) = force;
  for (Eigen::Index i = forces + 1; i < size; ++i) step(i, i - 1) = 1.0;
  return step;
}

}  // namespace

bool SampledLoop::known() const {
  return at_least(mass, 0.0) && mass + hand.mass > 0.0 && at_least(damping, 0.0) && at_least(period, 0.0) &&
         period > 0.0 && at_least(delay, 0.0) && ticks >= 1 && delay / period + ticks <= kMostPeriods + 1.0 &&
         (std::isnan(filter) || (filter > 0.0 && std::isfinite(filter))) && at_least(hand.mass, 0.0) &&
         at_least(hand.damping, 0.0) && at_least(hand.stiffness, 0.0) && around.known();
}

bool Directions::known() const {
  return moves.allFinite() && damping.allFinite() && at_least(stiffness, 0.0) && std::isfinite(damper) &&
         (std::isnan(filter) || (filter > 0.0 && std::isfinite(filter)));
}

SampledLoop SampledLoop::alone() const {
  SampledLoop loop = *this;
  loop.hand = {};
  return loop;
}

SampledLoop SampledLoop::along() const {
  SampledLoop loop = *this;
  loop.around = {};
  return loop;
}

Late late(const SampledLoop& loop) {
  const double periods = loop.delay / loop.period, whole = std::floor(periods + 1e-9);
  const double part = periods - whole;
  return {static_cast<int>(whole), part > 1e-9 ? part : 0.0};
}

Complex one_less(double angle) {
  const double half = std::sin(0.5 * angle);
  return {2.0 * half * half, std::sin(angle)};
}
Complex rate_response(const SampledLoop& loop, double angle) {
  return one_less(angle * loop.ticks) / (loop.ticks * loop.period);
}
Complex filter_response(double gain, double angle) {
  return std::isnan(gain) ? Complex(1.0) : gain / (gain + one_less(angle));
}

std::vector<double> angles(const SampledLoop& loop, int for_each_period) {
  constexpr double kFirst = 1e-7, kEven = 0.02;
  constexpr int kLogarithmic = 240;
  const int even = 300 + for_each_period * (late(loop).whole + loop.ticks);
  std::vector<double> all;
  all.reserve(static_cast<std::size_t>(kLogarithmic + even) + 1);
  for (int i = 0; i < kLogarithmic; ++i)
    all.push_back(kFirst * std::exp(std::log(kEven / kFirst) * i / kLogarithmic));
  for (int i = 0; i <= even; ++i) all.push_back(kEven + (pi - kEven) * i / even);
  return all;
}

std::vector<Complex> eigenvalues(const SampledLoop& loop, double stiffness, double damper) {
  if (!loop.known() || !std::isfinite(stiffness) || !std::isfinite(damper)) return {};
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(
      loop.around.count > 0 ? TipLoop(loop).step(stiffness, damper) : step_of(loop, stiffness, damper),
      false);
  if (solver.info() != Eigen::Success) return {};
  const auto& found = solver.eigenvalues();
  return {found.data(), found.data() + found.size()};
}

Complex slowest(const SampledLoop& loop, double stiffness, double damper) {
  Complex most{kUnset, kUnset};
  for (const Complex& z : eigenvalues(loop, stiffness, damper))
    if (!(std::norm(z) <= std::norm(most))) most = z;
  return most;
}

double spectral_radius(const SampledLoop& loop, double stiffness, double damper) {
  return std::sqrt(std::norm(slowest(loop, stiffness, damper)));
}
double ringing(const SampledLoop& loop, double stiffness, double damper) {
  const Complex z = slowest(loop, stiffness, damper);
  return std::abs(std::atan2(z.imag(), z.real())) / loop.period;
}
bool stable(const SampledLoop& loop, double stiffness, double damper) {
  if (loop.around.count > 0 && loop.known() && std::isfinite(stiffness) && std::isfinite(damper))
    return TipLoop(loop).outside(stiffness, damper) == 0;
  return spectral_radius(loop, stiffness, damper) < 1.0;
}

namespace {

// The angle between two, up to which the imaginary part of what is `needed` keeps the sign that it has
// `before`.
template <class Needed>
double last_of_sign(const Needed& needed, double before, double low, double high) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (needed(middle).imag() * before > 0.0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

std::vector<Edge> edges(const SampledLoop& loop, const Damper& damper, double dry) {
  if (!loop.known() || !std::isfinite(damper.fixed) || !std::isfinite(damper.ratio) || !at_least(dry, 0.0))
    return {};
  const Device device(loop);
  std::optional<TipLoop> around;
  if (loop.around.count > 0) around.emplace(loop);
  const auto rubbed = [&](double angle) {
    SampledLoop more = loop;
    more.damping += dry * loop.period / angle;
    return compliance(more, Device(more), angle);
  };
  const auto needed = [&](double angle) {
    if (around) return around->needed(angle, damper);
    const Complex rate = rate_response(loop, angle);
    const Complex place = dry > 0.0 ? rubbed(angle) : compliance(loop, device, angle);
    return -(1.0 / (place * filter_response(loop.filter, angle)) + damper.fixed * rate) /
           (1.0 + damper.ratio * rate);
  };
  std::vector<Edge> found;
  const auto add = [&](double angle, int leave) {
    const double stiffness = needed(angle).real();
    if (stiffness > 0.0 && stiffness < kStiffest) found.push_back({stiffness, angle, leave});
  };
  constexpr int kForEachPeriod = 24;  // a delay turns by 7.5 degrees from one to the next
  const std::vector<double> grid = angles(loop, kForEachPeriod);
  double from = grid.front(), before = needed(from).imag();
  for (const double end : grid) {
    const double to = std::min(end, pi - 1e-7);  // at pi all is real
    const double after = needed(to).imag();
    if (before * after < 0.0) add(last_of_sign(needed, before, from, to), before < 0.0 ? 2 : -2);
    from = to;
    before = after;
  }
  add(pi, before < 0.0 ? 1 : -1);
  std::sort(found.begin(), found.end(),
            [](const Edge& a, const Edge& b) { return a.stiffness < b.stiffness; });
  return found;
}

namespace {

// Eigenvalues that are not within the unit circle.
long outside_of(const SampledLoop& loop, double stiffness, const Damper& damper) {
  if (loop.around.count > 0) return TipLoop(loop).outside(stiffness, damper.at(stiffness));
  const auto all = eigenvalues(loop, stiffness, damper.at(stiffness));
  return std::count_if(all.begin(), all.end(), [](const Complex& z) { return !(std::norm(z) < 1.0); });
}

// Between a stable and an unstable stiffness.
double border(const SampledLoop& loop, const Damper& damper, double stable, double unstable) {
  for (int i = 0; i < 24; ++i) {
    const double middle = std::sqrt(stable * unstable);
    (outside_of(loop, middle, damper) == 0 ? stable : unstable) = middle;
  }
  return stable;
}

// The law grows in all directions at once, so no single loop has its edges: it is tried from soft to stiff.
Range tried_range(const SampledLoop& loop, const Damper& damper) {
  constexpr double kFirst = 1.0, kRise = 1.15;  // N/m; each over the one before
  double low = 0.0, before = 0.0;
  bool was_stable = false;
  const int all = static_cast<int>(std::log(kStiffest / kFirst) / std::log(kRise));
  for (int i = 0; i <= all; ++i) {
    const double at = kFirst * std::pow(kRise, i);
    const bool is_stable = outside_of(loop, at, damper) == 0;
    if (is_stable && !was_stable && before > 0.0) low = border(loop, damper, at, before);
    if (!is_stable && was_stable) return {low, border(loop, damper, before, at)};
    was_stable = is_stable;
    before = at;
  }
  return was_stable ? Range{low, std::numeric_limits<double>::infinity()} : Range{0.0, 0.0};
}

// A mode that hardly couples with the normal may leave the circle between two of the angles that are looked
// at.
double checked_high(const SampledLoop& loop, const Damper& damper, double stable, double high) {
  const double below = 0.99 * high;
  if (loop.around.count == 0 || !(below > stable) || outside_of(loop, below, damper) == 0) return high;
  return border(loop, damper, stable, below);
}

}  // namespace

Range stable_range(const SampledLoop& loop, const Damper& damper) {
  if (!loop.known() || !std::isfinite(damper.fixed) || !std::isfinite(damper.ratio)) return {};
  if (loop.around.count > 0 && loop.around.alike) return tried_range(loop, damper);
  std::vector<Edge> ends = edges(loop, damper);
  ends.push_back({kStiffest, pi, 0});
  double from = 0.0;
  long outside = -1;  // eigenvalues; counted once, then by what the edges let in and out
  for (const Edge& end : ends) {
    const double to = end.stiffness;
    if (outside <= 0 && to - from > 1e-9 * to) {
      const double between = from > 0.0 ? std::sqrt(from * to) : 0.5 * to;
      outside = outside_of(loop, between, damper);
      if (outside == 0)
        return {from, to < kStiffest ? checked_high(loop, damper, between, to)
                                     : std::numeric_limits<double>::infinity()};
    }
    outside += outside < 0 ? 0 : end.leave;
    from = to;
  }
  return {0.0, 0.0};
}

double critical_stiffness(const SampledLoop& loop, const Damper& damper) {
  return stable_range(loop, damper).high;
}

}  // namespace enc::certificate
