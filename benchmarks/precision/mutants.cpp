// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::precision {
namespace {

const Mutants kMutants{"precision",
                       {{.what = "orders against the coarsest path; the force of 100 ms ago",
                         .changes = {"coarse_truth", "late_force"},
                         .kills = {"order.*.*", "*.error.rms"}}}};

}  // namespace
}  // namespace enc::bench::precision
