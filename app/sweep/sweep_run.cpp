#include "app/sweep/sweep_run.h"

#include <cmath>
#include <exception>
#include <new>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/options.h"
#include "app/modules/modules.h"
#include "app/process.h"
#include "app/run/run_report.h"
#include "app/sweep/figures.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "trial/assemble/assemble.h"
#include "trial/measure/run_measures.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;

// The line of a run. The exit code and the CPU time are last (trial/sweep/shard.h).
struct RunLine {
  std::int64_t run;
  std::uint64_t seed;
  Json hash{}, figures{};
  std::string error{};
  int exit = 0;

  [[nodiscard]] std::string text(double cpu) const {
    Json json{{"id", run}, {"seed", seed}, {"state_hash", hash}, {"figures", figures}};
    if (!error.empty()) json["error"] = models::printable(error);
    json["exit"] = exit;
    json["cpu_s"] = std::round(cpu * 1e6) * 1e-6;
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
  }
};

SceneOptions scene_of(const trial::SweepSpec& spec, const std::vector<std::string>& values) {
  SceneOptions options{.scene = spec.scene, .rig = spec.rig, .set = {}};
  for (std::size_t i = 0; i < values.size(); ++i) options.set.push_back(spec.axes[i].name + "=" + values[i]);
  return options;
}

trial::TrialOptions trial_of(const trial::SweepSpec& spec, std::uint64_t seed) {
  trial::TrialOptions how;
  how.seed = seed;
  how.seconds = spec.seconds;
  how.drivers = load_module;
  return how;
}

RunOptions run_of(const trial::SweepSpec& spec, std::uint64_t seed) {
  RunOptions options;
  options.scene = spec.scene;
  options.seed = seed;
  if (!std::isnan(spec.seconds)) options.seconds = spec.seconds;
  return options;
}

}  // namespace

models::Setup sweep_setup(const trial::SweepSpec& spec, const std::vector<std::string>& values) {
  models::Setup setup = load_setup(scene_of(spec, values));
  if (trial::slots_of(setup).real)
    throw Error(trial::place_in(spec, "rig") +
                ": a device of this rig is real; expected the twin alone; name another rig, such as sim");
  return setup;
}

void SweepRunner::prepare(std::int64_t point) {
  if (point == now_.point) return;
  now_ = {};  // stays so if the point is refused
  now_.setup = sweep_setup(spec_, design_.values(point));
  now_.point = point;
}

void SweepRunner::check_measures() {
  try {
    prepare(0);
  } catch (const Error&) {  // refused values fail their own runs
    now_.setup = sweep_setup(spec_, {});
  }
  trial::TrialOptions how = trial_of(spec_, 1);
  const trial::RunMeasures measured(now_.setup, how);
  trial::Trial trial(now_.setup, how);
  const std::vector<trial::ArmStrength> none;
  const std::vector<trial::ObjectCertificate> uncertified;
  const RunOptions options = run_of(spec_, 1);
  const RunReport report{now_.setup, trial.scene(), trial.result(), measured, none, uncertified, options};
  Json json = figures_json(report);
  const Json forms = list_forms();
  for (const auto& [key, form] : forms.items())
    if (json.contains(key)) json[key] = form;
  for (const std::string& name : spec_.keep) {
    UnknownWord misspelt;
    static_cast<void>(figure_at(json, name, &misspelt));
    if (!misspelt.names.empty())
      throw Error(fmt::format("{}: no run of {} has a measure {}: there is no {}; {}",
                              trial::place_in(spec_, "keep"), spec_.scene, models::quoted(name),
                              models::quoted(misspelt.word), misspelt.names));
  }
}

std::string SweepRunner::line(std::int64_t run) {
  const double began = cpu_seconds();
  RunLine line{.run = run, .seed = design_.seed(run)};
  try {
    prepare(run / spec_.seeds);
    trial::TrialOptions how = trial_of(spec_, line.seed);
    const trial::RunMeasures measured(now_.setup, how);
    trial::Trial trial(now_.setup, how);
    if (!now_.certificates) now_.certificates = trial::certificates_of(now_.setup, trial.scene());
    const trial::TrialResult result = trial.run();
    const std::vector<trial::ArmStrength> strengths = trial::strengths_of(now_.setup, trial.scene());
    const RunOptions options = run_of(spec_, line.seed);
    RunReport report{now_.setup, trial.scene(), result, measured, strengths, *now_.certificates, options};
    complete(trial, report);
    const Json figures = figures_json(report);
    for (const std::string& name : spec_.keep) line.figures[name] = figure_at(figures, name);
    line.hash = fmt::format("{:016x}", result.hash);
    line.exit = exit_code(report);
    if (result.diverged_at >= 0) line.error = "the physics diverged: " + result.divergence;
  } catch (const Error& e) {
    line.error = e.what();
    line.exit = static_cast<int>(e.kind());
  } catch (const std::bad_alloc&) {
    line.error = "there is not enough memory for this";
    line.exit = 2;
  } catch (const std::exception& e) {
    line.error = e.what();
    line.exit = 2;
  }
  return line.text(cpu_seconds() - began);
}

std::string SweepRunner::line_of_killed(std::int64_t run, int signal, int times) const {
  RunLine line{.run = run, .seed = design_.seed(run)};
  line.error = signal != 0 ? fmt::format("its process was ended by signal {}, {} times", signal, times)
                           : fmt::format("its process ended, {} times", times);
  line.exit = signal != 0 ? 128 + signal : 2;
  return line.text(0.0);
}

}  // namespace enc::app
