// The output of `run`, as text within 25 lines or as one JSON object, and the limits that the run exceeded.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/common/options.h"
#include "trial/certificates.h"
#include "trial/measure/run_measures.h"
#include "trial/provenance/provenance.h"
#include "trial/trial.h"

namespace enc::app {

struct RunReport {
  const models::Setup& setup;
  const Scene& scene;
  const trial::TrialResult& result;
  const trial::RunMeasures& measured;
  const std::vector<trial::ArmStrength>& strengths;
  const std::vector<trial::ObjectCertificate>& certificates;
  const RunOptions& asked;
  // Steps of the simulated world, and the number of them that missed the solver's tolerance.
  std::int64_t steps = 0, unsolved = 0;
  bool whole = true;        // not ended early by --for-s, a signal, a full disk or diverged physics
  int elements = 0;         // elements of the simulated world
  double started = 0.0;     // CPU s from the start of the process to the first tick
  trial::WallTime begun{};  // due time of the first tick
  bool steered = false;     // a person steered the hand, so the scene's plan does not describe it
  std::vector<std::string> crossed{};  // crossed()
};

// Speed relative to the clock: two digits below 10, so that a slow run is not "0 x".
[[nodiscard]] std::string speed_text(double simulated, double wall);
[[nodiscard]] std::string run_text(const RunReport& report);
[[nodiscard]] std::string run_json(const RunReport& report);
// The part of both about the run's task: presses, pushes, the tool carried by the machine, meetings, energy.
[[nodiscard]] std::string measured_text(const RunReport& report);
[[nodiscard]] nlohmann::ordered_json measured_json(const RunReport& report);
// Looks like "last notice of the core: ...".
[[nodiscard]] std::string last_notice(const trial::TrialResult& result);
// An entry of each list of measured_json(), whose keys a run without entries does not show.
[[nodiscard]] nlohmann::ordered_json list_forms();
// The limits that a run exceeded, one line each; the program then ends with exit code 1.
[[nodiscard]] std::vector<std::string> crossed(const RunReport& report);
// Adds the simulated world's figures, and the results derived from the others. Call it after the run.
void complete(trial::Trial& trial, RunReport& report);
// 0, 1: limits crossed, 4: ended in hold or diverged.
[[nodiscard]] int exit_code(const RunReport& report);

}  // namespace enc::app
