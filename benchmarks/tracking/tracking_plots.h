// Tables and plots of the benchmark `tracking`, out of what it has found.
#pragma once

#include <array>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/tracking/tracking_fit.h"

namespace enc::bench::tracking {

// For each BiasSide.
struct Fits {
  std::array<Candidate, 3> from_20, all, all_free;  // columns 0 and 20; all, with the rig's acceleration; all
  std::array<Predicted40, 3> prediction;
};

struct Pictures {
  const Table1& paper;
  const SpannedTable& twin;  // the default rig, bias opposing
  const Candidate& theory;   // of the default rig
  const Fits& fits;
  const std::vector<Candidate>& open;
  Table1 twin_from_20, twin_adds;           // whole loop with the best chains of the two
  Table1 twin_back, twin_both;              // the default rig, motion along -, and both ways
  const std::vector<PacketError>& packets;  // one seed at 40 mm/s
  ChainSpec chain;
  double bias_x = 0.0;  // m
};

void add_tables(BenchResult& result, const Pictures& pictures);
void add_plots(BenchResult& result, const Pictures& pictures);

}  // namespace enc::bench::tracking
