// The sampled loop of a tip in all of its directions, for sampled_loop.cpp: a push along the normal moves the
// tip sideways too, and there the law has a spring and a damper of its own.
//
//   eta'' = -C eta' - W_n^T (k_h x_n + b_h x_n') + W^T F,   x = W eta      m_h likewise, on eta''
//   F_i = -(K_i e_i + B_i r_i), filtered, held and late as in sampled_loop.h; i: the normal and two sides
#pragma once

#include "core/control/safety/certificate/sampled_loop.h"

namespace enc::certificate {

class TipLoop {
 public:
  explicit TipLoop(const SampledLoop& loop);
  // The K along the normal, N/m, that puts an eigenvalue at e^{j angle}; possible where it is real.
  [[nodiscard]] std::complex<double> needed(double angle, const Damper& damper) const;
  // The step of everything that is remembered: eta, its rate, readings, filtered forces, forces under way.
  [[nodiscard]] Eigen::MatrixXd step(double stiffness, double damper) const;
  // Eigenvalues of it that are not within the unit circle. Counted without the matrix where that is large.
  [[nodiscard]] int outside(double stiffness, double damper) const;

 private:
  using Mat3c = Eigen::Matrix3cd;
  struct Response {
    Mat3c place;                // of the tip over its force, m/N, with the delay
    std::complex<double> free;  // det(I - A/z) of the device alone
  };
  [[nodiscard]] Response response(double angle) const;
  // Law along the normal and sideways at e^{j angle}, N/m.
  [[nodiscard]] std::complex<double> along(double angle, double stiffness, double damper) const;
  [[nodiscard]] std::complex<double> across(double angle, double stiffness, double damper) const;
  // det(I - S/z) of the step S.
  [[nodiscard]] std::complex<double> determinant(double angle, double stiffness, double damper) const;
  [[nodiscard]] double turned(double from, double to, std::complex<double> at_from,
                              std::complex<double> at_to, double stiffness, double damper, int depth) const;
  [[nodiscard]] int winding(double stiffness, double damper) const;

  const SampledLoop& loop_;
  Late late_;
  Eigen::Matrix<double, 6, 6> free_;         // what eta and its rate become in a period, less what they were
  Eigen::Matrix<double, 6, 3> fresh_, old_;  // by the force that begins in it, and by the one before
};

}  // namespace enc::certificate
