// The machine's commands, and the positions that it reported.
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "models/identify/block_fit.h"
#include "models/setup/driver_table.h"
#include "trial/identify/shadow/channels.h"

namespace enc::trial {
namespace {

constexpr double kMachineBlock = 0.25;  // s
constexpr int kRounds = 6;
constexpr std::size_t kMostRows = 100'000;  // most ticks to compare
constexpr double kMoves = 1e-3;             // m/s, speed of the twin: below, it stands

// Positions of the twin's machine, tick by tick from the first; NaN: unknown.
struct TwinWay {
  double begin, dt;
  std::vector<Vec3> at{};

  [[nodiscard]] Vec3 place(double t) const {
    const double i = (t - begin) / dt;
    if (!(i >= 0.0) || i > static_cast<double>(at.size() - 1)) return Vec3::Constant(kUnset);
    const auto low = std::min(static_cast<std::size_t>(i), at.size() - 1);
    const std::size_t high = std::min(low + 1, at.size() - 1);
    return at[low] + (i - static_cast<double>(low)) * (at[high] - at[low]);
  }
  [[nodiscard]] Vec3 speed(double t) const { return (place(t + dt) - place(t - dt)) / (2.0 * dt); }
};

struct MachineReading {
  double t;  // s, stamp
  Vec3 at;   // m, in R
};

models::BlockFit::Result fit_way(const TwinWay& way, const std::vector<MachineReading>& said, double late) {
  models::BlockFit fit(4, kMachineBlock);
  const std::size_t stride = 1 + said.size() / kMostRows;
  for (std::size_t k = 0; k < said.size(); k += stride) {
    const Vec3 place = way.place(said[k].t - late), speed = way.speed(said[k].t - late);
    if (!place.allFinite() || !speed.allFinite()) continue;
    for (Eigen::Index a = 0; a < 3; ++a) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(4);
      row(a) = 1.0;
      row(3) = -speed(a);
      fit.add(said[k].t, row, said[k].at(a) - place(a));
    }
  }
  return fit.solve();
}

// m rms, of all three axes: residual beyond delay and offset. It is the larger one of the moving and the
// standing part, so that neither hides behind the other.
double rest_of(const TwinWay& way, const std::vector<MachineReading>& said, double late,
               const models::BlockFit::Result& found) {
  const Vec3 off(found.values[0].value, found.values[1].value, found.values[2].value);
  double squares[2] = {0.0, 0.0}, rows[2] = {0.0, 0.0};  // standing, moving
  for (const MachineReading& one : said) {
    const Vec3 place = way.place(one.t - late), speed = way.speed(one.t - late);
    if (!place.allFinite() || !speed.allFinite()) continue;
    const int moves = speed.norm() > kMoves ? 1 : 0;
    squares[moves] += (one.at - place - off).squaredNorm();
    ++rows[moves];
  }
  double most = kUnset;
  for (const int part : {0, 1})
    if (rows[part] > 0.0) most = std::fmax(most, std::sqrt(squares[part] / rows[part]));
  return most;
}

// s between two set-points of the machine's driver, [driver.NAME] cycle_ms; 0: the driver has no such key.
double wire_cycle(const RigSpec& rig) {
  const std::string text = models::driver_text(rig, rig.manipulator.driver, "cycle_ms");
  double ms = 0.0;
  return std::from_chars(text.data(), text.data() + text.size(), ms).ec == std::errc() ? 1e-3 * ms : 0.0;
}

// The twin's way at the record's commands, and what the machine said.
struct Ways {
  TwinWay twin;
  std::vector<MachineReading> said{};
  double travel = 0.0;  // m, greatest distance from where it began
};

Ways ways_of(const Tape& tape) {
  ToldMachine twin(tape);
  Ways ways{{in_seconds(tape.begin), tape.scene.dt}};
  std::vector<Vec3>& at = ways.twin.at;
  std::vector<MachineReading>& said = ways.said;
  at.reserve(static_cast<std::size_t>(tape.last - tape.first + 1));
  Time newest = Time::min();
  tape.play([&](const RecordedTick& frame) {
    twin.advance(frame);
    const Vec3 place = twin.known() ? Vec3(twin.said().X_RH.p()) : Vec3(Vec3::Constant(kUnset));
    at.resize(static_cast<std::size_t>(frame.tick.index - tape.first), Vec3::Constant(kUnset));
    at.push_back(place);
    if (was_sent(frame)) twin.command(frame.out.manipulator.tip);
    if (is_well(frame.in.tip) && frame.in.tip.t > newest) {
      newest = frame.in.tip.t;
      said.push_back({in_seconds(newest), frame.in.tip.value.X_RH.p()});
      ways.travel = std::max(ways.travel, (said.back().at - said.front().at).norm());
    }
  });
  return ways;
}

// Offset and delay of the machine, round by round; late: the delay, s.
models::BlockFit::Result fit_delay(const Ways& ways, double& late) {
  models::BlockFit::Result found;
  for (int round = 0; round < kRounds; ++round) {
    found = fit_way(ways.twin, ways.said, late);
    const double more = found.values[3].value;
    if (!std::isfinite(more)) break;
    late = std::clamp(late + more, -0.5, 0.5);
    if (std::abs(more) < 1e-6) break;
  }
  return found;
}

// The offset along the axes of W.
void add_offset(const Tape& tape, const models::BlockFit::Result& found, Shadow& shadow) {
  const Mat3 axes = tape.scene.X_WR.q().toRotationMatrix();
  for (Eigen::Index a = 0; a < 3; ++a) {
    models::Interval off{0.0, 0.0};
    for (Eigen::Index b = 0; b < 3; ++b) {
      const models::Interval& one = found.values[static_cast<std::size_t>(b)];
      off.value += axes(a, b) * one.value;
      off.half = std::hypot(off.half, axes(a, b) * one.half);
    }
    add(shadow, Channel::machine, Quantity::machine_place, off, bounds::kMachinePlace,
        std::string(1, "xyz"[a]));
  }
}

}  // namespace

void see_machine(const Tape& tape, Shadow& shadow) {
  if (!tape.sent) return cannot_judge(shadow, Channel::machine, "nothing was sent to it: this was a dry run");
  const Ways ways = ways_of(tape);
  double late = 0.0;
  const models::BlockFit::Result found = fit_delay(ways, late);
  constexpr double kMoved = 0.1e-3;  // m
  if (ways.travel > kMoved)
    add(shadow, Channel::machine, Quantity::machine_time, {late, found.values[3].half},
        bounds::kMachineTime + bounds::kMachineCycles * wire_cycle(tape.twin.rig));
  else
    cannot_judge(shadow, Channel::machine, "it stood still: when it answers is not in this record");
  add_offset(tape, found, shadow);
  add(shadow, Channel::machine, Quantity::machine_rest, {rest_of(ways.twin, ways.said, late, found), 0.0},
      bounds::kMachineRest);
}

}  // namespace enc::trial
