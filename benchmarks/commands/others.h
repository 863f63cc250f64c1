// Benchmarks of somebody else: each is a module of its own, encounter_bench_NAME.so
// (docs/guide/benchmark.md).
#pragma once

#include <string>
#include <vector>

#include "trial/bench_module.h"

namespace enc::bench {

// Adds those of `others` that the options need to the table: all of them for a list, for a run without names,
// and if a name is unknown otherwise; else those that the options name. Throws Error for one that is named
// and cannot be loaded; any other such module is left out with a line on standard error.
void register_others(const trial::BenchOptions& options, const trial::ModuleFinder& modules,
                     const std::vector<std::string>& others);

}  // namespace enc::bench
