// The entry that the program loads from encounter_bench.so.
#include "benchmarks/commands/commands.h"

namespace {

constexpr enc::trial::BenchModule kBench{enc::bench::bench_command, enc::bench::questionnaire_command};

}  // namespace

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::ModuleInfo kInfo{.name = "bench", .bench = &kBench};
  return &kInfo;
}
