// The source of pictures and films: a run of a scene, or a record.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/common/options.h"
#include "app/view/recorded/playback.h"

namespace enc::app {

class Source {
 public:
  // `how` applies to a run; a record has its own options. Throws Error, also for options that a record cannot
  // follow.
  Source(const ViewOptions& options, const trial::TrialOptions& how);

  // False after the last tick.
  bool tick();
  [[nodiscard]] double now() const;  // s of the experiment, last tick
  [[nodiscard]] double end() const;  // s, end; reads a record to its end
  // Valid after a tick. The moment refers to this object and to data().
  [[nodiscard]] Moment moment();
  [[nodiscard]] mjData* data() { return trial().world().physics().data(); }
  [[nodiscard]] trial::Trial& trial() { return playback_ ? playback_->trial() : *trial_; }
  [[nodiscard]] const trial::Trial& trial() const { return playback_ ? playback_->trial() : *trial_; }
  // Record only, as far as it was played (playback.h); else empty.
  [[nodiscard]] std::string doubt() const { return playback_ ? playback_->doubt() : std::string(); }
  // True if a person presses in it, so that only the run shows when.
  [[nodiscard]] bool person() const;

 private:
  std::unique_ptr<trial::Trial> trial_;  // set for a scene
  std::unique_ptr<Playback> playback_;   // set for a record
  std::string record_;                   // file of the record
  Still still_;
  const trial::TrialOptions how_;
};

// s of the experiment at which the record's surface is deepest; its end if nothing was touched.
[[nodiscard]] double deepest_moment(const std::string& record);

}  // namespace enc::app
