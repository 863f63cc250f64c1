// A window's history of a run: the strip charts (force, deflection and gap, energy over the last seconds
// before the shown moment), and the stills.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/view/moment/moment.h"
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

// The stills of a run in order of time, and the shown one: the newest, or an earlier one.
class Timeline {
 public:
  // `most`: number of stills kept; the oldest go first.
  explicit Timeline(std::size_t most) : most_(most) {}

  void add(const RunSnapshot& still);
  [[nodiscard]] bool empty() const { return stills_.empty(); }
  [[nodiscard]] const RunSnapshot& shown() const { return at(shown_); }
  [[nodiscard]] const RunSnapshot& newest() const { return at(end() - 1); }
  // True if a still before the newest is shown.
  [[nodiscard]] bool past() const { return !stills_.empty() && shown_ + 1 < end(); }

  void seek(double share);     // 0: the oldest; 1: the newest, and all following ones
  void step(int stills);       // moves forward; negative: back
  void go_on(double seconds);  // continues from the shown still; at most to the newest
  void to_change();            // goes to the next change of mode; else to the newest
  void show_newest() { seek(1.0); }

  // The bar with the shown moment, and with contacts and holds as marks.
  [[nodiscard]] sim::ViewBar bar() const;

 private:
  // Number of a still, counted from the first one ever added.
  using Number = std::int64_t;
  [[nodiscard]] Number begin() const { return dropped_; }
  [[nodiscard]] Number end() const { return dropped_ + static_cast<Number>(stills_.size()); }
  [[nodiscard]] const RunSnapshot& at(Number n) const { return stills_[static_cast<std::size_t>(n) % most_]; }
  void show(Number n);

  std::size_t most_;
  std::vector<RunSnapshot> stills_;  // a ring once it is full
  Number dropped_ = 0, shown_ = 0;
  double rest_ = 0.0;  // s of go_on() that were too short for another still
};

[[nodiscard]] inline double seconds_of(const RunSnapshot& still) {
  return seconds(still.now.t.time_since_epoch());
}

}  // namespace enc::app
