// The pressed ball as a solid of revolution: potential energy of its rubber wall, of the gas in it and of the
// felt between wall and probe, with gradient and Hessian by the nodes' places.
//
// Rubber: neo-Hookean, four-node elements with one mean dilatation each (Q1P0), so that nearly incompressible
// rubber does not lock. Gas: isothermal. Felt: independent springs (Winkler) of pressure E_f x / (1 - x) at
// the compression x t_f, which is the felt's thickness less the gap between wall and probe. Felt locks at
// x = 1, so it is also the barrier that keeps the rigid, frictionless probe out. [sources/ball 2,
// sources/ball 3]
//
// Section through the axis: r sideways, z upwards, origin in the ball's middle; the probe comes from above.
#pragma once

#include <array>
#include <vector>

#include <Eigen/SparseCore>

#include "benchmarks/deformation/contour.h"
#include "sim/bodies/ball_plant.h"

namespace enc::bench::deformation {

// Nodes in columns from the outer to the inner side, the pole's first.
struct ShellMesh {
  int along = 0, through = 0;     // elements along the meridian and through the wall
  std::vector<Vec2> stress_free;  // m
  std::vector<Vec2> inflated;     // m, by the gas alone
  double below = 0.0;             // m^3, of the inside below the last column
  [[nodiscard]] int node(int i, int k) const { return i * (through + 1) + k; }
};

// The wall from the pole to the polar angle kClamped; below that the ball stands in its mount. Elements are
// `fine` (m) long under the probe and grow farther away.
inline constexpr double kClamped = 100.0;  // deg [sources/ball 2]
[[nodiscard]] ShellMesh shell_mesh(const sim::BallParameters& ball, int through, double fine);

class ShellEnergy {
 public:
  ShellEnergy(const sim::BallParameters& ball, ShellMesh mesh);

  // Puts the probe's lowest point `deflection` (m) below the undeformed felt.
  void press(double deflection);
  [[nodiscard]] Vec2 probe_centre() const { return {0.0, centre_}; }
  [[nodiscard]] const ShellMesh& mesh() const { return mesh_; }
  [[nodiscard]] Eigen::VectorXd inflated() const;  // r and z of each node, as `x` below

  // Of nodes that cannot move (the axis sideways, the mount) the gradient is 0 and the Hessian 1.
  struct Value {
    double energy = 0.0;  // J; infinite where an element is turned over or felt is locked: the rest is unset
    Eigen::VectorXd gradient;             // N
    Eigen::SparseMatrix<double> hessian;  // N/m, without the part gas_stiffness * volume * volume^T
    Eigen::VectorXd volume;               // gradient of the gas volume, m^2
    double gas_stiffness = 0.0;           // Pa/m^3
    double probe_force = 0.0;             // N, upwards
  };
  [[nodiscard]] Value at(const Eigen::VectorXd& x) const;

 private:
  struct Sum;
  struct Gauss {
    Eigen::Matrix<double, 5, 8> slope;  // deformation gradient from the places of the element's nodes
    double volume;
  };
  using Corners = std::array<int, 4>;
  static Gauss gauss(const std::vector<Vec2>& nodes, const Corners& corners, double s, double t);
  [[nodiscard]] Corners corners(int element) const;
  [[nodiscard]] bool rubber(const Eigen::VectorXd& x, Sum& sum) const;
  void gas(const Eigen::VectorXd& x, Sum& sum) const;
  [[nodiscard]] bool felt(const Eigen::VectorXd& x, Sum& sum) const;
  [[nodiscard]] double gas_volume(const Eigen::VectorXd& x) const;

  sim::BallParameters ball_;
  ShellMesh mesh_;
  double centre_ = 0.0;  // of the probe, z
  double full_ = 0.0;    // m^3, gas before the press
  std::vector<std::array<Gauss, 4>> points_;
  std::vector<bool> fixed_;
};

}  // namespace enc::bench::deformation
