// Which parameters reach a benchmark. `bench --set` refuses any other name before the benchmark runs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/kit/entry.h"

namespace enc::bench {

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
