// The subcommands that live in modules, because few need what they need.
#include <algorithm>

#include "app/fit/fit_module.h"
#include "app/modules.h"
#include "app/options.h"
#include "trial/bench_module.h"

namespace enc::app {
namespace {

const trial::BenchModule& benchmarks() {
  return *static_cast<const trial::BenchModule*>(load_module("bench").bench);
}

const FitModule& fits() { return *static_cast<const FitModule*>(load_module("fit").fit); }

const ModuleInfo* module_if_there(const std::string& name) {
  const std::vector<std::string> there = modules_there();
  return std::find(there.begin(), there.end(), name) == there.end() ? nullptr : &load_module(name);
}

}  // namespace

int bench(const BenchOptions& options) { return benchmarks().bench(options, module_if_there); }

int fit(const FitOptions& options) { return fits().fit(options); }

int calibrate(const CalibrateOptions& options) { return fits().calibrate(options); }

int questionnaire(const QuestionnaireOptions& options) { return benchmarks().questionnaire(options); }

}  // namespace enc::app
