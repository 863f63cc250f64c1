#include "trial/measure/frame_force.h"

#include <algorithm>
#include <cmath>

#include "core/control/step.h"

namespace enc::trial {

void FrameForce::step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) {
  const bool touched = state.mode == Mode::contact;
  if (in.tool.health == Health::ok && in.tool.t != newest_.t) {
    runs_ = newest_.health == Health::ok && (touched || state.mode == Mode::follow);
    untold_ = newest_;
    newest_ = in.tool;
    if (runs_) {
      beside_ = state;
      changes_.push_back({touched, 0.0});
    }
  }
  enc::step(scene, tick, in, state, out);
  if (!runs_) return;
  Inputs without = in;
  without.tool = untold_;
  Outputs then;
  enc::step(scene, tick, without, beside_, then);
  if (out.mode != Mode::contact && then.mode != Mode::contact) return;
  const double change = out.force.xyz[2] - then.force.xyz[2];
  double& most = changes_.back().most;
  most = std::isnan(most) || std::isnan(change) ? kUnset : std::max(most, std::abs(change));
}

double greatest_change(const std::vector<FrameForce::Change>& changes, bool touched) {
  double most = kUnset;
  for (const FrameForce::Change& change : changes) {
    if (change.touched != touched) continue;
    if (std::isnan(change.most)) return kUnset;
    most = std::fmax(most, change.most);
  }
  return most;
}

ForceDifference felt_apart(const FeltWay& one, const FeltWay& other, std::size_t frame) {
  ForceDifference apart;
  std::vector<double> sums{0.0};  // sums of the differences since both came into contact
  const std::size_t ticks = std::min(one.felt().size(), other.felt().size());
  for (std::size_t i = 0; i < ticks; ++i) {
    const double difference = other.felt()[i] - one.felt()[i];
    if (std::isnan(difference)) {
      sums.resize(1);
      continue;
    }
    ++apart.ticks;
    apart.tick = std::max(apart.tick, std::abs(difference));
    sums.push_back(sums.back() + difference);
    if (sums.size() <= frame) continue;
    const double mean = std::abs(sums.back() - sums[sums.size() - 1 - frame]) / static_cast<double>(frame);
    apart.frame = std::max(apart.frame, mean);
  }
  return apart;
}

}  // namespace enc::trial
