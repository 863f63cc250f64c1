#include "trial/identify/shadow/tape.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "trial/assemble/assemble.h"

namespace enc::trial {
namespace {

constexpr double kGap = 0.1;  // s: the machine's motion in a longer gap is unknown

TipSample between(const TipSample& a, const TipSample& b, double share) {
  const auto mixed = [&](const Vec<'R'>& x, const Vec<'R'>& y) {
    return Vec<'R'>(Vec3(x.e() + share * (y.e() - x.e())));
  };
  return {{a.X_RH.q().slerp(share, b.X_RH.q()), Vec3(a.X_RH.p() + share * (b.X_RH.p() - a.X_RH.p()))},
          mixed(a.velocity, b.velocity),
          mixed(a.acceleration, b.acceleration)};
}

}  // namespace

bool is_well(const Measurement<TipSample>& tip) {
  return (tip.health == Health::ok || tip.health == Health::out_of_range) && tip.value.X_RH.valid();
}

bool was_sent(const RecordedTick& frame) {
  return !frame.in.withheld && frame.out.manipulator.tip.valid() && frame.in.tip.health != Health::fault &&
         frame.in.tip.health != Health::absent;
}

bool is_news(const Measurement<TrackedTool>& tool, const Scene& scene, Time& newest) {
  const bool known = tool.health == Health::ok && tool.value.tool >= 0 &&
                     tool.value.tool < static_cast<std::int32_t>(scene.tools.size()) &&
                     tool.value.X_CT.valid();
  if (!known || tool.t == newest) return false;
  newest = tool.t;
  return true;
}

void TipTrace::see(const Measurement<TipSample>& tip) {
  if (is_well(tip) && (said_.empty() || tip.t > said_.back().t)) said_.push_back(tip);
}

std::size_t TipTrace::after(Time t) const {
  const auto later = std::upper_bound(said_.begin(), said_.end(), t,
                                      [](Time at, const Measurement<TipSample>& one) { return at < one.t; });
  return static_cast<std::size_t>(later - said_.begin());
}

bool TipTrace::knows(Time t) const {
  if (said_.empty() || t < said_.front().t || t > said_.back().t) return false;
  const std::size_t i = after(t);
  return i == said_.size() || age(said_[i].t, said_[i - 1].t) < kGap;
}

TipSample TipTrace::at(Time t) const {
  const std::size_t i = after(t);
  if (i == 0) return said_.front().value;
  if (i == said_.size()) return said_.back().value;
  const auto& [before, next] = std::pair(said_[i - 1], said_[i]);
  if (t == before.t) return before.value;
  return between(before.value, next.value, age(t, before.t) / age(next.t, before.t));
}

Tape::Tape(RecordReader& from, const models::Setup& setup, const Scene& prepared)
    : record(from), twin(setup), scene(prepared) {
  play([&](const RecordedTick& frame) {
    if (last < first) {
      first = frame.tick.index;
      begin = frame.tick.t;
    }
    last = frame.tick.index;
    missed += frame.in.missed;
    tip.see(frame.in.tip);
    sent = sent || was_sent(frame);
    pressed = pressed || frame.out.mode == Mode::contact;
  });
}

void Tape::play(const SeeTick& see) const {
  RecordedTick frame;
  for (record.rewind(); record.next(frame);) see(frame);
}

namespace {

std::vector<std::vector<Vec3>> markers_in(const models::Setup& twin) {
  std::vector<std::vector<Vec3>> all;
  all.reserve(twin.scene.tools.size());
  for (const ToolSpec& tool : twin.scene.tools) all.push_back(tool.markers);
  return all;
}

}  // namespace

ToldMachine::ToldMachine(const Tape& tape)
    : plant_(tape.twin.twin.hexapod, twin_seed(0)),
      steps_(std::max(1, tape.twin.twin.stepping(tape.twin.scene).steps_per_tick(tape.twin.rig.loop.rate))),
      timestep_(tape.scene.dt / steps_) {}

void ToldMachine::begin(const TipSample& at) {
  sim::HexapodPlant::State state = plant_.state();
  state.pose = state.wanted = state.newest = at.X_RH;
  state.velocity = state.acceleration = state.turning = Vec<'R'>::zero();
  state.pending.line.fill(at.X_RH);
  state.pending.head = 0;
  plant_.restore(state);
  known_ = true;
}

void ToldMachine::advance(const RecordedTick& frame) {
  const bool well = is_well(frame.in.tip);
  if (!known_ || frame.in.resumed) {
    known_ = false;
    tick_ = frame.tick.index;
    if (well) begin(frame.in.tip.value);
    return;
  }
  // After a lost link the machine's last command is unknown.
  if (frame.in.tip.health == Health::fault || frame.in.tip.health == Health::absent) {
    known_ = false;
    return;
  }
  for (; tick_ < frame.tick.index; ++tick_) {
    plant_.begin_cycle();
    for (int i = 0; i < steps_; ++i) plant_.move(timestep_);
  }
}

TipSample ToldMachine::said() const {
  const sim::HexapodPlant::State& state = plant_.state();
  return {state.pose, state.velocity, state.acceleration};
}

void lead_world(const Tape& tape, const models::Setup& twin, const Vec3& shift, const SeeWorld& see) {
  // Moving the machine from pose to pose would shake elastic legs. The reported pose is that of the servo, so
  // use stiff legs.
  models::Setup placed = twin;
  placed.twin.hexapod.form = sim::HexapodForm::control;
  const std::unique_ptr<sim::World> world = make_world(placed, tape.scene, twin_seed(0));
  for (std::int64_t i = tape.first; i <= tape.last; ++i) {
    const Time t = tape.begin + Duration((i - tape.first) * from_seconds(tape.scene.dt).count());
    TipSample led = tape.tip.at(t);
    led.X_RH = Pose<'R', 'H'>(Quat(led.X_RH.q()), Vec3(led.X_RH.p() + shift));
    world->machine->lead(led);
    world->advance();
    if (world->diverged_at() >= 0)
      throw Error(
          fmt::format("the twin's physics diverged at {:.3f} s: {}; expected a motion that it can "
                      "follow; see to --set",
                      in_seconds(t), world->divergence()));
    see(t, *world, led);
  }
}

TwinTrackers::TwinTrackers(const Tape& tape)
    : scene_(tape.scene), newest_(kTwins, Time::min()), packets_(kTwins) {
  plants_.reserve(kTwins);
  for (std::size_t i = 0; i < kTwins; ++i)
    plants_.emplace_back(tape.twin.twin.tracker, pose_of<'W', 'C'>(tape.twin.twin.frames.W_C), twin_seed(i),
                         markers_in(tape.twin));
}

void TwinTrackers::advance(Time t, std::int32_t tool, const Pose<'W', 'T'>& X_WT) {
  for (std::size_t i = 0; i < kTwins; ++i) {
    plants_[i].advance(t, tool, X_WT);
    Measurement<TrackedTool> newest;
    if (plants_[i].poll(newest) && is_news(newest, scene_, newest_[i]))
      packets_[i].push_back({t, newest.t, newest.value});
  }
}

std::vector<SeenPacket> recorded_packets(const Tape& tape) {
  std::vector<SeenPacket> packets;
  Time newest = Time::min();
  tape.play([&](const RecordedTick& frame) {
    if (is_news(frame.in.tool, tape.scene, newest))
      packets.push_back({frame.tick.t, frame.in.tool.t, frame.in.tool.value});
  });
  return packets;
}

}  // namespace enc::trial
