// What the program asks of the module of benchmarks. It is built and loaded when `bench` or `questionnaire`
// is called: nothing else needs it.
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
  std::string rig;                          // over whose devices it is measured; empty: in the twin
  bool armed = false, lockstep = false;     // of them, as for a run
  bool yes = false, not_real_time = false;  // likewise
  bool fakes = false;                       // `encounter fake` stands in for them
};
struct QuestionnaireOptions {
  std::string form = "vhmr_2020";
  std::string store, answers, participant, out, results;
  bool date = false, json = false, force = false;
};

// A module of the program by its name; null where it was not built.
using ModuleFinder = std::function<const ModuleInfo*(const std::string&)>;

// Each is a subcommand: prints what it has to say, gives the exit code, throws Error.
struct BenchModule {
  int (*bench)(const BenchOptions& options, const ModuleFinder& modules) = nullptr;
  int (*questionnaire)(const QuestionnaireOptions& options) = nullptr;
};

}  // namespace enc::trial
