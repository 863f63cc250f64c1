// The mutation run of one benchmark: it runs clean, then once with each mutant, and a bound that stays green
// under all of them has survived.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/mutants.h"

namespace enc::bench {

struct MutatedBound {
  Figure clean{};
  std::string mutant{};   // that turned it red; empty: it survived
  double value = kUnset;  // of the figure under that mutant
};

struct MutationResult {
  std::string benchmark;
  std::vector<MutatedBound> bounds{};
  // One line each: a bound that is red without a mutant, a mutant that leaves a bound green that it claims, a
  // bound that no run judged.
  std::vector<std::string> faults{};
  std::vector<std::string> mutants{};  // carried out, in their order
  double run_time = 0.0;               // s
  [[nodiscard]] std::size_t survivors() const;
  [[nodiscard]] bool ok() const { return faults.empty() && survivors() == 0; }
};

struct MutationOptions {
  // Bounds to judge, by whole id; mutants that claim none of them do not run. Null: all bounds.
  std::function<bool(const Figure&)> wanted{};
  std::vector<std::string> expected{};            // ids of bounds of the default form, which shall be judged
  std::function<void(const std::string&)> say{};  // progress: one line for each run
};

// Throws Error for a mutant that names an unknown bound, changes nothing, names a change that the benchmark
// does not ask for, or ends the benchmark with an Error.
[[nodiscard]] MutationResult mutate(const Benchmark& benchmark, std::span<const Mutant> mutants,
                                    const BenchContext& context, const MutationOptions& options = {});

}  // namespace enc::bench
