// Evaluates the pushes of an indentation test: peak force, loss, agreement of repeats, accuracy of the
// measured force.
#pragma once

#include <array>
#include <vector>

#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

// One push and its way back, as measured: unfiltered force along the axis at the measured deflection.
struct PushFigures {
  double peak_force = 0.0;               // N
  double peak_deflection = 0.0;          // m
  double work_in = 0.0, work_out = 0.0;  // J, going in and coming back
  [[nodiscard]] double loss() const { return work_in > 0.0 ? 1.0 - work_out / work_in : kUnset; }
};

class ProbeMeasure {
 public:
  void see(const Glance& glance);

  [[nodiscard]] const std::vector<PushFigures>& pushes() const { return pushes_; }
  // Largest difference of force between pushes at equal deflection and direction, N; unset for fewer than two
  // pushes.
  [[nodiscard]] double spread() const;
  // Largest difference of measured and true force along the axis in a push, N.
  [[nodiscard]] double force_error() const { return force_error_; }

 private:
  struct Range {
    double low = kUnset, high = kUnset;  // N
    int pushes = 0;
    void add(double force);
  };
  static constexpr double kLevel = 0.1e-3;  // m: step of the deflections at which pushes are compared
  void compare(double deflection, double force);

  std::vector<PushFigures> pushes_ = with_room<PushFigures>();
  std::array<std::vector<Range>, 2> levels_{with_room<Range>(), with_room<Range>()};  // going in, coming back
  double deflection_ = kUnset, force_ = kUnset;  // one tick ago, within the same push
  double force_error_ = 0.0;
};

}  // namespace enc::trial
