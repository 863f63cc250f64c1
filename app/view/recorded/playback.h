// A record for the window: the core runs again over the devices' data, beside the twin of the recorded scene,
// which supplies the data that no device measures.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "app/view/recorded/still.h"
#include "core/record/record.h"
#include "trial/steered/steering_log.h"

namespace enc::app {

class Playback {
 public:
  // Throws Error for a record that cannot be read or run again.
  explicit Playback(const std::string& path);
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  [[nodiscard]] trial::Trial& trial() { return *trial_; }
  [[nodiscard]] const trial::Trial& trial() const { return *trial_; }
  [[nodiscard]] const models::Setup& setup() const { return trial_->setup(); }
  [[nodiscard]] std::int64_t ticks() const { return record_.ticks(); }
  // True if all devices were simulated and the hand's motion is known: tool, tip and truth are then the
  // twin's. Otherwise they are those reported by the devices.
  [[nodiscard]] bool simulated() const { return simulated_; }
  [[nodiscard]] const RecordedTick& frame() const { return frame_; }

  // Reason why the pictures may differ from the actual run, as far as the record was played; empty: they are
  // accurate.
  [[nodiscard]] const std::string& doubt() const { return doubt_; }

  // Plays the next tick; false after the last. `see` gets it with the twin at that tick.
  bool next(const std::function<void(const trial::Glance&)>& see);

 private:
  [[nodiscard]] trial::TrialOptions options();

  RecordReader record_;
  RecordedTick frame_;
  trial::SteeringLog hand_;
  bool simulated_ = true;
  std::string doubt_;
  std::int64_t first_difference_ = -1;  // first tick at which the core's result differs from the record
  std::function<void(const trial::Glance&)> see_;
  std::unique_ptr<trial::Trial> trial_;
};

}  // namespace enc::app
