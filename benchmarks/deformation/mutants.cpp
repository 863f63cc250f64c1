// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::deformation {
namespace {

const Mutants kMutants{"deformation",
                       {{.what = "the seen ball dented 0.7 times as deep",
                         .changes = {"shallow"},
                         .kills = {"contour.*.rms_mm", "dent.*.iou", "volume.*.iou"}}}};

}  // namespace
}  // namespace enc::bench::deformation
