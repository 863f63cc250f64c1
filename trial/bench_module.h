// The interface to the module of benchmarks. It is built and loaded only for `bench` or `questionnaire`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/devices/module.h"

namespace enc::trial {

struct BenchOptions {
  std::vector<std::string> names, set;
  std::string out;
  std::uint64_t seed = 1;
  std::int64_t repeats = 0;  // 0: the benchmark's own
  bool quick = false, full = false, list = false, force = false;
  std::string rig;                          // rig whose devices are measured; empty: the twin
  bool armed = false, lockstep = false;     // arguments as for a run over those devices
  bool yes = false, not_real_time = false;  // arguments as for a run over those devices
  bool fakes = false;                       // `encounter fake` replaces those devices
  bool mutate = false, json = false;        // turn each bound red by a change; as one JSON object
};
struct QuestionnaireOptions {
  std::string form = "vhmr_2020";
  std::string store, answers, participant, out, results;
  bool date = false, json = false, force = false;
};

// A module of the program by its name; null if it was not built.
using ModuleFinder = std::function<const ModuleInfo*(const std::string&)>;

// Each function is a subcommand: it prints its results, returns the exit code, and throws Error.
struct BenchModule {
  // `others`: names of the benchmarks that have a module of their own, "press" for encounter_bench_press.so.
  int (*bench)(const BenchOptions& options, const ModuleFinder& modules,
               const std::vector<std::string>& others) = nullptr;
  int (*questionnaire)(const QuestionnaireOptions& options) = nullptr;
};

}  // namespace enc::trial
