// Linear model of the admittance loop: force sensor -> filter -> object -> machine -> hand. It predicts the
// softest object that the loop renders stably [sources/hexapod 5, VHMR Fig 3].
//
//   1 + Z(s) G(s) H(s) e^{-s Td} / k = 0,   Z = m s^2 + b s + k_hand,  G = servo (2nd order),
//   H = force filter (1st order)
//
// The softest stable stiffness is the largest -Re(Z G H e^{-s Td}) over the frequencies at which its
// imaginary part vanishes.
#pragma once

namespace enc {

struct LoopModel {
  // N/m, stiffness of the hand at the frequency of the limit: the grip, not the arm.
  double hand_stiffness = 700.0;
  double hand_damping = 4.0;   // N s/m
  double moved_mass = 0.0;     // kg, behind the sensor, not compensated
  double filter_hz = 5.0;      // force filter, 1st order
  double servo_hz = 15.0;      // machine's position loop, natural frequency
  double servo_damping = 0.8;  // position loop's damping ratio
  double delay = 0.005;        // s, all dead time of the loop
};

// N/m; 0 if the loop is stable for every stiffness.
[[nodiscard]] double lowest_stable_stiffness(const LoopModel& loop);

}  // namespace enc
