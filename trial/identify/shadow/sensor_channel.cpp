// The force sensor of a rendered object while no tool touches the tip: its noise, and its zero beside the
// weight. Both leave the press nearly unchanged, because the core filters and tares the force.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/machine/arm.h"
#include "sim/plants/device_plants.h"
#include "trial/identify/shadow/channels.h"

namespace enc::trial {
namespace {

constexpr double kZeroBlock = 0.25;       // s
constexpr double kApart = 0.05;           // s between a contact and the next tick that counts
constexpr std::size_t kFewestFree = 200;  // readings
constexpr double kDifferences = 6.0;      // variance of a second difference over that of a reading: 1 + 4 + 1

// A reading without a touch, and the force that a sensor without errors gives there, in F.
struct FreeReading {
  std::int64_t tick;
  Vec3 said, expected;  // N
};

// Weight and inertia behind the twin's sensor, in F.
Vec3 load_at(const Tape& tape, const Pose<'H', 'F'>& X_HF, Time t) {
  const TipSample tip = tape.tip.at(t);
  const double mass = tape.twin.twin.hexapod.mass;
  Vec3 load(0.0, 0.0, -mass * kStandardGravity);
  if (tip.acceleration.finite()) load -= mass * (tape.scene.X_WR * tip.acceleration).e();
  return (tape.scene.X_WR * tip.X_RH * X_HF).q().conjugate() * load;
}

std::vector<FreeReading> free_readings(const Tape& tape) {
  const Pose<'H', 'F'> X_HF = pose_of<'H', 'F'>(tape.twin.twin.frames.H_F);
  const auto apart = static_cast<std::int64_t>(kApart / tape.scene.dt);
  std::vector<FreeReading> all;
  std::int64_t touched = tape.first - apart - 1;
  Time newest = Time::min();
  tape.play([&](const RecordedTick& frame) {
    const std::int64_t tick = frame.tick.index;
    if (frame.out.mode == Mode::contact) {
      touched = tick;
      while (!all.empty() && all.back().tick >= tick - apart) all.pop_back();
    }
    const Measurement<Wrench>& said = frame.in.wrench;
    if (said.health != Health::ok || !said.value.force.finite() || said.t <= newest) return;
    newest = said.t;
    if (tick - touched <= apart || !tape.tip.knows(said.t)) return;
    all.push_back({tick, said.value.force.e(), load_at(tape, X_HF, said.t)});
  });
  return all;
}

// N rms along each axis, from second differences: slow forces cancel.
double noise_of(const std::vector<FreeReading>& all) {
  double squares = 0.0, n = 0.0;
  for (std::size_t i = 2; i < all.size(); ++i) {
    if (all[i].tick - all[i - 2].tick != 2) continue;
    squares += (all[i].said - 2.0 * all[i - 1].said + all[i - 2].said).squaredNorm();
    n += 3.0;
  }
  return std::sqrt(squares / (kDifferences * n));
}

// The readings that the twin's sensor with this seed gives in place of the recorded ones.
std::vector<FreeReading> twin_readings(const Tape& tape, std::vector<FreeReading> all, std::uint64_t seed) {
  sim::ForcePlant sensor(tape.twin.twin.force, seed);
  for (FreeReading& one : all) {
    sensor.measure(tape.begin, tape.scene.dt, {Vec<'F'>(one.expected), Vec<'F'>::zero()}, Vec<'F'>::zero());
    one.said = sensor.sample().value.force.e();
  }
  return all;
}

models::Interval zero_of(const Tape& tape, const std::vector<FreeReading>& all, Eigen::Index axis) {
  models::BlockFit fit(1, kZeroBlock);
  for (const FreeReading& one : all)
    fit.add(static_cast<double>(one.tick) * tape.scene.dt, Eigen::VectorXd::Ones(1),
            one.said(axis) - one.expected(axis));
  return fit.solve().values[0];
}

}  // namespace

void see_sensor(const Tape& tape, Shadow& shadow) {
  if (tape.scene.admittance() == nullptr || !tape.scene.has_force || !tape.pressed) return;
  const std::vector<FreeReading> recorded = free_readings(tape);
  if (recorded.size() < kFewestFree)
    return cannot_judge(shadow, Channel::force, "noise and zero of the sensor: it is hardly ever untouched");
  std::vector<std::vector<FreeReading>> twins;
  std::vector<double> noise;
  for (std::size_t k = 0; k < kTwins; ++k) {
    twins.push_back(twin_readings(tape, recorded, twin_seed(k)));
    noise.push_back(noise_of(twins.back()));
  }
  if (const models::Interval usual = of_twins(noise); usual.value > 0.0)
    add(shadow, Channel::force, Quantity::force_noise,
        {noise_of(recorded) / usual.value - 1.0, usual.half / usual.value}, bounds::kNoise);
  const double zero = tape.twin.twin.force.zero;
  if (!(zero > 0.0)) return;
  for (Eigen::Index a = 0; a < 3; ++a)
    add(shadow, Channel::force, Quantity::force_zero, zero_of(tape, recorded, a), bounds::kZeros * zero,
        std::string(1, "xyz"[a]));
}

}  // namespace enc::trial
