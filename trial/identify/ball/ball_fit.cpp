#include "trial/identify/ball/ball_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "core/base/error.h"
#include "core/base/units.h"

namespace enc::trial {

std::span<const BallNumber> ball_numbers() {
  using Ball = StandingBall;
  static constexpr std::array<BallNumber, kBallNumbers> kAll{{
      {"rubber_modulus_MPa", kMegapascal, 2.6e6, true, true,
       [](Ball& b) -> double& { return b.law.rubber_modulus; }, "push deeper or more often"},
      {"pressure_kPa", kKilopascal, 10e3, true, false, [](Ball& b) -> double& { return b.law.pressure; },
       "push deeper or more often, or measure it and hold it"},
      {"felt_modulus_MPa", kMegapascal, 0.2e6, true, true,
       [](Ball& b) -> double& { return b.law.felt_modulus; },
       "push more often, or measure where the ball begins and hold nearer_mm"},
      {"friction", 1.0, 0.1, false, false, [](Ball& b) -> double& { return b.law.friction; },
       "come back as well as push, more often"},
      {"friction_travel_mm", kMillimetre, 0.6e-3, false, true,
       [](Ball& b) -> double& { return b.law.friction_travel; }, "come back as well as push, more often"},
      {"relaxing_fast", 1.0, 0.05, false, false, [](Ball& b) -> double& { return b.law.relaxing[0]; },
       "push faster (probe.speed_mm_s = 20)"},
      {"relaxing_middle", 1.0, 0.05, false, false, [](Ball& b) -> double& { return b.law.relaxing[1]; },
       "push faster and stay at depth (probe.dwell_s = 4)"},
      {"relaxing_slow", 1.0, 0.05, false, false, [](Ball& b) -> double& { return b.law.relaxing[2]; },
       "stay at depth (probe.dwell_s = 4), several times"},
      {"nearer_mm", kMillimetre, 0.1e-3, false, false, [](Ball& b) -> double& { return b.nearer; },
       "push more often"},
      {"wall_mm", kMillimetre, 3.5e-3, true, true, [](Ball& b) -> double& { return b.law.wall; },
       "measure it on a cut ball and hold it"},
      {"felt_mm", kMillimetre, 3e-3, true, true, [](Ball& b) -> double& { return b.law.felt; },
       "measure it and hold it: with felt_modulus only what both make together is known"},
      {"relaxation_fast_s", 1.0, 0.05, false, true, [](Ball& b) -> double& { return b.law.relaxation[0]; },
       "push faster (probe.speed_mm_s = 20)"},
      {"relaxation_middle_s", 1.0, 0.5, false, true, [](Ball& b) -> double& { return b.law.relaxation[1]; },
       "stay at depth (probe.dwell_s = 4), several times"},
      {"relaxation_slow_s", 1.0, 5.0, false, true, [](Ball& b) -> double& { return b.law.relaxation[2]; },
       "stay at depth for longer than it is"},
  }};
  return kAll;
}

namespace {

using models::LoopPoint;

constexpr double kMean = 0.01;  // s

// m/s, speed of a push at its first reading.
double speed_in(const std::vector<LoopPoint>& push) {
  const LoopPoint& later = push[std::min<std::size_t>(push.size() - 1, 10)];
  const double time = later.time - push.front().time;
  return time > 0.0 ? std::max(1e-6, (later.deflection - push.front().deflection) / time) : 1e-6;
}

// Advances the ball to the first reading: free since the last push, then pressed in from the surface at a
// steady speed.
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

namespace {

const BallNumber& number_at(std::size_t i) { return ball_numbers()[i]; }

Eigen::VectorXd force_of(const BallLoops& loops, const StandingBall& ball) {
  return loops.predicted(sim::BallPlant(ball.law), ball.nearer);
}

// A point of the search: the ball and the residual of the readings, with the whitened residual and Jacobian.
class Search {
 public:
  Search(const BallLoops& loops, const BallFitOptions& options) : loops_(loops), ball_(options.start) {
    for (std::size_t i = 0; i < kBallNumbers; ++i) (options.free[i] ? free_ : held_).push_back(i);
    // A constant offset carries no information, because each push has its own zero.
    if (loops.means().size() < 2 * loops.pushes() + free_.size() + 10)
      throw Error("there are too few readings for so many numbers", "loop");
    left_ = loops_.measured() - force_of(loops_, ball_);
    slopes_ = ball_jacobian(loops_, ball_, free_);
  }

  // Levenberg-Marquardt with the present noise estimate, until a step is small compared with the standard
  // errors.
  void settle() {
    double damping = 1e-4;
    for (whiten_all(); steps_ < kMostSteps; ++steps_) {
      const Eigen::MatrixXd gram = jacobian_.transpose() * jacobian_;
      const Eigen::VectorXd slope = jacobian_.transpose() * residual_;
      if (damping <= 1e-3 && small(gram, slope)) return;
      Eigen::MatrixXd damped = gram;
      damped.diagonal() *= 1.0 + damping;
      const StandingBall next = moved(damped.ldlt().solve(slope));
      const Eigen::VectorXd left = loops_.measured() - force_of(loops_, next);
      const double cost = whitened(left).squaredNorm();
      if (!(cost <= residual_.squaredNorm())) {
        if ((damping *= 10.0) > 1e9) return;  // rounding: no better ball is near
        continue;
      }
      ball_ = next;
      left_ = left;
      damping = std::max(1e-9, 0.1 * damping);
      slopes_ = ball_jacobian(loops_, ball_, free_);
      whiten_all();
    }
    throw Error("the fit of the ball does not settle; hold a number that is known", "loop");
  }

  // Estimates the noise from the residuals; returns false if it hardly changed.
  bool learn_noise() {
    const models::DriftingNoise found = drifting_noise(loops_.means(), left_, slopes_);
    const bool news = std::abs(std::log(found.walk / noise_.walk)) > 0.1;
    noise_ = found;
    return news;
  }

  [[nodiscard]] BallFit result() {
    whiten_all();
    BallFit fit;
    fit.ball = ball_;
    fit.steps = steps_;
    const double freedom =
        static_cast<double>(left_.size()) - static_cast<double>(loops_.pushes() + free_.size());
    fit.noise = residual_.norm() / std::sqrt(freedom);
    fit.walk = fit.noise * std::sqrt(noise_.walk);
    fit.rms = left_.norm() / std::sqrt(static_cast<double>(left_.size()));
    estimate(fit, freedom);
    hold(fit);
    return fit;
  }

 private:
  static constexpr int kMostSteps = 200;

  [[nodiscard]] Eigen::MatrixXd whitened(const Eigen::MatrixXd& columns) const {
    Eigen::MatrixXd white = columns;
    whiten(loops_.means(), noise_, white);
    return white;
  }
  void whiten_all() {
    residual_ = whitened(left_);
    jacobian_ = whitened(slopes_);
  }
  // True for a step below a thousandth of the standard errors, or of a tiny constant.
  [[nodiscard]] bool small(const Eigen::MatrixXd& gram, const Eigen::VectorXd& slope) const {
    const double gain = slope.dot(gram.ldlt().solve(slope));
    return gain <= std::max(1e-6 * residual_.squaredNorm() / static_cast<double>(residual_.size()), 1e-24);
  }
  [[nodiscard]] StandingBall moved(const Eigen::VectorXd& by) const {
    StandingBall ball = ball_;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const BallNumber& n = number_at(free_[k]);
      double& x = n.of(ball);
      const double to = x + n.scale * by[static_cast<Eigen::Index>(k)];
      x = n.positive ? std::clamp(to, 0.3 * x, 3.0 * x) : to;
    }
    return ball;
  }

  // The inverse of the information matrix. A direction that the readings do not determine is infinitely
  // uncertain.
  void estimate(BallFit& fit, double freedom) const {
    const Eigen::VectorXd doubt = doubts();
    const Eigen::MatrixXd gram = jacobian_.transpose() * jacobian_;
    const Eigen::VectorXd length = gram.diagonal().cwiseSqrt().cwiseMax(1e-300);
    const Eigen::MatrixXd scaled =
        length.cwiseInverse().asDiagonal() * gram * length.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    const Eigen::VectorXd known = eigen.eigenvalues().cwiseMax(0.0);
    fit.condition = known[known.size() - 1] / known[0];
    const Eigen::VectorXd floored = known.cwiseMax(1e-14);
    const Eigen::MatrixXd covariance =
        eigen.eigenvectors() * floored.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const BallNumber& n = number_at(free_[k]);
      const double t = models::student(1.0 / (1.0 / freedom + doubt[i]));
      BallEstimate e{free_[k], {value_of(n, ball_), kUnset}, t * fit.noise * n.scale / length[i]};
      const bool lost = covariance(i, i) > 1e12;
      e.interval.half =
          lost ? std::numeric_limits<double>::infinity() : e.alone * std::sqrt(covariance(i, i));
      for (std::size_t m = 0; m < free_.size(); ++m) {
        const auto j = static_cast<Eigen::Index>(m);
        const double together = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
        if (m == k || std::abs(together) <= std::abs(e.correlation)) continue;
        e.tied = free_[m];
        e.correlation = together;
      }
      fit.estimates.push_back(e);
    }
  }

  // Logarithms of the estimates' variances for a walk changed by the factor exp(by).
  [[nodiscard]] Eigen::VectorXd log_variances(double by) const {
    Eigen::MatrixXd columns(left_.size(), slopes_.cols() + 1);
    columns << left_, slopes_;
    whiten(loops_.means(), {noise_.walk * std::exp(by)}, columns);
    const auto design = columns.rightCols(slopes_.cols());
    const Eigen::MatrixXd gram = design.transpose() * design;
    const Eigen::MatrixXd inverse = gram.ldlt().solve(Eigen::MatrixXd::Identity(gram.rows(), gram.cols()));
    return (columns.col(0).squaredNorm() * inverse.diagonal()).array().abs().log();
  }
  // Satterthwaite: an interval is as uncertain as the noise estimate behind it. Returns 1 / degrees of
  // freedom.
  [[nodiscard]] Eigen::VectorXd doubts() const {
    constexpr double kStep = 0.25;
    const Eigen::VectorXd slope = (log_variances(kStep) - log_variances(-kStep)) / (2.0 * kStep);
    return slope.cwiseAbs2() / std::max(noise_.sureness, 1e-3);
  }

  // Changes of the estimates for a change of each held number, to first order.
  void hold(BallFit& fit) const {
    const Eigen::MatrixXd columns = whitened(ball_jacobian(loops_, ball_, held_));
    const Eigen::MatrixXd moves =
        -(jacobian_.transpose() * jacobian_).ldlt().solve(jacobian_.transpose() * columns);
    for (std::size_t h = 0; h < held_.size(); ++h) {
      const BallNumber& n = number_at(held_[h]);
      HeldNumber held{held_[h], value_of(n, ball_), {}};
      for (std::size_t k = 0; k < free_.size(); ++k) {
        const BallNumber& found = number_at(free_[k]);
        held.moves.push_back(moves(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(h)) * found.scale /
                             value_of(found, ball_) * held.value / n.scale);
      }
      fit.held.push_back(held);
    }
  }

  const BallLoops& loops_;
  StandingBall ball_;
  std::vector<std::size_t> free_, held_;
  models::DriftingNoise noise_{0.02};  // 1/s: start value, that of the rig
  Eigen::VectorXd left_;               // N, measured minus predicted
  Eigen::MatrixXd slopes_;             // slopes of the prediction, N per scale
  Eigen::VectorXd residual_;           // left_, whitened
  Eigen::MatrixXd jacobian_;           // whitened, one column for each free number
  int steps_ = 0;
};

}  // namespace

double BallEstimate::width() const {
  // The ball's position has no size of its own, so use its scale.
  const double size = number == kNearer ? ball_numbers()[kNearer].scale : std::abs(interval.value);
  return 2.0 * interval.half / size;
}

EstimateQuality BallEstimate::known() const {
  const double w = width();
  return w <= 0.2 ? EstimateQuality::well : w <= 1.0 ? EstimateQuality::poorly : EstimateQuality::not_at_all;
}

Eigen::MatrixXd ball_jacobian(const BallLoops& loops, const StandingBall& ball,
                              std::span<const std::size_t> numbers, double step) {
  const sim::BallPlant plant(ball.law);
  const Eigen::VectorXd here = loops.predicted(plant, ball.nearer);
  Eigen::MatrixXd columns(here.size(), static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const BallNumber& n = number_at(numbers[k]);
    StandingBall other = ball;
    n.of(other) += step * n.scale;
    const sim::BallPlant changed = n.elastic ? sim::BallPlant(other.law) : plant.with_loss(other.law);
    columns.col(static_cast<Eigen::Index>(k)) = (loops.predicted(changed, other.nearer) - here) / step;
  }
  return columns;
}

BallFit fit_ball(const BallLoops& loops, const BallFitOptions& options) {
  constexpr int kRounds = 5;
  Search search(loops, options);
  for (int round = 0; round < kRounds; ++round) {
    search.settle();
    if (!search.learn_noise()) break;
  }
  return search.result();
}

}  // namespace enc::trial
