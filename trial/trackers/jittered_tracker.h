// A tracker whose results come at irregular times, as from a thread: the same results with the same stamps,
// each at a random time around the one at which it was due. For virtual time, where it is repeatable.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/devices/pose_tracker.h"
#include "sim/truth/random.h"

namespace enc::trial {

class JitteredTracker final : public PoseTracker {
 public:
  struct Spec {
    Duration latency{};  // from a stamp to when it is due
    Duration jitter{};   // earlier or later than that by at most so much
    std::uint64_t seed = 1;
  };
  // `tracker` tells at the exposure, or soon after (its own latency 0): so a result can come before it is
  // due. None comes before the tracker has it, and none before an older one, as a thread works on one after
  // the other.
  JitteredTracker(std::unique_ptr<PoseTracker> tracker, const Spec& spec)
      : tracker_(std::move(tracker)), spec_(spec), draw_(spec.seed, "jitter") {}

  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override {
    if (Stamped<TrackedTool> told; tracker_->poll(now, told) && count_ < line_.size()) {
      const double early_or_late = (2.0 * draw_.uniform() - 1.0) * seconds(spec_.jitter);
      last_ = std::max({last_, now, told.t + spec_.latency + from_seconds(early_or_late)});
      line_[(first_ + count_++) % line_.size()] = {told, last_};
    }
    bool due = false;
    for (; count_ > 0 && line_[first_].due <= now; --count_, due = true) {
      newest = line_[first_].told;
      first_ = (first_ + 1) % line_.size();
    }
    return due;
  }
  [[nodiscard]] std::string describe() const override { return tracker_->describe(); }
  [[nodiscard]] bool linked() const noexcept override { return tracker_->linked(); }
  [[nodiscard]] std::vector<std::string> remarks() const override { return tracker_->remarks(); }

 private:
  struct Waiting {
    Stamped<TrackedTool> told;
    Time due{};
  };
  std::unique_ptr<PoseTracker> tracker_;
  Spec spec_;
  sim::Stream draw_;
  std::array<Waiting, 64> line_;  // a ring
  std::size_t first_ = 0, count_ = 0;
  Time last_ = Time::min();
};

}  // namespace enc::trial
