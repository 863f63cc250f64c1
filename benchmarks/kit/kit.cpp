#include "benchmarks/kit/kit.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "benchmarks/kit/mutants.h"
#include "core/base/error.h"

namespace enc::bench {
namespace {

// The first entry creates the table, because the order of initialisation between files is not specified.
std::vector<Benchmark>& table() {
  static std::vector<Benchmark> all;
  return all;
}

// The first table creates the map, because the order of initialisation between files is not specified.
std::map<std::string, std::vector<Mutant>, std::less<>>& all_mutants() {
  static std::map<std::string, std::vector<Mutant>, std::less<>> all;
  return all;
}

}  // namespace

Entry::Entry(const char* name, const char* scene, const char* what, void (*run)(Bench&),
             void (*over_rig)(Bench&)) {
  register_benchmark({name, scene, what, run, over_rig});
}

void register_benchmark(const Benchmark& benchmark) {
  table().push_back(benchmark);
  std::sort(table().begin(), table().end(), [](const Benchmark& a, const Benchmark& b) {
    return std::string_view(a.name) < std::string_view(b.name);
  });
}

std::span<const Benchmark> benchmarks() { return table(); }

BenchResult result_of(const Benchmark& benchmark, const BenchContext& context) {
  if (const BenchmarkModule* module = benchmark.elsewhere; module != nullptr) {
    Benchmark there = benchmark;
    there.elsewhere = nullptr;
    return module->result_of(there, context);
  }
  BenchContext own = context;
  own.benchmark = benchmark.name;
  own.set = UserSettings(context.set.all());
  Bench bench(benchmark, own);
  (own.rig.empty() ? benchmark.run : benchmark.over_rig)(bench);
  if (const std::vector<std::string> unused = own.set.unused(); !unused.empty() && own.rig.empty())
    throw Error(fmt::format("--set {}: no run of {} uses this parameter, or each run holds it; leave it out",
                            unused.front(), benchmark.name));
  return std::move(bench.result);
}

Mutants::Mutants(const char* benchmark, std::vector<Mutant> mutants) {
  std::vector<Mutant>& all = all_mutants()[benchmark];
  for (Mutant& mutant : mutants) all.push_back(std::move(mutant));
}

std::span<const Mutant> mutants_of(std::string_view benchmark) {
  const auto at = all_mutants().find(benchmark);
  return at == all_mutants().end() ? std::span<const Mutant>{} : std::span<const Mutant>(at->second);
}

bool fits_id(std::string_view pattern, std::string_view id) {
  const std::size_t in_pattern = pattern.find('.'), in_id = id.find('.');
  const std::string_view token = pattern.substr(0, in_pattern);
  if (token != "*" && token != id.substr(0, in_id)) return false;
  if (in_pattern == std::string_view::npos || in_id == std::string_view::npos) return in_pattern == in_id;
  return fits_id(pattern.substr(in_pattern + 1), id.substr(in_id + 1));
}

std::vector<std::uint64_t> Bench::seeds(std::size_t count) const {
  std::vector<std::uint64_t> all(count);
  std::iota(all.begin(), all.end(), context.seed);
  return all;
}

void Bench::figure(const std::string& id, const Value& twin, const char* unit, std::string note) {
  figure(id, twin, unit, Bounds{}, std::move(note));
}
void Bench::figure(const std::string& id, const Value& twin, const char* unit, Bounds bounds,
                   std::string note) {
  figure(id, twin, unit, Paper{kUnset, Role::ours}, bounds, std::move(note));
}
void Bench::figure(const std::string& id, const Value& twin, const char* unit, const Paper& paper,
                   Bounds bounds, std::string note) {
  result.figures.push_back({result.name + "." + id, paper.value, twin.middle, unit, paper.role, bounds.low,
                            bounds.high, std::move(note), twin.least, twin.most});
  result.figures.back().values = twin.values;
}

void Bench::cost(const std::string& id, const Value& twin, const char* unit, std::string note) {
  cost(id, twin, unit, Bounds{}, std::move(note));
}
void Bench::cost(const std::string& id, const Value& twin, const char* unit, Bounds bounds,
                 std::string note) {
  const bool bounded = !std::isnan(bounds.low) || !std::isnan(bounds.high);
  if (bounded && std::string_view("s ms us ns").find(unit) != std::string_view::npos)
    throw std::logic_error(id + " bounds a time; a ratio to another time of the same run may have bounds");
  figure(id, twin, unit, bounds, std::move(note));
  result.figures.back().cost = true;
}

void Bench::absent(const std::string& id, const char* unit, std::string note) {
  figure(id, kUnset, unit, std::move(note));
  result.figures.back().absent = true;
}

void Bench::plot(Plot plot) {
  plot.id = result.name + "." + plot.id;
  result.plots.push_back(std::move(plot));
}
void Bench::picture(Picture picture) {
  picture.id = result.name + "." + picture.id;
  result.pictures.push_back(std::move(picture));
}
void Bench::table(Table table) {
  table.id = result.name + "." + table.id;
  result.tables.push_back(std::move(table));
}

Value median_of(const std::vector<double>& values) {
  return {median(values), percentile(values, 0.0), percentile(values, 1.0), values};
}

}  // namespace enc::bench
