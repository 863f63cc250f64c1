// What a benchmark gets from the user and the program: options, settings, modules.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/kit/user_settings.h"
#include "core/devices/module.h"

namespace enc::bench {

struct BenchContext {
  std::string models;  // folder
  std::uint64_t seed = 1;
  std::int64_t repeats = 0;  // 0: the benchmark's own
  bool quick = false;
  bool full = false;  // also the parts that take minutes: switch-off tables, work-precision
  UserSettings set;
  std::function<void(double)> progress;  // receives the share done; any thread may call it
  // Loads a module of the program by name; null if it was not built.
  std::function<const ModuleInfo*(const std::string&)> module{};
  // Rig whose devices run (scenes.h); empty: in the twin.
  std::string rig{};
  bool armed = false, lockstep = false, fakes = false;
  bool not_real_time = false;  // a machine moves although the system refuses real-time scheduling
  // Called before an attended machine moves for the first time. Throws Error if it must not move.
  std::function<void(const std::string& question)> confirm{};
  std::function<bool()> stop{};  // polled by code that runs over devices: true ends it
  // Mutation run (mutants.h): reports whether the benchmark shall carry out this change of itself.
  std::function<bool(std::string_view change)> mutation{};
  [[nodiscard]] bool mutated(std::string_view change) const { return mutation && mutation(change); }
  std::string benchmark{};  // that runs
  // Number of seeds or laps: the user's value, else the benchmark's own.
  [[nodiscard]] std::size_t count(std::size_t own, std::size_t if_quick) const {
    if (repeats > 0) return static_cast<std::size_t>(repeats);
    return quick ? if_quick : own;
  }
};

}  // namespace enc::bench
