// The entry of a module with a benchmark of somebody else. encounter_benchmark(NAME ...) of CMake compiles it
// with ENCOUNTER_BENCHMARK="NAME" (cmake/EncounterConfig.cmake); nothing in the tree does.
#include <string>

#include "benchmarks/kit/entry.h"

namespace {

constexpr enc::bench::BenchmarkModule kBenchmarks{enc::bench::benchmarks, enc::bench::result_of};

}  // namespace

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const std::string kName = std::string(enc::kBenchmarkPrefix) + ENCOUNTER_BENCHMARK;
  static const enc::ModuleInfo kInfo{.name = kName.c_str(), .benchmark = &kBenchmarks};
  return &kInfo;
}
