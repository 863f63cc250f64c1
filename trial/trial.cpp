#include "trial/trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/control/task/indentation/indentation.h"
#include "core/control/task/tracking/tracking.h"
#include "models/schema/wording.h"
#include "models/setup/calibration_files.h"
#include "sim/clock.h"
#include "trial/assemble/assemble.h"
#include "trial/assemble/vision.h"
#include "trial/certificates.h"
#include "trial/lists/room.h"

namespace enc::trial {
namespace {

using WallClock = std::chrono::steady_clock;

std::uint32_t nanoseconds(WallClock::duration d) {
  return static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(d).count());
}

// Duration of the machine's own programme, s; 10 if it only waits for a person. With a twin, the twin gives
// the duration.
double programme_of(const Scene& scene) {
  if (const IndentationTask* probe = scene.indentation()) return programme_time(scene, *probe);
  return scene.tracking() != nullptr ? scene.tracking()->duration() : 10.0;
}

// Pace as a share of wall time; 0: as fast as possible. With real devices everything runs in wall time.
double pace_of(const TrialOptions& options, bool wall) {
  if (!wall || options.pace == 1.0) return options.pace;
  if (options.pace != 0.0) throw Error("--pace: a rig with real devices runs at wall pace only");
  return 1.0;
}

void refuse_lockstep(const Slots& slots, const TrialOptions& options) {
  if (!slots.machine)
    throw Error(
        "--lockstep: the rig's machine is simulated, and no fake has a time to keep; expected a driver in "
        "[manipulator]; leave it out, or name another rig");
  if (options.pace != 0.0)
    throw Error("--pace: with --lockstep a run goes as fast as its fake; leave one of them out");
  if (!options.armed)
    throw Error(
        "--lockstep: the time of a fake goes on with each set-point, and without --armed none is sent; add "
        "it");
}

// Refuses limits for a real machine that a simulated one only reports (sources/choices 15).
void refuse_limits(const models::Setup& setup, const Scene& scene,
                   const std::vector<ObjectCertificate>& certificates) {
  for (const ObjectCertificate& one : certificates)
    if (const std::string why = refusal_text(setup, one); !why.empty())
      throw Error(models::place_of(setup, key_of(one)) + ": " + why + "; a real machine is not armed for it");
  for (const ArmStrength& at : strengths_of(setup, scene))
    if (const std::string beyond = beyond_text(at); !beyond.empty())
      throw Error(models::place_of(setup, "object." + at.object + ".behaviour") + ": " + beyond +
                  "; a real machine is not armed for it");
}

// A late tick puts the machine into hold, and without real-time priority any other program can delay it.
void refuse_slow(const models::Setup& setup, const std::string& machine, const RealTime& real_time) {
  if (real_time.granted()) return;
  throw Error(
      fmt::format("{}: the loop gets no real-time priority, so cycles may be missed while the machine "
                  "moves ({}); expected "
                  "the priority; allow it, or add --not-real-time",
                  models::place_of(setup, machine), real_time.words()));
}

void refuse_camera(const models::Setup& setup, const TrialOptions& options) {
  if (setup.scene.camera && !options.drivers)
    throw Error("the scene names [camera], whose modules nobody loads here", {}, ErrorKind::device);
  if (!setup.scene.camera && !options.frames.empty())
    throw Error(
        "--frames: the scene has no [camera], whose frames would be kept; leave it out, or run another "
        "scene");
}

// Frames that are not measured, or may have changed, give a wrong position of the tip.
void refuse_uncalibrated(const models::Setup& setup, const std::string& machine) {
  const std::string doubt = models::doubt_of(
      setup.rig.calibration, std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  if (!doubt.empty())
    throw Error(fmt::format("{}: {}; a real machine is not armed without it",
                            models::place_of(setup, machine), doubt));
}

}  // namespace

Trial::Trial(models::Setup setup, TrialOptions options)
    : setup_(std::move(setup)),
      options_(std::move(options)),
      scene_(prepare_setup(setup_)),
      family_(family_of(scene_)) {
  const Slots slots = options_.drivers ? slots_of(setup_) : Slots{};
  if (options_.lockstep) refuse_lockstep(slots, options_);
  const bool wall = slots.real && !options_.lockstep && keeps_wall_time(setup_, options_.drivers);
  const double pace = pace_of(options_, wall);
  result_.keeps_wall_time = wall && pace > 0.0;
  const bool armed = slots.machine && options_.armed;
  if (armed || options_.certify) certificates_ = certificates_of(setup_, scene_);
  if (armed) refuse_limits(setup_, scene_, certificates_);
  // On the wall clock a frame takes many periods. Else vision works within the loop, so that all runs are
  // equal.
  const bool threaded = setup_.scene.camera && wall;
  refuse_camera(setup_, options_);
  simulated_ = !slots.real;
  leads_ = slots.machine && slots.simulated && setup_.scene.manipulator.has_value();
  make_rig(slots.simulated || !slots.real);
  plan_length(pace);
  if (options_.begins) options_.begins();
  if (wall && options_.real_time) {  // before the devices, whose threads inherit its priority
    real_time_ = std::make_unique<RealTime>(true);
    result_.real_time = real_time_->words();
  }
  gate_ = Gate(setup_, slots.real && !options_.armed);
  // The camera comes first: it takes some frames' time to answer, and the arm then waits for nothing.
  if (threaded) put_vision(false, true);
  if (slots.real) put_drivers(rig_, setup_, options_.drivers, log_, {pace == 0.0, options_.lockstep});
  // The devices have now reported whether they are fakes. Nothing moves before a tick.
  const std::string machine = options_.armed ? real_machine(rig_, setup_) : std::string();
  if (!machine.empty() && !options_.calibrates) refuse_uncalibrated(setup_, machine);
  if (!machine.empty() && real_time_ && armed && options_.needs_real_time)
    refuse_slow(setup_, machine, *real_time_);
  if (setup_.scene.camera && !threaded) put_vision(pace == 0.0, false);
  if (slots.real) result_.devices = describe_drivers(rig_, setup_);
  in_.withheld = slots.machine && !options_.armed;
  if (options_.fit_out) options_.fit_out(rig_);
  check_devices(rig_, setup_.rig);
  if (pace > 0.0)
    rig_.clock = std::make_unique<sim::PacedClock>(
        std::move(rig_.clock), pace, wall ? sim::LatePolicy::skip : sim::LatePolicy::wait, options_.stop);
}

// Takes the twin's rig, or an empty rig with a clock.
void Trial::make_rig(bool simulated) {
  if (!simulated) {
    rig_.clock = std::make_unique<CountingClock>(setup_.rig.loop.rate);
    return;
  }
  world_ = make_world(setup_, scene_, options_.seed, options_.draw_all);
  if (options_.work) world_->ask_for_work();
  rig_ = world_->rig();
}

// Uses vision as the tracker.
void Trial::put_vision(bool waits, bool threaded) {
  rig_.tracker = make_vision(setup_, options_.drivers,
                             {world_.get(), options_.seed, log_, waits, options_.lockstep, threaded,
                              options_.look, options_.frames});
  result_.vision.threaded = threaded;
}

// Sets the number of ticks, and reserves memory for the data of each.
void Trial::plan_length(double pace) {
  result_.holds.reserve(TrialResult::kMostHolds);
  const bool endless = std::isinf(options_.seconds);
  const double programme = world_ ? world_->programme_time() : programme_of(scene_);
  const double length = std::isnan(options_.seconds) ? programme : options_.seconds;
  constexpr double kLongest = 1e6;  // s
  if (!endless && !(length < kLongest))
    throw Error(
        fmt::format("{}:1:1: the scene lasts {:.3g} s; expected less than {:g} s; shorten or repeat "
                    "less what it does, or give --for-s",
                    setup_.scene_path, length, kLongest));
  last_tick_ = endless ? std::numeric_limits<std::int64_t>::max() - 1 : std::llround(length / scene_.dt);
  const auto timed =
      static_cast<std::size_t>(std::min<std::int64_t>(last_tick_ + 1, TrialResult::kMostTimed));
  result_.step_ns = with_room<std::uint32_t>(timed);
  if (pace > 0.0 || endless) result_.period_ns = with_room<std::uint32_t>(timed);
  if (setup_.scene.camera) result_.vision.reserve(std::min(length, 3600.0) * setup_.rig.camera.rate);
}

void Trial::count() {
  const Mode mode = out_.mode;
  result_.mode_time[static_cast<std::size_t>(mode)] += scene_.dt;
  if (mode != result_.last_mode) {
    ++result_.mode_changes;
    if (mode == Mode::hold && ++result_.times_held <= TrialResult::kMostHolds)
      result_.holds.emplace_back(now_.t, out_.why & kHoldReasons);
  }
  if (mode == Mode::hold) result_.last_hold = {now_.t, out_.why & kHoldReasons};
  result_.last_mode = mode;
  result_.last_why = out_.why;
  result_.contacts = out_.contacts;
  add_tick(hash_, state_, out_);
  result_.hash = hash_.value;
  result_.missed += in_.missed;
  result_.withheld = gate_.withheld();
  ++result_.ticks;
}

void Trial::hear(const HandWord& word) {
  if (word.place) world_->steer(*word.place);
  if (word.changes_tool) world_->change_tool();
  faults_.set(word.faults);
}

bool Trial::ends() {
  if ((result_.ticks > 0 && now_.index >= last_tick_) || result_.stopped || result_.diverged_at >= 0)
    return true;
  if (options_.stop && options_.stop()) {
    result_.interrupted = true;
    return true;
  }
  // A fake without set-points stops its time, and each tick would wait for it.
  if (options_.lockstep && gate_.lost()) {
    result_.interrupted = true;
    return true;
  }
  return false;
}

// Reads the requests of the operators: of the machine, and of the twin's hand.
void Trial::ask_hands() {
  if (const Hand hand = options_.hand ? options_.hand() : Hand::none; hand == Hand::halt)
    gate_.halt(rig_, now_.t);
  else if (hand == Hand::resume)
    gate_.resume();
  if (options_.steer && world_)
    if (const auto word = options_.steer(result_.ticks)) hear(*word);
}

bool Trial::tick() {
  if (ends()) return false;
  ask_hands();
  now_ = rig_.clock->next();
  gate_.unmark(in_);
  rig_.read(now_.t, in_);
  if (rig_.hand_tracker) rig_.hand_tracker->poll(now_.t, hand_);
  faults_.apply(in_);
  if (setup_.scene.camera) result_.vision.see(now_.t, in_.tool);
  gate_.mark(rig_, now_.t, in_);
  if (leads_ && world_->machine && in_.tip.health != Health::absent) world_->machine->lead(in_.tip.value);
  if (options_.disturb) options_.disturb(in_);
  const WallClock::time_point before = WallClock::now();
  if (options_.law)
    options_.law(scene_, now_, in_, state_, out_);
  else
    step(scene_, now_, in_, state_, out_);
  const WallClock::time_point after = WallClock::now();
  gate_.write(rig_, out_);
  if (result_.step_ns.size() < result_.step_ns.capacity())
    result_.step_ns.push_back(nanoseconds(after - before));
  const std::uint32_t period = result_.ticks > 0 ? nanoseconds(before.time_since_epoch() - before_) : 0;
  if (result_.ticks > 0 && result_.period_ns.size() < result_.period_ns.capacity())
    result_.period_ns.push_back(period);
  before_ = before.time_since_epoch();
  count();
  if (record_ != nullptr) {
    record_->write(now_, in_, out_, hash_.value);
    result_.stopped = record_->full();
  }
  if (options_.watch)
    options_.watch({scene_, now_, truth(), in_, out_, simulated_, &state_, &gate_, period, family_});
  if (world_) result_.diverged_at = world_->diverged_at();
  return true;
}

Trial::~Trial() { gate_.stop(rig_); }

TrialResult Trial::run() {
  struct AtEnd {  // also if something throws
    Trial& trial;
    ~AtEnd() { trial.gate_.stop(trial.rig_); }
  } const at_end{*this};
  const WallClock::time_point start = WallClock::now();
  WallClock::time_point told = start;
  while (tick()) {
    if (!options_.progress || result_.ticks % 64 != 0) continue;
    const WallClock::time_point now = WallClock::now();
    if (now - told < std::chrono::milliseconds(100)) continue;
    told = now;
    options_.progress(static_cast<double>(now_.index) / static_cast<double>(last_tick_ + 1));
  }
  result_.wall = std::chrono::duration<double>(WallClock::now() - start).count();
  result_.simulated = static_cast<double>(result_.ticks + result_.missed) * scene_.dt;
  result_.lateness = rig_.clock->lateness();
  result_.links = gate_.links();
  result_.log = said();
  if (result_.diverged_at >= 0) result_.divergence = world_->divergence();
  return result_;
}

std::vector<std::string> Trial::said() const {
  std::vector<std::string> lines = log_.lines();
  each_device([&](const auto& role) {
    if (const auto& device = rig_.*role.slot)
      for (const std::string& line : device->remarks()) lines.push_back(models::printable(line));
  });
  return lines;
}

}  // namespace enc::trial
