// The optical tracker and its data path: exposure, host, server tick, process and UDP delay, loss [VHMR 2,
// 4.1; sources/tracking 3].
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/sample.h"
#include "core/base/time.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

class TrackerPlant {
 public:
  struct Packet {
    Stamped<TrackedTool> sample;
    Time due{};  // arrival at the core
    bool waiting = false;
  };
  struct State {
    Stream noise;
    Every exposure, server;
    std::array<Packet, 64> exposed;  // poses on their way to the server
    Stamped<TrackedTool> at_server;  // newest pose at the server
    Time sent{};                     // stamp of the newest packet sent
    std::array<Packet, 64> on_wire;
    Pose<'W', 'T'> before;  // the tool one tick ago, because exposures lie between ticks
    std::int32_t tool_before = -1;
    Time before_t{};
    Stamped<TrackedTool> arrived;  // newest pose at the core
    bool news = false;
    std::int64_t dropped = 0;  // packets lost
  };
  // `markers`: of each tool in T. Without them the tool is given, and `marker_noise` is unused.
  TrackerPlant(const TrackerTruth& truth, const Pose<'W', 'C'>& X_WC, std::uint64_t seed,
               std::vector<std::vector<Vec3>> markers = {});

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  void advance(Time t, std::int32_t tool, const Pose<'W', 'T'>& X_WT);  // once a tick, with the true pose
  bool poll(Stamped<TrackedTool>& newest) noexcept;

 private:
  [[nodiscard]] TrackedTool by_markers(std::int32_t tool, const Pose<'W', 'T'>& X_WT);
  void expose(Time at, std::int32_t tool, const Pose<'W', 'T'>& X_WT);
  void poll_exposed(Time now);
  void send_ready(Time now);
  void transmit(const Stamped<TrackedTool>& sample, Time at);
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
