#include "benchmarks/trial.h"

#include <chrono>
#include <cmath>

#include "core/error.h"
#include "sim/clock.h"

namespace enc::bench {
namespace {

using WallClock = std::chrono::steady_clock;

std::uint32_t nanoseconds(WallClock::duration d) {
  return static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(d).count());
}

}  // namespace

Scene prepare_setup(const models::Setup& setup) {
  try {
    return prepare(setup.scene, setup.rig);
  } catch (const Error& e) {
    throw Error(models::place_of(setup, e.key()) + ": " + e.what(), {}, e.kind());
  }
}

std::unique_ptr<sim::World> make_world(const models::Setup& setup, const Scene& prepared, std::uint64_t seed,
                                       bool draw_all) {
  const std::string mjcf = models::models_dir(setup.scene_path) + "/mjcf";
  try {
    return std::make_unique<sim::World>(
        sim::WorldSpec{setup.scene, setup.rig, setup.twin, prepared, mjcf, seed, draw_all});
  } catch (const Error& e) {
    if (e.key().empty()) throw;
    throw Error(models::place_of(setup, e.key()) + ": " + e.what(), {}, e.kind());
  }
}

void check_devices(const Rig& rig, const RigSpec& spec) {
  if (!rig.manipulator) return;
  const Reach reach = rig.manipulator->reach();
  if (reach.speed < spec.manipulator.speed * (1 - 1e-9) ||
      reach.acceleration < spec.manipulator.acceleration * (1 - 1e-9))
    throw Error(
        "the machine is slower than the rig file promises; lower rig.manipulator.speed_mm_s or "
        "acceleration_mm_s2",
        {}, ErrorKind::device);
}

Trial::Trial(models::Setup setup, TrialOptions options)
    : setup_(std::move(setup)), options_(std::move(options)), scene_(prepare_setup(setup_)) {
  world_ = make_world(setup_, scene_, options_.seed, options_.draw_all);
  rig_ = world_->rig();
  if (options_.fit_out) options_.fit_out(rig_);
  check_devices(rig_, setup_.rig);
  if (options_.pace > 0.0) rig_.clock = std::make_unique<sim::Paced>(std::move(rig_.clock), options_.pace);
  const double length = std::isnan(options_.seconds) ? world_->programme_time() : options_.seconds;
  last_tick_ = std::llround(length / scene_.dt);
  result_.step_ns.reserve(static_cast<std::size_t>(last_tick_) + 1);
  result_.holds.reserve(16);
}

void Trial::count(const Tick& tick) {
  const Mode mode = out_.mode;
  result_.mode_time[static_cast<std::size_t>(mode)] += scene_.dt;
  if (mode != result_.last_mode) {
    ++result_.mode_changes;
    if (mode == Mode::hold && result_.holds.size() < 16)
      result_.holds.emplace_back(tick.t, out_.why & kHoldReasons);
  }
  result_.last_mode = mode;
  result_.last_why = out_.why;
  result_.contacts = out_.contacts;
  add_tick(hash_, state_, out_);
  result_.hash = hash_.value;
  ++result_.ticks;
}

bool Trial::tick() {
  if (result_.ticks > last_tick_ || result_.stopped || result_.diverged_at >= 0) return false;
  const Tick tick = rig_.clock->next();
  rig_.read(in_);
  const WallClock::time_point before = WallClock::now();
  step(scene_, tick, in_, state_, out_);
  const WallClock::time_point after = WallClock::now();
  rig_.write(out_);
  if (result_.step_ns.size() < result_.step_ns.capacity())
    result_.step_ns.push_back(nanoseconds(after - before));
  count(tick);
  if (record_ != nullptr) {
    record_->write(tick, in_, out_, hash_.value);
    result_.stopped = record_->full();
  }
  if (options_.watch) options_.watch({scene_, tick, world_->truth(), in_, out_});
  result_.diverged_at = world_->diverged_at();
  return true;
}

TrialResult Trial::run() {
  const WallClock::time_point start = WallClock::now();
  WallClock::time_point told = start;
  while (tick()) {
    if (!options_.progress || result_.ticks % 64 != 0) continue;
    const WallClock::time_point now = WallClock::now();
    if (now - told < std::chrono::milliseconds(100)) continue;
    told = now;
    options_.progress(static_cast<double>(result_.ticks) / static_cast<double>(last_tick_ + 1));
  }
  result_.wall = std::chrono::duration<double>(WallClock::now() - start).count();
  result_.simulated = static_cast<double>(result_.ticks) * scene_.dt;
  if (result_.diverged_at >= 0) result_.divergence = world_->divergence();
  return result_;
}

}  // namespace enc::bench
