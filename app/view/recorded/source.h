// What pictures and films are made of: a run of a scene, or a record.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/common/options.h"
#include "app/view/recorded/playback.h"

namespace enc::app {

class Source {
 public:
  // `how` is for a run; a record has its own. Throws Error, as for options that a record cannot follow.
  Source(const ViewOptions& options, const trial::TrialOptions& how);

  // False after the last tick.
  bool tick();
  [[nodiscard]] double now() const;  // s of the experiment, of the last tick
  [[nodiscard]] double end() const;  // s, where it ends; reads a record to its end
  // Valid after a tick. It refers to this and to data().
  [[nodiscard]] Moment moment();
  [[nodiscard]] mjData* data() { return trial().world().physics().data(); }
  [[nodiscard]] trial::Trial& trial() { return playback_ ? playback_->trial() : *trial_; }
  [[nodiscard]] const trial::Trial& trial() const { return playback_ ? playback_->trial() : *trial_; }
  // Of a record, as far as it was played (playback.h); else empty.
  [[nodiscard]] std::string doubt() const { return playback_ ? playback_->doubt() : std::string(); }
  // A person presses in it, and when is for the run to tell.
  [[nodiscard]] bool person() const;

 private:
  std::unique_ptr<trial::Trial> trial_;  // of a scene
  std::unique_ptr<Playback> playback_;   // of a record
  std::string record_;                   // its file
  Still still_;
  const trial::TrialOptions how_;
};

// s of the experiment at which the record's surface is deepest; its end if nothing was touched.
[[nodiscard]] double deepest_moment(const std::string& record);

}  // namespace enc::app
