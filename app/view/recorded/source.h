// The source of pictures and films: a run of a scene, or a record.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/common/options.h"
#include "app/view/moment/moment.h"
#include "core/record/record.h"
#include "trial/steered/steering.h"

namespace enc::app {

// A record for the window. The core runs again over the devices' data, beside the twin of the recorded scene.
// The twin supplies the data that no device measures.
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

class Source {
 public:
  // `how` applies to a run; a record has its own options. Throws Error, also for options that a record cannot
  // follow.
  Source(const ViewOptions& options, const trial::TrialOptions& how);

  // Advances one tick; returns false after the last one.
  bool tick();
  [[nodiscard]] double now() const;  // s of the experiment, last tick
  [[nodiscard]] double end() const;  // s, end; reads a record to its end
  // Valid after a tick. The moment refers to this object and to data().
  [[nodiscard]] Moment moment();
  [[nodiscard]] mjData* data() { return trial().world().physics().data(); }
  [[nodiscard]] trial::Trial& trial() { return playback_ ? playback_->trial() : *trial_; }
  [[nodiscard]] const trial::Trial& trial() const { return playback_ ? playback_->trial() : *trial_; }
  // Record only, as far as it was played; else empty.
  [[nodiscard]] std::string doubt() const { return playback_ ? playback_->doubt() : std::string(); }
  // True if a person presses in it, so that only the run shows when.
  [[nodiscard]] bool person() const;

 private:
  std::unique_ptr<trial::Trial> trial_;  // set for a scene
  std::unique_ptr<Playback> playback_;   // set for a record
  std::string record_;                   // file of the record
  RunSnapshot still_;
  const trial::TrialOptions how_;
};

// s of the experiment at which the record's surface is deepest; its end if nothing was touched.
[[nodiscard]] double deepest_moment(const std::string& record);

}  // namespace enc::app
