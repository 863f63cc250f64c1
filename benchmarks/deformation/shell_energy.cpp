#include "benchmarks/deformation/shell_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace enc::bench::deformation {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAir = 101325.0;  // Pa, outside
constexpr double kBulk = 500.0;    // bulk over shear modulus: Poisson's ratio 0.499

// Deformation gradient of a solid of revolution: dr/dR, dr/dZ, dz/dR, dz/dZ, r/R.
using Five = Eigen::Matrix<double, 5, 1>;
using FiveFive = Eigen::Matrix<double, 5, 5>;

double determinant(const Five& f) { return (f[0] * f[3] - f[1] * f[2]) * f[4]; }
Five determinant_gradient(const Five& f) {
  Five g;
  g << f[3] * f[4], -f[2] * f[4], -f[1] * f[4], f[0] * f[4], f[0] * f[3] - f[1] * f[2];
  return g;
}
FiveFive determinant_hessian(const Five& f) {
  FiveFive h = FiveFive::Zero();
  h(0, 3) = h(3, 0) = f[4];
  h(1, 2) = h(2, 1) = -f[4];
  h.col(4) << f[3], -f[2], -f[1], f[0], 0.0;
  h.row(4) = h.col(4).transpose();
  return h;
}

// A neo-Hookean, incompressible shell of radii A < B that a gauge pressure p has widened to a and b has
// A^3 = a^3 - c, B^3 = b^3 - c; with stretches l = r / R: p / mu = (2/l + 1/(2 l^4)) at b less that at a.
double widened_by(double a, double b, double shear, double pressure) {
  const auto part = [](double radius, double c) {
    const double back = std::cbrt(1.0 - c / (radius * radius * radius));  // 1 / l
    return 2.0 * back + 0.5 * std::pow(back, 4);
  };
  double low = 0.0;
  double high = 0.9 * a * a * a;
  for (int i = 0; i < 100; ++i) {
    const double c = 0.5 * (low + high);
    (shear * (part(b, c) - part(a, c)) < pressure ? low : high) = c;
  }
  return low;
}

// Polar angles of the columns: even where the probe bends the wall, then growing to four times that.
std::vector<double> columns(double radius, double fine) {
  constexpr double kEven = 20e-3;  // m of arc
  constexpr double kGrown = 15e-3;
  const double last = kClamped * kPi / 180.0;
  std::vector<double> angles{0.0};
  while (angles.back() < last) {
    const double arc = angles.back() * radius;
    const double grown = 1.0 + 3.0 * std::clamp((arc - kEven) / kGrown, 0.0, 1.0);
    angles.push_back(angles.back() + grown * fine / radius);
  }
  const double fit = last / angles.back();
  for (double& angle : angles) angle *= fit;
  return angles;
}

}  // namespace

ShellMesh shell_mesh(const sim::BallParameters& ball, int through, double fine) {
  const double outer = ball.outer_radius - ball.felt;
  const double inner = outer - ball.wall;
  const double c = widened_by(inner, outer, ball.rubber_modulus / 3.0, ball.pressure);
  const std::vector<double> angles = columns(outer, fine);
  ShellMesh mesh{static_cast<int>(angles.size()) - 1, through, {}, {}, 0.0};
  for (const double angle : angles)
    for (int k = 0; k <= through; ++k) {
      const double radius = outer - ball.wall * k / through;
      const Vec2 out(std::sin(angle), std::cos(angle));
      mesh.inflated.emplace_back(radius * out);
      mesh.stress_free.emplace_back(std::cbrt(radius * radius * radius - c) * out);
    }
  const double height = inner * (1.0 + std::cos(angles.back()));
  mesh.below = kPi * height * height * (3.0 * inner - height) / 3.0;
  return mesh;
}

struct ShellEnergy::Sum {
  Value value;
  const std::vector<bool>& fixed;
  std::vector<Eigen::Triplet<double>> entries;

  template <class Nodes, class Gradient, class Hessian>
  void add(const Nodes& nodes, const Gradient& gradient, const Hessian& hessian) {
    const auto place = [&](int a) { return 2 * nodes[static_cast<std::size_t>(a / 2)] + a % 2; };
    const int size = 2 * static_cast<int>(nodes.size());
    for (int a = 0; a < size; ++a) {
      const int row = place(a);
      if (fixed[static_cast<std::size_t>(row)]) continue;
      value.gradient[row] += gradient[a];
      for (int b = 0; b < size; ++b)
        if (!fixed[static_cast<std::size_t>(place(b))]) entries.emplace_back(row, place(b), hessian(a, b));
    }
  }
};

ShellEnergy::ShellEnergy(const sim::BallParameters& ball, ShellMesh mesh)
    : ball_(ball), mesh_(std::move(mesh)), fixed_(2 * mesh_.inflated.size(), false) {
  press(0.0);
  full_ = gas_volume(inflated());
  for (int k = 0; k <= mesh_.through; ++k) {
    const auto pole = static_cast<std::size_t>(2 * mesh_.node(0, k));
    const auto mount = static_cast<std::size_t>(2 * mesh_.node(mesh_.along, k));
    fixed_[pole] = fixed_[mount] = fixed_[mount + 1] = true;
  }
  const double g = 1.0 / std::sqrt(3.0);
  for (int element = 0; element < mesh_.along * mesh_.through; ++element) {
    const Corners c = corners(element);
    const auto at = [&](double s, double t) { return gauss(mesh_.stress_free, c, s, t); };
    points_.push_back({at(-g, -g), at(g, -g), at(g, g), at(-g, g)});
  }
}

void ShellEnergy::press(double deflection) { centre_ = ball_.outer_radius - deflection + ball_.probe_radius; }

Eigen::VectorXd ShellEnergy::inflated() const {
  Eigen::VectorXd x(2 * static_cast<Eigen::Index>(mesh_.inflated.size()));
  Eigen::Index i = 0;
  for (const Vec2& node : mesh_.inflated) x.segment<2>(2 * i++) = node;
  return x;
}

ShellEnergy::Corners ShellEnergy::corners(int element) const {
  const int i = element / mesh_.through;
  const int k = element % mesh_.through;
  return {mesh_.node(i, k), mesh_.node(i + 1, k), mesh_.node(i + 1, k + 1), mesh_.node(i, k + 1)};
}

ShellEnergy::Gauss ShellEnergy::gauss(const std::vector<Vec2>& nodes, const Corners& corners, double s,
                                      double t) {
  const Eigen::Vector4d sign_s(-1, 1, 1, -1);
  const Eigen::Vector4d sign_t(-1, -1, 1, 1);
  const Eigen::Array4d in_s = 1.0 + s * sign_s.array();
  const Eigen::Array4d in_t = 1.0 + t * sign_t.array();
  const Eigen::Vector4d shape = 0.25 * in_s * in_t;
  Eigen::Matrix<double, 4, 2> slope;
  slope << 0.25 * sign_s.array() * in_t, 0.25 * sign_t.array() * in_s;
  Eigen::Matrix<double, 4, 2> at;
  for (int a = 0; a < 4; ++a)
    at.row(a) = nodes[static_cast<std::size_t>(corners[static_cast<std::size_t>(a)])];
  const Eigen::Matrix2d jacobian = at.transpose() * slope;
  const Eigen::Matrix<double, 4, 2> by_place = slope * jacobian.inverse();
  const double radius = shape.dot(at.col(0));
  Gauss point{Eigen::Matrix<double, 5, 8>::Zero(), 2.0 * kPi * radius * std::abs(jacobian.determinant())};
  for (int a = 0; a < 4; ++a) {
    point.slope(0, 2 * a) = point.slope(2, 2 * a + 1) = by_place(a, 0);
    point.slope(1, 2 * a) = point.slope(3, 2 * a + 1) = by_place(a, 1);
    point.slope(4, 2 * a) = shape[a] / radius;
  }
  return point;
}

// Per volume mu/2 (F:F - 3) - mu ln J, and K/2 (mean J - 1)^2 of each element.
bool ShellEnergy::rubber(const Eigen::VectorXd& x, Sum& sum) const {
  using Eight = Eigen::Matrix<double, 8, 1>;
  using EightEight = Eigen::Matrix<double, 8, 8>;
  const double shear = ball_.rubber_modulus / 3.0;
  const double bulk = kBulk * shear;
  for (int element = 0; element < mesh_.along * mesh_.through; ++element) {
    const auto& points = points_[static_cast<std::size_t>(element)];
    const Corners nodes = corners(element);
    Eight place;
    for (int a = 0; a < 4; ++a)
      place.segment<2>(2 * a) = x.segment<2>(2 * nodes[static_cast<std::size_t>(a)]);
    double volume = 0.0;
    double widened = 0.0;
    for (const Gauss& point : points) {
      volume += point.volume;
      widened += point.volume * determinant(point.slope * place);
    }
    const double dilatation = widened / volume - 1.0;
    sum.value.energy += 0.5 * bulk * dilatation * dilatation * volume;
    Eight gradient = Eight::Zero();
    Eight swelling = Eight::Zero();  // gradient of `widened`
    EightEight hessian = EightEight::Zero();
    for (const Gauss& point : points) {
      const Five f = point.slope * place;
      const double j = determinant(f);
      if (!(j > 0.0)) return false;
      const Five g = determinant_gradient(f);
      sum.value.energy += point.volume * shear * (0.5 * (f.squaredNorm() - 3.0) - std::log(j));
      gradient += point.volume * point.slope.transpose() * (shear * (f - g / j));
      swelling += point.volume * point.slope.transpose() * g;
      const FiveFive stiffness = shear * (FiveFive::Identity() + g * g.transpose() / (j * j)) +
                                 (bulk * dilatation - shear / j) * determinant_hessian(f);
      hessian += point.volume * point.slope.transpose() * stiffness * point.slope;
    }
    gradient += bulk * dilatation * swelling;
    hessian += bulk / volume * swelling * swelling.transpose();
    sum.add(nodes, gradient, hessian);
  }
  return true;
}

// Cut into truncated cones: pi/3 (r1^2 + r1 r2 + r2^2) (z1 - z2) each.
double ShellEnergy::gas_volume(const Eigen::VectorXd& x) const {
  double volume = mesh_.below;
  for (int i = 0; i < mesh_.along; ++i) {
    const Vec2 a = x.segment<2>(2 * mesh_.node(i, mesh_.through));
    const Vec2 b = x.segment<2>(2 * mesh_.node(i + 1, mesh_.through));
    volume += kPi / 3.0 * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) * (a[1] - b[1]);
  }
  return volume;
}

// Isothermal: (p + p_air) V is constant.
void ShellEnergy::gas(const Eigen::VectorXd& x, Sum& sum) const {
  const double volume = gas_volume(x);
  const double filling = (ball_.pressure + kAir) * full_;
  const double gauge = filling / volume - kAir;
  sum.value.energy += kAir * (volume - full_) - filling * std::log(volume / full_);
  sum.value.gas_stiffness = filling / (volume * volume);
  for (int i = 0; i < mesh_.along; ++i) {
    const std::array<int, 2> nodes{mesh_.node(i, mesh_.through), mesh_.node(i + 1, mesh_.through)};
    const Vec2 a = x.segment<2>(2 * nodes[0]);
    const Vec2 b = x.segment<2>(2 * nodes[1]);
    const double square = a[0] * a[0] + a[0] * b[0] + b[0] * b[0];
    const double down = a[1] - b[1];
    const double by_a = 2.0 * a[0] + b[0];  // of `square`
    const double by_b = 2.0 * b[0] + a[0];
    const Eigen::Vector4d gradient = kPi / 3.0 * Eigen::Vector4d(by_a * down, square, by_b * down, -square);
    Eigen::Matrix4d hessian;
    hessian << 2.0 * down, by_a, down, -by_a,  //
        by_a, 0.0, by_b, 0.0,                  //
        down, by_b, 2.0 * down, -by_b,         //
        -by_a, 0.0, -by_b, 0.0;
    for (int k = 0; k < 4; ++k) {
      const int place = 2 * nodes[static_cast<std::size_t>(k / 2)] + k % 2;
      if (!fixed_[static_cast<std::size_t>(place)]) sum.value.volume[place] += gradient[k];
    }
    sum.add(nodes, -gauge * gradient, -gauge * kPi / 3.0 * hessian);
  }
}

// Per area of the undeformed wall E_f t_f (-x - ln(1 - x)).
bool ShellEnergy::felt(const Eigen::VectorXd& x, Sum& sum) const {
  constexpr std::array<double, 4> kAt{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                      0.8611363115940526};
  constexpr std::array<double, 4> kWeight{0.3478548451374539, 0.6521451548625461, 0.6521451548625461,
                                          0.3478548451374539};
  for (int i = 0; i < mesh_.along; ++i) {
    const std::array<int, 2> nodes{mesh_.node(i, 0), mesh_.node(i + 1, 0)};
    const Vec2 from = mesh_.inflated[static_cast<std::size_t>(nodes[0])];
    const Vec2 to = mesh_.inflated[static_cast<std::size_t>(nodes[1])];
    for (std::size_t q = 0; q < kAt.size(); ++q) {
      const Eigen::Vector2d share(0.5 * (1.0 - kAt[q]), 0.5 * (1.0 + kAt[q]));
      const Vec2 off =
          share[0] * x.segment<2>(2 * nodes[0]) + share[1] * x.segment<2>(2 * nodes[1]) - probe_centre();
      const double distance = off.norm();
      const double squeezed = (ball_.felt - (distance - ball_.probe_radius)) / ball_.felt;
      if (squeezed <= 0.0) continue;
      if (squeezed >= 1.0) return false;
      const double area = kPi * kWeight[q] * (share[0] * from[0] + share[1] * to[0]) * (to - from).norm();
      const double pressure = ball_.felt_modulus * squeezed / (1.0 - squeezed);
      const double stiffness = ball_.felt_modulus / (ball_.felt * (1.0 - squeezed) * (1.0 - squeezed));
      const Vec2 n = off / distance;
      const Eigen::Matrix2d across = Eigen::Matrix2d::Identity() - n * n.transpose();
      const Eigen::Matrix2d one = area * (stiffness * n * n.transpose() - pressure / distance * across);
      Eigen::Vector4d gradient;
      gradient << share[0] * n, share[1] * n;
      Eigen::Matrix4d hessian;
      hessian << share[0] * share[0] * one, share[0] * share[1] * one,  //
          share[0] * share[1] * one, share[1] * share[1] * one;
      sum.value.energy += area * ball_.felt_modulus * ball_.felt * (-squeezed - std::log1p(-squeezed));
      sum.value.probe_force -= area * pressure * n[1];
      sum.add(nodes, -area * pressure * gradient, hessian);
    }
  }
  return true;
}

ShellEnergy::Value ShellEnergy::at(const Eigen::VectorXd& x) const {
  Sum sum{{}, fixed_, {}};
  sum.entries.reserve(points_.size() * 64 + static_cast<std::size_t>(mesh_.along) * 80);
  sum.value.gradient = sum.value.volume = Eigen::VectorXd::Zero(x.size());
  if (!rubber(x, sum) || !felt(x, sum)) {
    sum.value.energy = std::numeric_limits<double>::infinity();
    return sum.value;
  }
  gas(x, sum);
  for (int i = 0; i < static_cast<int>(x.size()); ++i)
    if (fixed_[static_cast<std::size_t>(i)]) sum.entries.emplace_back(i, i, 1.0);
  sum.value.hessian.resize(x.size(), x.size());
  sum.value.hessian.setFromTriplets(sum.entries.begin(), sum.entries.end());
  return sum.value;
}

}  // namespace enc::bench::deformation
