// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::footprint {
namespace {

const Mutants kMutants{"footprint",
                       {{.what = "camera/wall, which renders, in place of each scene",
                         .changes = {"camera_scene"},
                         .kills = {"*.threads", "plane.memory"}}}};

}  // namespace
}  // namespace enc::bench::footprint
