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

}  // namespace enc::trial
