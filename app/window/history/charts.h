// The strip charts of the window: force, deflection and gap, energy over the last seconds before the moment
// that is shown.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/view/recorded/still.h"
#include "sim/view/view.h"

namespace enc::app {

// What the strip charts show of a tick.
struct ChartSample {
  float t = 0.0F;                                             // s
  float measured = 0.0F, filtered = 0.0F, true_force = 0.0F;  // N, along the surface's normal
  float deflection = 0.0F, gap = 0.0F;                        // mm
  float energy = 0.0F;                                        // mJ, of the hand into the contact so far
};

// Takes consecutive ticks.
class Sampler {
 public:
  static constexpr std::int64_t kEach = 5;  // ticks, of the samples that charts show
  [[nodiscard]] ChartSample sample(const trial::Glance& glance);

 private:
  double energy_ = 0.0;  // J
};

class Charts {
 public:
  explicit Charts(std::size_t most) : most_(most) {}  // samples that are kept

  void add(const ChartSample& sample);
  // Up to the moment `end`, s. `cursor`: s, negative, of the values to be read out; unset: the newest.
  // `truth`: the true force is known.
  [[nodiscard]] std::vector<sim::ViewChart> until(double end, std::optional<double> cursor, bool truth) const;

  static constexpr float kSpan = 6.0F;  // s

 private:
  std::size_t most_;
  std::deque<ChartSample> samples_;
};

}  // namespace enc::app
