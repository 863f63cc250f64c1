#include "benchmarks/tracking/tracking_theory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "benchmarks/tracking/motion.h"

namespace enc::bench::tracking {
namespace {

// Mean of |N(mean, deviation)|.
double mean_size(double mean, double deviation) {
  const double size = std::abs(mean);
  if (size >= 6.0 * deviation) return size;
  const double z = size / (std::numbers::sqrt2 * deviation);
  return deviation * std::sqrt(2.0 / std::numbers::pi) * std::exp(-z * z) + size * std::erf(z);
}

constexpr double kCell = 1e-4;  // s, of the distribution of ages

// The distribution plus an independent wait that is even over `width`.
std::vector<double> waited(const std::vector<double>& density, double width) {
  const double cells = width / kCell;
  const auto whole = static_cast<std::size_t>(cells);
  std::vector<double> sum(density.size() + whole + 2, 0.0);
  // The last cell of the window counts by its part.
  const double part = cells - static_cast<double>(whole);
  double window = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (i < density.size()) window += density[i];
    if (whole > 0 && i >= whole && i - whole < density.size()) window -= density[i - whole];
    const bool last = i >= whole && i - whole < density.size();
    sum[i] = ((whole > 0 ? window : 0.0) + (last ? part * density[i - whole] : 0.0)) / cells;
  }
  return sum;
}

// Of the exponential delay of the packets that no later one overtakes.
std::vector<double> delays(double mean, double period) {
  if (!(mean > 0.1 * kCell)) return {1.0};
  std::vector<double> density;
  constexpr double kMostMeans = 12.0;  // means
  double total = 0.0;
  const int cells = static_cast<int>(std::ceil(kMostMeans * mean / kCell));
  density.reserve(static_cast<std::size_t>(cells));
  for (int i = 0; i < cells; ++i) {
    const double d = (i + 0.5) * kCell;
    double weight = std::exp(-d / mean);
    for (int later = 1; later * period < d; ++later) weight *= std::exp(-(d - later * period) / mean);
    density.push_back(weight);
    total += weight;
  }
  for (double& weight : density) weight /= total;
  return density;
}

struct AgeDensity {
  std::vector<double> share;
  double first = 0.0;  // s, middle of cell 0
  [[nodiscard]] double at(std::size_t i) const { return first + static_cast<double>(i) * kCell; }
};

AgeDensity age_density(const ChainSpec& chain) {
  const double wait = 1.0 / std::max(chain.rate, chain.server_rate);
  const double period = 1.0 / std::min(chain.rate, chain.server_rate);
  AgeDensity ages{waited(waited(delays(chain.jitter, period), wait), chain.tick), 0.0};
  // Discretised sums are off by part of a cell: the mean is known, so it is put right.
  double mean = 0.0;
  double exponential = 0.0;
  for (std::size_t i = 0; i < ages.share.size(); ++i) mean += ages.share[i] * ages.at(i);
  const std::vector<double> alone = delays(chain.jitter, period);
  for (std::size_t i = 0; alone.size() > 1 && i < alone.size(); ++i)
    exponential += alone[i] * (static_cast<double>(i) + 0.5) * kCell;
  ages.first = chain.fixed + 0.5 * wait + 0.5 * chain.tick + exponential - mean;
  return ages;
}

// Positions and speeds of the servo, one each step.
struct Path {
  std::vector<double> position, speed;
};

Path servo_path(const MovesSpec& moves, double rest) {
  StopsSpec command;
  command.stops = moves.stops;
  command.speed = moves.speed;
  command.acceleration = moves.acceleration;
  command.dwell = rest;
  command.both_ways = false;
  const Motion motion = moves_with_stops(command);
  const double w = 2.0 * std::numbers::pi * moves.servo;
  const auto steps = static_cast<std::size_t>(motion.duration / moves.step);
  Path path;
  path.position.reserve(steps);
  path.speed.reserve(steps);
  double x = moves.stops.front();
  double v = 0.0;
  for (std::size_t i = 0; i < steps; ++i) {
    const double wanted = motion.at(static_cast<double>(i) * moves.step).position.x();
    const double pull = std::clamp(w * w * (wanted - x) - 2.0 * moves.damping * w * v, -moves.acceleration,
                                   moves.acceleration);
    v = std::clamp(v + moves.step * pull, -moves.fastest, moves.fastest);
    x += moves.step * v;
    path.position.push_back(x);
    path.speed.push_back(v);
  }
  return path;
}

}  // namespace

std::vector<double> likely_ages(const ChainSpec& chain, std::size_t count) {
  const AgeDensity density = age_density(chain);
  std::vector<double> ages;
  ages.reserve(count);
  const double each = 1.0 / static_cast<double>(count);
  double filled = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < density.share.size(); ++i) {
    double share = density.share[i];
    while (filled + share >= each * (1.0 - 1e-12) && ages.size() + 1 < count) {
      const double part = each - filled;
      ages.push_back((sum + part * density.at(i)) / each);
      share -= part;
      filled = sum = 0.0;
    }
    filled += share;
    sum += share * density.at(i);
  }
  ages.push_back(sum / filled);
  return ages;
}

double mean_age(const ChainSpec& chain) {
  const AgeDensity density = age_density(chain);
  double mean = 0.0;
  for (std::size_t i = 0; i < density.share.size(); ++i) mean += density.share[i] * density.at(i);
  return mean;
}

Errors at_stops(double bias, double noise) {
  return {std::hypot(bias, noise), mean_size(bias, noise), std::abs(bias)};
}

Lag::Lag(const std::vector<double>& ages, const MovesSpec& moves) {
  const double oldest = *std::max_element(ages.begin(), ages.end());
  const Path path = servo_path(moves, oldest + 0.2);
  constexpr std::size_t kBins = 256;
  constexpr std::size_t kStride = 4;  // ticks: the error changes slowly
  bins_.resize(kBins);
  const double widest = -1.02 * oldest * std::min(moves.speed, moves.fastest) * 1.05;
  double n = 0.0;
  for (std::size_t i = 0; i < path.speed.size(); i += kStride) {
    if (std::abs(path.speed[i]) <= kMoving) continue;
    for (const double age : ages) {
      const double then = std::max(0.0, static_cast<double>(i) - age / moves.step);
      const auto k = static_cast<std::size_t>(then);
      const double part = then - static_cast<double>(k);
      const double before =
          path.position[k] + (part > 0.0 ? part * (path.position[k + 1] - path.position[k]) : 0.0);
      const double lag = before - path.position[i];
      const double place = std::clamp(lag / widest, 0.0, 0.9999);
      Bin& bin = bins_[static_cast<std::size_t>(place * kBins)];
      bin.lag += lag;
      bin.share += 1.0;
      mean_ += lag;
      square_ += lag * lag;
      n += 1.0;
    }
  }
  std::erase_if(bins_, [](const Bin& bin) { return bin.share == 0.0; });
  for (Bin& bin : bins_) {
    bin.lag /= bin.share;
    bin.share /= n;
  }
  mean_ /= n;
  square_ /= n;
}

Errors Lag::errors(double bias, double noise, int way) const {
  if (way == 0) {
    const Errors up = errors(bias, noise, 1);
    const Errors down = errors(bias, noise, -1);
    return {std::sqrt(0.5 * (up.rmse * up.rmse + down.rmse * down.rmse)), 0.5 * (up.mae + down.mae),
            std::abs(bias)};
  }
  const double along = way > 0 ? bias : -bias;  // towards + the lag is negative
  double mae = 0.0;
  for (const Bin& bin : bins_) mae += bin.share * mean_size(bin.lag + along, noise);
  const double square = square_ + 2.0 * along * mean_ + along * along + noise * noise;
  return {std::sqrt(std::max(0.0, square)), mae, std::abs(mean_ + along)};
}

}  // namespace enc::bench::tracking
