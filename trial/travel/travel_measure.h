// What the tracker says of a tool that the machine carries [VHMR 4.1, Table 1]: the tracked tip, through the
// believed calibration, less where the machine says it is, whenever a new packet has come. All of it is what
// the core is told: no truth is asked.
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

// One packet: time, place along the axis, error along it, and how it counts.
enum class Moving : std::int8_t { back = -1, stopped = 0, forward = 1 };
struct PacketError {
  double t = 0.0, position = 0.0, error = 0.0;  // s, m, m
  Moving moving = Moving::stopped;
  std::int32_t axis = 0;  // of W
};

// Sums of what counts, in the words of sources/choices 10.
class ErrorSum {
 public:
  void add(double error);
  void add(const ErrorSum& other);
  [[nodiscard]] Errors errors() const;  // unset where nothing was added
  [[nodiscard]] std::int64_t size() const { return n_; }

 private:
  double sum_ = 0.0, size_ = 0.0, square_ = 0.0;
  std::int64_t n_ = 0;
};

struct TravelSums {
  std::array<ErrorSum, 3> stopped, forward, back;  // of each axis of W, along it
  double largest = 0.0;                            // m, length of the whole error, any time
  std::vector<PacketError> packets;                // where they are kept
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
  double moved_ = 0.0;  // s, when last
};

}  // namespace enc::trial
