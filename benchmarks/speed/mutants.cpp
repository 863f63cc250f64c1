// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::speed {
namespace {

const Mutants kMutants{"speed",
                       {{.what = "the whole tick for step(); each tick counted twice",
                         .changes = {"whole_tick", "two_ticks"},
                         .kills = {"step_over_yardstick.median", "loop_over_yardstick.mean"}}}};

}  // namespace
}  // namespace enc::bench::speed
