// The sampled loop of a tip in all its directions, for sampled_loop.cpp. A push along the normal moves the
// tip sideways too, and there the law has its own spring and damper.
//
//   eta'' = -C eta' - W_n^T (k_h x_n + b_h x_n') + W^T F,   x = W eta      m_h acts on eta'' in this way too
//   F_i = -(K_i e_i + B_i r_i), filtered, held and late as in sampled_loop.h; i: the normal and two sides
#pragma once

#include "core/control/safety/certificate/sampled_loop.h"

namespace enc::certificate {

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
  Late late_;
  Eigen::Matrix<double, 6, 6> free_;  // change of eta and its rate over a period
  // Effect of the force that begins in the period, and of the last one.
  Eigen::Matrix<double, 6, 3> fresh_, old_;
};

}  // namespace enc::certificate
