#include "trial/identify/ball/ball_loops.h"

#include <algorithm>
#include <cmath>

namespace enc::trial {
namespace {

using models::LoopPoint;

constexpr double kMean = 0.01;  // s

// m/s, with which a push comes to its first reading.
double speed_in(const std::vector<LoopPoint>& push) {
  const LoopPoint& later = push[std::min<std::size_t>(push.size() - 1, 10)];
  const double time = later.time - push.front().time;
  return time > 0.0 ? std::max(1e-6, (later.deflection - push.front().deflection) / time) : 1e-6;
}

// From when the ball was left until the first reading: free, then in from the surface at a steady speed.
void come_in(const sim::BallPlant& ball, sim::BallPlantState& state, const std::vector<LoopPoint>& push,
             double free_since, double nearer) {
  const double depth = std::max(0.0, push.front().deflection + nearer);
  const double way_in = depth / speed_in(push);
  ball.step(state, 0.0, std::max(0.0, push.front().time - way_in - free_since));
  ball.step(state, depth, way_in);
}

}  // namespace

BallLoops::BallLoops(std::vector<Pushes> runs) : runs_(std::move(runs)) {
  std::vector<double> measured;
  for (const Pushes& run : runs_)
    for (const auto& push : run) {
      readings_ += push.size();
      bool first = true;
      for (std::size_t from = 0, to = 0; from < push.size(); from = to) {
        models::NoisyMean mean{0.0, 0.0, first};
        double force = 0.0;
        for (; to < push.size() && push[to].time < push[from].time + kMean - 1e-9; ++to) {
          mean.time += push[to].time;
          mean.weight += 1.0;
          force += push[to].force;
        }
        mean.time /= mean.weight;
        means_.push_back(mean);
        measured.push_back(force / mean.weight);
        first = false;
      }
    }
  measured_ = Eigen::Map<const Eigen::VectorXd>(measured.data(), static_cast<Eigen::Index>(measured.size()));
}

std::size_t BallLoops::pushes() const {
  std::size_t count = 0;
  for (const Pushes& run : runs_) count += run.size();
  return count;
}

Eigen::VectorXd BallLoops::predicted(const sim::BallPlant& ball, double nearer) const {
  Eigen::VectorXd force(measured_.size());
  Eigen::Index at = 0;
  for (const Pushes& run : runs_) {
    sim::BallPlantState state;
    double before = run.empty() ? 0.0 : run.front().front().time - 1e3;
    for (const auto& push : run) {
      come_in(ball, state, push, before, nearer);
      before = push.front().time;
      std::size_t i = 0;
      while (i < push.size()) {
        const auto n = static_cast<std::size_t>(means_[static_cast<std::size_t>(at)].weight);
        double sum = 0.0;
        for (const std::size_t end = i + n; i < end; ++i) {
          sum += ball.step(state, push[i].deflection + nearer, push[i].time - before);
          before = push[i].time;
        }
        force[at++] = sum / static_cast<double>(n);
      }
    }
  }
  return force;
}

}  // namespace enc::trial
