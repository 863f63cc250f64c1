#include "trial/identify/shadow/tape.h"

#include <algorithm>
#include <cmath>

namespace enc::trial {
namespace {

constexpr double kGap = 0.1;  // s: what the machine did meanwhile is not known

TipSample between(const TipSample& a, const TipSample& b, double share) {
  const auto mixed = [&](const Vec<'R'>& x, const Vec<'R'>& y) {
    return Vec<'R'>(Vec3(x.e() + share * (y.e() - x.e())));
  };
  return {{a.X_RH.q().slerp(share, b.X_RH.q()), Vec3(a.X_RH.p() + share * (b.X_RH.p() - a.X_RH.p()))},
          mixed(a.velocity, b.velocity),
          mixed(a.acceleration, b.acceleration)};
}

}  // namespace

bool is_well(const Stamped<TipSample>& tip) {
  return (tip.health == Health::ok || tip.health == Health::out_of_range) && tip.value.X_RH.valid();
}

bool was_sent(const RecordedTick& frame) {
  return !frame.in.withheld && frame.out.tip.valid() && frame.in.tip.health != Health::fault &&
         frame.in.tip.health != Health::absent;
}

bool is_news(const Stamped<TrackedTool>& tool, const Scene& scene, Time& newest) {
  const bool known = tool.health == Health::ok && tool.value.tool >= 0 &&
                     tool.value.tool < static_cast<std::int32_t>(scene.tools.size()) &&
                     tool.value.X_CT.valid();
  if (!known || tool.t == newest) return false;
  newest = tool.t;
  return true;
}

void TipTrace::see(const Stamped<TipSample>& tip) {
  if (is_well(tip) && (said_.empty() || tip.t > said_.back().t)) said_.push_back(tip);
}

std::size_t TipTrace::after(Time t) const {
  const auto later = std::upper_bound(said_.begin(), said_.end(), t,
                                      [](Time at, const Stamped<TipSample>& one) { return at < one.t; });
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

}  // namespace enc::trial
