// The table of benchmarks. Each benchmark registers itself by one line in its own file:
//   const Entry kEntry{"speed", "tennis_ball", "step(), times real time", run};
#pragma once

#include <span>
#include <string>
#include <vector>

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

// A benchmark without this declaration reads the scene of its Entry as a run of that scene does. Another one
// declares it beside its Entry:
//   const Reads kReads{"deformation", {.only = {"object"}}};
struct ReadParts {
  std::vector<std::string> scenes{};  // names as in Entry, "*": all that ship; empty: that of Entry
  std::vector<std::string> only{};    // tables that it reads, "rig.arm"; empty: all that a run reads
  std::vector<std::string> also{};    // tables that a run of the scene as it ships would not read
};
class Reads {
 public:
  Reads(const char* benchmark, ReadParts parts);
};

// Scenes or rigs that the benchmark loads; empty: its settings reach none.
[[nodiscard]] std::vector<std::string> scenes_read(const Benchmark& benchmark, const std::string& models);
// Names of --set that reach the benchmark.
[[nodiscard]] std::vector<std::string> names_read(const Benchmark& benchmark, const std::string& models);
// Throws Error for a setting that the benchmark would ignore; names the closest name that reaches it.
void check_settings(const Benchmark& benchmark, const std::string& models,
                    const std::vector<std::string>& set);

// The user's settings for a scene: those that name a parameter of it, if the benchmark loads several scenes.
// Records them as used, but for names that `held` sets. Throws std::logic_error for an undeclared scene.
[[nodiscard]] std::vector<std::string> settings_for(const BenchContext& context, const std::string& scene,
                                                    const std::vector<std::string>& held = {});

}  // namespace enc::bench
