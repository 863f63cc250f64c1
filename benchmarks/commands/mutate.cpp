// `encounter bench --mutate`: each bound with the mutant that turns it red.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "benchmarks/commands/commands.h"
#include "benchmarks/commands/committed_results.h"
#include "benchmarks/commands/mutation.h"
#include "benchmarks/report/choice.h"
#include "core/base/error.h"
#include "models/setup/scene_file.h"

namespace enc::bench {
namespace {

// Each mutant has its own form and settings.
void refuse_options(const trial::BenchOptions& options) {
  for (const auto& [given, name] : {std::pair{options.quick, "--quick"},
                                    {options.full, "--full"},
                                    {options.repeats != 0, "--repeats"},
                                    {!options.set.empty(), "--set"},
                                    {!options.rig.empty(), "--rig"},
                                    {!options.out.empty(), "--out"}})
    if (given)
      throw Error(fmt::format(
          "--mutate: each mutant has its own form and settings, so {} has no meaning; leave it out", name));
}

std::string bounds_text(const Figure& f) {
  if (std::isfinite(f.low) && std::isfinite(f.high))
    return fmt::format("within {:.4g}..{:.4g}", f.low, f.high);
  return std::isfinite(f.high) ? fmt::format("at most {:.4g}", f.high)
                               : fmt::format("at least {:.4g}", f.low);
}

// The mutants once, with numbers; then each bound with the number of its mutant.
void print_mutation(const MutationResult& result) {
  fmt::print("{}: {} bounds, {} mutants, {:.1f} s\n", result.benchmark, result.bounds.size(),
             result.mutants.size(), result.run_time);
  for (std::size_t i = 0; i < result.mutants.size(); ++i)
    fmt::print("  mutant {}: {}\n", i + 1, result.mutants[i]);
  for (const MutatedBound& b : result.bounds) {
    const auto at = std::find(result.mutants.begin(), result.mutants.end(), b.mutant);
    const std::string fate =
        b.mutant.empty() ? std::string("SURVIVED")
                         : fmt::format("-> {:.4g} (mutant {})", b.value, at - result.mutants.begin() + 1);
    fmt::print("  {:34} {:>10.4g} {:5} {:22} {}\n", b.clean.id, b.clean.twin, b.clean.unit,
               bounds_text(b.clean), fate);
  }
  for (const std::string& fault : result.faults) fmt::print("  {}\n", fault);
  std::fflush(stdout);
}

using MutationJson = nlohmann::ordered_json;

MutationJson json_number(double x) { return std::isfinite(x) ? MutationJson(x) : MutationJson(nullptr); }

MutationJson mutation_json(const MutationResult& result) {
  MutationJson bounds = MutationJson::array();
  for (const MutatedBound& b : result.bounds)
    bounds.push_back({{"id", b.clean.id},
                      {"unit", b.clean.unit},
                      {"low", json_number(b.clean.low)},
                      {"high", json_number(b.clean.high)},
                      {"clean", json_number(b.clean.twin)},
                      {"killed", !b.mutant.empty()},
                      {"mutant", b.mutant.empty() ? MutationJson(nullptr) : MutationJson(b.mutant)},
                      {"mutated", json_number(b.value)}});
  return {{"name", result.benchmark},      {"mutants", result.mutants}, {"survivors", result.survivors()},
          {"run_time_s", result.run_time}, {"bounds", bounds},          {"faults", result.faults}};
}

// Sums over the benchmarks.
struct MutationSum {
  std::size_t bounds = 0, mutants = 0, survivors = 0, faults = 0;
  double run_time = 0.0;
  void add(const MutationResult& result) {
    bounds += result.bounds.size();
    mutants += result.mutants.size();
    survivors += result.survivors();
    faults += result.faults.size();
    run_time += result.run_time;
  }
};

}  // namespace

int mutate_command(const trial::BenchOptions& options, const trial::ModuleFinder& modules) {
  refuse_options(options);
  BenchContext context;
  context.models = models::models_dir();
  context.seed = options.seed;
  context.module = modules;
  const CommittedResults committed = CommittedResults::load(context.models);
  MutationSum sum;
  MutationJson all = MutationJson::array();
  for (const Choice& choice : chosen(options.names)) {
    MutationOptions how;
    how.wanted = [&](const Figure& figure) { return wanted(choice, figure); };
    if (choice.ids.empty()) how.expected = committed.bounded(choice.benchmark->name);
    how.say = [](const std::string& line) { fmt::print(stderr, "encounter: {}\n", line); };
    const MutationResult result = mutate(*choice.benchmark, mutants_of(choice.benchmark->name), context, how);
    sum.add(result);
    if (options.json)
      all.push_back(mutation_json(result));
    else
      print_mutation(result);
  }
  if (options.json)
    fmt::print("{}\n", MutationJson{{"bounds", sum.bounds},
                                    {"survivors", sum.survivors},
                                    {"mutants", sum.mutants},
                                    {"run_time_s", sum.run_time},
                                    {"benchmarks", all}}
                           .dump(2));
  else
    fmt::print("{} bounds, {} red under a mutant, {} survived; {} mutants, {:.0f} s\n", sum.bounds,
               sum.bounds - sum.survivors, sum.survivors, sum.mutants, sum.run_time);
  return sum.survivors == 0 && sum.faults == 0 ? 0 : 1;
}

}  // namespace enc::bench
