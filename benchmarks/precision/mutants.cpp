// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::precision {
namespace {

const Mutants kMutants{"precision",
                       {{.what = "orders against the coarsest path; the worst setting for the one that ships",
                         .changes = {"coarse_truth", "worst_setting"},
                         .kills = {"order.*.*", "*.error.rms"}}}};

}  // namespace
}  // namespace enc::bench::precision
