// Results of the tests that a machine makes without a hand: indentation test and tracking test.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trial/lists/room.h"
#include "trial/trial.h"
#include "trial/trial_options.h"

namespace enc::trial {

// ---- indentation test: peak force, loss, agreement of repeats, accuracy of the measured force
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

// ---- tracking test of a tool that the machine carries [VHMR 4.1, Table 1]: the tracked tip through the
// rig's calibration, minus the machine's reported tip, for each new packet. It uses only the core's inputs,
// no ground truth. The machine counts as moving above this speed, m/s.
inline constexpr double kMoving = 1e-3;

struct Errors {
  double rmse = 0.0, mae = 0.0, bias = 0.0;  // m; sources/choices 10
};

// One packet: time, position along the axis, error along it, and the direction of motion.
enum class MotionDirection : std::int8_t { back = -1, stopped = 0, forward = 1 };
struct PacketError {
  double t = 0.0, position = 0.0, error = 0.0;  // s, m, m
  MotionDirection moving = MotionDirection::stopped;
  std::int32_t axis = 0;  // axis of W
};

// Sums over the packets that count, in the terms of sources/choices 10.
class ErrorSum {
 public:
  void add(double error);
  void add(const ErrorSum& other);
  [[nodiscard]] Errors errors() const;  // unset if nothing was added
  [[nodiscard]] std::int64_t size() const { return n_; }

 private:
  double sum_ = 0.0, size_ = 0.0, square_ = 0.0;
  std::int64_t n_ = 0;
};

struct TravelSums {
  std::array<ErrorSum, 3> stopped, forward, back;  // each axis of W, along that axis
  double largest = 0.0;                            // m, length of the whole error, at any time
  std::vector<PacketError> packets;                // if they are kept
  void add(const TravelSums& other);
  [[nodiscard]] std::int64_t size() const;  // packets that count
};

class TravelMeasure {
 public:
  explicit TravelMeasure(bool keeps_packets = false) : keeps_(keeps_packets) {}

  void see(const Glance& glance);
  [[nodiscard]] const TravelSums& sums() const { return sums_; }

 private:
  void count(PacketError packet, double speed, bool at_rest);

  bool keeps_;
  TravelSums sums_;
  Time stamp_{};
  double moved_ = 0.0;  // s, time of the last motion
};

}  // namespace enc::trial
