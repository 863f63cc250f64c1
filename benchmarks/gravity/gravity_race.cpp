// Kinematics, Jacobian, gravity and J^T f of one pose: closed form and chain against Orocos KDL. Same poses,
// one run, chunks interleaved; ours takes part twice.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "benchmarks/gravity/gravity.h"
#include "benchmarks/kit/cost.h"
#include "benchmarks/peers/peers.h"
#include "core/devices/module.h"

namespace enc::bench::gravity {
namespace {

constexpr std::size_t kPoses = 10'000, kChunk = 250;

// A PHANToM as KDL takes it: three hinges in a row, each with its angle against the one before. The links of
// the parallelogram are left out, to the peer's advantage.
ArmMachine in_a_row(const ArmMachine& machine, double payload) {
  const PhantomGeometry& g = machine.phantom;
  ArmMachine row = machine;
  row.kind = ArmKind::chain;
  row.links = {{"turret", JointKind::hinge, {0, 0, 1}, {0, 0, 0}, 0.0, {0, 0, 0}, Vec3::Constant(g.I_base)},
               {"upper arm", JointKind::hinge, {0, -1, 0}, {0, 0, 0}, g.m_be, {g.l5, 0, 0}, g.I_be},
               {"forearm", JointKind::hinge, {0, -1, 0}, {g.l1, 0, 0}, g.m_a, {0, 0, -0.5 * g.l2}, g.I_a}};
  row.tip = {0, 0, -g.l2};
  // The prop, at the tip, is a part of the last link.
  ChainLink& last = row.links.back();
  last.centre = (last.mass * last.centre + payload * row.tip) / (last.mass + payload);
  last.mass += payload;
  return row;
}
PerJoint relative(const PerJoint& q) { return {q[0], q[1], q[2] - q[1]}; }

struct Question {
  PerJoint q, relative;
  Vec<'R'> force;
};
std::vector<Question> questions(const Arm& arm, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Question> all;
  while (all.size() < kPoses) {
    PerJoint q{};
    for (std::size_t i = 0; i < arm.joints(); ++i)
      q[i] = uniform(arm.machine().drives[i].low, arm.machine().drives[i].high);
    if (!arm.within_limits(q)) continue;
    all.push_back({q, relative(q), Vec<'R'>(uniform(-8, 8), uniform(-8, 8), uniform(-8, 8))});
  }
  return all;
}

ArmAnswer answer(const Arm& arm, const PerJoint& q, const Vec<'R'>& force, double payload) {
  const Mat3 J = arm.jacobian(q);
  ArmAnswer answer{arm.tip(q).e(), arm.gravity(q, payload, Payload::exact)};
  const PerJoint push = arm.torque(J, force);
  for (std::size_t i = 0; i < kMostJoints; ++i) answer.torque[i] += push[i];
  return answer;
}

using Answers = std::vector<ArmAnswer>;
// Tips, m, and torques, N m: largest difference between the two.
std::array<double, 2> apart(const Answers& a, const Answers& b) {
  std::array<double, 2> most{0.0, 0.0};
  for (std::size_t i = 0; i < kPoses; ++i) {
    most[0] = std::max(most[0], (a[i].tip - b[i].tip).norm());
    for (std::size_t j = 0; j < kMostJoints; ++j)
      most[1] = std::max(most[1], std::abs(a[i].torque[j] - b[i].torque[j]));
  }
  return most;
}

}  // namespace

void add_race(const GravityRig& rig, const BenchContext& context, BenchResult& result) {
  const Arm& arm = rig.believed.arm;
  if (arm.machine().kind != ArmKind::phantom) {
    result.note += "no race: it is about the closed form of the PHANToM. ";
    return;
  }
  const Arm row(in_a_row(arm.machine(), rig.believed.payload));
  const ModuleInfo* module = context.module ? context.module("peers") : nullptr;
  const auto* peers = module != nullptr ? static_cast<const PeersModule*>(module->peers) : nullptr;
  std::unique_ptr<ArmPeer> kdl;
  if (peers != nullptr && peers->kdl != nullptr) kdl = peers->kdl(row.machine());
  const std::vector<Question> all = questions(arm, context.seed);
  Answers ours(kPoses), chain(kPoses), theirs(kPoses);
  const auto closed = in_chunks(kPoses, kChunk, [&](std::size_t i) {
    ours[i] = answer(arm, all[i].q, all[i].force, rig.believed.payload);
  });
  std::vector<std::function<void()>> ways{closed, closed, in_chunks(kPoses, kChunk, [&](std::size_t i) {
                                            chain[i] = answer(row, all[i].relative, all[i].force, 0.0);
                                          })};
  if (kdl)
    ways.push_back(in_chunks(
        kPoses, kChunk, [&](std::size_t i) { theirs[i] = kdl->answer(all[i].relative, all[i].force.e()); }));
  constexpr std::size_t kLap = kPoses / kChunk;
  const Race raced(context.count(10, 2) * kLap, ways, kLap);
  const auto nanoseconds = [&](std::size_t way) { return raced.seconds(way) / kChunk * 1e9; };
  add_cost(result, "statics.p50", nanoseconds(0), "ns",
           "kinematics, Jacobian, gravity, J^T f of one pose, closed form; over chunks of 250");
  add_cost(result, "statics.chain.p50", nanoseconds(2), "ns", "the same of a chain of three hinges");
  add_cost(result, "same_over_same.median", raced.ratio(1, 0), "x",
           "ours over ours in the same run: how far the machine can be trusted");
  if (!kdl) {
    result.note += "no race: Orocos KDL was not there when this was built (./encounter bench installs it). ";
    return;
  }
  add_cost(result, "statics.kdl.p50", nanoseconds(3), "ns",
           "Orocos KDL, chain of three hinges without the parallelogram's links");
  add_cost(result, "kdl_ratio.median", raced.ratio(3, 0), "x",
           "KDL over the closed form, chunks of 250 interleaved", 5.0);
  add_cost(result, "kdl_ratio.chain.median", raced.ratio(3, 2), "x", "KDL over our chain, the same machine");
  const auto [tip, torque] = apart(chain, theirs);
  add_figure(result, "apart_from_kdl.tip.max", kUnset, tip, "m", "our chain against KDL", kUnset, 1e-12);
  add_figure(result, "apart_from_kdl.torque.max", kUnset, torque, "N m", "our chain against KDL", kUnset,
             1e-12);
}

}  // namespace enc::bench::gravity
