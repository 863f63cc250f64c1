// A tool that the machine carries, or that presses the tip: its position by the machine and by the tracker,
// and the delay and age of packets.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/rotation.h"
#include "core/base/words.h"
#include "models/identify/block_fit.h"
#include "models/identify/tracker/latency_fit.h"
#include "models/order_statistics.h"
#include "sim/world_spec.h"
#include "trial/identify/shadow/channels.h"

namespace enc::trial {
namespace {

constexpr std::size_t kFewestPackets = 30;
constexpr double kAgeBlock = 0.25;  // s
constexpr double kMost = 0.5;       // share of the tool's motion that the machine's does not explain

// Keeps the packets for whose arrival and stamp the machine's position is known.
std::vector<SeenPacket> with_machine(const Tape& tape, std::vector<SeenPacket> packets) {
  std::erase_if(packets,
                [&](const SeenPacket& one) { return !tape.tip.knows(one.t) || !tape.tip.knows(one.stamp); });
  return packets;
}

double median_pause(const std::vector<SeenPacket>& packets) {
  std::vector<double> pauses;
  pauses.reserve(packets.size());
  for (std::size_t i = 1; i < packets.size(); ++i) pauses.push_back(age(packets[i].t, packets[i - 1].t));
  return models::median(pauses);
}

// A log as for `encounter calibrate tracker`, with equal ticks for the record and its twins.
models::TrackerLog with_packets(models::TrackerLog rows, const Scene& scene,
                                const std::vector<SeenPacket>& packets) {
  rows.packets.reserve(packets.size());
  for (const SeenPacket& one : packets)
    rows.packets.push_back({in_seconds(one.t), in_seconds(one.stamp), Vec3(tip_of(scene, one.tool).e())});
  rows.packet_period = median_pause(packets);
  return rows;
}

bool goes_along(const models::LatencyFit& fit) {
  return fit.carried && fit.in_range && !(fit.unexplained > kMost);
}

// True if only another motion could hide the agreement: a real tracker may be ten times as noisy as the
// twin's.
bool goes_clearly_along(const models::LatencyFit& fit) {
  constexpr double kClear = 0.1;
  return goes_along(fit) && !(fit.unexplained > kClear);
}

// Describes why a carried tool does not move along with the machine.
std::string astray(const models::LatencyFit& fit) {
  if (!fit.carried) return "the tool moved while the machine that carries it stood still";
  if (fit.unexplained > kMost)
    return fmt::format(
        "the tool did not go where the machine carried it: {:.0f} % of its motion is not the machine's; it "
        "is not held, or the camera is turned",
        100.0 * std::min(1.0, fit.unexplained));
  if (fit.latency.value < 0.0)
    return fmt::format(
        "the tool is seen {:.0f} ms before the machine carried it there: times of one of them are wrong",
        -1e3 * fit.latency.value);
  return fmt::format("the tool is seen {:.0f} ms after the machine carried it there: no tracker is so late",
                     1e3 * fit.latency.value);
}

// Age of packets beyond that of their stamps at arrival, s: mean, and interval from blocks of time.
models::Interval mean_age(const std::vector<SeenPacket>& packets) {
  models::BlockFit fit(1, kAgeBlock);
  for (const SeenPacket& one : packets)
    fit.add(in_seconds(one.t), Eigen::VectorXd::Ones(1), age(one.t, one.stamp));
  return fit.solve().values[0];
}

struct Pauses {
  double rate = kUnset, longest = 0.0;  // packets a second; s
};
Pauses pauses_of(const std::vector<SeenPacket>& packets) {
  Pauses out;
  for (std::size_t i = 1; i < packets.size(); ++i)
    out.longest = std::max(out.longest, age(packets[i].t, packets[i - 1].t));
  if (packets.size() > 1)
    out.rate =
        static_cast<double>(packets.size() - 1) / std::max(1e-9, age(packets.back().t, packets.front().t));
  return out;
}

// Judges the numbers that need neither tip nor machine: age of packets by their stamps, and number of
// packets.
void see_ages(const Tape& tape, const std::vector<SeenPacket>& recorded,
              const std::vector<std::vector<SeenPacket>>& twins, bool judge, Shadow& shadow) {
  std::vector<double> ages, rates;
  ages.reserve(twins.size());
  rates.reserve(twins.size());
  double longest = 0.0;
  for (const std::vector<SeenPacket>& packets : twins) {
    ages.push_back(mean_age(packets).value);
    const Pauses pauses = pauses_of(packets);
    rates.push_back(pauses.rate);
    longest = std::max(longest, pauses.longest);
  }
  const models::Interval older = beside_twins(mean_age(recorded), ages);
  // Over a network the quickest packet is as old as the rig file says, so the mean shows only the jitter.
  const bool wire = tape.twin.rig.tracker.driver != "sim";
  if (judge && wire) {
    cannot_judge(shadow, Channel::tool,
                 "how late it is seen: a constant delay is not in stamps that are tied to when packets come");
    if (older.known())
      shadow.facts.push_back(
          {Channel::tool,
           fmt::format("by their stamps packets come {:.2f} +- {:.2f} ms later than from the twin's tracker",
                       1e3 * older.value, 1e3 * older.half)});
  } else if (judge) {
    add(shadow, Channel::tool, Quantity::tool_latency, older, bounds::kToolLatency);
  }
  const Pauses pauses = pauses_of(recorded);
  shadow.facts.push_back(
      {Channel::clock,
       fmt::format("{:.1f} packets of the tool a second, the twin's {:.1f}; longest pause {:.0f} ms, the "
                   "twin's {:.0f} ms",
                   pauses.rate, of_twins(rates).value, 1e3 * pauses.longest, 1e3 * longest)});
}

// Leads the twin's machine as the record's went. Returns its tip, tick by tick; its trackers see its tool.
models::TrackerLog lead_twin(const Tape& tape, TwinTrackers& trackers) {
  models::TrackerLog rows;
  rows.period = tape.scene.dt;
  lead_world(tape, tape.twin, Vec3::Zero(), [&](Time t, const sim::World& world, const TipSample& led) {
    rows.time.push_back(in_seconds(t));
    rows.tip.emplace_back((tape.scene.X_WR * led.X_RH.origin()).e());
    const sim::TrackerPlant::State& seen = world.tracker->state();  // input of the tracker of this world
    trackers.advance(t, seen.tool_before, seen.before);
  });
  return rows;
}

// Says why too few packets of a carried tool are known; known: their number.
void tell_few_known(const Tape& tape, const std::vector<SeenPacket>& recorded, std::size_t known,
                    Shadow& shadow) {
  const auto arrived = std::count_if(recorded.begin(), recorded.end(),
                                     [&](const SeenPacket& one) { return tape.tip.knows(one.t); });
  if (arrived >= static_cast<std::ptrdiff_t>(kFewestPackets))
    return diverges_grossly(shadow, Channel::tool,
                            "its stamps are of another time than that in which its packets came");
  cannot_judge(shadow, Channel::tool,
               fmt::format("where the machine was is known for {} of its {}; expected {}", known,
                           counted(recorded.size(), "packet"), kFewestPackets));
}

// Judges place and delay of a carried tool beside those of the twins.
void add_carried(const models::LatencyFit& found, const std::vector<models::LatencyFit>& twins,
                 Shadow& shadow) {
  const auto beside = [&](const auto& part) {
    std::vector<double> values;
    values.reserve(twins.size());
    for (const models::LatencyFit& twin : twins) values.push_back(part(twin).value);
    return beside_twins(part(found), values);
  };
  for (std::size_t a = 0; a < 3; ++a)
    add(shadow, Channel::tool, Quantity::registration,
        beside([a](const models::LatencyFit& fit) { return fit.axes[a].bias; }), bounds::kRegistration,
        std::string(1, "xyz"[a]));
  if (!found.latency.known()) return;
  add(shadow, Channel::tool, Quantity::tool_latency,
      beside([](const models::LatencyFit& fit) { return fit.latency; }), bounds::kToolLatency);
  // Packets older than their stamps indicate have stamps that are too late by that difference.
  add(shadow, Channel::tool, Quantity::tool_stamps,
      beside([](const models::LatencyFit& fit) { return fit.stamp_error; }), bounds::kToolStamps);
}

// A tool carried by the machine.
void see_carried(const Tape& tape, const std::vector<SeenPacket>& recorded, Shadow& shadow) {
  TwinTrackers trackers(tape);
  const models::TrackerLog rows = lead_twin(tape, trackers);
  const std::vector<SeenPacket> known = with_machine(tape, recorded);
  if (known.size() < kFewestPackets) {
    see_ages(tape, recorded, trackers.packets(), true, shadow);
    return tell_few_known(tape, recorded, known.size(), shadow);
  }
  const models::LatencyFit found = models::fit_latency(with_packets(rows, tape.scene, known));
  const bool carried = goes_along(found);
  see_ages(tape, recorded, trackers.packets(), !carried || !found.latency.known(), shadow);
  std::vector<models::LatencyFit> twins;
  twins.reserve(kTwins);
  for (const std::vector<SeenPacket>& packets : trackers.packets())
    if (const std::vector<SeenPacket> seen = with_machine(tape, packets); seen.size() >= kFewestPackets)
      twins.push_back(models::fit_latency(with_packets(rows, tape.scene, seen)));
  // A motion that vanishes in the tracker's noise also vanishes in the twin's.
  if (!carried && std::count_if(twins.begin(), twins.end(), goes_clearly_along) > std::ssize(twins) / 2)
    return diverges_grossly(shadow, Channel::tool, astray(found));
  if (!carried)
    return cannot_judge(shadow, Channel::tool,
                        "the machine hardly moved it: it is lost in what its tracker adds");
  add_carried(found, twins, shadow);
}

// A tool that presses the tip. Both tips are round, so their centres are one known length apart. The tracked
// distance gives the tool's offset away from the tip. The sideways offset stays unknown.

constexpr double kPressBlock = 0.25;  // s
constexpr double kFirm = 0.5;         // N: a smaller force may be a touch that is about to end
constexpr double kAround = 0.03;      // s before and after a packet that must be pressed too
constexpr std::size_t kFewest = 30;   // packets

// Ticks with a pressed tip: force, and direction from the haptic-tip to the tool's tip.
struct PressData {
  std::vector<Vec3> felt;  // N, in W, on the tip; NaN: not pressed
  double begin, dt;
  std::vector<Vec3> away{};           // unit vector for each tick
  std::vector<TrackedTool> newest{};  // for each tick

  [[nodiscard]] std::ptrdiff_t tick(double t) const { return std::lround((t - begin) / dt); }
  [[nodiscard]] bool firm(std::ptrdiff_t i) const {
    return i >= 0 && i < static_cast<std::ptrdiff_t>(felt.size()) &&
           felt[static_cast<std::size_t>(i)].norm() > kFirm;  // false for NaN
  }
  [[nodiscard]] bool firm_around(double t) const {
    const auto reach = static_cast<std::ptrdiff_t>(kAround / dt);
    for (std::ptrdiff_t i = tick(t) - reach; i <= tick(t) + reach; ++i)
      if (!firm(i)) return false;
    return true;
  }
};

double length_between(const Scene& scene, const TrackedTool& tool) {
  return scene.tip_radius + scene.tools[static_cast<std::size_t>(tool.tool)].tip.radius;
}

// Vector from the haptic-tip to the tool's tip, at a packet's stamp. NaN: not pressed.
Vec3 from_tip(const Tape& tape, const PressData& pressed, const SeenPacket& packet) {
  if (!pressed.firm_around(in_seconds(packet.stamp)) || !tape.tip.knows(packet.stamp))
    return Vec3::Constant(kUnset);
  return (tip_of(tape.scene, packet.tool) - tape.scene.X_WR * tape.tip.at(packet.stamp).X_RH.origin()).e();
}

struct ToolComparison {
  models::Interval away;    // m
  models::Interval stamps;  // s
  models::Interval gives;   // m/N: approach of the tips under load
  double noise = kUnset;    // m rms along each axis, from second differences
  std::size_t packets = 0;
};

// The vector between both tips in a packet that came at this time.
struct LineSample {
  double t;
  Vec3 apart;
};

// Noise along each axis, from second differences. The machine follows the tool, so the press cancels.
double noise_of(const std::vector<LineSample>& line, double pause) {
  double squares = 0.0, n = 0.0;
  for (std::size_t i = 2; i < line.size(); ++i) {
    if (line[i].t - line[i - 2].t > 2.5 * pause) continue;
    squares += (line[i].apart - 2.0 * line[i - 1].apart + line[i - 2].apart).squaredNorm();
    n += 3.0;
  }
  return std::sqrt(squares / (6.0 * n));  // 6: variance of a second difference over that of a sample
}

ToolComparison seen_pressing(const Tape& tape, const PressData& pressed,
                             const std::vector<SeenPacket>& packets) {
  models::BlockFit fit(3, kPressBlock);
  std::vector<LineSample> line;
  for (const SeenPacket& one : packets) {
    const Vec3 apart = from_tip(tape, pressed, one);
    if (!apart.allFinite()) continue;
    line.push_back({in_seconds(one.t), apart});
    const Vec3 away = apart.normalized();
    const Vec3 speed = (tape.scene.X_WR * tape.tip.at(one.stamp).velocity).e();
    const double pressing =
        -pressed.felt[static_cast<std::size_t>(pressed.tick(in_seconds(one.stamp)))].dot(away);
    Eigen::VectorXd row(3);
    row << 1.0, -pressing, -speed.dot(away);
    fit.add(in_seconds(one.stamp), row, apart.norm() - length_between(tape.scene, one.tool));
  }
  const models::BlockFit::Result found = fit.solve();
  return {found.values[0], found.values[2], found.values[1], noise_of(line, median_pause(packets)),
          fit.rows()};
}

// The direction between both tips, as the mean of a contact's packets.
void find_lines(const Tape& tape, const std::vector<SeenPacket>& recorded,
                const std::vector<std::int32_t>& contact, PressData& pressed) {
  std::vector<Vec3> sums(1, Vec3::Zero());
  const auto number = [&](std::ptrdiff_t i) {
    return static_cast<std::size_t>(std::max(0, contact[static_cast<std::size_t>(i)]));
  };
  for (const SeenPacket& one : recorded) {
    const Vec3 apart = from_tip(tape, pressed, one);
    if (!apart.allFinite()) continue;
    const std::size_t n = number(pressed.tick(in_seconds(one.stamp)));
    if (sums.size() <= n) sums.resize(n + 1, Vec3::Zero());
    sums[n] += apart.normalized();
  }
  pressed.away.reserve(pressed.felt.size());
  for (std::size_t i = 0; i < pressed.felt.size(); ++i) {
    const std::size_t n = number(static_cast<std::ptrdiff_t>(i));
    const bool known = n < sums.size() && sums[n].norm() > 0.0;
    pressed.away.push_back(known ? Vec3(sums[n].normalized()) : Vec3(Vec3::Constant(kUnset)));
  }
}

// The true pose of the tool's markers in the twin, whose tips touch; no tool: unknown.
struct ToolTruth {
  std::int32_t tool = -1;
  Pose<'W', 'T'> X_WT = Pose<'W', 'T'>::identity();
};
ToolTruth held_by_twin(const Tape& tape, const PressData& pressed, const Pose<'W', 'R'>& X_WR, std::size_t i,
                       Time t) {
  const TrackedTool& seen = pressed.newest[i];
  if (!pressed.firm(static_cast<std::ptrdiff_t>(i)) || seen.tool < 0 || !pressed.away[i].allFinite())
    return {};
  const sim::ContactTruth& gives = tape.twin.twin.contact;
  const Vec3 tip = (X_WR * tape.tip.at(t).X_RH.origin()).e() +
                   length_between(tape.scene, seen) * pressed.away[i] +
                   (gives.compliance + gives.flexure) * pressed.felt[i];
  const Quat q = (tape.scene.X_WC * seen.X_CT).q();
  const Vec3 tip_T = tape.scene.tools[static_cast<std::size_t>(seen.tool)].tip.centre.e();
  return {seen.tool, {q, Vec3(tip - q * tip_T)}};
}

// The ticks of the record, with the directions between both tips.
PressData pressed_in(const Tape& tape, const std::vector<SeenPacket>& recorded) {
  PressData pressed{{}, in_seconds(tape.begin), tape.scene.dt};
  std::vector<std::int32_t> contact;
  Time newest = Time::min();
  TrackedTool tool;
  tape.play([&](const RecordedTick& frame) {
    if (is_news(frame.in.tool, tape.scene, newest)) tool = frame.in.tool.value;
    const auto n = static_cast<std::size_t>(frame.tick.index - tape.first);
    pressed.felt.resize(n, Vec3::Constant(kUnset));  // fills lost cycles
    pressed.newest.resize(n, tool);
    contact.resize(n, frame.out.contacts);
    const bool touched = frame.out.mode == Mode::contact && frame.out.force_unfiltered.finite();
    pressed.felt.push_back(touched ? Vec3(frame.out.force_unfiltered.e()) : Vec3(Vec3::Constant(kUnset)));
    pressed.newest.push_back(tool);
    contact.push_back(frame.out.contacts);
  });
  find_lines(tape, recorded, contact, pressed);
  return pressed;
}

// The trackers see the tool held by the twin.
void hold_in_twin(const Tape& tape, const PressData& pressed, TwinTrackers& trackers) {
  const Pose<'W', 'R'> X_WR = sim::hexapod_base(tape.twin.twin.hexapod);
  for (std::size_t i = 0; i < pressed.felt.size(); ++i) {
    const Time t = tape.begin + Duration(static_cast<std::int64_t>(i) * from_seconds(tape.scene.dt).count());
    const ToolTruth held = held_by_twin(tape, pressed, X_WR, i, t);
    trackers.advance(t, held.tool, held.X_WT);
  }
}

// The trackers see the tool where the record's tracker saw it.
void hold_as_seen(const Tape& tape, const PressData& pressed, TwinTrackers& trackers) {
  for (std::size_t i = 0; i < pressed.felt.size(); ++i) {
    const Time t = tape.begin + Duration(static_cast<std::int64_t>(i) * from_seconds(tape.scene.dt).count());
    const TrackedTool& seen = pressed.newest[i];
    trackers.advance(t, seen.tool, seen.tool < 0 ? Pose<'W', 'T'>::identity() : tape.scene.X_WC * seen.X_CT);
  }
}

// Judges the stamps of a pressing tool, and its delay. stamps: error of those of each twin; own: packets of
// its tracker.
void add_stamps(const std::vector<SeenPacket>& recorded, const models::Interval& found,
                const std::vector<double>& stamps, const std::vector<std::vector<SeenPacket>>& own,
                Shadow& shadow) {
  add(shadow, Channel::tool, Quantity::tool_stamps, beside_twins(found, stamps), bounds::kToolStamps);
  // A stamp that is too late makes a packet look younger by that error.
  std::vector<double> old;
  old.reserve(kTwins);
  for (std::size_t i = 0; i < own.size(); ++i) old.push_back(mean_age(own[i]).value + stamps[i]);
  const models::Interval age = mean_age(recorded);
  add(shadow, Channel::tool, Quantity::tool_latency,
      beside_twins({age.value + found.value, std::hypot(age.half, found.half)}, old), bounds::kToolLatency);
}

// Judges noise and number of the poses of a pressing tool. noise, packets: of each twin.
void add_poses(const ToolComparison& found, const std::vector<double>& noise,
               const std::vector<double>& packets, Shadow& shadow) {
  if (const models::Interval usual = of_twins(noise); usual.value > 0.0)
    add(shadow, Channel::tool, Quantity::tool_noise,
        {found.noise / usual.value - 1.0, usual.half / usual.value}, bounds::kNoise);
  const models::Interval usual = of_twins(packets);
  const double lost = 1.0 - static_cast<double>(found.packets) / usual.value;
  const double by_luck = 2.0 * std::sqrt(std::max(0.0, lost) / usual.value);  // each pose is lost alone
  add(shadow, Channel::tool, Quantity::tool_loss, {lost, std::hypot(by_luck, usual.half / usual.value)},
      bounds::kLoss);
}

// The force of a press beside the line between both tips, as a sensor with the twin's errors of direction
// would show it. A turn about that line stays unknown.
void add_turned(const Tape& tape, const PressData& pressed, const std::vector<SeenPacket>& recorded,
                Shadow& shadow) {
  const Quat rig = tape.scene.X_HF.q();
  const Quat truth = pose_of<'H', 'F'>(tape.twin.twin.frames.H_F).q();
  const Quat read = rotation_xyz(tape.twin.twin.force.turned).conjugate();
  models::BlockFit right(1, kPressBlock), up(1, kPressBlock);
  Vec3 any = Vec3::Constant(kUnset), line = Vec3::Zero(), began = any, deepest = any;
  double most = 0.0;  // N
  for (const SeenPacket& one : recorded) {
    const Vec3 apart = from_tip(tape, pressed, one);
    if (!apart.allFinite()) continue;
    const Vec3 tip = (tape.scene.X_WR * tape.tip.at(one.stamp).X_RH.origin()).e();
    const Vec3 felt = pressed.felt[static_cast<std::size_t>(pressed.tick(in_seconds(one.stamp)))];
    const Quat q = (tape.scene.X_WR * tape.tip.at(one.stamp).X_RH).q();
    const Vec3 along = q * (rig * (read * (truth.conjugate() * (q.conjugate() * Vec3(-apart.normalized())))));
    if (!any.allFinite()) {
      any = along.unitOrthogonal();
      began = tip;
    }
    line += along;
    if (felt.norm() > most) {
      most = felt.norm();
      deepest = tip;
    }
    const Vec3 side = along.cross(any).normalized();
    const Eigen::VectorXd size = Eigen::VectorXd::Constant(1, felt.dot(along));
    right.add(in_seconds(one.stamp), size, felt.dot(side));
    up.add(in_seconds(one.stamp), size, felt.dot(side.cross(along)));
  }
  const models::Interval a = right.solve().values[0], b = up.solve().values[0];
  const double length = length_between(tape.scene, recorded.front().tool);
  const Vec3 yielded = deepest - began;
  const double beside = std::atan2(line.cross(yielded).norm(), line.dot(yielded));
  add(shadow, Channel::force, Quantity::force_turned,
      {std::atan(std::hypot(a.value, b.value)), std::hypot(a.half, b.half)},
      bounds::kTurned + std::sqrt(2.0) * bounds::kRegistration / length + beside);
}

void see_pressing(const Tape& tape, const std::vector<SeenPacket>& recorded, Shadow& shadow) {
  const PressData pressed = pressed_in(tape, recorded);
  const ToolComparison found = seen_pressing(tape, pressed, recorded);
  const bool told = found.packets >= kFewest;
  TwinTrackers trackers(tape), ages(tape);
  hold_as_seen(tape, pressed, ages);
  see_ages(tape, recorded, ages.packets(), !told || !found.stamps.known(), shadow);
  if (!told)
    return cannot_judge(shadow, Channel::tool,
                        fmt::format("{} came of a tool that pressed the tip, and the machine carried "
                                    "none; expected {}: where it should be seen is not known",
                                    counted(found.packets, "packet"), kFewest));
  hold_in_twin(tape, pressed, trackers);
  std::vector<double> away, stamps, gives, noise, number;
  for (std::vector<double>* one : {&away, &stamps, &gives, &noise, &number}) one->reserve(kTwins);
  for (const std::vector<SeenPacket>& packets : trackers.packets()) {
    const ToolComparison twin = seen_pressing(tape, pressed, packets);
    away.push_back(twin.away.value);
    stamps.push_back(twin.stamps.value);
    gives.push_back(twin.gives.value);
    noise.push_back(twin.noise);
    number.push_back(static_cast<double>(twin.packets));
  }
  add(shadow, Channel::tool, Quantity::registration, beside_twins(found.away, away), bounds::kRegistration,
      "away");
  shadow.unjudged.push_back(
      {Channel::tool, "how far it is seen to the side of the tip that it presses: both are round there"});
  if (found.stamps.known()) add_stamps(recorded, found.stamps, stamps, ages.packets(), shadow);
  add_poses(found, noise, number, shadow);
  add_turned(tape, pressed, recorded, shadow);
  const models::Interval more = beside_twins(found.gives, gives);
  if (more.known())
    shadow.facts.push_back(
        {Channel::tool, fmt::format("tool and tip come nearer by {:.1f} +- {:.1f} um/N more than the twin's",
                                    1e6 * more.value, 1e6 * more.half)});
}

}  // namespace

void see_tool(const Tape& tape, Shadow& shadow) {
  if (!tape.scene.has_tracker) return;
  if (tape.twin.scene.camera)
    return cannot_judge(shadow, Channel::tool,
                        "it is seen by a camera: see `encounter replay --frames` for vision");
  const std::vector<SeenPacket> recorded = recorded_packets(tape);
  if (recorded.size() < kFewestPackets)
    return cannot_judge(shadow, Channel::tool,
                        fmt::format("it was seen {}; expected at least {}", counted(recorded.size(), "time"),
                                    kFewestPackets));
  if (tape.scene.clamped_tool >= 0 && !tape.twin.scene.user) return see_carried(tape, recorded, shadow);
  see_pressing(tape, recorded, shadow);
}

}  // namespace enc::trial
