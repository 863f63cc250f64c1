// The subcommands of the module.
#pragma once

#include <string>
#include <vector>

#include "trial/bench_module.h"

namespace enc::bench {

int bench_command(const trial::BenchOptions& options, const trial::ModuleFinder& modules,
                  const std::vector<std::string>& others);
int mutate_command(const trial::BenchOptions& options, const trial::ModuleFinder& modules);
int questionnaire_command(const trial::QuestionnaireOptions& options);

}  // namespace enc::bench
