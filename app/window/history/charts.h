// The strip charts of the window: force, deflection and gap, energy over the last seconds before the shown
// moment.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/view/recorded/still.h"
#include "sim/view/view.h"

namespace enc::app {

// The values of a tick in the strip charts.
struct ChartSample {
  float t = 0.0F;                                             // s
  float measured = 0.0F, filtered = 0.0F, true_force = 0.0F;  // N, along the surface's normal
  float deflection = 0.0F, gap = 0.0F;                        // mm
  float energy = 0.0F;                                        // mJ, work of the hand on the contact so far
};

// Takes consecutive ticks.
class Sampler {
 public:
  static constexpr std::int64_t kEach = 5;  // ticks between the samples in the charts
  [[nodiscard]] ChartSample sample(const trial::Glance& glance);

 private:
  double energy_ = 0.0;  // J
};

class Charts {
 public:
  explicit Charts(std::size_t most) : most_(most) {}  // number of samples kept

  void add(const ChartSample& sample);
  // Charts up to the moment `end`, s. `cursor`: s, negative, selects the values to print; unset: the newest.
  // `truth`: the true force is known.
  [[nodiscard]] std::vector<sim::ViewChart> until(double end, std::optional<double> cursor, bool truth) const;

  static constexpr float kSpan = 6.0F;  // s

 private:
  std::size_t most_;
  std::deque<ChartSample> samples_;
};

}  // namespace enc::app
