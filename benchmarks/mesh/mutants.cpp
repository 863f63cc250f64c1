// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::mesh {
namespace {

const Mutants kMutants{
    "mesh",
    {{.what = "tracker without the tool from the first moment; four meshes loaded; the worst tick for the "
              "median",
      .set = {"truth.tracker.blackout_at_s=0.5", "truth.tracker.blackout_for_s=1000"},
      .changes = {"four_meshes", "worst_tick"},
      .kills = {"step_over_yardstick.median", "load_over_yardstick.total", "contacts", "hold.time"}}}};

}  // namespace
}  // namespace enc::bench::mesh
