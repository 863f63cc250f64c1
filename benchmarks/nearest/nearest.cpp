// How fast is the nearest point? Our tree against Embree's point query, on a hand that comes, hovers,
// touches, presses and slides over the tennis ball as a mesh: same queries, one run, chunks interleaved.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/kit.h"
#include "benchmarks/peers/peers.h"
#include "core/mesh/mesh_tree.h"
#include "core/module.h"
#include "models/shapes/shapes.h"

namespace enc::bench::nearest {
namespace {

constexpr double kStep = 0.05e-3;        // m: 50 mm/s at 1 kHz
constexpr std::size_t kQueries = 20000;  // 20 s
constexpr std::size_t kChunk = 500;

// Around the ball at kStep a query: from 60 mm down, a hover up to 60 mm and back, touch, slide, press to
// 3 mm, slide, off again.
std::vector<Point<'O'>> hand_path() {
  struct Leg {
    double to, rise;  // height at its end, m, and the share of the way that goes up; 0: `to` is a way along
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
      heading = Eigen::AngleAxisd(2e-4, outward) * (turn * heading);  // never the same way twice
      heading = (heading - heading.dot(outward) * outward).normalized();
      outward.normalize();
    }
  }
  return path;
}

// One who answers, and the CPU seconds that each chunk took.
struct Runner {
  std::vector<double> seconds;
  std::vector<double> distances = std::vector<double>(kQueries);

  template <class Ask>
  void chunk(const std::vector<Point<'O'>>& path, std::size_t first, Ask& ask) {
    const double start = thread_seconds();
    for (std::size_t i = first; i < first + kChunk; ++i) distances[i] = ask.answer(path[i]);
    seconds.push_back(thread_seconds() - start);
  }
  [[nodiscard]] double nanoseconds(double share) const { return percentile(seconds, share) / kChunk * 1e9; }
};

// Warm: each query gets the answer of the one before.
struct Ours {
  const MeshTree& tree;
  std::int32_t hint = -1;
  double answer(const Point<'O'>& p) {
    const Nearest at = tree.nearest(p, hint);
    hint = at.feature;
    return at.distance;
  }
};
// The radius hint: the last distance, and how far the query has moved since.
struct Theirs {
  NearestPeer& peer;
  double distance = 1.0;
  std::optional<Point<'O'>> before;
  double answer(const Point<'O'>& p) {
    const double radius = (distance + (before ? (p - *before).norm() : 0.0)) * (1.0 + 1e-5) + 1e-7;
    const NearestPeer::Found found = peer.nearest(
        {static_cast<float>(p.xyz[0]), static_cast<float>(p.xyz[1]), static_cast<float>(p.xyz[2])},
        static_cast<float>(radius));
    before = p;
    distance = found.distance;
    return distance;
  }
};

struct Race {
  Runner ours, again, theirs;
  [[nodiscard]] static double median_ratio(const Runner& a, const Runner& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.seconds.size(); ++i) ratios.push_back(a.seconds[i] / b.seconds[i]);
    return percentile(ratios, 0.5);
  }
};

// Every chunk is answered by all, in an order drawn anew; ours takes part twice, to know what a ratio of one
// looks like here.
Race race(const MeshTree& tree, NearestPeer* peer, int laps, const BenchContext& context) {
  const std::vector<Point<'O'>> path = hand_path();
  std::mt19937_64 random(context.seed);
  Race result;
  for (int lap = -1; lap < laps; ++lap) {
    if (lap == 0)  // the first was to warm up
      for (Runner* runner : {&result.ours, &result.again, &result.theirs}) runner->seconds.clear();
    Ours ours{tree};
    Ours again{tree};
    std::optional<Theirs> theirs;
    if (peer != nullptr) theirs.emplace(Theirs{*peer, 1.0, {}});
    for (std::size_t first = 0; first < kQueries; first += kChunk) {
      std::array<int, 3> order{0, 1, 2};
      std::shuffle(order.begin(), order.end(), random);
      for (const int who : order) {
        if (who == 0) result.ours.chunk(path, first, ours);
        if (who == 1) result.again.chunk(path, first, again);
        if (who == 2 && theirs) result.theirs.chunk(path, first, *theirs);
      }
    }
  }
  return result;
}

struct Jumps {
  double point = 0.0, normal = 0.0;  // m beyond the way of the query; rad
};
Jumps largest_jumps(const MeshTree& tree) {
  const std::vector<Point<'O'>> path = hand_path();
  Jumps most;
  Nearest before = tree.nearest(path.front());
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Nearest at = tree.nearest(path[i], before.feature);
    most.point = std::max(most.point, (at.point - before.point).norm() - (path[i] - path[i - 1]).norm());
    const double sine = at.normal.e().cross(before.normal.e()).norm();
    most.normal = std::max(most.normal, std::atan2(sine, dot(at.normal, before.normal)));
    before = at;
  }
  return most;
}

class Report {
 public:
  explicit Report(BenchResult& result) : result_(result) {}
  void operator()(const std::string& id, double value, const char* unit, const char* note,
                  double low = kUnset, double high = kUnset) {
    result_.figures.push_back({"nearest." + id, kUnset, value, unit, Role::ours, low, high, note});
  }

 private:
  BenchResult& result_;
};

void against_peer(const Race& raced, Report& add) {
  add("ball_100k.ratio_to_embree.median", Race::median_ratio(raced.theirs, raced.ours), "x",
      "Embree's point query, radius hint, over our signed query, warm; chunks of 500 interleaved", 3.0);
  add("ball_100k.embree.p50", raced.theirs.nanoseconds(0.5), "ns", "a query, over chunks");
  add("ball_100k.embree.p99", raced.theirs.nanoseconds(0.99), "ns", "a query, over chunks");
  double apart = 0.0;
  for (std::size_t i = 0; i < kQueries; ++i)
    apart = std::max(apart, std::abs(std::abs(raced.ours.distances[i]) - raced.theirs.distances[i]));
  add("ball_100k.apart_from_embree.max", apart, "m", "distances; Embree computes in float", kUnset, 1e-6);
}

}  // namespace

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  Report add(result);
  const int laps = static_cast<int>(context.count(3, 1));
  const Mesh ball = models::geodesic_ball(71);
  const MeshTree tree(ball);
  std::unique_ptr<NearestPeer> embree;
  const ModuleInfo* module = context.module ? context.module("peers") : nullptr;
  const auto* peers = module != nullptr ? static_cast<const PeersModule*>(module->peers) : nullptr;
  if (peers != nullptr && peers->embree != nullptr)
    embree = peers->embree(ball);
  else
    result.note = "no race: Embree was not there when this was built (./encounter bench installs it)";
  const Race raced = race(tree, embree.get(), laps, context);
  if (context.progress) context.progress(0.4);
  if (embree) against_peer(raced, add);
  add("ball_100k.p50", raced.ours.nanoseconds(0.5), "ns", "a query, over chunks of 500, thread CPU time");
  add("ball_100k.p99", raced.ours.nanoseconds(0.99), "ns", "a query, over chunks of 500");
  add("same_over_same.median", Race::median_ratio(raced.again, raced.ours), "x",
      "ours over ours in the same run: how far the machine can be trusted");
  const Jumps jumps = largest_jumps(tree);
  add("ball_100k.point_jump.max", jumps.point * 1e3, "mm",
      "of the point between ticks, beyond the hand's way", kUnset, 0.1);
  add("ball_100k.normal_jump.max", jumps.normal * 180.0 / M_PI, "deg", "of the normal between ticks");

  const Race small = race(MeshTree(models::geodesic_ball(7)), nullptr, laps, context);
  const Mesh large = models::geodesic_ball(224);
  if (context.progress) context.progress(0.6);
  const double start = thread_seconds();
  const MeshTree large_tree(large);
  const double built = thread_seconds() - start;
  if (context.progress) context.progress(0.8);
  const Race big = race(large_tree, nullptr, laps, context);
  add("ball_1k.p50", small.ours.nanoseconds(0.5), "ns", "980 triangles");
  add("ball_1M.p50", big.ours.nanoseconds(0.5), "ns", "1,003,520 triangles");
  add("ball_1M.p99", big.ours.nanoseconds(0.99), "ns", "1,003,520 triangles");
  add("growth_1k_to_1M.median", Race::median_ratio(big.ours, small.ours), "x", "the same hand", kUnset, 3.5);
  add("ball_1M.build", built, "s", "the tree, normals included; CPU time", kUnset, 2.0);
  add("ball_1M.memory",
      static_cast<double>(large_tree.memory_bytes()) / static_cast<double>(large.triangles.size()), "B/tri",
      "the mesh included", kUnset, 150.0);
}

const Entry kEntry{"nearest", "geodesic ball",
                   "nearest point on a mesh: time, growth, jumps, race against Embree", run};

}  // namespace enc::bench::nearest
