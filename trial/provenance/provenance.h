// Origin of a result, for later readers: program, machine and time. It is not part of any state hash.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace enc::trial {

// The commit of the program: twelve digits, plus "-dirty" if the code was changed since, and the commit's
// day. Both are "unknown" without a repository (cmake/commit.sh).
struct BuiltCommit {
  const char *name, *day;
};
[[nodiscard]] BuiltCommit built_commit() noexcept;
// Looks like "Encounter 0.1.0, commit 71961a4f3c2d of 2026-11-29".
[[nodiscard]] std::string program_words();

using WallTime = std::chrono::sys_time<std::chrono::milliseconds>;  // UTC
[[nodiscard]] WallTime wall_time();
[[nodiscard]] std::string day_text(WallTime t);   // looks like "2026-11-30"
[[nodiscard]] std::string time_text(WallTime t);  // "2026-11-30T02:38:12.345Z", ISO 8601

struct Machine {
  std::string processor, system, compiler;
  unsigned cores = 0;
};
[[nodiscard]] Machine this_machine();
[[nodiscard]] std::string words_of(const Machine& machine);  // in one line

// The texts of a record about its origin: `version`, `commit`, `commit_date`, `date` and `machine`; a run
// that keeps the wall clock adds `started`.
[[nodiscard]] std::map<std::string, std::string> provenance_texts(WallTime started, bool wall_clock);

}  // namespace enc::trial
