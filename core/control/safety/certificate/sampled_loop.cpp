#include "core/control/safety/certificate/sampled_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace enc::certificate {

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

// The sampled loop of a tip in all its directions, for sampled_loop.cpp. A push along the normal moves the
// tip sideways too, and there the law has its own spring and damper.
//
//   eta'' = -C eta' - W_n^T (k_h x_n + b_h x_n') + W^T F,   x = W eta      m_h acts on eta'' in this way too
//   F_i = -(K_i e_i + B_i r_i), filtered, held and late as in sampled_loop.h; i: the normal and two sides
class TipLoop {
 public:
  explicit TipLoop(const SampledLoop& loop);
  // The K along the normal that puts an eigenvalue at e^{j angle}, N/m; a solution only if it is real.
  [[nodiscard]] std::complex<double> needed(double angle, const Damper& damper) const;
  // Matrix of one step of the whole memory: eta, its rate, readings, filtered forces, pending forces.
  [[nodiscard]] Eigen::MatrixXd step(double stiffness, double damper) const;
  // Number of eigenvalues of the step outside the unit circle. A large matrix is never built: then they are
  // counted without it.
  [[nodiscard]] int outside(double stiffness, double damper) const;

 private:
  using Mat3c = Eigen::Matrix3cd;
  struct Response {
    Mat3c place;                // tip position over tip force, m/N, with the delay
    std::complex<double> free;  // det(I - A/z) of the device alone
  };
  [[nodiscard]] Response response(double angle) const;
  // The law along the normal and sideways at e^{j angle}, N/m.
  [[nodiscard]] std::complex<double> along(double angle, double stiffness, double damper) const;
  [[nodiscard]] std::complex<double> across(double angle, double stiffness, double damper) const;
  // det(I - S/z) of the step S.
  [[nodiscard]] std::complex<double> determinant(double angle, double stiffness, double damper) const;
  [[nodiscard]] double turned(double from, double to, std::complex<double> at_from,
                              std::complex<double> at_to, double stiffness, double damper, int depth) const;
  [[nodiscard]] int winding(double stiffness, double damper) const;

  const SampledLoop& loop_;
  LoopDelay late_;
  Eigen::Matrix<double, 6, 6> free_;  // change of eta and its rate over a period
  // Effect of the force that begins in the period, and of the last one.
  Eigen::Matrix<double, 6, 3> fresh_, old_;
};

using Mat3c = Eigen::Matrix3cd;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat69 = Eigen::Matrix<double, 6, 9>;

// The derivative of eta and of its rate, caused by both of them and by a held force, in units of a period. A
// direction that does not exist is a damped spring of its own.
Mat69 derivative(const SampledLoop& loop) {
  const Directions& all = loop.around;
  const double T = loop.period;
  const Vec3 normal = all.moves.row(0).transpose();
  const Mat3 hand = normal * normal.transpose();
  Mat3 spring = loop.hand.stiffness * T * T * hand, damper = T * (all.damping + loop.hand.damping * hand);
  for (int i = all.count; i < 3; ++i) spring(i, i) = damper(i, i) = 1.0;
  const Mat3 lighter = (Mat3::Identity() + loop.hand.mass * hand).inverse();
  Mat69 a = Mat69::Zero();
  a.block<3, 3>(0, 3).setIdentity();
  a.block<3, 3>(3, 0) = -lighter * spring;
  a.block<3, 3>(3, 3) = -lighter * damper;
  a.block<3, 3>(3, 6) = T * T * lighter * all.moves.transpose();
  return a;
}

// Change of eta and its rate in a share of a period: the matrix exponential of the derivative without the
// identity. The difference keeps the digits of slow loops.
Mat69 added(const Mat69& a, double share) {
  const double size = a.cwiseAbs().rowwise().sum().maxCoeff();
  double scale = share;
  int halved = 0;
  while (size * scale > 0.1) {
    scale *= 0.5;
    ++halved;
  }
  const Mat6 small = scale * a.leftCols<6>();
  Mat69 term = scale * a, sum = term;
  for (int i = 2; i <= 9; ++i) {
    term = (small * term / static_cast<double>(i)).eval();
    sum += term;
  }
  for (int i = 0; i < halved; ++i) sum = (2.0 * sum + sum.leftCols<6>() * sum).eval();
  return sum;
}

TipLoop::TipLoop(const SampledLoop& loop)
    : loop_(loop), late_(late(loop)), old_(Eigen::Matrix<double, 6, 3>::Zero()) {
  const Mat69 a = derivative(loop), whole = added(a, 1.0);
  const Mat69 rest = late_.part > 0.0 ? added(a, 1.0 - late_.part) : whole;
  free_ = whole.leftCols<6>();
  fresh_ = rest.rightCols<3>();
  if (late_.part > 0.0) {
    const Eigen::Matrix<double, 6, 3> first = added(a, late_.part).rightCols<3>();
    old_ = first + rest.leftCols<6>() * first;
  }
}

TipLoop::Response TipLoop::response(double angle) const {
  const Complex past = one_less(angle), turn = -std::conj(past);  // 1 - 1/z, z - 1
  const Eigen::Matrix<Complex, 6, 3> push = fresh_.cast<Complex>() + (1.0 - past) * old_.cast<Complex>();
  const auto block = [&](int row, int column) -> Mat3c {
    return -free_.block<3, 3>(row, column).cast<Complex>();
  };
  const Mat3c rate = block(3, 3) + turn * Mat3c::Identity(), slower = rate.inverse();
  const Mat3c by_rate = block(0, 3) * slower;
  const Mat3c place = block(0, 0) + turn * Mat3c::Identity() - by_rate * block(3, 0);
  const Mat3c eta = place.inverse() * (push.topRows<3>() - by_rate * push.bottomRows<3>());
  const Complex back = 1.0 - past;
  return {loop_.around.moves.cast<Complex>() * eta * (1.0 - one_less(angle * late_.whole)),
          rate.determinant() * place.determinant() * (back * back * back) * (back * back * back)};
}

Complex TipLoop::along(double angle, double stiffness, double damper) const {
  return (stiffness + damper * rate_response(loop_, angle)) * filter_response(loop_.filter, angle);
}

Complex TipLoop::across(double angle, double stiffness, double damper) const {
  const Directions& all = loop_.around;
  const Complex rate = rate_response(loop_, angle);
  return (all.alike ? stiffness + damper * rate : all.stiffness + all.damper * rate) *
         filter_response(all.filter, angle);
}

// A normal with closed sides is a single loop.
Complex TipLoop::needed(double angle, const Damper& damper) const {
  const Mat3c place = response(angle).place;
  const Complex side = across(angle, 0.0, 0.0), rate = rate_response(loop_, angle);
  const Eigen::Matrix2cd held = Eigen::Matrix2cd::Identity() + side * place.bottomRightCorner<2, 2>();
  const Complex along = place(0, 0) - side * (place.topRightCorner<1, 2>() * held.inverse() *
                                              place.bottomLeftCorner<2, 1>())(0);
  return -(1.0 / (along * filter_response(loop_.filter, angle)) + damper.fixed * rate) /
         (1.0 + damper.ratio * rate);
}

Complex TipLoop::determinant(double angle, double stiffness, double damper) const {
  const Response device = response(angle);
  const Complex side = across(angle, stiffness, damper);
  Mat3c closed = Mat3c::Identity();
  closed.col(0) += along(angle, stiffness, damper) * device.place.col(0);
  closed.rightCols<2>() += side * device.place.rightCols<2>();
  return device.free * closed.determinant();
}

double TipLoop::turned(double from, double to, Complex at_from, Complex at_to, double stiffness,
                       double damper, int depth) const {
  constexpr double kFine = 0.8;
  const double turn = std::arg(at_to / at_from);
  if (depth == 0 || !(std::abs(turn) >= kFine)) return turn;
  const double middle = 0.5 * (from + to);
  const Complex at = determinant(middle, stiffness, damper);
  return turned(from, middle, at_from, at, stiffness, damper, depth - 1) +
         turned(middle, to, at, at_to, stiffness, damper, depth - 1);
}

// As a function of 1/z the determinant has its zeros at the eigenvalues' inverses and no pole within the
// circle. So it winds once around 0 for each zero there.
int TipLoop::winding(double stiffness, double damper) const {
  constexpr int kForEachPeriod = 24, kDeepest = 24;
  double from = 0.0, turns = 0.0;
  Complex before;
  for (const double to : angles(loop_, kForEachPeriod)) {
    const Complex at = determinant(to, stiffness, damper);
    if (from > 0.0) turns += turned(from, to, before, at, stiffness, damper, kDeepest);
    from = to;
    before = at;
  }
  return static_cast<int>(std::lround(-turns / pi));
}

int TipLoop::outside(double stiffness, double damper) const {
  constexpr Eigen::Index kDense = 60;
  const Directions& all = loop_.around;
  if (all.count * (2 + loop_.ticks + late_.whole) > kDense) return winding(stiffness, damper);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(step(stiffness, damper), false);
  if (solver.info() != Eigen::Success) return winding(stiffness, damper);
  const auto& found = solver.eigenvalues();
  return static_cast<int>(
      std::count_if(found.begin(), found.end(), [](const Complex& z) { return !(std::norm(z) < 1.0); }));
}

// Rows of the first n of three directions, positions and then speeds.
template <class Matrix>
Eigen::MatrixXd of_directions(const Matrix& all, Eigen::Index n) {
  Eigen::MatrixXd found(2 * n, all.cols());
  found << all.topRows(n), all.middleRows(3, n);
  return found;
}

Eigen::MatrixXd TipLoop::step(double stiffness, double damper) const {
  const Directions& all = loop_.around;
  const Eigen::Index n = all.count, readings = 2 * n, filters = readings + n * loop_.ticks;
  const bool own = !std::isnan(loop_.filter), sides = !std::isnan(all.filter);
  const Eigen::Index forces = filters + (own ? 1 : 0) + (sides ? 2 : 0);
  const Eigen::Index size = forces + 3 * (late_.whole + (late_.part > 0.0 ? 1 : 0));
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd law = Eigen::MatrixXd::Zero(3, size);
  Eigen::Index filter = filters;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const bool along = i == 0 || all.alike;
    const double k = along ? stiffness : all.stiffness, gain = i == 0 ? loop_.filter : all.filter;
    const double b = (along ? damper : all.damper) / (loop_.ticks * loop_.period);
    law.row(i).head(n) = (k + b) * all.moves.row(i).head(n);
    law.row(i).segment(filters - n, n) -= b * all.moves.row(i).head(n);
    if (std::isnan(gain)) continue;
    law.row(i) *= gain;
    law(i, filter) = 1.0;
    law.row(i) /= 1.0 + gain;
    step.row(filter++) = law.row(i);
  }
  const auto rows = [n](const auto& of) { return of_directions(of, n); };
  Eigen::MatrixXd free(2 * n, 2 * n);
  free << free_.topLeftCorner(n, n), free_.block(0, 3, n, n), free_.block(3, 0, n, n),
      free_.block(3, 3, n, n);
  step.topLeftCorner(2 * n, 2 * n) = Eigen::MatrixXd::Identity(2 * n, 2 * n) + free;
  if (late_.whole == 0)
    step.topRows(2 * n) -= rows(fresh_) * law;
  else
    step.block(0, forces + 3 * (late_.whole - 1), 2 * n, 3) -= rows(fresh_);
  if (late_.part > 0.0) step.block(0, forces + 3 * late_.whole, 2 * n, 3) -= rows(old_);
  step.block(readings, 0, n, n).setIdentity();
  for (Eigen::Index i = readings + n; i < filters; ++i) step(i, i - n) = 1.0;
  if (size > forces) step.middleRows(forces, 3) = law;
  for (Eigen::Index i = forces + 3; i < size; ++i) step(i, i - 3) = 1.0;
  return step;
}

bool at_least(double value, double least) { return std::isfinite(value) && value >= least; }

// Change of the device's state over a share of a period. Units: position, position per period, and force T^2
// / mass. The identity is left out, so that slow loops keep their digits.
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
  for (int i = 0; i < halved; ++i) sum = (2.0 * sum + sum * sum).eval();  // e^2a - 1 from e^a - 1
  return sum;
}

// One period of the device: the change of position and speed without a force, the effect of the force that
// begins in it, and the effect of the previous force, which lasts for its first part.
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

// Compliance at z = e^{j angle}, with the delay, m/N.
Complex compliance(const SampledLoop& loop, const Device& device, double angle) {
  const LoopDelay delay = late(loop);
  const Complex past = one_less(angle), turn = -std::conj(past);  // 1 - 1/z, z - 1
  const Eigen::Vector2cd push = device.fresh.cast<Complex>() + (1.0 - past) * device.old.cast<Complex>();
  const Complex a = turn - device.free(0, 0), d = turn - device.free(1, 1);
  const double b = device.free(0, 1), c = device.free(1, 0);
  const Complex place = (d * push(0) + b * push(1)) / (a * d - b * c);
  return place * (1.0 - one_less(angle * delay.whole)) * (loop.period * loop.period) /
         (loop.mass + loop.hand.mass);
}

// One step of the whole memory: position, speed, n readings, both filtered values, pending forces.
Eigen::MatrixXd step_of(const SampledLoop& loop, double stiffness, double damper) {
  const LoopDelay delay = late(loop);
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

LoopDelay late(const SampledLoop& loop) {
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

// The last angle of an interval at which the imaginary part of `needed` still has the sign of `before`.
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
  constexpr int kForEachPeriod = 24;  // a delay turns the phase by 7.5 degrees between two angles
  const std::vector<double> grid = angles(loop, kForEachPeriod);
  double from = grid.front(), before = needed(from).imag();
  for (const double end : grid) {
    const double to = std::min(end, pi - 1e-7);  // all values are real at pi
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

// Number of eigenvalues on or outside the unit circle.
long outside_of(const SampledLoop& loop, double stiffness, const Damper& damper) {
  if (loop.around.count > 0) return TipLoop(loop).outside(stiffness, damper.at(stiffness));
  const auto all = eigenvalues(loop, stiffness, damper.at(stiffness));
  return std::count_if(all.begin(), all.end(), [](const Complex& z) { return !(std::norm(z) < 1.0); });
}

// Bisection between a stable and an unstable stiffness.
double border(const SampledLoop& loop, const Damper& damper, double stable, double unstable) {
  for (int i = 0; i < 24; ++i) {
    const double middle = std::sqrt(stable * unstable);
    (outside_of(loop, middle, damper) == 0 ? stable : unstable) = middle;
  }
  return stable;
}

// The law grows in all directions at once, so no single loop has its edges. The search tries stiffnesses from
// soft to stiff.
Range tried_range(const SampledLoop& loop, const Damper& damper) {
  constexpr double kFirst = 1.0, kRise = 1.15;  // N/m; factor from one trial to the next
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

// A mode that hardly couples with the normal may leave the circle between two sampled angles.
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
  long outside = -1;  // eigenvalues outside; counted once, then updated at each edge
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
