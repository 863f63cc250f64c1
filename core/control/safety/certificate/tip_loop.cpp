#include "core/control/safety/certificate/tip_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace enc::certificate {
namespace {

using Complex = std::complex<double>;
using Mat3c = Eigen::Matrix3cd;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat69 = Eigen::Matrix<double, 6, 9>;
using std::numbers::pi;

// The derivative of eta and of its rate, by both and by a held force, in units of a period. A direction that
// does not exist is a damped spring of its own.
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

// What becomes of them in a share of a period, less what they were, so that slow loops keep their digits: of
// the matrix exponential of the derivative the part that is not constant.
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

}  // namespace

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

// With the sides closed the normal is one loop.
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
// circle: it turns once around 0 for each zero there.
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

namespace {

// Of places and speeds along three directions those of the first n.
template <class Matrix>
Eigen::MatrixXd of_directions(const Matrix& all, Eigen::Index n) {
  Eigen::MatrixXd found(2 * n, all.cols());
  found << all.topRows(n), all.middleRows(3, n);
  return found;
}

}  // namespace

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

}  // namespace enc::certificate
