// A record for the window: the core runs again over what the devices said, beside the twin of the recorded
// scene, which gives what no device says.
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
  // All devices were simulated, and it is known what the hand did: tool, tip and truth are the twin's. Else
  // they are where devices said.
  [[nodiscard]] bool simulated() const { return simulated_; }
  [[nodiscard]] const RecordedTick& frame() const { return frame_; }

  // Why the pictures may not be what happened, as far as the record was played; empty: they are.
  [[nodiscard]] const std::string& doubt() const { return doubt_; }

  // The next tick; false after the last. `see` gets it with the twin as it was.
  bool next(const std::function<void(const trial::Glance&)>& see);

 private:
  [[nodiscard]] trial::TrialOptions options();

  RecordReader record_;
  RecordedTick frame_;
  trial::SteeringLog hand_;
  bool simulated_ = true;
  std::string doubt_;
  std::int64_t first_difference_ = -1;  // tick of which the core says otherwise than the record
  std::function<void(const trial::Glance&)> see_;
  std::unique_ptr<trial::Trial> trial_;
};

}  // namespace enc::app
