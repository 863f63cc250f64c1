// Difference of two runs of one scene in the force along the surface's normal, tick by tick and over a frame
// of vision: the effect of a disturbance such as jitter.
#pragma once

#include <vector>

#include "trial/trial.h"

namespace enc::trial {

// Force in each tick, N; unset without a contact.
class FeltWay {
 public:
  void see(const Glance& glance) {
    felt_.push_back(glance.out.mode == Mode::contact ? glance.out.force.xyz[2] : kUnset);
  }
  [[nodiscard]] const std::vector<double>& felt() const { return felt_; }

 private:
  std::vector<double> felt_;
};

struct FeltApart {
  std::size_t ticks = 0;  // ticks in which both were in contact
  // Largest difference in one tick, N. It includes the encoders' steps: a contact 1 ms later has them in
  // other ticks.
  double tick = 0.0;
  // Largest difference of the means over a frame in which both were in contact throughout, N.
  double frame = 0.0;
};
// `frame`: ticks.
[[nodiscard]] FeltApart felt_apart(const FeltWay& one, const FeltWay& other, std::size_t frame);

}  // namespace enc::trial
