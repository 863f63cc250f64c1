// A tracker whose results arrive at irregular times, as from a thread. Results and stamps are unchanged, but
// each arrives at a random time around its due time. It is for virtual time, where it is repeatable.
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
    Duration latency{};  // time from the stamp to the due time
    Duration jitter{};   // largest deviation from the due time, either way
    std::uint64_t seed = 1;
  };
  // `tracker` must return its results at the exposure or soon after (its own latency 0), so that a result can
  // arrive before its due time. A result never arrives before the tracker has it, nor before an older one,
  // because a thread works on one after the other.
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
