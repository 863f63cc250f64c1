#include "benchmarks/tracking/tracking_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/tracking/motion.h"
#include "core/base/frames.h"
#include "sim/truth/random.h"

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

// Adds to the distribution an independent wait that is even over `width`.
std::vector<double> waited(const std::vector<double>& density, double width) {
  const double cells = width / kCell;
  const auto whole = static_cast<std::size_t>(cells);
  std::vector<double> sum(density.size() + whole + 2, 0.0);
  // The last cell of the window counts by its covered part.
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

// Distribution of the exponential delay of packets that no later one overtakes.
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
  // Discretised sums are off by part of a cell. The mean is known, so this corrects it.
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

constexpr double kShortest = 2e-3, kLongest = 30e-3;  // s, of the fixed delay
constexpr double kMostJitter = 6e-3;                  // s
constexpr double kSlowest = 0.2, kQuickest = 5.0;     // m/s^2

// Even over (0, 1) in any number of dimensions, with different bases (Halton).
double spread_out(std::size_t index, std::size_t base) {
  double value = 0.0;
  double share = 1.0;
  for (std::size_t i = index + 1; i > 0; i /= base) {
    share /= static_cast<double>(base);
    value += share * static_cast<double>(i % base);
  }
  return value;
}

double relative(double value, double paper) { return value / paper - 1.0; }

struct FitSetting {
  double fixed, jitter, acceleration;
};

std::vector<Candidate> candidates_at(const std::vector<FitSetting>& asked, const ChainSpec& chain,
                                     const MovesSpec& moves, const std::array<AxisError, 3>& axes) {
  std::vector<Candidate> all(asked.size());
  constexpr std::size_t kBlock = 25;
  in_parallel((asked.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(asked.size(), (block + 1) * kBlock); ++i) {
      ChainSpec c = chain;
      c.fixed = asked[i].fixed;
      c.jitter = asked[i].jitter;
      MovesSpec m = moves;
      m.acceleration = asked[i].acceleration;
      all[i] = candidate_of(c, m, axes);
    }
  });
  return all;
}

double judged(const Candidate& c, const Table1& paper, BiasSide side, Judge judge) {
  const Misfit m = misfit(c.table[static_cast<std::size_t>(side)], paper);
  return judge == Judge::moving20 ? m.moving20 : m.worst;
}

double at_share(std::vector<double> values, double share) {
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank];
}

// Student's t with n degrees of freedom.
double student(sim::Stream& random, int n) {
  double squares = 0.0;
  for (int i = 0; i < n; ++i) squares += std::pow(random.normal(), 2);
  return random.normal() / std::sqrt(squares / n);
}

// 1: along + of W, -1: along -, 0: both
int way_of(BiasSide side) { return side == BiasSide::opposes ? 1 : side == BiasSide::adds ? -1 : 0; }

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

ChainSpec chain_of(const models::Setup& setup) {
  const sim::TrackerTruth& t = setup.twin.tracker;
  return {t.rate, t.server_rate, t.latency + t.process, t.udp_delay, 1.0 / setup.rig.loop.rate};
}

MovesSpec moves_of(const models::Setup& setup) {
  const sim::HexapodTruth& machine = setup.twin.hexapod;
  return {setup.scene.travel->stops,
          setup.scene.travel->speed,
          std::min(machine.acceleration, setup.rig.manipulator.acceleration),
          machine.servo,
          machine.damping,
          machine.speed,
          setup.twin.stepping(setup.scene).timestep};
}

std::array<AxisError, 3> axis_errors(const Table1& paper) {
  std::array<AxisError, 3> axes;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Cell& rest = paper[0][a];  // the bias is several times the noise, so the mean size is the bias
    axes[a] = {rest.mae, std::sqrt(std::max(0.0, rest.rmse * rest.rmse - rest.mae * rest.mae))};
  }
  return axes;
}

Candidate candidate_of(const ChainSpec& chain, const MovesSpec& moves, const std::array<AxisError, 3>& axes) {
  Candidate candidate{chain.fixed, chain.jitter, moves.acceleration, {}};
  const std::vector<double> ages = likely_ages(chain);
  for (std::size_t s = 0; s < kTableSpeeds.size(); ++s) {
    std::optional<Lag> lag;
    if (kTableSpeeds[s] > 0) {
      MovesSpec at = moves;
      at.speed = 1e-3 * kTableSpeeds[s];
      lag.emplace(ages, at);
    }
    for (const BiasSide side : {BiasSide::opposes, BiasSide::adds, BiasSide::both_ways}) {
      auto& column = candidate.table[static_cast<std::size_t>(side)][s];
      for (std::size_t a = 0; a < axes.size(); ++a) {
        const Errors e = lag ? lag->errors(axes[a].bias, axes[a].noise, way_of(side))
                             : at_stops(axes[a].bias, axes[a].noise);
        column[a] = {e.rmse, e.mae};
      }
      fill_norm(column);
    }
  }
  return candidate;
}

Misfit misfit(const Table1& table, const Table1& paper) {
  constexpr double kEach = 0.13, kNorm = 0.06;
  Misfit m;
  for (std::size_t s = 1; s < table.size(); ++s)
    for (std::size_t a = 0; a < table[s].size(); ++a)
      for (const double d :
           {relative(table[s][a].rmse, paper[s][a].rmse), relative(table[s][a].mae, paper[s][a].mae)}) {
        m.worst = std::max(m.worst, std::abs(d) / (a == 3 ? kNorm : kEach));
        if (a == 3) continue;
        m.moving += d * d / 12.0;
        if (s == 1) m.moving20 += d * d / 6.0;
      }
  m.moving = std::sqrt(m.moving);
  m.moving20 = std::sqrt(m.moving20);
  return m;
}

std::vector<Candidate> spread(const ChainSpec& chain, const MovesSpec& moves,
                              const std::array<AxisError, 3>& axes, std::size_t count, double acceleration) {
  std::vector<FitSetting> asked;
  asked.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    asked.push_back({kShortest + (kLongest - kShortest) * spread_out(i, 2), kMostJitter * spread_out(i, 3),
                     std::isnan(acceleration) ? kSlowest * std::pow(kQuickest / kSlowest, spread_out(i, 5))
                                              : acceleration});
  return candidates_at(asked, chain, moves, axes);
}

Candidate best(const std::vector<Candidate>& candidates, const Table1& paper, BiasSide side, Judge judge,
               const ChainSpec& chain, const MovesSpec& moves, bool acceleration_free) {
  const auto better = [&](const Candidate& a, const Candidate& b) {
    return judged(a, paper, side, judge) < judged(b, paper, side, judge);
  };
  Candidate found = *std::min_element(candidates.begin(), candidates.end(), better);
  double size = 0.1;  // share of the whole range, to each side
  for (int closer = 0; closer < 4; ++closer, size *= 0.35) {
    std::vector<FitSetting> asked;
    for (std::size_t i = 0; i < 50; ++i) {
      const auto off = [&](std::size_t base) { return size * (2.0 * spread_out(i, base) - 1.0); };
      asked.push_back(
          {std::clamp(found.fixed + off(2) * (kLongest - kShortest), kShortest, kLongest),
           std::clamp(found.jitter + off(3) * kMostJitter, 0.0, kMostJitter),
           acceleration_free
               ? std::clamp(found.acceleration * std::pow(kQuickest / kSlowest, off(5)), kSlowest, kQuickest)
               : found.acceleration});
    }
    const std::vector<Candidate> near = candidates_at(asked, chain, moves, axis_errors(paper));
    const Candidate& nearest = *std::min_element(near.begin(), near.end(), better);
    if (better(nearest, found)) found = nearest;
  }
  return found;
}

Predicted40 predict_40(const std::vector<Candidate>& candidates, const Table1& paper, BiasSide side,
                       std::uint64_t seed) {
  constexpr int kFigures = 6;  // the deciding figures: rmse and mae of three axes at 20 mm/s
  constexpr std::size_t kDraws = 4000;
  std::vector<double> sum(candidates.size());
  std::vector<double> size(candidates.size());
  double total = 0.0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    size[i] = misfit(candidates[i].table[static_cast<std::size_t>(side)], paper).moving20;
    sum[i] = total += std::pow(size[i], -kFigures);  // the error's size s integrated out over ds / s
  }
  sim::Stream random(seed, "predict_40");
  Predicted40 prediction;
  std::array<std::vector<double>, 8> figures;
  for (std::size_t n = 0; n < kDraws; ++n) {
    const double at = total * random.uniform();
    const auto i = static_cast<std::size_t>(std::lower_bound(sum.begin(), sum.end(), at) - sum.begin());
    prediction.drawn.push_back(i);
    std::array<Cell, 4> column = candidates[i].table[static_cast<std::size_t>(side)][2];
    for (std::size_t a = 0; a < 3; ++a) {
      const double factor = std::max(0.0, 1.0 + size[i] * student(random, kFigures));
      column[a] = {factor * column[a].rmse, factor * column[a].mae};
    }
    fill_norm(column);
    for (std::size_t a = 0; a < 4; ++a) {
      figures[2 * a].push_back(column[a].rmse);
      figures[2 * a + 1].push_back(column[a].mae);
    }
  }
  for (std::size_t a = 0; a < 4; ++a) {
    const auto both = [&](double share) {
      return Cell{at_share(figures[2 * a], share), at_share(figures[2 * a + 1], share)};
    };
    prediction.low[2][a] = both(0.05);
    prediction.median[2][a] = both(0.5);
    prediction.high[2][a] = both(0.95);
  }
  prediction.norm_rmse = figures[6];
  std::sort(prediction.norm_rmse.begin(), prediction.norm_rmse.end());
  return prediction;
}

}  // namespace enc::bench::tracking
