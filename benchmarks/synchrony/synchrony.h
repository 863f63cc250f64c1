// What the benchmark `synchrony` has run, for its figures, tables and plots. Internal to it.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/synchrony/sync_trial.h"

namespace enc::bench::synchrony {

// What a run came to; its samples are gone.
struct SyncSummary {
  SyncErrors haptic, packets, rests, truth;
  double lag = kUnset, truth_lag = kUnset;  // s
  std::array<double, 3> over{};             // m, of each press
  double given = 0.0;                       // m
  double peak_speed = kUnset;               // m/s
  std::int32_t contacts = 0;
  bool held = false;
};

// Mean, least and most over seeds.
struct OverSeeds {
  double mean = kUnset, least = kUnset, most = kUnset;
};

// Runs of one set-up, several seeds.
struct SyncGroup {
  std::string name;
  models::Setup setup;
  std::vector<SyncSummary> seeds;
  SyncRun first{};  // with its samples, where they are kept
  bool keep = false;

  template <class Value>
  [[nodiscard]] OverSeeds over(Value value) const {
    OverSeeds all{0.0, value(seeds.front()), value(seeds.front())};
    for (const SyncSummary& s : seeds) {
      const double x = value(s);
      all.mean += x / static_cast<double>(seeds.size());
      all.least = std::min(all.least, x);
      all.most = std::max(all.most, x);
    }
    return all;
  }
};

// On which side of the way in the tracker's static bias is, along z [VHMR Table 1 gives no sign].
inline constexpr std::array<const char*, 3> kBiasSides{"deeper", "shallower", "none"};
inline constexpr std::array<double, 4> kPressTimes{0.8, 1.2, 1.7, 2.4};  // s
inline constexpr std::array<int, 4> kRates{30, 60, 90, 120};             // Hz

struct SyncStudy {
  SyncGroup paper;  // the paper's pipeline, calibrated
  std::array<std::array<SyncGroup, kPressTimes.size()>, kBiasSides.size()>
      presses;  // [bias side][press time]
  std::array<SyncGroup, 4> rates;
  SyncGroup later;              // the display 10 ms later
  SyncGroup predicted;          // the loop's own predicted tool
  SyncGroup fused, late_fused;  // with and without looking ahead, nothing gives
  // Where tool and contact give, and the tool tilts:
  SyncGroup giving_paper, giving_fused, giving_late_fused, giving_known, giving_blind;
  double paper_mae = kUnset, paper_rmse = kUnset;  // m, as printed
};

void add_sync_tables(const SyncStudy& study, BenchResult& result);
void add_sync_plots(const SyncStudy& study, BenchResult& result);

}  // namespace enc::bench::synchrony
