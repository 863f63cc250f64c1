#include "app/view/recorded/source.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "app/built.h"
#include "core/base/error.h"
#include "core/control/step.h"
#include "models/files.h"
#include "trial/assemble/assemble.h"

namespace enc::app {
namespace {

double time_of(const RecordedTick& frame) { return seconds(frame.tick.t.time_since_epoch()); }

std::uint64_t seed_of(const RecordTexts& texts) {
  std::uint64_t seed = 1;
  if (const auto said = texts.find("seed"); said != texts.end())
    (void)std::from_chars(said->second.data(), said->second.data() + said->second.size(), seed);
  return seed;
}

}  // namespace

Playback::Playback(const std::string& path) : record_(path, PartialRead::yes) {
  if (record_.ticks() == 0)
    throw Error(path + ": holds no whole tick; there is nothing to see; record it again");
  models::Setup setup = models::setup_of(record_.texts(), path);
  leave_out_vision(setup);
  if (!record_.damage().empty())
    doubt_ = "damaged, and not read from there on: " + record_.damage();
  else if (!record_.sealed())
    doubt_ = "the record is not sealed: it was cut off";
  // The end of a record states whether somebody steered the hand.
  const bool unknown_hand = !record_.sealed() && setup.scene.user.has_value();
  simulated_ = !trial::slots_of(setup).real && !unknown_hand;
  if (unknown_hand) doubt_ += "; tool and tip are drawn where the devices said";
  if (const auto hand = record_.end_texts().find("hand"); hand != record_.end_texts().end())
    hand_ = trial::SteeringLog::read(hand->second, path);
  trial_ = std::make_unique<trial::Trial>(setup, options());
}

trial::TrialOptions Playback::options() {
  trial::TrialOptions options;
  options.seed = seed_of(record_.texts());
  options.seconds = 1e5;  // longer than any record: next() detects the end
  options.draw_all = true;
  options.steer = [this](std::int64_t tick) { return hand_.at(tick); };
  // The twin's machine follows the recorded motion of a real one.
  options.law = [this](const Scene& scene, const Tick&, const Inputs&, State& state, Outputs& out) {
    const Measurement<TipSample>& tip = frame_.in.tip;
    if (!simulated_ && trial_->world().machine && tip.health != Health::absent)
      trial_->world().machine->lead(tip.value);
    step(scene, frame_.tick, frame_.in, state, out);
  };
  options.watch = [this](const trial::Glance& glance) {
    see_({glance.scene, frame_.tick, glance.truth, frame_.in, glance.out, simulated_, glance.state});
  };
  return options;
}

bool Playback::next(const std::function<void(const trial::Glance&)>& see) {
  if (!record_.next(frame_)) return false;
  see_ = see;
  if (!trial_->tick()) return false;
  if (first_difference_ < 0 && trial_->result().hash != frame_.hash) {
    first_difference_ = frame_.tick.index;
    doubt_ += fmt::format("{}the core differs from the record from tick {} on", doubt_.empty() ? "" : "; ",
                          first_difference_);
  }
  return true;
}

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
  RecordReader reader(record_, PartialRead::yes);
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
  RecordReader reader(record, PartialRead::yes);
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
