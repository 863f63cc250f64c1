// What a benchmark gets from the user and the program: options, settings, modules.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/devices/module.h"

namespace enc::bench {

// The user's --set. It records which settings a benchmark has used, so that none is ignored in silence.
class UserSettings {
 public:
  UserSettings() : UserSettings(std::vector<std::string>{}) {}
  UserSettings(std::vector<std::string> all) : all_(std::move(all)) {}  // NOLINT(google-explicit-constructor)
  UserSettings(std::initializer_list<std::string> all) : all_(all) {}

  [[nodiscard]] bool empty() const { return all_.empty(); }
  // Without a record, to look at or to filter.
  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

  // The whole list, as a benchmark that loads its scene itself takes it: each of its settings is used.
  operator const std::vector<std::string>&() const {  // NOLINT(google-explicit-constructor)
    for (const std::string& one : all_) use(one);
    return all_;
  }
  [[nodiscard]] auto begin() const { return static_cast<const std::vector<std::string>&>(*this).begin(); }
  [[nodiscard]] auto end() const { return all_.end(); }

  void use(const std::string& one) const;  // any thread may call it
  // Settings that were never used. Copies share their record.
  [[nodiscard]] std::vector<std::string> unused() const;

 private:
  struct Record {
    std::mutex turn;
    std::set<std::string> used;
  };
  std::vector<std::string> all_;
  std::shared_ptr<Record> record_ = std::make_shared<Record>();
};

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
