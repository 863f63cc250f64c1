// The table of benchmarks. Each benchmark registers itself by one line in its own file:
//   const Entry kEntry{"speed", "tennis_ball", "step(), times real time", run};
#pragma once

#include <span>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

class Bench;
struct Benchmark;

// The export of a module that encounter_benchmark() of CMake builds (kit/module.cpp). Each module has a copy
// of the kit, so a class Bench never leaves its module; results do.
struct BenchmarkModule {
  std::span<const Benchmark> (*benchmarks)() = nullptr;
  BenchResult (*result_of)(const Benchmark& benchmark, const BenchContext& context) = nullptr;
};

struct Benchmark {
  const char* name;   // name of its folder and first token of its figures' ids
  const char* scene;  // file in models/scenes or models/rigs, without ".toml"; else the measured object: no
                      // --set
  const char* what;   // one line
  void (*run)(Bench&);
  void (*over_rig)(Bench&) = nullptr;          // runs over the devices of a rig; null: the twin alone
  const BenchmarkModule* elsewhere = nullptr;  // the module that holds run(); null: this module
};

class Entry {
 public:
  Entry(const char* name, const char* scene, const char* what, void (*run)(Bench&),
        void (*over_rig)(Bench&) = nullptr);
};

// Adds a benchmark of another module to this module's table.
void register_benchmark(const Benchmark& benchmark);
[[nodiscard]] std::span<const Benchmark> benchmarks();  // by name
// Runs in the twin, or over the devices of the context's rig.
[[nodiscard]] BenchResult result_of(const Benchmark& benchmark, const BenchContext& context);

}  // namespace enc::bench
