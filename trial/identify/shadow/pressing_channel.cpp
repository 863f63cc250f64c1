// A tool that presses the tip. Both are round, so the middle of its tip is one known length away from the
// haptic-tip's: how far apart they are seen says how far off the tool is seen, away from the tip. Sideways
// nothing is known of it.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/counted.h"
#include "models/identify/block_fit.h"
#include "sim/world_spec.h"
#include "trial/identify/shadow/bounds.h"
#include "trial/identify/shadow/channels.h"

namespace enc::trial {
namespace {

constexpr double kPressBlock = 0.25;  // s
constexpr double kFirm = 0.5;         // N: less may be a touch that is about to end
constexpr double kAround = 0.03;      // s before and after a packet, in which it is pressed, too
constexpr std::size_t kFewest = 30;   // packets

// In which ticks the tip is pressed, how hard, and where the tool's tip is from the haptic-tip's.
struct Pressed {
  std::vector<Vec3> felt;  // N, in W, on the tip; NaN: it is not pressed
  double begin, dt;
  std::vector<Vec3> away{};           // unit, of each tick
  std::vector<TrackedTool> newest{};  // likewise

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

// From the haptic-tip to the tool's, at a packet's stamp. NaN where it is not pressed.
Vec3 from_tip(const Tape& tape, const Pressed& pressed, const SeenPacket& packet) {
  if (!pressed.firm_around(in_seconds(packet.stamp)) || !tape.tip.knows(packet.stamp))
    return Vec3::Constant(kUnset);
  return (tip_of(tape.scene, packet.tool) - tape.scene.X_WR * tape.tip.at(packet.stamp).X_RH.origin()).e();
}

struct Seen {
  models::Interval away;    // m
  models::Interval stamps;  // s
  models::Interval gives;   // m/N: they come nearer under load
  std::size_t packets = 0;
};

Seen seen_pressing(const Tape& tape, const Pressed& pressed, const std::vector<SeenPacket>& packets) {
  models::BlockFit fit(3, kPressBlock);
  for (const SeenPacket& one : packets) {
    const Vec3 apart = from_tip(tape, pressed, one);
    if (!apart.allFinite()) continue;
    const Vec3 away = apart.normalized();
    const Vec3 speed = (tape.scene.X_WR * tape.tip.at(one.stamp).velocity).e();
    const double pressing =
        -pressed.felt[static_cast<std::size_t>(pressed.tick(in_seconds(one.stamp)))].dot(away);
    Eigen::VectorXd row(3);
    row << 1.0, -pressing, -speed.dot(away);
    fit.add(in_seconds(one.stamp), row, apart.norm() - length_between(tape.scene, one.tool));
  }
  const models::BlockFit::Result found = fit.solve();
  return {found.values[0], found.values[2], found.values[1], fit.rows()};
}

// The line between both tips: what packets say of it in a contact, on the average.
void find_lines(const Tape& tape, const std::vector<SeenPacket>& recorded,
                const std::vector<std::int32_t>& contact, Pressed& pressed) {
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

// Where the tool's markers truly are for the twin, whose tips touch; no tool where it does not know.
struct Held {
  std::int32_t tool = -1;
  Pose<'W', 'T'> X_WT = Pose<'W', 'T'>::identity();
};
Held held_by_twin(const Tape& tape, const Pressed& pressed, const Pose<'W', 'R'>& X_WR, std::size_t i,
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

}  // namespace

void see_pressing(const Tape& tape, const std::vector<SeenPacket>& recorded, Shadow& shadow) {
  Pressed pressed{{}, in_seconds(tape.begin), tape.scene.dt};
  std::vector<std::int32_t> contact;
  Time newest = Time::min();
  TrackedTool tool;
  tape.play([&](const RecordedTick& frame) {
    if (is_news(frame.in.tool, tape.scene, newest)) tool = frame.in.tool.value;
    const auto n = static_cast<std::size_t>(frame.tick.index - tape.first);
    pressed.felt.resize(n, Vec3::Constant(kUnset));  // of lost cycles
    pressed.newest.resize(n, tool);
    contact.resize(n, frame.out.contacts);
    const bool touched = frame.out.mode == Mode::contact && frame.out.felt.finite();
    pressed.felt.push_back(touched ? Vec3(frame.out.felt.e()) : Vec3(Vec3::Constant(kUnset)));
    pressed.newest.push_back(tool);
    contact.push_back(frame.out.contacts);
  });
  find_lines(tape, recorded, contact, pressed);
  const Seen found = seen_pressing(tape, pressed, recorded);
  const bool told = found.packets >= kFewest;
  TwinTrackers trackers(tape), ages(tape);
  const Pose<'W', 'R'> X_WR = sim::hexapod_base(tape.twin.twin.hexapod);
  for (std::size_t i = 0; i < pressed.felt.size(); ++i) {
    const Time t = tape.begin + Duration(static_cast<std::int64_t>(i) * from_seconds(tape.scene.dt).count());
    const TrackedTool& seen = pressed.newest[i];
    ages.advance(t, seen.tool, seen.tool < 0 ? Pose<'W', 'T'>::identity() : tape.scene.X_WC * seen.X_CT);
    if (!told) continue;
    const Held held = held_by_twin(tape, pressed, X_WR, i, t);
    trackers.advance(t, held.tool, held.X_WT);
  }
  see_ages(tape, recorded, ages.packets(), !told || !found.stamps.known(), shadow);
  if (!told)
    return cannot_judge(shadow, Channel::tool,
                        fmt::format("{} came of a tool that pressed the tip, and the machine carried "
                                    "none; expected {}: where it should be seen is not known",
                                    counted(found.packets, "packet"), kFewest));
  std::vector<double> away, stamps, gives;
  for (std::vector<double>* one : {&away, &stamps, &gives}) one->reserve(kTwins);
  for (const std::vector<SeenPacket>& packets : trackers.packets()) {
    const Seen twin = seen_pressing(tape, pressed, packets);
    away.push_back(twin.away.value);
    stamps.push_back(twin.stamps.value);
    gives.push_back(twin.gives.value);
  }
  add(shadow, Channel::tool, Quantity::registration, beside_twins(found.away, away), bounds::kRegistration,
      "away");
  shadow.unjudged.push_back(
      {Channel::tool, "how far it is seen to the side of the tip that it presses: both are round there"});
  if (found.stamps.known()) {
    add(shadow, Channel::tool, Quantity::tool_stamps, beside_twins(found.stamps, stamps),
        bounds::kToolStamps);
    // By its stamp a packet is younger than it is by what that is late.
    const auto& own = ages.packets();
    std::vector<double> old;
    old.reserve(kTwins);
    for (std::size_t i = 0; i < own.size(); ++i) old.push_back(mean_age(own[i]).value + stamps[i]);
    const models::Interval age = mean_age(recorded);
    add(shadow, Channel::tool, Quantity::tool_latency,
        beside_twins({age.value + found.stamps.value, std::hypot(age.half, found.stamps.half)}, old),
        bounds::kToolLatency);
  }
  const models::Interval more = beside_twins(found.gives, gives);
  if (more.known())
    shadow.facts.push_back(
        {Channel::tool, fmt::format("tool and tip come nearer by {:.1f} +- {:.1f} um/N more than the twin's",
                                    1e6 * more.value, 1e6 * more.half)});
}

}  // namespace enc::trial
