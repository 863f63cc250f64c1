// The subcommands that live in modules, because few need what they need.
#include <fmt/format.h>

#include "app/common/options.h"
#include "app/modules/modules.h"
#include "app/modules/own_modules.h"
#include "core/base/error.h"
#include "trial/bench_module.h"

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

const ModuleInfo* module_if_there(const std::string& name) {
  return module_there(name) ? &load_module(name) : nullptr;
}

}  // namespace

const FitModule& fit_module() { return *static_cast<const FitModule*>(own_module("fit", "fit").fit); }

const CalibrationModule& calibration_module() {
  return *static_cast<const CalibrationModule*>(
      own_module("calibration", "calibrate stereo FOLDER").calibration);
}

const ModuleInfo& module_for_pictures(const std::string& name) {
  if (name != "vision" && name != "camera") return load_module(name);
  return own_module(name, "calibrate camera RIG --through-images");
}

int bench(const BenchOptions& options) { return benchmarks().bench(options, module_if_there); }

int fit(const FitOptions& options) { return fit_module().fit(options); }

int shadow(const ShadowOptions& options) { return fit_module().shadow(options); }

int questionnaire(const QuestionnaireOptions& options) { return benchmarks().questionnaire(options); }

}  // namespace enc::app
