// The table of benchmarks. Each one puts itself there, by one line in its own file:
//   const Entry kEntry{"speed", "tennis_ball", "step(), times real time", run};
#pragma once

#include <span>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

class Bench;

struct Benchmark {
  const char* name;   // of its folder, too; first token of its figures' ids
  const char* scene;  // in models/scenes or models/rigs, without ".toml"; else what is measured: no --set
  const char* what;   // one line
  void (*run)(Bench&);
  void (*over_rig)(Bench&) = nullptr;  // the same over the devices of a rig; null: the twin alone
};

class Entry {
 public:
  Entry(const char* name, const char* scene, const char* what, void (*run)(Bench&),
        void (*over_rig)(Bench&) = nullptr);
};

[[nodiscard]] std::span<const Benchmark> benchmarks();  // by name
// In the twin, or over the devices of the context's rig.
[[nodiscard]] BenchResult result_of(const Benchmark& benchmark, const BenchContext& context);

}  // namespace enc::bench
