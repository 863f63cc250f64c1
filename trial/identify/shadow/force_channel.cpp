// Force and position: a probe pressed against a real object, and a rendered object.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/base/words.h"
#include "core/control/step.h"
#include "models/identify/block_fit.h"
#include "trial/identify/shadow/channels.h"

namespace enc::trial {

// A real object that the machine presses with its probe. The recorded positions of the probe give the force
// that the twin's object would have returned.

namespace {

constexpr double kForceBlock = 0.25;  // s
constexpr double kBefore = 1e-3;      // m before the touch, where the evaluation of a push begins
constexpr double kStep = 20e-6;       // m, step of the numerical slope
constexpr double kSlopeTime = 4e-3;   // s, step of the numerical slope
constexpr double kSame = 1e-4;        // N: kStep on the softest object gives more
constexpr double kFelt = 1.0;         // N: above weight, inertia and drift in a block of time
constexpr int kMostRounds = 10;
constexpr double kBend = 0.5e-3;    // m
constexpr double kSettled = 2e-6;   // m
constexpr double kFarthest = 3e-3;  // m: a larger distance is another place
constexpr Eigen::Index kAlike = 0, kNearer = 1, kLate = 2, kPushed = 3;

using Forces = std::vector<double>;  // N, along the push, tick by tick

// A force reading of the sensor, with its own stamp.
struct Reading {
  double at;     // ticks after the first
  double force;  // N, along the push
};

// The compared ticks of all pushes, with the number of each push.
struct Rows {
  std::vector<std::ptrdiff_t> push;  // push of each tick; -1: no push
  std::ptrdiff_t pushes = 0;
  double begin = 0.0, dt = kUnset;
};

// A sensor without errors, in its true axes. Each seed adds errors later.
models::Setup faultless(models::Setup twin) {
  sim::ForceTruth& force = twin.twin.force;
  force.quantum = force.torque_quantum = force.noise = force.torque_noise = 0.0;
  force.zero = force.drift = force.push_drift = 0.0;
  force.turned = Vec3::Zero();
  return twin;
}

// The twin's sensor at each tick, in its true axes, with its probe `nearer` further along the push.
std::vector<Wrench> felt_by_twin(const Tape& tape, const models::Setup& twin, double nearer) {
  const Vec3 along = -(tape.scene.indentation()->X_WN * Vec<'N'>(0, 0, 1)).e();
  const Vec3 shift = nearer * (tape.scene.X_WR.q().conjugate() * along);
  std::vector<Wrench> felt;
  felt.reserve(static_cast<std::size_t>(tape.last - tape.first + 1));
  lead_world(tape, twin, shift, [&](Time, const sim::World& world, const TipSample&) {
    felt.push_back(world.force->sample().value);
  });
  return felt;
}

// Component against the push, with the sensor's pose from the rig file.
class PushComponent {
 public:
  explicit PushComponent(const Tape& tape) : tape_(tape) {}
  double operator()(std::size_t i, const Vec<'F'>& force) const {
    const Time t =
        tape_.begin + Duration(static_cast<std::int64_t>(i) * from_seconds(tape_.scene.dt).count());
    const Pose<'W', 'F'> X_WF = tape_.scene.X_WR * tape_.tip.at(t).X_RH * tape_.scene.X_HF;
    return dot(X_WF * force, tape_.scene.indentation()->X_WN * Vec<'N'>(0, 0, 1));
  }

 private:
  const Tape& tape_;
};

Forces along_push(const PushComponent& along, const std::vector<Wrench>& felt) {
  Forces out;
  out.reserve(felt.size());
  for (std::size_t i = 0; i < felt.size(); ++i) out.push_back(along(i, felt[i].force));
  return out;
}

// Force between two ticks, interpolated.
double force_at(const Forces& forces, double i) {
  const double last = static_cast<double>(forces.size() - 1);
  const double at = std::clamp(i, 0.0, last);
  const auto low = static_cast<std::size_t>(at), high = std::min(low + 1, forces.size() - 1);
  return forces[low] + (at - static_cast<double>(low)) * (forces[high] - forces[low]);
}

Rows rows_of(const Tape& tape) {
  const IndentationTask& probe = *tape.scene.indentation();
  const auto ticks = static_cast<std::size_t>(tape.last - tape.first + 1);
  Rows rows{std::vector<std::ptrdiff_t>(ticks, -1), 0, in_seconds(tape.begin), tape.scene.dt};
  const double from = -std::min(kBefore, 0.5 * probe.clear);
  bool in = false;
  for (std::size_t i = 0; i < ticks; ++i) {
    const Time t = tape.begin + Duration(static_cast<std::int64_t>(i) * from_seconds(tape.scene.dt).count());
    const bool now =
        tape.tip.knows(t) && probe.deflection(tape.scene.X_WR * tape.tip.at(t).X_RH.origin()) > from;
    if (now && !in) ++rows.pushes;
    if (now) rows.push[i] = rows.pushes - 1;
    in = now;
  }
  return rows;
}

struct ForceComparison {
  models::Interval alike, nearer, late;
  double rms = kUnset;
};

// Fits measured(t) = alike * twin(t - late), with the object nearer. Fits all three at once, with one zero
// for each push.
ForceComparison compare(const Rows& rows, const std::vector<Reading>& measured, const Forces& twin,
                        const Forces& stepped, double late) {
  models::BlockFit fit(static_cast<std::size_t>(kPushed), kForceBlock);
  const double reach = kSlopeTime / rows.dt;
  for (const Reading& one : measured) {
    const auto tick = static_cast<std::size_t>(std::max(0.0, std::round(one.at)));
    if (tick >= rows.push.size() || rows.push[tick] < 0) continue;
    const double at = one.at - late / rows.dt;
    const double force = force_at(twin, at);
    Eigen::VectorXd row(kPushed);
    row(kAlike) = force;
    row(kNearer) = (force_at(stepped, at) - force) / kStep;
    row(kLate) = -(force_at(twin, at + reach) - force_at(twin, at - reach)) / (2.0 * kSlopeTime);
    fit.add(rows.begin + one.at * rows.dt, row, one.force, rows.push[tick]);
  }
  const models::BlockFit::Result found = fit.solve();
  const double size = found.values[kAlike].value;
  const auto scaled = [&](Eigen::Index c) {
    const models::Interval& one = found.values[static_cast<std::size_t>(c)];
    return models::Interval{one.value / size, one.half / std::abs(size)};
  };
  return {found.values[kAlike], scaled(kNearer), scaled(kLate), found.rms};
}

// The readings of the record's sensor, without repeated and invalid ones.
std::vector<Reading> recorded_forces(const Tape& tape, const PushComponent& along) {
  std::vector<Reading> out;
  Time newest = Time::min();
  tape.play([&](const RecordedTick& frame) {
    const Measurement<Wrench>& said = frame.in.wrench;
    if (said.health != Health::ok || !said.value.force.finite() || said.t <= newest) return;
    newest = said.t;
    const auto tick = static_cast<std::size_t>(frame.tick.index - tape.first);
    out.push_back({age(said.t, tape.begin) / tape.scene.dt, along(tick, said.value.force)});
  });
  return out;
}

// N, difference between the blocks of time with the largest and the smallest force, whatever the probe
// pressed.
double felt_at_most(const std::vector<Reading>& readings, double dt) {
  std::map<std::int64_t, std::pair<double, double>> blocks;  // sum and number
  for (const Reading& one : readings) {
    auto& [sum, number] = blocks[static_cast<std::int64_t>(std::floor(one.at * dt / kForceBlock))];
    sum += one.force;
    ++number;
  }
  double least = INFINITY, most = -INFINITY;
  for (const auto& [block, of] : blocks) {
    least = std::min(least, of.first / of.second);
    most = std::max(most, of.first / of.second);
  }
  return std::max(0.0, most - least);
}

// The readings of the twin's sensor with this seed.
std::vector<Reading> twin_forces(const Tape& tape, const PushComponent& along,
                                 const std::vector<Wrench>& felt, std::uint64_t seed) {
  std::vector<Reading> out;
  out.reserve(felt.size());
  sim::ForcePlant sensor(tape.twin.twin.force, seed);
  for (std::size_t i = 0; i < felt.size(); ++i) {
    const Time t(Duration(static_cast<std::int64_t>(i) * from_seconds(tape.scene.dt).count()));
    sensor.measure(t, tape.scene.dt, felt[i], Vec<'F'>::zero());
    out.push_back({static_cast<double>(i), along(i, sensor.sample().value.force)});
  }
  return out;
}

std::vector<Reading> tick_by_tick(const Forces& forces) {
  std::vector<Reading> out;
  out.reserve(forces.size());
  for (const double force : forces) out.push_back({static_cast<double>(out.size()), force});
  return out;
}

// A probe that moves nearer without more force touches nothing: weight and inertia do not change.
bool alike_all(const Forces& twin, const Forces& stepped) {
  return std::equal(twin.begin(), twin.end(), stepped.begin(), stepped.end(),
                    [](double a, double b) { return std::abs(a - b) < kSame; });
}

// Reports that the twin's probe presses nothing. felt: force change of the record's probe; thought: that of
// the twin's, at the assumed place of its object.
void nothing_there(double felt, double thought, Shadow& shadow) {
  if (felt > kFelt)
    return diverges_grossly(
        shadow, Channel::force,
        fmt::format("the probe felt {:.1f} N where the twin has nothing that it presses", felt));
  if (thought > kFelt)
    return diverges_grossly(
        shadow, Channel::force,
        fmt::format("the probe felt nothing where the twin's presses with {:.1f} N", thought));
  cannot_judge(shadow, Channel::force, "the probe pressed nothing that the twin has there");
}

// What the record's probe felt.
struct ProbeData {
  PushComponent along;
  std::vector<Reading> readings;
  double pressed;  // N, by felt_at_most
  Rows rows;
};

ProbeData probed_in(const Tape& tape) {
  const PushComponent along(tape);
  std::vector<Reading> readings = recorded_forces(tape, along);
  const double pressed = felt_at_most(readings, tape.scene.dt);
  return {along, std::move(readings), pressed, rows_of(tape)};
}

// The twin's probe, moved until it feels what the record's felt.
struct Match {
  double nearer = 0.0, late = 0.0;  // m, s: how far it was moved
  double thought = 0.0;             // N, by felt_at_most, before it was moved
  std::vector<Wrench> felt{};
  Forces twin{}, stepped{};  // along the push; stepped: kStep nearer
  ForceComparison found{};
  bool touches = true, settled = false;
};

Match match_twin(const Tape& tape, const ProbeData& real) {
  const models::Setup quiet = faultless(tape.twin);
  Match at;
  for (int round = 0; round < kMostRounds; ++round) {
    at.felt = felt_by_twin(tape, quiet, at.nearer);
    at.twin = along_push(real.along, at.felt);
    at.stepped = along_push(real.along, felt_by_twin(tape, quiet, at.nearer + kStep));
    const auto [least, most] = std::minmax_element(at.twin.begin(), at.twin.end());
    if (round == 0) at.thought = felt_at_most(tick_by_tick(at.twin), tape.scene.dt);
    at.touches = real.rows.pushes != 0 && !alike_all(at.twin, at.stepped);
    if (!at.touches) break;
    at.found = compare(real.rows, real.readings, at.twin, at.stepped, at.late);
    const ForceComparison& found = at.found;
    if (!std::isfinite(found.nearer.value) || !std::isfinite(found.alike.value)) break;
    at.settled = std::abs(found.nearer.value) < kSettled;
    if (at.settled || round + 1 == kMostRounds) break;
    // Move the twin's probe until it measures the recorded force, in steps within which the law is nearly
    // straight. If the shapes disagree completely, only the size of the force gives the direction.
    const double towards = real.pressed > *most - *least ? kBend : -kBend;
    at.nearer += found.alike.value > 0.0 ? std::clamp(found.nearer.value, -kBend, kBend) : towards;
    if (std::isfinite(found.late.value)) at.late = std::clamp(at.late + found.late.value, -0.02, 0.02);
  }
  return at;
}

// False if the forces give no numbers to judge; `shadow` has the reason.
bool gives_numbers(const Match& at, Shadow& shadow) {
  if (!at.settled && std::abs(at.nearer) > kFarthest) {
    diverges_grossly(
        shadow, Channel::force,
        fmt::format(
            "the object, or the machine, stands elsewhere: more than {:.0f} mm {} each other than the "
            "twin's",
            1e3 * kFarthest, at.nearer > 0.0 ? "nearer to" : "farther from"));
    return false;
  }
  if (!at.found.alike.known()) {
    cannot_judge(shadow, Channel::force, "the probe pressed for too short a time");
    return false;
  }
  if (!at.settled && !(at.found.alike.value > 0.0)) {
    diverges_grossly(
        shadow, Channel::force,
        "what the probe felt is not what the twin's object pushes back with, wherever it stands");
    return false;
  }
  return true;
}

// Judges the numbers of the match beside those of twins with sensors of their own.
void add_match(const Tape& tape, const ProbeData& real, const Match& at, Shadow& shadow) {
  std::vector<double> alike, place, time, rest;
  for (std::vector<double>* one : {&alike, &place, &time, &rest}) one->reserve(kTwins);
  for (std::size_t k = 0; k < kTwins; ++k) {
    const ForceComparison one =
        compare(real.rows, twin_forces(tape, real.along, at.felt, twin_seed(k)), at.twin, at.stepped, 0.0);
    alike.push_back(one.alike.value);
    place.push_back(one.nearer.value);
    time.push_back(one.late.value);
    rest.push_back(one.rms);
  }
  const ForceComparison& found = at.found;
  models::Interval stiffer = beside_twins(found.alike, alike);
  add(shadow, Channel::force, Quantity::stiffness, stiffer, bounds::kStiffness);
  models::Interval off = beside_twins(found.nearer, place);
  off.value += at.nearer;
  add(shadow, Channel::force, Quantity::object_place, off, bounds::kObjectPlace);
  models::Interval delay = beside_twins(found.late, time);
  delay.value += at.late;
  add(shadow, Channel::force, Quantity::force_time, delay, bounds::kForceTime);
  // Elastic legs shake their load, and the twin's legs do not move here, so skip their residual.
  if (!tape.twin.twin.structural())
    add(shadow, Channel::force, Quantity::force_rest, beside_twins({found.rms, 0.0}, rest),
        bounds::kForceRest);
  shadow.facts.push_back(
      {Channel::force, fmt::format("{}; what is left of the force is {:.3f} N rms, of the twin's {:.3f} N",
                                   counted(real.rows.pushes, "push"), found.rms, of_twins(rest).value)});
}

}  // namespace

void see_probed(const Tape& tape, Shadow& shadow) {
  if (tape.scene.indentation() == nullptr || !tape.scene.has_force) return;
  const ProbeData real = probed_in(tape);
  const Match at = match_twin(tape, real);
  if (!at.touches) return nothing_there(real.pressed, at.thought, shadow);
  if (gives_numbers(at, shadow)) add_match(tape, real, at, shadow);
}

// A rendered object. The measured force gives the displacement of the twin's object, rendered by the twin's
// machine. The core runs again on the devices' data; only the machine is the twin's.

namespace {

constexpr double kDepthBlock = 0.25;  // s
constexpr double kDeep = 0.1e-3;      // m: a shallower press gives no slope
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
    if (machine.known() && was_sent(frame) && outputs.manipulator.tip.valid())
      machine.command(outputs.manipulator.tip);
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
  if (tape.scene.admittance() == nullptr || !tape.scene.has_force) return;
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
    fit.add(one.t, row, one.recorded, one.contact);  // each contact has its own offset
  }
  const models::BlockFit::Result found = fit.solve();
  const models::Interval& deeper = found.values[kDeeper];
  const models::Interval stiffer{1.0 / deeper.value - 1.0, deeper.half / (deeper.value * deeper.value)};
  add(shadow, Channel::rendering, Quantity::rendered, stiffer, bounds::kRendered);
  shadow.facts.push_back({Channel::rendering, fmt::format("{}; what is left of the depth is {:.3f} mm rms",
                                                          counted(contacts, "contact"), 1e3 * found.rms)});
}

}  // namespace enc::trial
