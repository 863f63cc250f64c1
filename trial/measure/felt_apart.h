// How far apart two runs of one scene are in what is felt along the surface's normal, tick by tick and over a
// frame of vision: what a disturbance such as jitter changes.
#pragma once

#include <vector>

#include "trial/trial.h"

namespace enc::trial {

// What was felt in each tick, N; unset where that was no contact.
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
  std::size_t ticks = 0;  // in which both were in contact
  // Greatest of one tick, N. The encoders' steps are in it: a contact that is 1 ms later has them in other
  // ticks.
  double tick = 0.0;
  double frame = 0.0;  // greatest of the means over a frame, in all of which both were in contact, N
};
// `frame`: ticks.
[[nodiscard]] FeltApart felt_apart(const FeltWay& one, const FeltWay& other, std::size_t frame);

}  // namespace enc::trial
