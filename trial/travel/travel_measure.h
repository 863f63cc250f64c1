// Tracking error of a tool that the machine carries [VHMR 4.1, Table 1]: the tracked tip through the rig's
// calibration, minus the machine's reported tip, for each new packet. It uses only the core's inputs, no
// ground truth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trial/trial_options.h"

namespace enc::trial {

// The machine counts as moving above this speed, m/s.
inline constexpr double kMoving = 1e-3;

struct Errors {
  double rmse = 0.0, mae = 0.0, bias = 0.0;  // m; sources/choices 10
};

// One packet: time, position along the axis, error along it, and the direction of motion.
enum class Moving : std::int8_t { back = -1, stopped = 0, forward = 1 };
struct PacketError {
  double t = 0.0, position = 0.0, error = 0.0;  // s, m, m
  Moving moving = Moving::stopped;
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
