#include "benchmarks/commands/others.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>

#include "benchmarks/kit/entry.h"
#include "benchmarks/report/choice.h"
#include "core/base/error.h"
#include "models/schema/wording.h"

namespace enc::bench {
namespace {

// "press" for "press" and for "press.restore".
std::string_view benchmark_in(std::string_view word) { return word.substr(0, word.find('.')); }

bool is_ours(std::string_view name) {
  const auto is = [&](const auto& entry) { return name == entry.name; };
  return std::any_of(benchmarks().begin(), benchmarks().end(), is) ||
         std::any_of(groups().begin(), groups().end(), is);
}

// The benchmark of a module, as this module runs it.
Benchmark benchmark_of(const ModuleInfo& module, const std::string& name) {
  const auto* given = static_cast<const BenchmarkModule*>(module.benchmark);
  const auto refuse = [&](const std::string& why, const char* advice) {
    throw Error(fmt::format("encounter_{}{}.so: {}; {}", kBenchmarkPrefix, name, why, advice), {},
                ErrorKind::device);
  };
  if (given == nullptr) refuse("holds no benchmark", "build it with encounter_benchmark() of CMake");
  const std::span<const Benchmark> all = given->benchmarks();
  if (all.size() != 1)
    refuse(fmt::format("holds {} benchmarks; expected one", all.size()), "write one line `const Entry`");
  if (all.front().name != name)
    refuse(fmt::format("its benchmark is called {}; expected {}", models::quoted(all.front().name),
                       models::quoted(name)),
           "give `const Entry` and encounter_benchmark() the same name");
  if (is_ours(name)) refuse("Encounter has a benchmark of that name", "choose another name");
  Benchmark benchmark = all.front();
  benchmark.elsewhere = given;
  return benchmark;
}

}  // namespace

void register_others(const trial::BenchOptions& options, const trial::ModuleFinder& modules,
                     const std::vector<std::string>& others) {
  const auto names = [&](const std::string& name) {
    return std::any_of(options.names.begin(), options.names.end(),
                       [&](const std::string& word) { return benchmark_in(word) == name; });
  };
  const auto known = [&](const std::string& word) {
    return is_ours(benchmark_in(word)) ||
           std::find(others.begin(), others.end(), benchmark_in(word)) != others.end();
  };
  const bool all = options.list || options.names.empty() ||
                   !std::all_of(options.names.begin(), options.names.end(), known);
  for (const std::string& name : others) {
    if (!all && !names(name)) continue;
    try {
      const ModuleInfo* module = modules(kBenchmarkPrefix + name);
      if (module != nullptr) register_benchmark(benchmark_of(*module, name));
    } catch (const Error& e) {
      if (names(name)) throw;
      fmt::print(stderr, "encounter: left out: {}\n", e.what());
    }
  }
}

}  // namespace enc::bench
