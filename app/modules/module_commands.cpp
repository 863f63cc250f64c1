// The subcommands that live in modules, because few need what they need.
#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "app/calibration/calibration_module.h"
#include "app/common/options.h"
#include "app/fit/fit_module.h"
#include "app/modules/modules.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "trial/bench_module.h"
#include "trial/operator/operator.h"

namespace enc::app {
namespace {

// One that was not built is no broken device: the words ask for something that is not there.
const ModuleInfo& own_module(const std::string& name, const std::string& command) {
  try {
    return load_module(name);
  } catch (const Error& e) {
    throw Error(fmt::format("{}; './encounter {}' builds it", e.what(), command));
  }
}

const trial::BenchModule& benchmarks() {
  return *static_cast<const trial::BenchModule*>(own_module("bench", "bench").bench);
}

const FitModule& fits() { return *static_cast<const FitModule*>(own_module("fit", "fit").fit); }

const CalibrationModule& calibrations() {
  return *static_cast<const CalibrationModule*>(own_module("calibration", "calibrate FOLDER").calibration);
}

const ModuleInfo* module_if_there(const std::string& name) {
  return module_there(name) ? &load_module(name) : nullptr;
}

// Vision and its camera are built when asked for; all else is a driver.
const ModuleInfo& module_for_calibration(const std::string& name) {
  if (name != "vision" && name != "camera") return load_module(name);
  return own_module(name, "calibrate RIG --through-images");
}

// What stands where a folder of images, a table or a rig should: in words of what it is, before a reader of
// one of them says that it is none of its own.
void refuse_what_it_is_not(const CalibrateOptions& options, const std::vector<std::string>& rigs) {
  namespace fs = std::filesystem;
  const std::string& what = options.log;
  std::error_code none;
  const bool there = fs::exists(what, none);
  const std::string ending = models::lower_case(fs::path(what).extension().string());
  if (there && (ending == ".png" || ending == ".jpg" || ending == ".jpeg"))
    throw Error(fmt::format(
        "{}: is a single image; expected the folder that all of them are in; give its name", what));
  if (options.square_mm || options.corners || !options.picture.empty() || !options.skin.empty())
    throw Error(fmt::format("{}: is {}; expected a folder of images; see to its name", what,
                            there ? "a file" : "not there"));
  if (!there && ending != ".csv" && ending != ".toml")
    throw Error(
        fmt::format("{}: is not there; expected a log or points (CSV), a folder of images, or a rig; {}",
                    what, models::advice(what, rigs)));
}

}  // namespace

int bench(const BenchOptions& options) { return benchmarks().bench(options, module_if_there); }

int fit(const FitOptions& options) { return fits().fit(options); }

int calibrate(const CalibrateOptions& options) {
  const std::vector<std::string> rigs = models::files_in(models::models_dir(), "rigs");
  // A rig by its name, though a folder may have it, as `sim` of the sources.
  const bool rig = std::find(rigs.begin(), rigs.end(), options.log) != rigs.end();
  std::error_code none;
  const bool folder = !rig && std::filesystem::is_directory(options.log, none);
  if (!rig && !folder) refuse_what_it_is_not(options, rigs);
  if (folder) return calibrations().calibrate(options);
  // A machine that moves is stopped by any signal or key.
  std::optional<trial::Operator> person;
  bool halted = false;
  CalibrateOptions stoppable = options;
  stoppable.catch_signals = [&] {
    person.emplace();
    if (options.armed) person->stops_when_suspended();
    person->begin();
  };
  stoppable.confirm = [&](const std::string& question) {
    const bool yes = question.empty() || options.yes || person->confirm(question) == trial::Answer::yes;
    if (yes) person->listen();
    return yes;
  };
  stoppable.stop = [&] {
    halted = halted || (person && (person->next() == trial::Hand::halt || person->quits()));
    return halted || (person && person->stop());
  };
  const int code = fits().calibrate(stoppable, module_for_calibration);
  return person && person->signal() != 0 ? 128 + person->signal() : code;
}

int shadow(const ShadowOptions& options) { return fits().shadow(options); }

int questionnaire(const QuestionnaireOptions& options) { return benchmarks().questionnaire(options); }

}  // namespace enc::app
