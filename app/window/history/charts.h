// The strip charts of the window: force, deflection and gap, energy over the last seconds before the moment
// that is shown.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/window/history/still.h"
#include "sim/view/view.h"

namespace enc::app {

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
