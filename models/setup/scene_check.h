// Shared parts of the checks of a scene (scene_check.cpp, machine_check.cpp).
#pragma once

#include <string>
#include <vector>

#include "models/setup/scene_file.h"

namespace enc::models {

// Throws Error: the place of the key in its file, then the problem, the expected value and the remedy.
[[noreturn]] void fail(const Setup& setup, const std::string& key, const std::string& what);
[[nodiscard]] std::string mm(double metres);  // text as in a file

template <class T>
[[nodiscard]] std::vector<std::string> names_of(const std::vector<T>& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const T& item : items) names.push_back(item.name);
  return names;
}

inline constexpr double kNoWay = 1e-6;  // a shorter vector has no direction
// A direction must have length 1; `key` ends with its name in the file.
void check_unit(const Setup& setup, const std::string& key, const Vec3& v);

// A time constant of MuJoCo, s, and its key.
struct StopTime {
  std::string key;
  double time;
};

void check_interaction(const Setup& setup, const BehaviourSpec& behaviour);  // machine_check.cpp

// The parts of the checks that differ from machine to machine.
struct MachineChecks {
  const char* behaviour;  // an entry of models/behaviours.toml that it renders
  const char* rig;        // a rig of models/rigs that has it
  bool bare_finger;       // it meets a finger without markers
  bool (*simulated)(const RigSpec& rig);
  void (*tool)(const Setup& setup, const ToolSpec& tool);
  void (*scene)(const Setup& setup);
  std::vector<StopTime> (*stops)(const Setup& setup);
};
[[nodiscard]] const MachineChecks& checks_of(const SceneSpec& scene);

}  // namespace enc::models
