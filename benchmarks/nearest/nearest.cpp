// Speed of the nearest point: our tree against Embree's point query. A hand comes, hovers, touches, presses
// and slides over the tennis ball as a mesh: equal queries, one run, chunks interleaved.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/peers/peers.h"
#include "core/base/units.h"
#include "core/devices/module.h"
#include "core/shape/surface/mesh_tree.h"
#include "models/shapes/shapes.h"

namespace enc::bench::nearest {
namespace {

constexpr double kStep = 0.05e-3;        // m: 50 mm/s at 1 kHz
constexpr std::size_t kQueries = 20000;  // 20 s
constexpr std::size_t kChunk = 500;
constexpr double kBuild = 8e5;  // yardsticks: measured 2.8e5, on a busy machine

// A path around the ball with kStep per query: from 60 mm down, a hover up to 60 mm and back, touch, slide,
// press to 3 mm, slide, off again.
std::vector<Point<'O'>> hand_path() {
  struct Leg {
    double to, rise;  // height at its end, m, and the vertical share of the path; 0: `to` is a length along
                      // the surface
  };
  constexpr std::array<Leg, 8> kLegs{{{0.020, -1.0},
                                      {0.060, 0.5},
                                      {0.020, -0.5},
                                      {0.000, -0.7},
                                      {0.120, 0.0},
                                      {-0.003, -0.2},
                                      {0.120, 0.0},
                                      {0.020, 1.0}}};
  std::vector<Point<'O'>> path;
  double height = 0.060;
  Vec3 outward = Vec3(0.3, 0.4, 0.86).normalized();
  Vec3 heading = outward.unitOrthogonal();
  for (std::size_t leg = 0; path.size() < kQueries; leg = (leg + 1) % kLegs.size()) {
    const auto [to, rise] = kLegs[leg];
    const double length = rise == 0.0 ? to : (to - height) / rise;
    for (double way = 0.0; way < length && path.size() < kQueries; way += kStep) {
      path.emplace_back(Vec3((models::kBallRadius + height) * outward));
      height += rise * kStep;
      const double angle = std::sqrt(1.0 - rise * rise) * kStep / (models::kBallRadius + height);
      const Eigen::AngleAxisd turn(angle, outward.cross(heading));
      outward = turn * outward;
      heading = Eigen::AngleAxisd(2e-4, outward) * (turn * heading);  // never the same path twice
      heading = (heading - heading.dot(outward) * outward).normalized();
      outward.normalize();
    }
  }
  return path;
}

// Warm start: each query gets the answer of the one before.
struct WarmStart {
  const MeshTree& tree;
  std::int32_t hint = -1;
  double answer(const Point<'O'>& p) {
    const SurfacePoint at = tree.nearest(p, hint);
    hint = at.feature;
    return at.distance;
  }
};
// The radius hint: the last distance plus the motion of the query since.
struct RadiusHint {
  NearestPeer& peer;
  double distance = 1.0;
  std::optional<Point<'O'>> before{};
  double answer(const Point<'O'>& p) {
    const double radius = (distance + (before ? (p - *before).norm() : 0.0)) * (1.0 + 1e-5) + 1e-7;
    const NearestPeer::NearestPoint found = peer.nearest(
        {static_cast<float>(p.xyz[0]), static_cast<float>(p.xyz[1]), static_cast<float>(p.xyz[2])},
        static_cast<float>(radius));
    before = p;
    distance = found.distance;
    return distance;
  }
};

// A contender of the race: each call runs the hand's next chunk, lap after lap.
template <class Ask>
std::function<void()> answering(const std::vector<Point<'O'>>& path, std::vector<double>& distances,
                                Ask ask) {
  return in_chunks(kQueries, kChunk, [&, ask](std::size_t i) mutable { distances[i] = ask.answer(path[i]); });
}
Race race(std::size_t laps, const std::vector<std::function<void()>>& ways) {
  constexpr std::size_t kLap = kQueries / kChunk;
  return {laps * kLap, ways, kLap};
}
// Time of one query, over chunks.
double nanoseconds(const Race& race, std::size_t way, double share) {
  return race.seconds(way, share) / kChunk * 1e9;
}
void tail_figure(Bench& bench, const std::string& id, const Race& race, std::size_t way) {
  const Tail tail = tail_of(race.all(way), 0.99);
  bench.cost(id + "." + tail.word, tail.value / kChunk * 1e9, "ns", "a query, over chunks of 500");
}

struct Jumps {
  double point = 0.0, normal = 0.0;  // m, beyond the motion of the query; rad
};
Jumps largest_jumps(const MeshTree& tree, const std::vector<Point<'O'>>& path, double share) {
  Jumps most;
  SurfacePoint before = tree.nearest(path.front());
  for (std::size_t i = 1; i < path.size(); ++i) {
    const SurfacePoint at = tree.nearest(path[i], before.feature);
    most.point =
        std::max(most.point, (at.point - before.point).norm() - share * (path[i] - path[i - 1]).norm());
    const double sine = at.normal.e().cross(before.normal.e()).norm();
    most.normal = std::max(most.normal, std::atan2(sine, dot(at.normal, before.normal)));
    before = at;
  }
  return most;
}

// A ball of 100,000 triangles. Ours takes part twice, to show how far a ratio of one scatters here.
void against_peer(Bench& bench, const MeshTree& tree, NearestPeer* peer, const std::vector<Point<'O'>>& path,
                  std::size_t laps) {
  std::vector<double> ours(kQueries), again(kQueries), theirs(kQueries);
  std::vector<std::function<void()>> ways{answering(path, ours, WarmStart{tree}),
                                          answering(path, again, WarmStart{tree})};
  if (peer != nullptr) ways.push_back(answering(path, theirs, RadiusHint{*peer}));
  const Race raced = race(laps, ways);
  if (peer != nullptr) {
    bench.cost("ball_100k.ratio_to_embree.median",
               bench.context.mutated("exchange_race") ? raced.ratio(0, 2) : raced.ratio(2, 0), "x",
               at_least(2.0),
               "Embree's point query, radius hint, over our signed query, warm; chunks of 500 interleaved");
    bench.cost("ball_100k.embree.p50", nanoseconds(raced, 2, 0.5), "ns", "a query, over chunks");
    tail_figure(bench, "ball_100k.embree", raced, 2);
    double apart = 0.0;
    const std::size_t later = bench.context.mutated("next_query") ? 1 : 0;
    for (std::size_t i = 0; i + later < kQueries; ++i)
      apart = std::max(apart, std::abs(std::abs(ours[i + later]) - theirs[i]));
    bench.figure("ball_100k.apart_from_embree.max", apart, "m", at_most(1e-6),
                 "distances; Embree computes in float");
  }
  bench.cost("ball_100k.p50", nanoseconds(raced, 0, 0.5), "ns",
             "a query, over chunks of 500, thread CPU time");
  tail_figure(bench, "ball_100k", raced, 0);
  bench.cost("same_over_same.median", raced.ratio(1, 0), "x",
             "ours over ours in the same run: how far the machine can be trusted");
}

void growth(Bench& bench, const std::vector<Point<'O'>>& path, std::size_t laps) {
  const MeshTree small(models::geodesic_ball(7));
  const Mesh ball = models::geodesic_ball(224);
  Yardstick yardstick;
  for (int i = 0; i < 64; ++i) yardstick.measure();
  const double start = thread_seconds();
  const MeshTree large(ball);
  const int work = bench.context.mutated("four_times") ? 4 : 1;
  for (int i = 1; i < work; ++i) (void)MeshTree(ball);
  const double built = thread_seconds() - start;
  for (int i = 0; i < 64; ++i) yardstick.measure();
  bench.progress(0.8);
  std::vector<double> distances(kQueries);
  const auto alone = [&](const MeshTree& tree, int times) {
    const auto way = [ask = answering(path, distances, WarmStart{tree}), times] {
      for (int i = 0; i < times; ++i) ask();
    };
    return race(laps, {way, way});
  };
  const Race few = alone(small, 1), many = alone(large, work);
  bench.cost("ball_1k.p50", nanoseconds(few, 0, 0.5), "ns", "980 triangles");
  bench.cost("ball_1M.p50", nanoseconds(many, 0, 0.5), "ns", "1,003,520 triangles");
  tail_figure(bench, "ball_1M", many, 0);
  bench.cost("growth_1k_to_1M.median", many.ratio(0, few, 0), "x", at_most(5.0), "the same hand");
  bench.cost("ball_1M.build", built, "s", "the tree, normals included; CPU time");
  bench.cost("ball_1M.build_over_yardstick.total", built / yardstick.seconds(), "x", at_most(kBuild),
             "the same over a fixed piece of work of the same run (kit/cost.h)");
  bench.figure("ball_1M.memory",
               (bench.context.mutated("kept_twice") ? 2.0 : 1.0) * static_cast<double>(large.memory_bytes()) /
                   static_cast<double>(ball.triangles.size()),
               "B/tri", at_most(150.0), "the mesh included");
}

void run(Bench& bench) {
  const std::size_t laps = bench.context.count(3, 1);
  const std::vector<Point<'O'>> path = hand_path();
  const Mesh ball = models::geodesic_ball(71);
  const MeshTree tree(ball);
  std::unique_ptr<NearestPeer> embree;
  const ModuleInfo* module = bench.context.module ? bench.context.module("peers") : nullptr;
  const auto* peers = module != nullptr ? static_cast<const PeersModule*>(module->peers) : nullptr;
  if (peers != nullptr && peers->embree != nullptr)
    embree = peers->embree(ball);
  else
    bench.result.note = "no race: Embree was not there when this was built (./encounter bench installs it)";
  against_peer(bench, tree, embree.get(), path, laps);
  bench.progress(0.4);
  const Jumps jumps = largest_jumps(tree, path, bench.context.mutated("way_left") ? 0.0 : 1.0);
  bench.figure("ball_100k.point_jump.max", jumps.point * kMmPerM, "mm", at_most(0.1),
               "of the point between ticks, beyond the hand's way");
  bench.figure("ball_100k.normal_jump.max", jumps.normal * 180.0 / M_PI, "deg",
               "of the normal between ticks");
  growth(bench, path, laps);
}

const Entry kEntry{"nearest", "geodesic ball",
                   "nearest point on a mesh: time, growth, jumps, race against Embree", run};

}  // namespace
}  // namespace enc::bench::nearest
