// The subcommands that live in modules, because few need what they need.
#include <fmt/format.h>

#include "app/fit/fit_module.h"
#include "app/modules/modules.h"
#include "app/options.h"
#include "core/error.h"
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

const FitModule& fits() { return *static_cast<const FitModule*>(own_module("fit", "fit").fit); }

const ModuleInfo* module_if_there(const std::string& name) {
  return module_there(name) ? &load_module(name) : nullptr;
}

}  // namespace

int bench(const BenchOptions& options) { return benchmarks().bench(options, module_if_there); }

int fit(const FitOptions& options) { return fits().fit(options); }

int calibrate(const CalibrateOptions& options) { return fits().calibrate(options); }

int questionnaire(const QuestionnaireOptions& options) { return benchmarks().questionnaire(options); }

}  // namespace enc::app
