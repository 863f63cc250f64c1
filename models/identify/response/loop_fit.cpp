#include "models/identify/response/loop_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/shape/response/response.h"
#include "models/identify/block_fit.h"
#include "models/identify/response/loop_csv.h"

namespace enc::models {
namespace {

// Errors of a fitted curve besides noise: repeats differ, the zero of the force and the begin of contact are
// uncertain, and a polynomial cannot follow every curve.
class CurveErrors {
 public:
  CurveErrors(const LoopData& loop, const Response& response, bool pressing);

  // Half of the 95 % interval at a deflection, N; `noise`: half of the interval from noise alone. The
  // polynomial's misfit is not random, so it is added linearly.
  [[nodiscard]] double half(double deflection, double noise) const;

 private:
  struct Residual {
    double deflection = 0.0, force = 0.0;  // m, N
  };
  [[nodiscard]] double misfit(double deflection) const;
  [[nodiscard]] double misfit_within(double deflection, double width) const;
  [[nodiscard]] double slope(double deflection) const;  // N/m

  Response response_;
  bool pressing_;
  std::vector<Residual> residuals_;  // sorted by deflection
  double scatter_ = 0.0;             // N: standard deviation of a residual
  double repeats_ = 0.0;             // N: half of the interval of the repeats' mean, as whole branches
  double zero_, begin_;              // N, m: standard deviations
};

CurveErrors::CurveErrors(const LoopData& loop, const Response& response, bool pressing)
    : response_(response), pressing_(pressing), zero_(loop.zero_error), begin_(loop.begin_error) {
  double presses = 0.0, sum = 0.0, squares = 0.0;
  for (const auto& press : loop.moving) {
    double own = 0.0, count = 0.0;
    for (const LoopPoint& p : press) {
      if (p.pressing != pressing || p.deflection > response.limit()) continue;
      const double fitted = pressing ? response.press(p.deflection) : response.release(p.deflection);
      residuals_.push_back({p.deflection, p.force - fitted});
      own += p.force - fitted;
      count += 1.0;
    }
    if (!(count > 0.0)) continue;
    presses += 1.0;
    sum += own / count;
    squares += own / count * own / count;
  }
  if (presses > 1.0)
    repeats_ = student(presses - 1.0) *
               std::sqrt(std::max(0.0, squares - sum * sum / presses) / (presses - 1.0) / presses);
  for (const Residual& r : residuals_) scatter_ += r.force * r.force;
  scatter_ = std::sqrt(scatter_ / std::max<double>(1.0, static_cast<double>(residuals_.size())));
  std::sort(residuals_.begin(), residuals_.end(),
            [](const Residual& a, const Residual& b) { return a.deflection < b.deflection; });
}

double CurveErrors::half(double deflection, double noise) const {
  const double chance =
      std::hypot(std::hypot(noise, repeats_), kNormal95 * std::hypot(zero_, slope(deflection) * begin_));
  return chance + misfit(deflection);
}

double CurveErrors::slope(double deflection) const {
  const double step = 1e-3 * response_.limit();
  const auto force = [&](double d) { return pressing_ ? response_.press(d) : response_.release(d); };
  const double to = std::min(deflection, response_.limit()), from = std::max(0.0, to - step);
  return (force(to) - force(from)) / (to - from);
}

// The largest mean residual around a deflection, there and on either side, over a width with enough readings.
double CurveErrors::misfit(double deflection) const {
  constexpr double kShare = 1.0 / 50.0, kGrows = 1.25;
  const double least = response_.limit() / 200.0, most = response_.limit() / 4.0;
  const double enough = std::clamp(kShare * static_cast<double>(residuals_.size()), 30.0, 150.0);
  double width = least, nearest = INFINITY;
  for (const Residual& r : residuals_) nearest = std::min(nearest, std::abs(r.deflection - deflection));
  width = std::max(width, 3.0 * nearest);
  const auto within = [&](double w) {
    const auto below = [](const Residual& r, double d) { return r.deflection < d; };
    const auto from = std::lower_bound(residuals_.begin(), residuals_.end(), deflection - w, below);
    const auto to = std::lower_bound(residuals_.begin(), residuals_.end(), deflection + w, below);
    return static_cast<double>(to - from);
  };
  while (within(width) < enough && width < most) width *= kGrows;
  double worst = 0.0;
  for (const double side : {-1.0, 0.0, 1.0})
    worst =
        std::max(worst, misfit_within(std::clamp(deflection + side * width, 0.0, response_.limit()), width));
  return worst;
}

// The magnitude of a straight line through the residuals around a deflection, evaluated there, and its
// standard deviation.
double CurveErrors::misfit_within(double deflection, double width) const {
  double n = 0.0, x = 0.0, xx = 0.0, y = 0.0, xy = 0.0;
  for (const Residual& r : residuals_) {
    const double off = r.deflection - deflection;
    if (std::abs(off) > width) continue;
    n += 1.0, x += off, xx += off * off, y += r.force, xy += off * r.force;
  }
  const double spread = n * xx - x * x;
  if (!(n > 2.0) || !(spread > 0.0)) return scatter_;
  return std::abs(xx * y - x * xy) / spread + scatter_ * std::sqrt(xx / spread);
}

// Neighbouring residuals are similar, because they mostly show the polynomial's misfit. So intervals come
// from a block bootstrap: each branch of each press in blocks, drawn with replacement. The seed is fixed and
// the engine's numbers are used directly, so one file gives equal intervals everywhere.
constexpr std::size_t kBlocks = 12;
constexpr std::size_t kFewest = 4;  // fewest readings of a block
constexpr int kDraws = 400;

std::vector<Quadratic> blocks_of(const LoopData& loop, double limit) {
  std::vector<Quadratic> blocks;
  for (const auto& press : loop.moving)
    for (const bool pressing : {true, false}) {
      std::vector<LoopPoint> branch;
      std::copy_if(press.begin(), press.end(), std::back_inserter(branch),
                   [&](const LoopPoint& p) { return p.pressing == pressing; });
      const std::size_t count = std::clamp<std::size_t>(branch.size() / kFewest, 1, kBlocks);
      for (std::size_t b = 0; b < count; ++b) {
        const std::size_t from = branch.size() * b / count;
        const std::size_t to = branch.size() * (b + 1) / count;
        blocks.push_back(normal_equations(std::span(branch).subspan(from, to - from), limit));
      }
    }
  return blocks;
}

// The refitted unknowns, a column for each draw.
Eigen::MatrixXd bootstrap(const LoopData& loop, double limit, const Constraints& all, double tolerance) {
  const std::vector<Quadratic> blocks = blocks_of(loop, limit);
  std::mt19937_64 random(1);
  std::vector<Eigen::VectorXd> drawn;
  for (int n = 0; n < kDraws; ++n) {
    Quadratic q{Eigen::MatrixXd::Zero(8, 8), Eigen::VectorXd::Zero(8)};
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const Quadratic& block = blocks[random() % blocks.size()];
      q.gram += block.gram;
      q.moment += block.moment;
    }
    // A draw that happens to leave out most of a branch does not determine it.
    if (Eigen::LLT<Eigen::MatrixXd>(q.gram).info() != Eigen::Success) continue;
    drawn.push_back(constrained_minimum(q, all, tolerance));
  }
  if (drawn.empty())
    throw Error("the readings lie at so few deflections that no part of them determines the curves", "loop");
  Eigen::MatrixXd x(8, static_cast<Eigen::Index>(drawn.size()));
  for (std::size_t n = 0; n < drawn.size(); ++n) x.col(static_cast<Eigen::Index>(n)) = drawn[n];
  return x;
}

// Half the distance between the 2.5 % and the 97.5 % quantile.
double half_width(const Eigen::RowVectorXd& values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
  };
  return 0.5 * (at(0.975) - at(0.025));
}

BranchEstimate known(const Quadratic& q, const Eigen::MatrixXd& drawn, const std::array<double, 4>& curve,
                     double limit, bool pressing, const CurveErrors& errors) {
  const Eigen::Index at = pressing ? 0 : 4;
  BranchEstimate k;
  const Eigen::MatrixXd x = drawn.middleRows(at, 4);
  for (std::size_t i = 0; i < 4; ++i)
    k.coefficients[i] = {curve[i], half_width(x.row(static_cast<Eigen::Index>(i))) /
                                       std::pow(limit, static_cast<double>(i + 1))};
  for (int i = 1; i * 1e-3 <= limit * (1.0 + 1e-9); ++i) {
    const double d = i * 1e-3;
    const double u = d / limit;
    const Eigen::RowVector4d powers(u, u * u, u * u * u, u * u * u * u);
    const double force = d * (curve[0] + d * (curve[1] + d * (curve[2] + d * curve[3])));
    k.curve.push_back({force, errors.half(d, half_width(powers * x))});
  }
  const Eigen::Matrix4d gram = q.gram.block<4, 4>(at, at);
  const Eigen::Vector4d scale = gram.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix4d scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  const Eigen::Vector4d eigen = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(scaled).eigenvalues();
  k.condition = eigen[3] / eigen[0];
  const Eigen::Matrix4d covariance = scaled.llt().solve(Eigen::Matrix4d::Identity());
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) {
      const double c = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
      if (std::abs(c) <= std::abs(k.correlation)) continue;
      k.correlation = c;
      k.tied = {j + 1, i + 1};
    }
  return k;
}

// Mean force of a press near a deflection, relative to the fitted curve; NaN without readings. A fast branch
// has few readings, so they are taken from a larger range.
double force_near(const std::vector<LoopPoint>& press, double d, bool pressing, const Response& response) {
  constexpr double kNear = 0.05e-3;         // m
  constexpr double kFarthest = 1.0 / 10.0;  // of the limit
  constexpr int kEnough = 3;
  double sum = 0.0;
  int count = 0;
  for (double near = kNear; count < kEnough && (near == kNear || near <= kFarthest * response.limit());
       near *= 2.0) {
    sum = 0.0;
    count = 0;
    for (const LoopPoint& p : press) {
      if (p.pressing != pressing || std::abs(p.deflection - d) > near) continue;
      sum += p.force - (pressing ? response.press(p.deflection) : response.release(p.deflection));
      ++count;
    }
  }
  return count > 0 ? sum / count : kUnset;
}

// Uncertainty between repeats alone, independent of the curve's shape: Student's interval of their mean at 1,
// 2, ... mm.
std::vector<double> known_by_repeats(const LoopData& loop, const Response& response, bool pressing) {
  std::vector<double> halves;
  for (int i = 1; i * 1e-3 <= response.limit() * (1.0 + 1e-9); ++i) {
    double sum = 0.0;
    double squares = 0.0;
    double n = 0.0;
    for (const auto& press : loop.moving) {
      const double force = force_near(press, i * 1e-3, pressing, response);
      if (std::isnan(force)) continue;
      sum += force;
      squares += force * force;
      n += 1.0;
    }
    const double variance = n > 2.0 ? std::max(0.0, squares - sum * sum / n) / (n - 1.0) : kUnset;
    halves.push_back(student(n - 1.0) * std::sqrt(variance / n));
  }
  return halves;
}

void find_repeatability(const LoopData& loop, const Response& response, LoopFit& fit) {
  constexpr double kStep = 0.25e-3;  // m
  for (int i = 1; i * kStep < response.limit(); ++i)
    for (const bool pressing : {true, false}) {
      const double d = i * kStep;
      double low = INFINITY;
      double high = -INFINITY;
      for (const auto& press : loop.moving) {
        const double force = force_near(press, d, pressing, response);
        if (std::isnan(force)) continue;
        low = std::min(low, force);
        high = std::max(high, force);
      }
      if (high - low <= fit.repeatability) continue;
      fit.repeatability = high - low;
      fit.repeatability_at = d;
    }
}

std::string source_of(const LoopFit& fit, const LoopData& loop) {
  return fmt::format(
      "{} `encounter fit`: {} presses, {} readings, {}to {:g} mm; slope {:.3f} to {:.2f} N/mm; RMSE press "
      "{:.3f}, release {:.3f} N (without constraints {:.3f}, {:.3f} N); stops {:.3f} N (without constraints "
      "{:.3f} N)",
      loop.remark.empty() ? "Of unknown origin." : loop.remark + ".", fit.presses, fit.readings,
      loop.notes.empty() ? "" : fmt::format("{}; ", fmt::join(loop.notes, "; ")), fit.response.limit * 1e3,
      fit.floor * 1e-3, fit.ceiling * 1e-3, fit.curves.rmse_press, fit.curves.rmse_release,
      fit.curves.rmse_press_free, fit.curves.rmse_release_free, fit.stops.rmse, fit.stops.rmse_free);
}

}  // namespace

LoopFit fit_loop(const LoopData& loop, const LoopFitOptions& options) {
  LoopFit fit;
  fit.presses = loop.presses.size();
  fit.floor = options.floor;
  std::vector<LoopPoint> all;
  for (const auto& press : loop.moving) all.insert(all.end(), press.begin(), press.end());
  fit.readings = all.size();
  fit.curves = fit_response(all, options.limit, options.floor);
  fit.ceiling = std::isnan(options.ceiling) ? fit_ceiling(fit.curves.spec) : options.ceiling;
  fit.stops = fit_stops(loop.presses, options.limit, options.floor, fit.ceiling);
  fit.response = fit.curves.spec;
  fit.response.stops = fit.stops.spec;
  fit.response = rounded(fit.response);
  // Both models must satisfy prepare(), whose check throws otherwise.
  const Response response(fit.response, options.floor);
  static_cast<void>(Response(fit.response, options.floor, Reversal::prandtl_ishlinskii));
  const Quadratic q = normal_equations(all, options.limit);
  double largest = options.floor * options.limit;
  for (const LoopPoint& p : all) largest = std::max(largest, std::abs(p.force));
  const double margin = 1e-5 * largest;
  const Eigen::MatrixXd drawn =
      bootstrap(loop, options.limit, renderable(options.floor, options.limit, margin), 0.01 * margin);
  fit.press = known(q, drawn, fit.response.press, options.limit, true, CurveErrors(loop, response, true));
  fit.release =
      known(q, drawn, fit.response.release, options.limit, false, CurveErrors(loop, response, false));
  fit.press.repeats = known_by_repeats(loop, response, true);
  fit.release.repeats = known_by_repeats(loop, response, false);
  find_repeatability(loop, response, fit);
  fit.source = source_of(fit, loop);
  return fit;
}

}  // namespace enc::models
