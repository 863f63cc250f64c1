// A rendered object: what the sensor felt says how far the twin's object, rendered by the twin's machine,
// would have given way. The core runs again with what the devices said; only the machine is the twin's.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/counted.h"
#include "core/control/step.h"
#include "models/identify/block_fit.h"
#include "trial/identify/shadow/bounds.h"
#include "trial/identify/shadow/channels.h"

namespace enc::trial {
namespace {

constexpr double kDepthBlock = 0.25;  // s
constexpr double kDeep = 0.1e-3;      // m: less is no press that tells a slope
constexpr Eigen::Index kDeeper = 0, kAfter = 1, kColumns = 2;

struct Depth {
  double t, twin, speed, recorded;  // s, m, m/s, m
  std::int32_t contact;
};

std::vector<Depth> depths(const Tape& tape) {
  std::vector<Depth> out;
  ToldMachine machine(tape);
  State state;
  Outputs outputs;
  tape.play([&](const RecordedTick& frame) {
    machine.advance(frame);
    Inputs in = frame.in;
    if (machine.known() && is_well(in.tip)) in.tip = {machine.said(), frame.tick.t, Health::ok};
    step(tape.scene, frame.tick, in, state, outputs);
    if (machine.known() && was_sent(frame) && outputs.tip.valid()) machine.command(outputs.tip);
    const Contact& contact = contact_of(state);
    const bool both = outputs.mode == Mode::contact && frame.out.mode == Mode::contact &&
                      outputs.contacts == frame.out.contacts && contact.anchored && !contact.below &&
                      ((outputs.why | frame.out.why) & kAtLimit) == 0;
    if (!both || !machine.known() || !tape.tip.knows(frame.tick.t)) return;
    const Pose<'N', 'W'> X_NW = contact.X_WN.inverse();
    const auto deep = [&](const TipSample& tip) {
      return -(X_NW * (tape.scene.X_WR * tip.X_RH.origin())).xyz[2] - tape.scene.tip_radius;
    };
    const TipSample twin = machine.said();
    out.push_back({in_seconds(frame.tick.t), deep(twin), -(X_NW * (tape.scene.X_WR * twin.velocity)).xyz[2],
                   deep(tape.tip.at(frame.tick.t)), outputs.contacts});
  });
  return out;
}

}  // namespace

void see_rendered(const Tape& tape, Shadow& shadow) {
  if (tape.scene.render() == nullptr || !tape.scene.has_force) return;
  if (!tape.sent)
    return cannot_judge(shadow, Channel::rendering, "nothing was sent to the machine: this was a dry run");
  if (!tape.pressed) return cannot_judge(shadow, Channel::rendering, "nothing that is rendered was pressed");
  const std::vector<Depth> all = depths(tape);
  std::int32_t contacts = 0, last = -1;
  double deepest = 0.0;
  for (const Depth& one : all) {
    contacts += one.contact != last ? 1 : 0;
    last = one.contact;
    deepest = std::max(deepest, one.twin);
  }
  if (deepest < kDeep)
    return cannot_judge(
        shadow, Channel::rendering,
        fmt::format("where the record has a contact the twin's gave way by {:.3f} mm; expected "
                    "more than {:.1f} mm",
                    1e3 * deepest, 1e3 * kDeep));
  models::BlockFit fit(static_cast<std::size_t>(kColumns), kDepthBlock);
  for (const Depth& one : all) {
    Eigen::VectorXd row(kColumns);
    row(kDeeper) = one.twin;
    row(kAfter) = -one.speed;
    fit.add(one.t, row, one.recorded, one.contact);  // each has its own beginning
  }
  const models::BlockFit::Result found = fit.solve();
  const models::Interval& deeper = found.values[kDeeper];
  const models::Interval stiffer{1.0 / deeper.value - 1.0, deeper.half / (deeper.value * deeper.value)};
  add(shadow, Channel::rendering, Quantity::rendered, stiffer, bounds::kRendered);
  shadow.facts.push_back({Channel::rendering, fmt::format("{}; what is left of the depth is {:.3f} mm rms",
                                                          counted(contacts, "contact"), 1e3 * found.rms)});
}

}  // namespace enc::trial
