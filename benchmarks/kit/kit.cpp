#include "benchmarks/kit/kit.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string_view>

namespace enc::bench {
namespace {

// The first entry creates the table, because the order of initialisation between files is not specified.
std::vector<Benchmark>& table() {
  static std::vector<Benchmark> all;
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
  Bench bench(benchmark, context);
  (context.rig.empty() ? benchmark.run : benchmark.over_rig)(bench);
  return std::move(bench.result);
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
  return {median(values), percentile(values, 0.0), percentile(values, 1.0)};
}

}  // namespace enc::bench
