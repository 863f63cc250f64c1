#include "app/view/recorded/source.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/built.h"
#include "core/base/error.h"
#include "models/files.h"

namespace enc::app {
namespace {

double time_of(const RecordedTick& frame) { return seconds(frame.tick.t.time_since_epoch()); }

}  // namespace

Source::Source(const ViewOptions& options, const trial::TrialOptions& how) : how_(how) {
  if (!is_record(options.scene)) {
    models::Setup setup = models::load(options.scene, options.rig, options.set);
    leave_out_vision(setup);
    trial_ = std::make_unique<trial::Trial>(setup, how);
    print_notes(setup.notes);
    return;
  }
  models::note_input(options.scene);
  record_ = options.scene;
  playback_ = std::make_unique<Playback>(options.scene);
  print_notes(playback_->setup().notes);
}

bool Source::tick() {
  if (!playback_) return trial_->tick();
  if (how_.stop && how_.stop()) return false;
  if (now() >= how_.seconds) return false;
  return playback_->next([this](const trial::Glance& glance) {
    take_still(playback_->trial(), glance, playback_->simulated(), still_);
  });
}

double Source::now() const {
  return playback_ ? time_of(playback_->frame()) : seconds(trial_->now().t.time_since_epoch());
}

double Source::end() const {
  if (!playback_) return trial_->world().programme_time();
  double end = 0.0;
  RecordReader reader(record_, Partial::yes);
  for (RecordedTick frame; reader.next(frame);) end = time_of(frame);
  return end;
}

Moment Source::moment() {
  return playback_ ? moment_of(playback_->trial(), still_, data()) : moment_of(*trial_);
}

bool Source::person() const {
  const SceneSpec& scene = trial().setup().scene;
  return !playback_ && scene.user.has_value() && !scene.tools.empty();
}

double deepest_moment(const std::string& record) {
  RecordReader reader(record, Partial::yes);
  double at = 0.0, most = 0.0;
  for (RecordedTick frame; reader.next(frame);) {
    if (frame.out.mode == Mode::contact && frame.out.deflection > most) {
      most = frame.out.deflection;
      at = time_of(frame);
    } else if (most == 0.0) {
      at = time_of(frame);
    }
  }
  return at;
}

}  // namespace enc::app
