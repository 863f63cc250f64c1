#include "benchmarks/deformation/shell_press.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "core/base/error.h"

namespace enc::bench::deformation {
namespace {

constexpr double kBalanced = 1e-7;  // N

double largest(const Eigen::VectorXd& v) { return v.lpNorm<Eigen::Infinity>(); }

// Newton's step; the gas couples all nodes of the inside, which is a change of rank one [Sherman, Morrison].
bool newton_step(const ShellEnergy::Value& value, Eigen::VectorXd& step) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(value.hessian);
  if (factors.info() != Eigen::Success) return false;
  const Eigen::VectorXd free = factors.solve(value.gradient);
  const Eigen::VectorXd swell = factors.solve(value.volume);
  const double share =
      value.gas_stiffness * value.volume.dot(free) / (1.0 + value.gas_stiffness * value.volume.dot(swell));
  step = share * swell - free;
  return step.allFinite();
}

// Moves x to the state of rest; false where that fails.
bool settle(const ShellEnergy& energy, Eigen::VectorXd& x, ShellEnergy::Value& value) {
  value = energy.at(x);
  for (int i = 0; i < 40 && std::isfinite(value.energy); ++i) {
    if (largest(value.gradient) < kBalanced) return true;
    Eigen::VectorXd step;
    if (!newton_step(value, step)) return false;
    const double before = value.gradient.norm();
    const double was = value.energy;
    const auto better = [&] {
      return std::isfinite(value.energy) && (value.energy < was || value.gradient.norm() < before);
    };
    double share = 2.0;
    for (int halved = 0; halved == 0 || (halved < 11 && !better()); ++halved) {
      share *= 0.5;
      value = energy.at(x + share * step);
    }
    if (!better()) return false;
    x += share * step;
  }
  return false;
}

// The felt rides on the wall with its own thickness along the wall's normal; what would be inside the probe
// and the shaft above it, of the same radius, is pushed straight down onto the probe.
Contour felt_contour(const ShellEnergy& energy, const sim::BallParameters& ball, const Eigen::VectorXd& x) {
  const ShellMesh& mesh = energy.mesh();
  const auto at = [&](int i) { return Vec2(x.segment<2>(2 * mesh.node(i, 0))); };
  const auto pushed = [&](const Vec2& p) {
    const double under = ball.probe_radius * ball.probe_radius - p[0] * p[0];
    return under > 0.0 ? Vec2(p[0], std::min(p[1], energy.probe_centre()[1] - std::sqrt(under))) : p;
  };
  Contour contour;
  contour.reserve(static_cast<std::size_t>(mesh.along) + 3);
  Vec2 last = Vec2::Zero();
  bool touched = true;  // at the pole
  for (int i = 0; i <= mesh.along; ++i) {
    // Mirrored at the axis; one-sided at the mount.
    const Vec2 before = i > 0 ? at(i - 1) : Vec2(-at(1)[0], at(1)[1]);
    const Vec2 tangent = at(std::min(i + 1, mesh.along)) - before;
    const Vec2 point = at(i) + ball.felt * Vec2(-tangent[1], tangent[0]).normalized();
    const bool touches = pushed(point) != point;
    if (i > 0 && touched && !touches) {  // where it leaves the probe there is a corner
      Vec2 in = last;
      Vec2 out = point;
      for (int k = 0; k < 50; ++k) {
        const Vec2 middle = 0.5 * (in + out);
        (pushed(middle) == middle ? out : in) = middle;
      }
      contour.push_back(pushed(in));
      contour.push_back(out);
    }
    contour.push_back(pushed(point));
    last = point;
    touched = touches;
  }
  return contour;
}

}  // namespace

std::vector<PressedShell> press_shell(const sim::BallParameters& ball, int through, double fine,
                                      const std::vector<double>& depths) {
  constexpr double kStep = 0.25e-3;  // m, of the probe
  ShellEnergy energy(ball, shell_mesh(ball, through, fine));
  Eigen::VectorXd x = energy.inflated();
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(x.size());  // dx over the probe's way
  ShellEnergy::Value value;
  double now = 0.0;
  double step = kStep;
  std::vector<PressedShell> states;
  for (const double depth : depths) {
    while (now < depth) {
      const double way = std::min(step, depth - now);
      energy.press(now + way);
      Eigen::VectorXd to = x + way * slope;
      if (!settle(energy, to, value)) {
        step = 0.5 * way;
        if (step < 1e-6)
          throw Error(
              fmt::format("no state of rest of the ball at a deflection of {:.3f} mm; use other "
                          "parameters",
                          1e3 * (now + way)));
        continue;
      }
      slope = (to - x) / way;
      x = to;
      now = depth - now - way < 1e-12 ? depth : now + way;
      step = std::min(kStep, 2.0 * step);
    }
    const int inside = energy.mesh().node(0, through);
    const double inner = ball.outer_radius - ball.felt - ball.wall;
    states.push_back({depth, value.probe_force, largest(value.gradient), inner - x[2 * inside + 1],
                      felt_contour(energy, ball, x)});
  }
  return states;
}

}  // namespace enc::bench::deformation
