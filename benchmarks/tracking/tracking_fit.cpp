#include "benchmarks/tracking/tracking_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "benchmarks/kit/parallel.h"
#include "core/base/frames.h"
#include "sim/truth/random.h"

namespace enc::bench::tracking {
namespace {

constexpr double kShortest = 2e-3, kLongest = 30e-3;  // s, of the fixed delay
constexpr double kMostJitter = 6e-3;                  // s
constexpr double kSlowest = 0.2, kQuickest = 5.0;     // m/s^2

// Even over (0, 1) in every number of dimensions with different bases (Halton).
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

struct Asked {
  double fixed, jitter, acceleration;
};

std::vector<Candidate> candidates_at(const std::vector<Asked>& asked, const ChainSpec& chain,
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

}  // namespace

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
    const Cell& rest = paper[0][a];  // the bias is several times the noise: the mean size is the bias
    axes[a] = {rest.mae, std::sqrt(std::max(0.0, rest.rmse * rest.rmse - rest.mae * rest.mae))};
  }
  return axes;
}

int way_of(BiasSide side) { return side == BiasSide::opposes ? 1 : side == BiasSide::adds ? -1 : 0; }

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
  std::vector<Asked> asked;
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
  double size = 0.1;  // of the whole range, to each side
  for (int closer = 0; closer < 4; ++closer, size *= 0.35) {
    std::vector<Asked> asked;
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
  constexpr int kFigures = 6;  // that decide: rmse and mae of three axes at 20 mm/s
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
