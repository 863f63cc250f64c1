// Where a tool that the machine carries was, and where and when it was seen; how old packets are.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/counted.h"
#include "models/identify/block_fit.h"
#include "models/identify/tracker/latency_fit.h"
#include "models/order_statistics.h"
#include "trial/identify/shadow/bounds.h"
#include "trial/identify/shadow/channels.h"

namespace enc::trial {
namespace {

constexpr std::size_t kFewestPackets = 30;
constexpr double kAgeBlock = 0.25;  // s
constexpr double kMost = 0.5;       // of the tool's motion, that the machine's does not explain

// Of those that came, and are of a time, at which it is known where the machine was.
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

// The log that `encounter calibrate tracker` reads, of the same ticks for the record and its twins.
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

// So well that nothing but another motion hides it: a real tracker may be ten times as noisy as the twin's.
bool goes_clearly_along(const models::LatencyFit& fit) {
  constexpr double kClear = 0.1;
  return goes_along(fit) && !(fit.unexplained > kClear);
}

// How a tool that the machine carries does not go along with it.
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

}  // namespace

models::Interval mean_age(const std::vector<SeenPacket>& packets) {
  models::BlockFit fit(1, kAgeBlock);
  for (const SeenPacket& one : packets)
    fit.add(in_seconds(one.t), Eigen::VectorXd::Ones(1), age(one.t, one.stamp));
  return fit.solve().values[0];
}

namespace {

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

}  // namespace

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
  // Over a wire the quickest packet is as old as the rig file says: the mean tells no more than the jitter.
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

void see_carried(const Tape& tape, const std::vector<SeenPacket>& recorded, Shadow& shadow) {
  models::TrackerLog rows;
  rows.period = tape.scene.dt;
  TwinTrackers trackers(tape);
  lead_world(tape, tape.twin, Vec3::Zero(), [&](Time t, const sim::World& world, const TipSample& led) {
    rows.time.push_back(in_seconds(t));
    rows.tip.emplace_back((tape.scene.X_WR * led.X_RH.origin()).e());
    const sim::TrackerPlant::State& seen = world.tracker->state();  // what its own tracker was shown
    trackers.advance(t, seen.tool_before, seen.before);
  });
  const std::vector<SeenPacket> known = with_machine(tape, recorded);
  if (known.size() < kFewestPackets) {
    see_ages(tape, recorded, trackers.packets(), true, shadow);
    const auto arrived = std::count_if(recorded.begin(), recorded.end(),
                                       [&](const SeenPacket& one) { return tape.tip.knows(one.t); });
    if (arrived >= static_cast<std::ptrdiff_t>(kFewestPackets))
      return diverges_grossly(shadow, Channel::tool,
                              "its stamps are of another time than that in which its packets came");
    return cannot_judge(shadow, Channel::tool,
                        fmt::format("where the machine was is known for {} of its {}; expected {}",
                                    known.size(), counted(recorded.size(), "packet"), kFewestPackets));
  }
  const models::LatencyFit found = models::fit_latency(with_packets(rows, tape.scene, known));
  const bool carried = goes_along(found);
  see_ages(tape, recorded, trackers.packets(), !carried || !found.latency.known(), shadow);
  std::vector<models::LatencyFit> twins;
  twins.reserve(kTwins);
  for (const std::vector<SeenPacket>& packets : trackers.packets())
    if (const std::vector<SeenPacket> seen = with_machine(tape, packets); seen.size() >= kFewestPackets)
      twins.push_back(models::fit_latency(with_packets(rows, tape.scene, seen)));
  // A motion that is lost in the tracker's noise is lost in the twin's, too.
  if (!carried && std::count_if(twins.begin(), twins.end(), goes_clearly_along) > std::ssize(twins) / 2)
    return diverges_grossly(shadow, Channel::tool, astray(found));
  if (!carried)
    return cannot_judge(shadow, Channel::tool,
                        "the machine hardly moved it: it is lost in what its tracker adds");
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
  // Packets that are older than their stamps say have stamps that are so much too late.
  add(shadow, Channel::tool, Quantity::tool_stamps,
      beside([](const models::LatencyFit& fit) { return fit.stamp_error; }), bounds::kToolStamps);
}

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
