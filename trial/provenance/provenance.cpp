#include "trial/provenance/provenance.h"

#include <fstream>
#include <thread>

#include <encounter_version.h>
#include <fmt/format.h>
#include <sys/utsname.h>

namespace enc::trial {

// Default version. A program that prints the commit links another version, which the build writes
// (enc_commit). All other programs, such as tests, keep this one, so a new commit does not link them again.
[[gnu::weak]] BuiltCommit built_commit() noexcept { return {"unknown", "unknown"}; }

std::string program_words() {
  return fmt::format("Encounter {}, commit {} of {}", ENCOUNTER_VERSION, built_commit().name,
                     built_commit().day);
}

WallTime wall_time() {
  return std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
}

std::string day_text(WallTime t) {
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(t));
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()));
}

std::string time_text(WallTime t) {
  const std::chrono::hh_mm_ss time(t - std::chrono::floor<std::chrono::days>(t));
  return fmt::format("{}T{:02}:{:02}:{:02}.{:03}Z", day_text(t), time.hours().count(), time.minutes().count(),
                     time.seconds().count(), time.subseconds().count());
}

Machine this_machine() {
  Machine machine{"unknown", {}, __VERSION__, std::thread::hardware_concurrency()};
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) {
      machine.processor = line.substr(line.find(':') + 2);
      break;
    }
  utsname system{};
  uname(&system);
  machine.system = fmt::format("{} {}", system.sysname, system.machine);
  return machine;
}

std::string words_of(const Machine& machine) {
  return fmt::format("{}, {} cores, {}, compiler {}", machine.processor, machine.cores, machine.system,
                     machine.compiler);
}

std::map<std::string, std::string> provenance_texts(WallTime started, bool wall_clock) {
  std::map<std::string, std::string> texts{{"version", ENCOUNTER_VERSION},
                                           {"commit", built_commit().name},
                                           {"commit_date", built_commit().day},
                                           {"date", day_text(started)},
                                           {"machine", words_of(this_machine())}};
  if (wall_clock) texts["started"] = time_text(started);
  return texts;
}

}  // namespace enc::trial
