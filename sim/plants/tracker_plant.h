// Plants of the trackers: an optical tracker, and the noise of a fingertip that a stereo camera sees.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "core/base/time.h"
#include "sim/spec/sensor_spec.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

// A stereo head that measures single points, with the errors of matching: a point in C becomes a position in
// the left image and a disparity, and these become a point again [VisHap 2.1; sources/tracking 7]. It uses no
// images: the tip counts as found, with the noise of CameraTruth.

// Image of a point, px: column and row in the left image from its upper left pixel, and the disparity, left
// column minus right column.
struct StereoPixel {
  double column = kUnset, row = kUnset, disparity = kUnset;
};

class StereoPoints {
 public:
  StereoPoints(const CameraTruth& truth, std::uint64_t seed);

  // Projection without errors. Empty if the point is behind the cameras or outside of either image.
  [[nodiscard]] std::optional<StereoPixel> project(const Point<'C'>& point) const;
  // The point with that image; NaN if the disparity is not positive.
  [[nodiscard]] Point<'C'> triangulate(const StereoPixel& pixel) const;
  // Scatter of a point by the noise of one frame, rms along the axes of C, m: to first order.
  [[nodiscard]] Vec<'C'> scatter(const Point<'C'>& point) const;

  // Call this when the object has moved: draws the errors that stay until it moves again.
  void move();
  // One frame of the point.
  [[nodiscard]] std::optional<Point<'C'>> see(const Point<'C'>& point);

 private:
  CameraTruth truth_;
  Stream frames_, places_;
  Vec3 standing_{0, 0, 0};  // column, row and disparity, px
};

// The optical tracker and its data path: exposure, host, server tick, process and UDP delay, loss [VHMR 2,
// 4.1; sources/tracking 3].
class TrackerPlant {
 public:
  struct Packet {
    Measurement<TrackedTool> sample;
    Time due{};  // arrival at the core
    bool waiting = false;
  };
  struct State {
    Stream noise;
    DueTimes exposure, server;
    std::array<Packet, 64> exposed;      // poses on their way to the server
    Measurement<TrackedTool> at_server;  // newest pose at the server
    Time sent{};                         // stamp of the newest packet sent
    std::array<Packet, 64> on_wire;
    Pose<'W', 'T'> before;  // the tool one tick ago, because exposures lie between ticks
    std::int32_t tool_before = -1;
    Time before_t{};
    Measurement<TrackedTool> arrived;  // newest pose at the core
    bool news = false;
    std::int64_t dropped = 0;  // packets lost
  };
  // `markers`: of each tool in T. Without them the tool is given, and `marker_noise` is unused.
  TrackerPlant(const TrackerTruth& truth, const Pose<'W', 'C'>& X_WC, std::uint64_t seed,
               std::vector<std::vector<Vec3>> markers = {});

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  void advance(Time t, std::int32_t tool, const Pose<'W', 'T'>& X_WT);  // once a tick, with the true pose
  bool poll(Measurement<TrackedTool>& newest) noexcept;

 private:
  [[nodiscard]] TrackedTool by_markers(std::int32_t tool, const Pose<'W', 'T'>& X_WT);
  void expose(Time at, std::int32_t tool, const Pose<'W', 'T'>& X_WT);
  void poll_exposed(Time now);
  void send_ready(Time now);
  void transmit(const Measurement<TrackedTool>& sample, Time at);
  void deliver(Time now);

  TrackerTruth truth_;
  Pose<'C', 'W'> X_CW_;
  std::vector<std::vector<Vec3>> markers_;
  State state_;
};

// Equal noise of an upright tool's tip, in W, from a tracker with a given tool: `noise` includes the
// markers'.
[[nodiscard]] TrackerTruth with_tool_known(TrackerTruth truth, std::span<const Vec3> markers,
                                           const Vec3& tip);

}  // namespace enc::sim
