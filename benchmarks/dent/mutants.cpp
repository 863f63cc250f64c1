// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::dent {
namespace {

const Mutants kMutants{
    "dent",
    {{.what = "tool 1 % less deep; volume with the other sign; no vertex skipped",
      .changes = {"shallower", "turned_volume", "nothing_skipped"},
      .kills = {"contact_error.*.max", "volume_change.*.value", "straight_over_ours.median"}}}};

}  // namespace
}  // namespace enc::bench::dent
